#include "core/input/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/input/input_error.h"
#include "core/input/utf8.h"

namespace stiffscope {

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

  /// Bytes that were there; fewer than asked for only at the end of the file.
  std::size_t read(char* into, std::size_t size) const {
    std::size_t done = 0;
    while (done < size) {
      const ssize_t some = ::read(descriptor_, into + done, size - done);
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

void requireUtf8(const fs::path& path, const std::string& bytes) {
  for (const std::string_view mark : {"\xFF\xFE", "\xFE\xFF"}) {
    if (bytes.starts_with(mark)) {
      refuse(path, "expected text in UTF-8; this file is UTF-16 by its byte-order mark, save it as UTF-8");
    }
  }
  if (bytes.find('\0') != std::string::npos) {
    refuse(path, "expected text in UTF-8; this file holds a byte 0 (UTF-16 or binary?)");
  }
  const std::size_t at = findNotUtf8(bytes);
  if (at == std::string::npos) return;
  const auto line = 1 + std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  refuse(path, "expected text in UTF-8; save the file in that encoding", static_cast<std::size_t>(line));
}

}  // namespace

TextFile readTextFileWithStamp(const fs::path& path, std::size_t largest) {
  const OpenFile file(path);
  const struct ::stat status = file.status();
  requireOrdinary(path, status, largest);
  TextFile text{std::string(static_cast<std::size_t>(status.st_size), '\0'), stampFrom(status)};
  const std::size_t size = file.read(text.bytes.data(), text.bytes.size());
  if (size != text.bytes.size() || stampFrom(file.status()) != text.stamp) {
    refuse(path, "expected a file that stays as it is; it changed while it was read");
  }
  if (text.bytes.empty()) refuse(path, "expected a file that is not empty");
  requireUtf8(path, text.bytes);
  return text;
}

std::string readTextFile(const fs::path& path, std::size_t largest) {
  return readTextFileWithStamp(path, largest).bytes;
}

}  // namespace stiffscope
