#pragma once

#include <filesystem>
#include <string_view>

namespace stiffscope {

/// Writes `bytes` to `path` so that the file appears whole or not at all: into a temporary beside it, which
/// is then renamed. Where `path` is a link the file it points to is replaced, where it is a device
/// (/dev/stdout) it is written directly. Throws std::runtime_error with path and reason; the temporary is
/// removed then.
void writeFileWhole(const std::filesystem::path& path, std::string_view bytes);

/// Writes `bytes` to `file` directly and waits until they are on the disk; messages name `named`. For files that another
/// step puts in their place.
void writeFileNamed(const std::filesystem::path& file, std::string_view bytes, const std::filesystem::path& named);

/// Makes a folder and those above it where they are absent. Throws std::runtime_error with path and reason.
void makeFolder(const std::filesystem::path& folder);

}  // namespace stiffscope
