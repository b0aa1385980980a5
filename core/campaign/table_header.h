#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope {

/// A column as the header line is matched against it.
struct WantedColumn {
  std::string name;
  bool required = true;
};

inline constexpr std::size_t kAbsentColumn = static_cast<std::size_t>(-1);

/// For each wanted column its place among `cells`, the header line's, or kAbsentColumn where an optional one
/// is absent. Columns that nobody wants go into one warning that names them all. Throws InputError, naming
/// `file` and `line`, for a required column that is missing, one that is there twice, and a file whose
/// columns are not separated by commas.
std::vector<std::size_t> matchHeader(const std::string& file, std::size_t line,
                                     const std::vector<std::string_view>& cells,
                                     const std::vector<WantedColumn>& wanted,
                                     std::vector<std::string>& warnings);

}  // namespace stiffscope
