#include "core/io/write_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <stdexcept>

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

}  // namespace

void writeFileNamed(const fs::path& file, const ByteSource& bytes, const fs::path& named) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) failToOpen(named, errno);
  try {
    bytes([&](std::string_view part) { writeAll(descriptor, part, named); });
    synchronise(descriptor, named);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0) fail(named, std::strerror(errno));
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
    writeFileNamed(temporary, bytes, path);
    fs::rename(temporary, file, error);
    if (error) fail(path, error.message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

void makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": expected a folder that can be written: " + error.message());
}

}  // namespace stiffscope::io
