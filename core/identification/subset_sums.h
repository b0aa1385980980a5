#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/identification/subsets.h"

namespace stiffscope {

/// One subset's result at one kind of point.
struct SubsetResidual {
  std::vector<double> left;  ///< per posture, m; empty where these points are not measured
  SubsetCompensation compensated;
};

/// One subset, solved and judged.
struct Subset {
  Eigen::ArrayXd used;  ///< a posture each: 1 where the subset uses it, else 0
  Vector6d compliance = Vector6d::Zero();
  SubsetResidual at_wrist, at_targets;
};

/// From the sums of the equations of the postures that a subset uses; `reflectors` only for the decoupled method.
Vector6d solveSubset(const SubsetMethod& method, const NormalEquations& normal, const NormalEquations& reflectors);

/// Judges solved subsets: some at a time are quicker than one by one.
void judgeSubsets(const SubsetMethod& method, std::span<Subset> subsets);

/// Results of some subsets, in the order in which they were added.
struct SubsetSums {
  std::vector<Vector6d> compliances;
  SubsetJudgement at_wrist, at_targets;  ///< sums
  Eigen::ArrayXd held_out;               ///< subsets that leave each posture out
};

void add(const SubsetCompensation& one, SubsetCompensation& sum);
void add(const Subset& subset, SubsetSums& sums);

}  // namespace stiffscope
