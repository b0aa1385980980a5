#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/finding.h"
#include "core/audit/rows.h"
#include "core/audit/tool_distances.h"

namespace stiffscope {

namespace {

struct Sum {
  double chi2 = 0.0;
  int dof = 0;
  double ratio() const { return dof > 0 ? chi2 / dof : 0.0; }
  double limit() const { return dof > 0 ? chiSquareLimit(kLevel, dof) / dof : 0.0; }
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

/// Whether a state's distances are those of the tool if its reflectors carry each other's names in this
/// order.
bool fitsRenamed(const ToolDistances& tool, const StatePoints& state, const std::vector<std::size_t>& order,
                 const TrackerNoise& noise) {
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const auto* pair = tool.pair(state.reflectors[order[a]].target, state.reflectors[order[b]].target);
      if (pair == nullptr) return false;
      const ReflectorMean& first = state.reflectors[a];
      const ReflectorMean& second = state.reflectors[b];
      const Eigen::Vector3d between = second.point - first.point;
      const Eigen::Vector3d along = between.normalized();
      const double sd = std::sqrt(along.dot((first.covariance(noise) + second.covariance(noise)) * along) +
                                  pair->reference_sd * pair->reference_sd);
      if (std::abs(between.norm() - pair->reference) > tool.limit * sd) return false;
    }
  }
  return true;
}

/// The exchange of names that would make a state's distances those of the tool.
std::string exchangeIn(const Campaign& campaign, const ToolDistances& tool, const StatePoints& state,
                       const TrackerNoise& noise) {
  std::vector<std::size_t> order(state.reflectors.size());
  std::iota(order.begin(), order.end(), 0);
  while (order.size() >= 3 && std::next_permutation(order.begin(), order.end())) {
    if (!fitsRenamed(tool, state, order, noise)) continue;
    std::string names;
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (order[k] == k) continue;
      names += fmt::format("{}{} is {}", names.empty() ? "" : ", ",
                           targetName(campaign, state.reflectors[k].target),
                           targetName(campaign, state.reflectors[order[k]].target));
    }
    return names;
  }
  return {};
}

class Inquiry {
 public:
  Inquiry(const Evidence& evidence, ToolDistances tool)
      : evidence_(evidence), campaign_(evidence.campaign), tool_(std::move(tool)) {}

  AuditCheck run() {
    const auto worst = std::max_element(
        tool_.distances.begin(), tool_.distances.end(),
        [](const auto& a, const auto& b) { return std::abs(a.change / a.sd) < std::abs(b.change / b.sd); });
    check_.id = "rigid_tool";
    check_.unit = "sigma";
    check_.value = std::abs(worst->change / worst->sd);
    check_.limit = tool_.limit;
    check_.limit_source = byChance(fmt::format("largest of {} normal deviates", tool_.distances.size()));
    check_.message = fmt::format("largest change of a distance: {} to {} by {:.0f} um at {}",
                                 targetName(campaign_, worst->first), targetName(campaign_, worst->second),
                                 1e6 * worst->change, nameOf(campaign_, evidence_.states[worst->state]));
    findExchanges();
    const Sum all = sumOf(tool_, [&](const ToolDistance& one) { return counts(one); });
    const bool spread = all.ratio() > all.limit();
    if (*check_.value <= *check_.limit && !spread) return check_;
    const bool doubled = all.ratio() > kFailVarianceRatio;
    check_.verdict = doubled || !exchanged_.empty() ? AuditVerdict::fail : AuditVerdict::warn;
    check_.message += fmt::format("; over all states distances scatter {:.2f} times as far as noise alone",
                                  std::sqrt(all.ratio()));
    nameReflector(all);
    nameExchanges();
    return check_;
  }

 private:
  bool counts(const ToolDistance& one) const { return !exchanged_.contains(one.state); }

  void findExchanges() {
    for (const ToolDistance& one : tool_.distances) {
      if (std::abs(one.change) <= tool_.limit * one.sd || exchanged_.contains(one.state)) continue;
      const std::string names = exchangeIn(campaign_, tool_, evidence_.states[one.state], *evidence_.noise);
      if (!names.empty()) exchanged_[one.state] = names;
    }
  }

  void nameExchanges() {
    for (const auto& [state, names] : exchanged_) {
      const StatePoints& points = evidence_.states[state];
      const std::string row = rowName(fileOf(campaign_, points), points.reflectors.front().line);
      if (state == exchanged_.begin()->first) check_.where = row;
      check_.message += fmt::format("; reflectors exchanged at {} ({}): {}", row, nameOf(campaign_, points), names);
    }
  }

  /// The reflector without which the other distances are those of a rigid tool.
  void nameReflector(const Sum& all) {
    if (all.ratio() <= all.limit() && !anyBeyond()) return;  // the exchanges were all there is
    int culprit = -1;
    double least = INFINITY;
    for (int k = 0; k < static_cast<int>(campaign_.targets.size()); ++k) {
      const Sum others = sumOf(
          tool_, [&](const ToolDistance& one) { return counts(one) && one.first != k && one.second != k; });
      if (others.dof == 0 || others.ratio() > others.limit() || others.ratio() >= least) continue;
      least = others.ratio();
      culprit = k;
    }
    if (culprit < 0) {
      check_.message +=
          "; no one reflector explains it: two move, the tool itself bends, or the tracker's noise is larger "
          "than declared";
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
      auto& [sum, count] = by_load[evidence_.states[one.state].step != 0];
      sum += one.change * one.change;
      ++count;
      if (first == nullptr && std::abs(one.change) > tool_.limit * one.sd) first = &one;
    }
    const std::string& name = targetName(campaign_, culprit);
    check_.where = name;
    if (first != nullptr) {
      const StatePoints& state = evidence_.states[first->state];
      check_.where = fmt::format("{}, {}", name, rowName(fileOf(campaign_, state), state.of(culprit)->line));
    }
    const auto rms = [&](bool loaded) {
      const auto& [sum, count] = by_load[loaded];
      return count > 0 ? 1e6 * std::sqrt(sum / count) : 0.0;
    };
    check_.message += fmt::format(
        "; reflector {} moves: the distances between the others hold, its own change by {:.0f} um "
        "rms under load and {:.0f} um without",
        name, rms(true), rms(false));
  }

  const Evidence& evidence_;
  const Campaign& campaign_;
  ToolDistances tool_;
  std::map<std::size_t, std::string> exchanged_;  ///< states whose reflectors carry each other's names
  AuditCheck check_;
};

}  // namespace

Findings checkRigidTool(const Evidence& evidence) {
  if (!evidence.noise) {
    return {
        notTestable("rigid_tool", "the tracker's noise is not declared: state `tracker` in campaign.xml")};
  }
  ToolDistances tool = toolDistances(evidence.states, static_cast<int>(evidence.campaign.targets.size()), *evidence.noise);
  if (tool.distances.empty()) {
    return {notTestable("rigid_tool",
                        "no two reflectors were read in the same states: read two or more in each")};
  }
  return {Inquiry(evidence, std::move(tool)).run()};
}

}  // namespace stiffscope
