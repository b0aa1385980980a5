#pragma once

#include <filesystem>
#include <string>

namespace stiffscope {

/// The bytes of a text file, read once. Throws InputError, naming the file and what was expected, where it is
/// missing, a directory or device, unreadable, empty, or no text in UTF-8.
std::string readTextFile(const std::filesystem::path& path);

}  // namespace stiffscope
