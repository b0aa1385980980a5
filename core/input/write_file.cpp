#include "core/input/write_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace stiffscope {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

void writeInto(const fs::path& file, std::string_view bytes, const fs::path& named) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) fail(named, errno != 0 ? std::strerror(errno) : "the write failed");
}

}  // namespace

void writeFileWhole(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  if (path.filename().empty()) fail(path, "it names no file");
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(path, "it is a directory");
  if (fs::exists(status) && !fs::is_regular_file(status)) return writeInto(path, bytes, path);

  const fs::path file = fs::is_symlink(fs::symlink_status(path, error)) ? fs::weakly_canonical(path) : path;
  const fs::path temporary = file.string() + fmt::format(".{}.part", ::getpid());
  try {
    writeInto(temporary, bytes, path);
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

}  // namespace stiffscope
