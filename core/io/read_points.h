#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope::io {

/// Points from a text file, one `x y z` a line, separated by blanks, tabs, commas or semicolons, in whatever
/// unit the file is. Empty lines and what follows a '#' are skipped; a first line of one whole number is the
/// count of points and must be it. There is no header line, but one behind a '#'. Throws InputError with file, line,
/// column, value and expectation.
std::vector<Eigen::Vector3d> readPoints(const std::filesystem::path& file);

/// The same from the bytes of such a file; `file` is its name for messages.
std::vector<Eigen::Vector3d> parsePoints(std::string_view bytes, const std::string& file);

}  // namespace stiffscope::io
