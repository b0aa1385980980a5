#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/input/file_stamp.h"

namespace stiffscope {

/// Largest files that are read: tables of some ten million readings, and XML that no person and no exporter exceeds. A
/// larger file is refused by its size, before any of it is in memory.
inline constexpr std::size_t kLargestTable = std::size_t{1} << 30;
inline constexpr std::size_t kLargestXml = std::size_t{1} << 24;

/// Bytes that were read; copies share them.
struct TextFile {
  std::shared_ptr<const char[]> bytes;
  std::size_t size = 0;
  FileStamp stamp;  ///< before and after the reading

  std::string_view text() const { return {bytes.get(), size}; }
};

/// A text file, read once. Throws InputError, naming the file and what was expected, where it is missing, a directory,
/// a device or a pipe, unreadable, empty, larger than `largest`, no text in UTF-8, or changes while it is read. Large files
/// are read on all cores.
TextFile readTextFileWithStamp(const std::filesystem::path& path, std::size_t largest = kLargestTable);

/// The bytes alone.
std::string readTextFile(const std::filesystem::path& path, std::size_t largest = kLargestTable);

}  // namespace stiffscope
