#include "core/io/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/mman.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/io/input_error.h"
#include "core/io/xml.h"
#include "core/numerics/parallel.h"

namespace stiffscope::io {

FileStamp stampFrom(const struct ::stat& status) {
  return {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino),
          static_cast<std::int64_t>(status.st_size), static_cast<std::int64_t>(status.st_mtim.tv_sec),
          static_cast<std::int64_t>(status.st_mtim.tv_nsec)};
}

std::optional<FileStamp> stampOf(const std::filesystem::path& path) {
  struct ::stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return stampFrom(status);
}

namespace {

struct FilesRead {
  std::mutex mutex;
  std::uint64_t readings = 0;                                             ///< so far
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint64_t> last;  ///< reading of a device and inode, from 1
};

FilesRead& filesRead() {
  static FilesRead files;
  return files;
}

thread_local std::uint64_t readings_before_run = 0;

}  // namespace

void recordRead(const FileStamp& stamp) {
  FilesRead& files = filesRead();
  const std::lock_guard lock(files.mutex);
  files.last[{stamp.device, stamp.inode}] = ++files.readings;
}

void requireNotRead(const std::filesystem::path& path) {
  const auto stamp = stampOf(path);
  FilesRead& files = filesRead();
  const std::lock_guard lock(files.mutex);
  if (!stamp) return;
  const auto read = files.last.find({stamp->device, stamp->inode});
  if (read == files.last.end() || read->second <= readings_before_run) return;
  throw std::runtime_error(path.string() + ": not written: it is an input of this run; expected another file");
}

OneRun::OneRun() : readings_before_outer_(readings_before_run) {
  FilesRead& files = filesRead();
  const std::lock_guard lock(files.mutex);
  readings_before_run = files.readings;
}

OneRun::~OneRun() { readings_before_run = readings_before_outer_; }

#if defined(MADV_HUGEPAGE)

void askForLargePages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (first + kPage - 1) / kPage * kPage, to = (first + bytes) / kPage * kPage;
  if (from < to) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);  // a hint: no matter if it fails
}

#else

void askForLargePages(void*, std::size_t) {}

#endif

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& why, std::size_t line = 0) {
  throw InputError({path.string(), line, ""}, "", why);
}

[[noreturn]] void refuseUnreadable(const fs::path& path) {
  if (errno == ENOENT || errno == ENOTDIR) refuse(path, "expected a file; there is none");
  refuse(path, std::string("expected a readable file: ") + std::strerror(errno));
}

/// An open file. Opening a pipe without a writer does not wait, so that it can be refused.
class OpenFile {
 public:
  explicit OpenFile(const fs::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    if (descriptor_ < 0) refuseUnreadable(path);
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  struct ::stat status() const {
    struct ::stat status {};
    if (::fstat(descriptor_, &status) != 0) refuseUnreadable(path_);
    return status;
  }

  /// Bytes that were there behind the first `from`; fewer than asked for only at the end of the file.
  std::size_t read(char* into, std::size_t size, std::size_t from) const {
    std::size_t done = 0;
    while (done < size) {
      const ssize_t some = ::pread(descriptor_, into + done, size - done, static_cast<off_t>(from + done));
      if (some < 0 && errno == EINTR) continue;
      if (some < 0) refuseUnreadable(path_);
      if (some == 0) break;
      done += static_cast<std::size_t>(some);
    }
    return done;
  }

 private:
  const fs::path& path_;
  int descriptor_;
};

void requireOrdinary(const fs::path& path, const struct ::stat& status, std::size_t largest) {
  if (S_ISDIR(status.st_mode)) refuse(path, "expected a file; this is a directory");
  if (!S_ISREG(status.st_mode)) refuse(path, "expected an ordinary file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size <= largest) return;
  refuse(path, fmt::format("expected a file of at most {} MiB; this one has {}", largest >> 20, size >> 20));
}

void requireUtf8(const fs::path& path, std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xFE\0\0"sv) || bytes.starts_with("\0\0\xFE\xFF"sv)) {
    refuse(path, "expected text in UTF-8; this file is UTF-32 by its byte-order mark, save it as UTF-8");
  }
  for (const std::string_view mark : {"\xFF\xFE", "\xFE\xFF"}) {
    if (bytes.starts_with(mark)) {
      refuse(path, "expected text in UTF-8; this file is UTF-16 by its byte-order mark, save it as UTF-8");
    }
  }
  if (bytes.find('\0') != std::string_view::npos) {
    refuse(path, "expected text in UTF-8; this file holds a byte 0 (UTF-16 or binary?)");
  }
  const std::size_t at = findNotUtf8(bytes);
  if (at == std::string_view::npos) return;
  refuse(path, "expected text in UTF-8; save the file in that encoding", lineOf(bytes, at));
}

/// ASCII without a byte 0, as most text is.
bool isPlain(std::string_view bytes) {
  unsigned char odd = 0;
  for (const char c : bytes) odd |= static_cast<unsigned char>((c & 0x80) | (c == 0 ? 1 : 0));
  return odd == 0;
}

struct Bytes {
  std::shared_ptr<char[]> bytes;
  std::size_t size = 0;  ///< that were there
  bool plain = true;
};

/// The first `size` bytes, in blocks on all cores: each writes, and looks at, its own.
Bytes readBlocks(const OpenFile& file, std::size_t size) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  Bytes all{std::make_shared_for_overwrite<char[]>(size)};
  askForLargePages(all.bytes.get(), size);
  std::vector<std::size_t> sizes((size + kBlock - 1) / kBlock);
  std::vector<char> plain(sizes.size());
  numerics::onAllCores(sizes.size(), [&](std::size_t i) {
    char* const into = all.bytes.get() + i * kBlock;
    sizes[i] = file.read(into, std::min(kBlock, size - i * kBlock), i * kBlock);
    plain[i] = isPlain({into, sizes[i]});
  });
  all.size = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  all.plain = std::all_of(plain.begin(), plain.end(), [](char one) { return one != 0; });
  return all;
}

struct BytesRead {
  TextFile file;
  bool plain = true;
};

BytesRead readAll(const fs::path& path, std::size_t largest) {
  const OpenFile file(path);
  const struct ::stat status = file.status();
  requireOrdinary(path, status, largest);
  const auto size = static_cast<std::size_t>(status.st_size);
  const Bytes read = readBlocks(file, size);
  const TextFile text{read.bytes, size, stampFrom(status)};
  recordRead(text.stamp);
  if (read.size != size || stampFrom(file.status()) != text.stamp) {
    refuse(path, "expected a file that stays as it is; it changed while it was read");
  }
  if (size == 0) refuse(path, "expected a file that is not empty");
  return {text, read.plain};
}

}  // namespace

TextFile readTextFileWithStamp(const fs::path& path, std::size_t largest) {
  const BytesRead read = readAll(path, largest);
  if (!read.plain) requireUtf8(path, read.file.text());
  return read.file;
}

TextFile readBytesWithStamp(const fs::path& path, std::size_t largest) { return readAll(path, largest).file; }

std::string readTextFile(const fs::path& path, std::size_t largest) {
  return std::string(readTextFileWithStamp(path, largest).text());
}

std::string sha256Hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available from libcrypto");
  }
  std::string hex;
  for (unsigned int i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace stiffscope::io
