#pragma once

#include <sys/stat.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace stiffscope::io {

/// Which file it is and its state: two stamps that are equal mean that nobody wrote to it, or replaced it, between
/// them, as far as the file system's clock shows (a write within the same tick of some milliseconds and without a
/// change of size stays unseen).
struct FileStamp {
  std::uint64_t device = 0, inode = 0;
  std::int64_t size = 0;
  std::int64_t modified_s = 0, modified_ns = 0;

  bool operator==(const FileStamp&) const = default;
};

FileStamp stampFrom(const struct ::stat& status);

/// Stamp of what `path` leads to; nullopt where there is nothing.
std::optional<FileStamp> stampOf(const std::filesystem::path& path);

/// Files that this process has read as input (readTextFileWithStamp), whatever name or link led to them. A measured day
/// cannot be had again: who writes a result asks first whether that would be over one of them.
void recordRead(const FileStamp& stamp);

/// Throws std::runtime_error where `path` was read; while a OneRun of the calling thread stands, only where it was read
/// since that began.
void requireNotRead(const std::filesystem::path& path);

/// While it stands, what its thread does is one run, whose inputs are what is read from now on, by whichever thread.
/// For a process that computes again and again: what one call has read, a later one may write anew. A program that runs
/// once needs none.
class OneRun {
 public:
  OneRun();
  ~OneRun();
  OneRun(const OneRun&) = delete;
  OneRun& operator=(const OneRun&) = delete;

 private:
  std::uint64_t readings_before_outer_;
};

/// Asks for large pages for memory that is about to be filled for the first time, where the system has them: each page
/// of four kilobytes that is touched costs its attention, a quarter of the time that reading a million rows takes.
/// Changes nothing but the time; of less than a few megabytes not even that.
void askForLargePages(void* begin, std::size_t bytes);

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
/// a device or a pipe, unreadable, empty, larger than `largest`, no text in UTF-8, or changes while it is read. Large
/// files are read on all cores.
TextFile readTextFileWithStamp(const std::filesystem::path& path, std::size_t largest = kLargestTable);

/// The bytes of a file in any encoding, unchecked, with its stamp.
TextFile readBytesWithStamp(const std::filesystem::path& path, std::size_t largest = kLargestTable);

/// The bytes alone.
std::string readTextFile(const std::filesystem::path& path, std::size_t largest = kLargestTable);

/// SHA-256 (FIPS 180-4) of `bytes`, 64 lower-case hex digits. Throws std::runtime_error where the system's
/// libcrypto refuses to compute it.
std::string sha256Hex(std::string_view bytes);

}  // namespace stiffscope::io
