#include "core/audit/tool_distances.h"

#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/finding.h"

namespace stiffscope {

namespace {

/// Distances of one pair; `change` holds the distance itself until the reference is known.
std::vector<ToolDistance> distancesOf(const std::vector<StatePoints>& states, int first, int second,
                                      const TrackerNoise& noise) {
  std::vector<ToolDistance> found;
  found.reserve(states.size());
  for (std::size_t s = 0; s < states.size(); ++s) {
    const ReflectorMean* a = states[s].of(first);
    const ReflectorMean* b = states[s].of(second);
    if (a == nullptr || b == nullptr) continue;
    const Eigen::Vector3d between = b->point - a->point;
    const Eigen::Vector3d along = between.normalized();
    found.push_back(
        {s, first, second, between.norm(), std::sqrt(along.dot((a->covariance(noise) + b->covariance(noise)) * along))});
  }
  return found;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ToolDistances::Pair referenceOf(const std::vector<StatePoints>& states,
                                const std::vector<ToolDistance>& distances, double limit) {
  std::vector<double> unloaded;
  for (const ToolDistance& one : distances) {
    if (states[one.state].step == 0) unloaded.push_back(one.change);
  }
  const bool all = unloaded.size() < 3;
  if (all) {
    for (const ToolDistance& one : distances) unloaded.push_back(one.change);
  }
  const double middle = medianOf(unloaded);
  ToolDistances::Pair pair{distances.front().first, distances.front().second};
  double weights = 0.0, sum = 0.0;
  for (const ToolDistance& one : distances) {
    if ((!all && states[one.state].step != 0) || std::abs(one.change - middle) > limit * one.sd) continue;
    const double weight = 1.0 / (one.sd * one.sd);
    weights += weight;
    sum += weight * one.change;
    ++pair.states;
  }
  pair.reference = weights > 0.0 ? sum / weights : middle;
  pair.reference_sd = weights > 0.0 ? std::sqrt(1.0 / weights) : 0.0;
  return pair;
}

}  // namespace

const ToolDistances::Pair* ToolDistances::pair(int first, int second) const {
  for (const Pair& one : pairs) {
    if ((one.first == first && one.second == second) || (one.first == second && one.second == first))
      return &one;
  }
  return nullptr;
}

ToolDistances toolDistances(const std::vector<StatePoints>& states, int targets, const TrackerNoise& noise) {
  std::vector<std::vector<ToolDistance>> by_pair;
  std::size_t count = 0;
  for (int a = 0; a < targets; ++a) {
    for (int b = a + 1; b < targets; ++b) {
      std::vector<ToolDistance> found = distancesOf(states, a, b, noise);
      if (found.size() < 3) continue;
      count += found.size();
      by_pair.push_back(std::move(found));
    }
  }
  ToolDistances result;
  if (count == 0) return result;
  result.limit = normalLimit(kLevel / static_cast<double>(count));
  result.distances.reserve(count);
  for (std::vector<ToolDistance>& distances : by_pair) {
    const ToolDistances::Pair pair = referenceOf(states, distances, result.limit);
    result.pairs.push_back(pair);
    for (ToolDistance& one : distances) {
      one.change -= pair.reference;
      // A state that made the reference is not independent of it: the difference is then less uncertain than
      // this.
      one.sd = std::hypot(one.sd, pair.reference_sd);
      result.distances.push_back(one);
    }
    std::vector<ToolDistance>().swap(distances);
  }
  return result;
}

}  // namespace stiffscope
