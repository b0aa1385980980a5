#include "core/identification/subset_sums.h"

#include "core/identification/decoupled_partial_pose.h"

namespace stiffscope {

namespace {

using PostureArray = Eigen::Map<const Eigen::ArrayXd>;

PostureArray each(const std::vector<double>& posture) {
  return {posture.data(), static_cast<Eigen::Index>(posture.size())};
}

void judge(const DeflectionJudge& judge, std::span<Subset> subsets, SubsetResidual Subset::*points) {
  if (judge.postures() == 0) return;
  std::vector<Vector6d> compliances;
  std::vector<std::vector<double>*> left;
  for (Subset& one : subsets) {
    compliances.push_back(one.compliance);
    left.push_back(&(one.*points).left);
  }
  judge.residuals(compliances, left);
  const PostureArray displacement = each(judge.displacement());
  const double whole = displacement.sum();
  for (Subset& one : subsets) {
    const PostureArray left = each((one.*points).left);
    const double left_used = (left * one.used).sum(), left_whole = left.sum(), used = (displacement * one.used).sum();
    (one.*points).compensated = {1.0 - left_used / used, 1.0 - (left_whole - left_used) / (whole - used),
                                 1.0 - left_whole / whole};
  }
}

void add(const SubsetResidual& one, const Eigen::ArrayXd& used, SubsetJudgement& sum) {
  if (one.left.empty()) return;
  add(one.compensated, sum.compensated);
  sum.left_held_out.resize(one.left.size(), 0.0);
  Eigen::Map<Eigen::ArrayXd>(sum.left_held_out.data(), used.size()) += (1.0 - used) * each(one.left);
}

}  // namespace

Vector6d solveSubset(const SubsetMethod& method, const NormalEquations& normal, const NormalEquations& reflectors) {
  return method.reflectors.empty() ? solveNormal(normal, method.unknown)
                                   : solveDecoupled(normal, reflectors, method.unknown);
}

void judgeSubsets(const SubsetMethod& method, std::span<Subset> subsets) {
  judge(method.at_wrist, subsets, &Subset::at_wrist);
  judge(method.at_targets, subsets, &Subset::at_targets);
}

void add(const SubsetCompensation& one, SubsetCompensation& sum) {
  sum.used += one.used;
  sum.held_out += one.held_out;
  sum.all += one.all;
}

void add(const Subset& subset, SubsetSums& sums) {
  sums.compliances.push_back(subset.compliance);
  if (sums.held_out.size() == 0) sums.held_out.setZero(subset.used.size());
  sums.held_out += 1.0 - subset.used;
  add(subset.at_wrist, subset.used, sums.at_wrist);
  add(subset.at_targets, subset.used, sums.at_targets);
}

}  // namespace stiffscope
