#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope::interchange {

/// Metres in a unit of length by its name, in any of the languages seen: mm, millimeter, m, meter, in, inch, zoll, ".
/// nullopt for another.
std::optional<double> metresIn(std::string_view unit);

/// Metres in the unit that the user gave (`stated`); where that is empty, millimetres, with a warning that the file
/// states none. Throws InputError for a unit that is none.
double unitOrMillimetres(const std::string& file, const std::string& stated, std::vector<std::string>& warnings);

}  // namespace stiffscope::interchange
