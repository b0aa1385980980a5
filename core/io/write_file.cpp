#include "core/io/write_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

namespace stiffscope::io {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

[[noreturn]] void failToOpen(const fs::path& path, int error) {
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (error == ENOENT || error == ENOTDIR)
    fail(path, fmt::format("expected a folder that is there; there is no {}", parent.string()));
  if (error == EACCES || error == EPERM || error == EROFS)
    fail(path, fmt::format("{}; expected a folder that can be written", std::strerror(error)));
  fail(path, std::strerror(error));
}

void writeAll(int file, std::string_view bytes, const fs::path& named) {
  while (!bytes.empty()) {
    const ssize_t some = ::write(file, bytes.data(), bytes.size());
    if (some < 0 && errno != EINTR) fail(named, std::strerror(errno));
    if (some > 0) bytes.remove_prefix(static_cast<std::size_t>(some));
  }
}

void synchronise(int file, const fs::path& named) {
  // A device or a pipe cannot be synchronised, and need not be.
  if (::fsync(file) != 0 && errno != EINVAL && errno != EROFS) fail(named, std::strerror(errno));
}

constexpr int kAnew = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
constexpr mode_t kMode = 0666;

/// Whether the file is one of a folder still; another run may have taken it for abandoned before it was locked.
bool isThere(int file) {
  struct ::stat status {};
  return ::fstat(file, &status) != 0 || status.st_nlink > 0;
}

/// Descriptor of a new file that is locked as long as it is open, where the file system has locks; -1, and errno.
int openLocked(const fs::path& file) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const int descriptor = ::open(file.c_str(), kAnew, kMode);
    if (descriptor < 0) return -1;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 || isThere(descriptor)) return descriptor;
    ::close(descriptor);
  }
  errno = EAGAIN;
  return -1;
}

bool isPipe(const fs::path& file) {
  std::error_code error;
  return fs::is_fifo(fs::status(file, error));
}

/// Descriptor of a named pipe once somebody reads it; -1, and errno. An ordinary opening would wait for ever.
int openPipe(const fs::path& pipe, const fs::path& named) {
  constexpr std::chrono::milliseconds kOften(50);
  constexpr std::chrono::seconds kLongest(5);
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (true) {
    const int descriptor = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor >= 0) {
      // From here on a slow reader is waited for.
      ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
      return descriptor;
    }
    if (errno != ENXIO && errno != EINTR) return -1;
    if (std::chrono::steady_clock::now() >= end)
      fail(named, "nobody reads this pipe; expected a program that reads it to be started before");
    std::this_thread::sleep_for(kOften);
  }
}

/// NAME.PID.part, as writeFileWhole calls what is not whole yet.
bool isPart(const std::string& name) {
  const std::string end = ".part";
  if (!name.ends_with(end)) return false;
  const std::string rest = name.substr(0, name.size() - end.size());
  const std::size_t point = rest.rfind('.');
  if (point == std::string::npos || point == 0 || point + 1 == rest.size()) return false;
  return std::all_of(rest.begin() + static_cast<std::ptrdiff_t>(point) + 1, rest.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Writes, waits until it is on the disk, and closes when `then` is done.
void writeOpened(int descriptor, const ByteSource& bytes, const fs::path& named, const std::function<void()>& then) {
  try {
    bytes([&](std::string_view part) { writeAll(descriptor, part, named); });
    synchronise(descriptor, named);
    then();
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0) fail(named, std::strerror(errno));
}

}  // namespace

void writeFileNamed(const fs::path& file, const ByteSource& bytes, const fs::path& named) {
  const int descriptor = isPipe(file) ? openPipe(file, named) : ::open(file.c_str(), kAnew, kMode);
  if (descriptor < 0) failToOpen(named, errno);
  writeOpened(descriptor, bytes, named, [] {});
}

void writeFileWhole(const fs::path& path, std::string_view bytes) {
  writeFileWhole(path, [bytes](const ByteSink& sink) { sink(bytes); });
}

void writeFileWhole(const fs::path& path, const ByteSource& bytes) {
  std::error_code error;
  if (path.filename().empty()) fail(path, "it names no file; expected the name of one");
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(path, "it is a directory; expected the name of a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) return writeFileNamed(path, bytes, path);

  const fs::path file = fs::is_symlink(fs::symlink_status(path, error)) ? fs::weakly_canonical(path) : path;
  const fs::path temporary = file.string() + fmt::format(".{}.part", ::getpid());
  try {
    const int descriptor = openLocked(temporary);
    if (descriptor < 0) failToOpen(path, errno);
    // Under its own name before it is unlocked: what is not locked passes for abandoned.
    writeOpened(descriptor, bytes, path, [&] {
      fs::rename(temporary, file, error);
      if (error) fail(path, error.message());
    });
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

void removeAbandonedParts(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!isPart(entry.path().filename().string()) || !entry.is_regular_file(error) || entry.is_symlink(error)) continue;
    const int part = ::open(entry.path().c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (part < 0) continue;
    if (::flock(part, LOCK_EX | LOCK_NB) == 0) fs::remove(entry.path(), error);
    ::close(part);
  }
}

void makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": expected a folder that can be written: " + error.message());
}

}  // namespace stiffscope::io
