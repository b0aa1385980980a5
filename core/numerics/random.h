#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string_view>

namespace stiffscope::numerics {

/// x with Phi(x) = p, Phi the standard normal distribution, 0 < p < 1, to about 16 digits. M. J. Wichura,
/// Algorithm AS 241 (PPND16), Applied Statistics 37 (1988). Written out because the standard library leaves
/// its normal distribution's algorithm open, and a seed must mean the same draws everywhere.
double inverseNormal(double p);

/// x between `low` and `high`, which may be infinite, with Phi(x) = Phi(low) + uniform (Phi(high) - Phi(low)): a
/// standard normal number given that it lies there, of a uniform one; rising with it and continuous in all three. `low`
/// where nothing lies between. Far from zero to about 10 digits.
double normalBetween(double low, double high, double uniform);

/// Independent random numbers for one purpose. Streams of different names are independent, so that asking one
/// section of a specification for more draws leaves every other section's as they were. The engine,
/// std::mt19937_64, is fully specified by the standard; one 64-bit word makes one number, uniform or normal.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  double uniform();  ///< in the open interval (0, 1), a multiple of 2^-53
  double uniform(double low, double high);
  double normal();            ///< mean 0, standard deviation 1
  Eigen::Vector3d normal3();  ///< three of them, x first

 private:
  std::mt19937_64 engine_;
};

}  // namespace stiffscope::numerics
