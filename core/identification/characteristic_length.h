#pragma once

#include <vector>

#include "core/identification/load_case.h"

namespace stiffscope::identification {

/// The characteristic length L of paper (8) (Khan and Angeles): the length by which the displacement rows of
/// the stacked Jacobian are divided, chosen where its condition number is least.
struct CharacteristicLength {
  double length = 1.0;                           ///< m
  double condition = 0.0;                        ///< of the stacked normalised Jacobian at that length
  std::vector<std::pair<double, double>> curve;  ///< condition number against length, over 0.05 m to 20 m
};

/// Golden-section search on log L within 0.05 m to 20 m, started at the best point of `curve`.
CharacteristicLength characteristicLength(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange);

}  // namespace stiffscope::identification
