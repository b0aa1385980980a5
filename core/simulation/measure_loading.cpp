#include <algorithm>

#include "core/input/input_error.h"
#include "core/simulation/load_cell.h"
#include "core/simulation/postures.h"
#include "core/simulation/session.h"

namespace stiffscope::simulation {

namespace {

const LinkFrame& cellParent(const SimulationSpec& spec) {
  const std::string& name = spec.load_cell->declared.parent;
  const auto found = std::find_if(spec.nominal.links.begin(), spec.nominal.links.end(),
                                  [&](const LinkFrame& link) { return link.name == name; });
  if (found == spec.nominal.links.end()) {
    throw InputError({spec.file.string(), 0, "parent"}, name, "expected a link on the chain of the URDF");
  }
  return *found;
}

void measureState(Session& session, const MachineState& state, int pose, int step) {
  const SimulationSpec& spec = session.spec;
  State row;
  row.pose = pose;
  row.step = step;
  row.time_s = session.now_s;
  row.q = session.reported(state.q);
  if (spec.load_cell) {
    row.wrench_in_cell = loadWrenchInCell(session.machine, state, cellParent(spec), spec.load_cell->declared);
  }
  session.campaign.states->rows.push_back(row);
  for (int repeat = 1; repeat <= spec.loading->repeats; ++repeat) {
    for (std::size_t t = 0; t < spec.targets.size(); ++t) {
      LoadingReading reading;
      reading.pose = pose;
      reading.step = step;
      reading.repeat = std::to_string(repeat);
      reading.target = static_cast<int>(t);
      reading.time_s = session.takeReading();
      reading.point = session.tracker_from_base * state.targets_in_base[t];
      session.campaign.loading->rows.push_back(reading);
    }
  }
}

}  // namespace

void measureLoading(Session& session) {
  const SimulationSpec& spec = session.spec;
  if (!spec.loading) return;
  session.campaign.loading = Loading{"loading.csv", PointFrame::tracker, {}};
  session.campaign.states = States{"states.csv", PointFrame::tracker, {}};
  const std::vector<Posture> postures = loadingPostures(spec);
  for (std::size_t p = 0; p < postures.size(); ++p) {
    session.campaign.pose_ids.push_back(std::to_string(p + 1));
    session.now_s += spec.timing.move_s;
    for (int step = 0; step <= loadSteps(*spec.loading); ++step) {
      if (step > 0) session.now_s += spec.timing.load_change_s;
      const AppliedLoad load =
          loadAtStep(*spec.loading, step, session.machine.gravity_in_base, postures[p].pull_direction);
      measureState(session, session.rest(postures[p].q, load), static_cast<int>(p), step);
    }
    measureNestsIfDue(session);
  }
}

}  // namespace stiffscope::simulation
