#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <optional>

namespace stiffscope {

/// Which file it is and its state: two stamps that are equal mean that nobody wrote to it, or replaced it, between
/// them, as far as the file system's clock shows (a write within the same tick of some milliseconds and without a change
/// of size stays unseen).
struct FileStamp {
  std::uint64_t device = 0, inode = 0;
  std::int64_t size = 0;
  std::int64_t modified_s = 0, modified_ns = 0;

  bool operator==(const FileStamp&) const = default;
};

FileStamp stampFrom(const struct ::stat& status);

/// Stamp of what `path` leads to; nullopt where there is nothing.
std::optional<FileStamp> stampOf(const std::filesystem::path& path);

}  // namespace stiffscope
