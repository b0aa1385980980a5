#pragma once

#include <filesystem>

namespace stiffscope {

/// A new folder beside `target`, named after it, that is removed with this object. It is locked as long as its process
/// lives; those that killed processes left unlocked are removed when a new one is made.
class PartFolder {
 public:
  /// Throws std::filesystem::filesystem_error where no folder can be made there.
  explicit PartFolder(const std::filesystem::path& target);
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace stiffscope
