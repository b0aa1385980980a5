#include "core/identification/load_step.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/identification/load_case.h"
#include "core/input/input_error.h"

namespace stiffscope {

namespace {

InputPlace inFile(const Campaign& campaign, const std::string& file) {
  return {(campaign.folder / file).string(), 0, {}};
}

}  // namespace

std::string whatLoadsLack(const Campaign& campaign) {
  if (!campaign.states) return "no 'states': joint angles and load-cell readings are needed to identify";
  if (!campaign.load_cell) return "no 'load_cell': where the measured wrench acts is needed to identify";
  if (!campaign.loading && !campaign.displacements) {
    return "neither 'loading' nor 'displacements': readings under load are needed to identify";
  }
  return {};
}

std::vector<int> loadSteps(const Campaign& campaign) {
  std::set<int> steps;
  if (campaign.states) {
    for (const State& state : campaign.states->rows) steps.insert(state.step);
  }
  steps.erase(0);
  return {steps.begin(), steps.end()};
}

std::map<int, double> meanForces(const Campaign& campaign) {
  if (!campaign.states) return {};
  struct Forces {
    double sum = 0.0;
    int count = 0;
  };
  std::map<int, Forces> forces;
  auto at = forces.end();
  for (const State& state : campaign.states->rows) {
    // A posture's steps follow one another in most tables.
    if (at != forces.end() && at->first != state.step) ++at;
    if (at == forces.end() || at->first != state.step) at = forces.try_emplace(state.step).first;
    at->second.sum += state.wrench_in_cell.head<3>().norm();
    ++at->second.count;
  }
  std::map<int, double> means;
  for (const auto& [step, force] : forces) means[step] = force.sum / force.count;
  return means;
}

std::vector<int> loadedSteps(const Campaign& campaign) {
  const std::map<int, double> forces = meanForces(campaign);
  constexpr double kReturn = 0.05;
  double most = 0.0;
  for (const auto& [step, force] : forces) {
    if (step != 0) most = std::max(most, force);
  }
  std::vector<int> steps;
  for (const auto& [step, force] : forces) {
    if (step != 0 && most > 0.0 && force >= kReturn * most) steps.push_back(step);
  }
  return steps;
}

int chosenStep(const Campaign& campaign, const std::optional<int>& asked) {
  const std::string lacking = whatLoadsLack(campaign);
  if (!lacking.empty()) throw InputError(inFile(campaign, "campaign.xml"), "", lacking);
  if (asked) {
    const std::vector<int> steps = loadSteps(campaign);
    if (std::find(steps.begin(), steps.end(), *asked) == steps.end()) {
      throw InputError(inFile(campaign, campaign.states->file), std::to_string(*asked),
                       steps.empty() ? "not a load step of this campaign, which has none"
                                     : fmt::format("not a load step of this campaign, which has {}",
                                                   fmt::join(steps, ", ")));
    }
    return *asked;
  }
  const auto heaviest = heaviestStep(campaign);
  if (!heaviest) throw InputError(inFile(campaign, campaign.states->file), "", "no load step has a force");
  return *heaviest;
}

}  // namespace stiffscope
