#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace stiffscope::io {

/// Takes the next bytes of a file.
using ByteSink = std::function<void(std::string_view)>;

/// Hands all bytes of a file to the sink, in as many parts as it likes: of a long file, so that they never
/// stand in memory together. The same ones whenever it is called.
using ByteSource = std::function<void(const ByteSink&)>;

/// Writes `bytes` to `path` so that the file appears whole or not at all: into a temporary beside it, which
/// is then renamed. Where `path` is a link the file it points to is replaced, where it is a device
/// (/dev/stdout) or a named pipe it is written directly; a pipe that nobody reads within five seconds is refused.
/// Throws std::runtime_error with path and reason; the temporary is removed then.
void writeFileWhole(const std::filesystem::path& path, std::string_view bytes);
void writeFileWhole(const std::filesystem::path& path, const ByteSource& bytes);

/// Removes what killed runs left of the files of a folder, NAME.PID.part. A run that writes holds its own locked, on
/// whichever machine it is; where the file system has no locks nothing is removed. Once a run and not once a file: a
/// folder may have many.
void removeAbandonedParts(const std::filesystem::path& folder);

/// Writes `bytes` to `file` directly and waits until they are on the disk; messages name `named`. For files
/// that another step puts in their place.
void writeFileNamed(const std::filesystem::path& file, const ByteSource& bytes, const std::filesystem::path& named);

/// Makes a folder and those above it where they are absent. Throws std::runtime_error with path and reason.
void makeFolder(const std::filesystem::path& folder);

}  // namespace stiffscope::io
