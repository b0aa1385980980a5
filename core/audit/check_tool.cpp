#include "core/audit/redundancies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>

#include "core/audit/checks.h"
#include "core/audit/remarks.h"
#include "core/campaign/row_names.h"
#include "core/numerics/distributions.h"
#include "core/numerics/resampling.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::audit {

namespace {

preparation::AuditCheck scatterCheck(const std::string& id, bool along, double chi2, int dof, double rms,
                                     double digit) {
  preparation::AuditCheck check;
  check.id = id;
  check.value = std::sqrt(chi2 / dof);
  check.limit = std::sqrt(numerics::chiSquareLimit(preparation::kLevel, dof) / dof);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square, dof));
  if (*check.value > *check.limit) {
    check.verdict = *check.value * *check.value > preparation::kFailVarianceRatio ? preparation::AuditVerdict::fail
                                                                                  : preparation::AuditVerdict::warn;
  }
  check.message =
      Remark(RemarkId::repeats_scatter, along, rms, *check.value, check.verdict != preparation::AuditVerdict::pass);
  // Repeats within seconds do not see all that a data sheet covers; less than half of it is another matter.
  constexpr double kFarBelow = 0.5;
  if (*check.value < kFarBelow) check.details.push_back(Remark(RemarkId::repeats_scatter_little));
  constexpr double kFelt = 0.05;  // of the variance
  if (digit * digit / 12.0 > kFelt * rms * rms) check.details.push_back(Remark(RemarkId::repeats_rounded, digit));
  return check;
}

}  // namespace

Findings checkRepeatability(const AuditInput& input) {
  const preparation::RepeatScatter& scatter = input.scatter;
  if (!scatter.tested) {
    return {preparation::notTestable("repeatability_along", scatter.reason),
            preparation::notTestable("repeatability_across", scatter.reason)};
  }
  return {scatterCheck("repeatability_along", true, scatter.along_chi2, scatter.along_dof, scatter.along_rms,
                       scatter.digit),
          scatterCheck("repeatability_across", false, scatter.across_chi2, scatter.across_dof, scatter.across_rms,
                       scatter.digit)};
}

namespace {

struct Sum {
  double chi2 = 0.0;
  int dof = 0;
  double ratio() const { return dof > 0 ? chi2 / dof : 0.0; }
  double limit() const { return dof > 0 ? numerics::chiSquareLimit(preparation::kLevel, dof) / dof : 0.0; }
};

/// Squares over the distances that `counts` lets through.
template <class Counts>
Sum sumOf(const ToolDistances& tool, const Counts& counts) {
  Sum sum;
  for (const ToolDistance& one : tool.distances) {
    if (!counts(one)) continue;
    sum.chi2 += one.change * one.change / (one.sd * one.sd);
    ++sum.dof;
  }
  return sum;
}

/// Finds, in a state whose distances are not those of the tool, the names with which they are: one reflector after the
/// other gets each name that suits its distances to those that have one. Two fixed reflectors leave the third few names
/// and three leave the others one, so that this takes the cube of their number in steps, not its factorial.
class Renaming {
 public:
  Renaming(const ToolDistances& tool, const campaign::StatePoints& state, const metrology::TrackerNoise& noise)
      : limit_(tool.limit), count_(state.reflectors.size()), seen_(count_ * count_), reference_(count_ * count_) {
    for (std::size_t a = 0; a < count_; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const campaign::ReflectorMean &first = state.reflectors[a], &second = state.reflectors[b];
        const Eigen::Vector3d between = second.point - first.point;
        const Eigen::Vector3d along = between.normalized();
        seen_[a * count_ + b] = {between.norm(),
                                 along.dot((first.covariance(noise) + second.covariance(noise)) * along)};
        const ToolDistances::Pair* pair = tool.pair(first.target, second.target);
        if (pair == nullptr) continue;
        reference_[a * count_ + b] =
            reference_[b * count_ + a] = {pair->reference, pair->reference_sd * pair->reference_sd};
      }
    }
  }

  /// By reflector which one it is; the first order in which all distances fit but one of no exchange. Empty: none does.
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> found;
    extend(found, true);
    return found;
  }

 private:
  struct Distance {
    double length = -1.0;  ///< m; of a pair whose reference is not known below zero
    double variance = 0.0;
  };

  /// Adds the other reflectors to `so_far`, of which all distances fit; false where that cannot be done.
  bool extend(std::vector<std::size_t>& so_far, bool unchanged) const {
    const std::size_t next = so_far.size();
    if (next == count_) return !unchanged;
    for (std::size_t name = 0; name < count_; ++name) {
      if (std::find(so_far.begin(), so_far.end(), name) != so_far.end() || !fits(so_far, name)) continue;
      so_far.push_back(name);
      if (extend(so_far, unchanged && name == next)) return true;
      so_far.pop_back();
    }
    return false;
  }

  bool fits(const std::vector<std::size_t>& so_far, std::size_t name) const {
    for (std::size_t other = 0; other < so_far.size(); ++other) {
      const Distance& seen = seen_[so_far.size() * count_ + other];
      const Distance& reference = reference_[name * count_ + so_far[other]];
      if (reference.length < 0.0) return false;
      const double off = std::abs(seen.length - reference.length);
      if (off > limit_ * std::sqrt(seen.variance + reference.variance)) return false;
    }
    return true;
  }

  double limit_;
  std::size_t count_;
  std::vector<Distance> seen_, reference_;  ///< of each two; seen: of a later one to an earlier one
};

/// The exchange of names that would make a state's distances those of the tool: in pairs, what a reflector is called
/// and what it is.
std::vector<std::string> exchangeIn(const campaign::Campaign& campaign, const ToolDistances& tool,
                                    const campaign::StatePoints& state, const metrology::TrackerNoise& noise) {
  if (state.reflectors.size() < 3) return {};
  const std::vector<std::size_t> order = Renaming(tool, state, noise).order();
  std::vector<std::string> names;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] == k) continue;
    names.push_back(campaign::targetName(campaign, state.reflectors[k].target));
    names.push_back(campaign::targetName(campaign, state.reflectors[order[k]].target));
  }
  return names;
}

class Inquiry {
 public:
  Inquiry(const AuditInput& input, ToolDistances tool)
      : input_(input), campaign_(input.campaign), tool_(std::move(tool)) {}

  preparation::AuditCheck run() {
    const auto worst = std::max_element(
        tool_.distances.begin(), tool_.distances.end(),
        [](const auto& a, const auto& b) { return std::abs(a.change / a.sd) < std::abs(b.change / b.sd); });
    check_.id = "rigid_tool";
    check_.value = std::abs(worst->change / worst->sd);
    check_.limit = tool_.limit;
    check_.limit_source = preparation::byChance(Remark(LimitId::normal_deviates, tool_.distances.size()));
    const std::string state = campaign::nameOf(campaign_, input_.states[worst->state]);
    const auto says = [&] {
      return Remark(RemarkId::distance_changes, campaign::targetName(campaign_, worst->first),
                    campaign::targetName(campaign_, worst->second), worst->change, state, more_);
    };
    check_.message = says();
    findExchanges();
    const Sum all = sumOf(tool_, [&](const ToolDistance& one) { return counts(one); });
    constexpr int kEnough = 20;
    constexpr double kFarBelow = 0.01;  // of the variance: repeats within seconds do not keep this well either
    if (all.dof >= kEnough && all.ratio() < kFarBelow)
      check_.details.push_back(Remark(RemarkId::distances_keep_too_well, std::sqrt(all.ratio())));
    const bool spread = all.ratio() > all.limit();
    if (*check_.value <= *check_.limit && !spread) return check_;
    const bool doubled = all.ratio() > preparation::kFailVarianceRatio;
    check_.verdict = doubled || !exchanged_.empty() ? preparation::AuditVerdict::fail : preparation::AuditVerdict::warn;
    more_.push_back(Remark(RemarkId::distances_scatter, std::sqrt(all.ratio())));
    nameReflector(all);
    nameExchanges();
    check_.message = says();
    return check_;
  }

 private:
  bool counts(const ToolDistance& one) const { return !exchanged_.contains(one.state); }

  void findExchanges() {
    std::set<std::size_t> searched;  // a state in which one reflector moved has many distances beyond the limit
    for (const ToolDistance& one : tool_.distances) {
      if (std::abs(one.change) <= tool_.limit * one.sd || !searched.insert(one.state).second) continue;
      const std::vector<std::string> names = exchangeIn(campaign_, tool_, input_.states[one.state], *input_.noise);
      if (!names.empty()) exchanged_[one.state] = names;
    }
  }

  /// States that follow each other and have the same exchange are named once: names change from some state on.
  void nameExchanges() {
    const std::size_t last_read = input_.states.size() - 1;
    for (auto one = exchanged_.begin(); one != exchanged_.end();) {
      auto last = one, next = std::next(one);
      std::int64_t count = 1;
      for (; next != exchanged_.end() && next->first == last->first + 1 && next->second == one->second; ++next, ++count)
        last = next;
      const campaign::StatePoints& points = input_.states[one->first];
      const std::string row = campaign::rowName(campaign::fileOf(campaign_, points), points.reflectors.front().line);
      const std::string name = campaign::nameOf(campaign_, points);
      if (one == exchanged_.begin()) check_.where = Remark(preparation::RemarkId::at_name, row);
      more_.push_back(Remark(RemarkId::reflectors_exchanged, row, name, one->second, count,
                             campaign::nameOf(campaign_, input_.states[last->first]), last->first == last_read));
      one = next;
    }
  }

  /// The reflector without which the other distances are those of a rigid tool.
  void nameReflector(const Sum& all) {
    if (all.ratio() <= all.limit() && !anyBeyond()) return;  // the exchanges were all there is
    int culprit = -1;
    double least = INFINITY;
    for (int k = 0; k < static_cast<int>(campaign_.targets.size()); ++k) {
      const Sum others =
          sumOf(tool_, [&](const ToolDistance& one) { return counts(one) && one.first != k && one.second != k; });
      if (others.dof == 0 || others.ratio() > others.limit() || others.ratio() >= least) continue;
      least = others.ratio();
      culprit = k;
    }
    if (culprit < 0) {
      more_.push_back(Remark(RemarkId::no_one_reflector));
      return;
    }
    describe(culprit);
  }

  bool anyBeyond() const {
    return std::any_of(tool_.distances.begin(), tool_.distances.end(), [&](const ToolDistance& one) {
      return counts(one) && std::abs(one.change) > tool_.limit * one.sd;
    });
  }

  void describe(int culprit) {
    std::map<bool, std::pair<double, int>> by_load;  // sums of squares: unloaded, loaded
    const ToolDistance* first = nullptr;
    for (const ToolDistance& one : tool_.distances) {
      if (!counts(one) || (one.first != culprit && one.second != culprit)) continue;
      auto& [sum, count] = by_load[input_.states[one.state].step != 0];
      sum += one.change * one.change;
      ++count;
      if (first == nullptr && std::abs(one.change) > tool_.limit * one.sd) first = &one;
    }
    const std::string& name = campaign::targetName(campaign_, culprit);
    check_.where = Remark(preparation::RemarkId::at_name, name);
    if (first != nullptr) {
      const campaign::StatePoints& state = input_.states[first->state];
      check_.where = Remark(RemarkId::at_moved_reflector, name,
                            campaign::rowName(campaign::fileOf(campaign_, state), state.of(culprit)->line));
    }
    const auto rms = [&](bool loaded) {
      const auto& [sum, count] = by_load[loaded];
      return count > 0 ? std::sqrt(sum / count) : 0.0;
    };
    more_.push_back(Remark(RemarkId::reflector_moves, name, rms(true), rms(false)));
  }

  const AuditInput& input_;
  const campaign::Campaign& campaign_;
  ToolDistances tool_;
  std::map<std::size_t, std::vector<std::string>> exchanged_;  ///< states whose reflectors carry each other's names
  std::vector<Remark> more_;                                   ///< to say beside the largest change
  preparation::AuditCheck check_;
};

}  // namespace

Findings checkRigidTool(const AuditInput& input) {
  if (!input.noise) {
    return {preparation::notTestable("rigid_tool", Remark(preparation::RemarkId::tracker_noise_not_declared))};
  }
  ToolDistances tool = toolDistances(input.states, static_cast<int>(input.campaign.targets.size()), *input.noise);
  if (tool.distances.empty()) {
    return {preparation::notTestable("rigid_tool", Remark(MissingId::no_two_reflectors_in_states))};
  }
  return {Inquiry(input, std::move(tool)).run()};
}

bool reflectorsExchanged(const AuditInput& input) {
  for (const preparation::AuditCheck& check : checkRigidTool(input)) {
    if (!check.message.is(RemarkId::distance_changes)) continue;
    const auto& more = std::get<std::vector<Remark>>(check.message.values.back());
    if (std::any_of(more.begin(), more.end(), [](const Remark& one) { return one.is(RemarkId::reflectors_exchanged); }))
      return true;
  }
  return false;
}

namespace {

/// Distances of one pair; `change` holds the distance itself until the reference is known.
std::vector<ToolDistance> distancesOf(const std::vector<campaign::StatePoints>& states, int first, int second,
                                      const metrology::TrackerNoise& noise) {
  std::vector<ToolDistance> found;
  found.reserve(states.size());
  for (std::size_t s = 0; s < states.size(); ++s) {
    const campaign::ReflectorMean* a = states[s].of(first);
    const campaign::ReflectorMean* b = states[s].of(second);
    if (a == nullptr || b == nullptr) continue;
    const Eigen::Vector3d between = b->point - a->point;
    const Eigen::Vector3d along = between.normalized();
    found.push_back({s, first, second, between.norm(),
                     std::sqrt(along.dot((a->covariance(noise) + b->covariance(noise)) * along))});
  }
  return found;
}

ToolDistances::Pair referenceOf(const std::vector<campaign::StatePoints>& states,
                                const std::vector<ToolDistance>& distances, double limit) {
  std::vector<double> unloaded;
  for (const ToolDistance& one : distances) {
    if (states[one.state].step == 0) unloaded.push_back(one.change);
  }
  const bool all = unloaded.size() < 3;
  if (all) {
    for (const ToolDistance& one : distances) unloaded.push_back(one.change);
  }
  const double middle = numerics::upperMedian(unloaded);
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
    if ((one.first == first && one.second == second) || (one.first == second && one.second == first)) return &one;
  }
  return nullptr;
}

ToolDistances toolDistances(const std::vector<campaign::StatePoints>& states, int targets,
                            const metrology::TrackerNoise& noise) {
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
  result.limit = numerics::normalLimit(preparation::kLevel / static_cast<double>(count));
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

}  // namespace stiffscope::audit
