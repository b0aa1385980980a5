#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/interchange/point_reading.h"

namespace stiffscope::interchange {

/// The format of that name. Throws InputError, naming `option`, for another.
PointFormat pointFormatNamed(const std::string& name, const std::string& option);

/// Reads a file of points of any of the formats. Which one follows from how the file is built, never from words that a
/// translation changes. Throws InputError, with line and what was seen, where nothing or more than one format fits (the
/// candidates are named), where the file is not of the format wanted, and where a row is not as its format has it.
PointFile readPointFile(const std::filesystem::path& path, const FileOptions& options = {});

/// The same of bytes; `file` is their name for messages.
PointFile parsePointFile(const std::string& file, std::string_view bytes, const FileOptions& options = {});

}  // namespace stiffscope::interchange
