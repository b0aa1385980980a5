#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/planning/design_value.h"

namespace stiffscope {

struct DesignProblem {
  std::vector<Matrix6d> information;  ///< of each candidate
  Matrix6d known = Matrix6d::Zero();  ///< of what is measured already
  JointMask unknown{};
  /// Which candidates may not be chosen together (too near each other), by rows; and which not at all.
  std::vector<std::vector<char>> excludes;
  std::vector<char> barred;
  std::optional<Vector6d> reference;  ///< as in designValue, rad/Nm
};

struct ExchangeOptions {
  int starts = 4;                 ///< random ones: exchanges end in a local optimum
  std::vector<std::size_t> from;  ///< one start more, if not empty, before the random ones
  int most_passes = 60;
  std::uint64_t seed = 1;
};

struct Design {
  std::vector<std::size_t> chosen;  ///< in the order in which each next one adds most to the logarithm
  double log_determinant = 0.0;     ///< of `known` and all chosen
  int passes = 0;                   ///< over all starts
};

/// The best choice of `count` candidates by designValue, none twice: exchanges of each chosen one for the
/// candidate that raises it most, until no exchange does. V. V. Fedorov, Theory of Optimal Experiments, 1972,
/// in the form of R. D. Cook and C. J. Nachtsheim, Technometrics 22 (1980) 315. Fewer are chosen where the
/// exclusions leave no more.
Design exchangeDesign(const DesignProblem& problem, int count, const ExchangeOptions& options = {});

/// A random choice that keeps the exclusions.
std::vector<std::size_t> randomDesign(const DesignProblem& problem, int count, std::uint64_t seed);

/// Sum of `known` and of those chosen.
Matrix6d informationOf(const DesignProblem& problem, const std::vector<std::size_t>& chosen);

}  // namespace stiffscope
