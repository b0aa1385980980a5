#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace stiffscope::conformity {

/// What a limit can be on, in the unit that its name ends in. Of a loaded day: the stiffnesses by the method shown
/// first, what it compensates on postures held out, the softest direction at P_TCP over the day's postures, and, of a
/// pair, what active encoders avoid. Of an unloaded day: position errors on postures held out, by the URDF's arm and by
/// the calibrated one. Of circle sweeps: the largest difference of a distance between axes from the URDF's.
enum class Quantity {
  k1,
  k2,
  k3,
  k4,
  k5,
  k6,
  compensated_at_reflectors,
  compensated_at_wrist,
  softest,
  avoided,
  nominal_rms,
  nominal_largest,
  calibrated_rms,
  calibrated_largest,
  link_difference
};

/// The name of a quantity in a file of limits and its unit in SI: a value in the file times `unit` is SI.
struct QuantityName {
  Quantity quantity;
  const char* name;
  double unit;
};

/// All quantities, in the order of the enumeration.
const std::vector<QuantityName>& quantityNames();
const QuantityName& nameOf(Quantity quantity);

/// One acceptance limit, SI: the quantity is to be at least, or at most, this. One of the two may be absent.
struct Limit {
  Quantity quantity = Quantity::k1;
  std::optional<double> least, most;
  std::string reason;    ///< who asks for it and why, as the file says
  std::size_t line = 0;  ///< in the file
};

/// A file of limits.
struct Limits {
  std::string file;    ///< its bare name
  std::string sha256;  ///< of its bytes
  std::vector<Limit> limits;
};

/// Reads a table (CSV) of the columns `name`, `least`, `most`, `reason`: a row a limit. Throws InputError, with file,
/// line, column and value, for a name that is not known (with the nearest that is) or stands there twice, a number that
/// is none, a row without a number or with `least` above `most`, and a row without a reason.
Limits readLimits(const std::filesystem::path& path);

}  // namespace stiffscope::conformity
