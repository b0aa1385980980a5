#pragma once

#include <filesystem>
#include <string>

namespace stiffscope {

/// A folder of its own for one test, removed with it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A campaign of a few rows with every element and table of the format, written by hand, to be altered.
class SmallCampaign {
 public:
  SmallCampaign();

  const std::filesystem::path& folder() const { return folder_.path(); }
  void write(const std::string& file, const std::string& bytes) const;
  std::string read(const std::string& file) const;
  void remove(const std::string& file) const;

  /// Replaces the first `find` in a file; fails the test where there is none.
  void alter(const std::string& file, const std::string& find, const std::string& replace) const;

 private:
  TemporaryFolder folder_;
};

}  // namespace stiffscope
