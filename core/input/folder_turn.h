#pragma once

#include <filesystem>

namespace stiffscope {

/// Held by one run at a time of those that write folders beside each other, as long as its process lives. A folder that was
/// replaced stands unlocked under the name of a part (part_folder.h), where another run would take it for abandoned.
class FolderTurn {
 public:
  /// Waits for it some seconds, and then, or where nothing can be locked, does without: a run that stands still must not
  /// hold up others for ever.
  explicit FolderTurn(const std::filesystem::path& parent);
  ~FolderTurn();
  FolderTurn(const FolderTurn&) = delete;
  FolderTurn& operator=(const FolderTurn&) = delete;

 private:
  int parent_;
};

}  // namespace stiffscope
