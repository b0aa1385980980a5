#include "core/identification/subset_sums.h"

#include "core/identification/decoupled_partial_pose.h"

namespace stiffscope {

namespace {

// Adding 0 instead of branching: which postures are used is as good as random.
double where(bool condition, double value) { return condition ? value : 0.0; }

void judge(const DeflectionJudge& judge, std::span<Subset> subsets, SubsetResidual Subset::*points) {
  if (judge.postures() == 0) return;
  std::vector<Vector6d> compliances;
  std::vector<std::vector<double>*> left;
  for (Subset& one : subsets) {
    compliances.push_back(one.compliance);
    left.push_back(&(one.*points).left);
  }
  judge.residuals(compliances, left);
  for (Subset& one : subsets) {
    const std::vector<double>& left = (one.*points).left;
    double left_used = 0.0, left_held_out = 0.0, used = 0.0, held_out = 0.0;
    for (std::size_t p = 0; p < left.size(); ++p) {
      const bool in = one.used[p] != 0;
      left_used += where(in, left[p]);
      left_held_out += where(!in, left[p]);
      used += where(in, judge.displacement()[p]);
      held_out += where(!in, judge.displacement()[p]);
    }
    (one.*points).compensated = {1.0 - left_used / used, 1.0 - left_held_out / held_out,
                                 1.0 - (left_held_out + left_used) / (held_out + used)};
  }
}

void add(const SubsetResidual& one, const std::vector<char>& used, SubsetJudgement& sum) {
  if (one.left.empty()) return;
  add(one.compensated, sum.compensated);
  sum.left_held_out.resize(one.left.size(), 0.0);
  for (std::size_t p = 0; p < one.left.size(); ++p) sum.left_held_out[p] += where(used[p] == 0, one.left[p]);
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
  sums.held_out.resize(subset.used.size(), 0);
  for (std::size_t p = 0; p < subset.used.size(); ++p) sums.held_out[p] += subset.used[p] == 0;
  add(subset.at_wrist, subset.used, sums.at_wrist);
  add(subset.at_targets, subset.used, sums.at_targets);
}

}  // namespace stiffscope
