#include "core/input/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/input/input_error.h"
#include "core/input/utf8.h"

namespace stiffscope {

namespace fs = std::filesystem;

std::string readTextFile(const fs::path& path) {
  const auto refuse = [&](const std::string& why) -> InputError { return {{path.string(), 0, ""}, "", why}; };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw refuse("expected a file; there is none");
  if (error) throw refuse("expected a readable file: " + error.message());
  if (fs::is_directory(status)) throw refuse("expected a file; this is a directory");
  if (!fs::is_regular_file(status)) throw refuse("expected an ordinary file");

  errno = 0;
  std::ifstream in(path, std::ios::binary);
  const auto unreadable = [&] {
    return refuse(std::string("expected a readable file: ") +
                  (errno ? std::strerror(errno) : "reading fails"));
  };
  if (!in) throw unreadable();
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw refuse("expected a readable file: " + error.message());
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in.bad() || static_cast<std::size_t>(in.gcount()) != bytes.size()) throw unreadable();
  if (bytes.empty()) throw refuse("expected a file that is not empty");
  if (bytes.find('\0') != std::string::npos) {
    throw refuse("expected text in UTF-8; this file holds a byte 0 (UTF-16 or binary?)");
  }
  if (const std::size_t at = findNotUtf8(bytes); at != std::string::npos) {
    const auto line = 1 + std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InputError({path.string(), static_cast<std::size_t>(line), ""}, "",
                     "expected text in UTF-8; save the file in that encoding");
  }
  return bytes;
}

}  // namespace stiffscope
