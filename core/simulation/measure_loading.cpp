#include <algorithm>
#include <cmath>
#include <utility>

#include "core/input/input_error.h"
#include "core/simulation/load_cell.h"
#include "core/simulation/postures.h"
#include "core/simulation/session.h"
#include "core/simulation/target_motion.h"

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

/// What one posture carries from load to load.
struct PostureRun {
  const Posture& posture;
  int pose;
  ReflectorSeats seats;
  Eigen::VectorXd anchors{};      ///< of the sliders; set at arrival
  Eigen::VectorXd deformation{};  ///< of the state before, as it has come to by the change of load
};

/// The state as it is at the time of a reading: swinging, creeping.
MachineState stateNow(const Session& session, const PostureRun& run, const AppliedLoad& load,
                      const MachineState& rest, const Eigen::VectorXd& late, double since_s) {
  const SimulationSpec& spec = session.spec;
  const AppliedLoad swung = swungLoad(*spec.loading, load, session.now_s);
  const bool swings = spec.loading->swing != 0.0 && std::holds_alternative<DeadForce>(load);
  if (!swings && late.size() == 0) return rest;
  MachineState state = swings ? session.rest(rest.q, swung, &run.anchors) : rest;
  if (late.size() == 0) return state;
  const Eigen::VectorXd x = state.deformation - std::exp(-since_s / spec.machine.creep->time_constant) * late;
  const ElasticMachine& machine = session.machine;
  return machine.changes() ? stateAt(machineAt(machine, rest.q, session.now_s), rest.q, swung, x)
                           : stateAt(machine, rest.q, swung, x);
}

void readTargets(Session& session, PostureRun& run, const AppliedLoad& load, const MachineState& rest,
                 int step) {
  const SimulationSpec& spec = session.spec;
  const double changed_s = session.now_s;
  Eigen::VectorXd late;  // of the deformation, at the change of load
  if (spec.machine.creep && step > 0) {
    late = spec.machine.creep->share * (rest.deformation - run.deformation);
  }
  const std::vector<Eigen::Vector3d>& shifts =
      run.seats.under(rest.base_from_flange.linear().transpose() * rest.load_force_in_base);
  MachineState state = rest;
  for (int repeat = 1; repeat <= spec.loading->repeats; ++repeat) {
    for (std::size_t t = 0; t < spec.targets.size(); ++t) {
      LoadingReading reading;
      reading.pose = run.pose;
      reading.step = step;
      reading.repeat = std::to_string(repeat);
      reading.target = static_cast<int>(t);
      reading.time_s = session.takeReading();
      state = stateNow(session, run, load, rest, late, session.now_s - changed_s);
      const Eigen::Vector3d place =
          spec.targets[t].motion
              ? Eigen::Vector3d(state.targets_in_base[t] + state.base_from_flange.linear() * shifts[t])
              : state.targets_in_base[t];
      reading.point = session.station.readRobot(place, session.now_s);
      session.campaign.loading->rows.push_back(reading);
    }
  }
  run.deformation = late.size() == 0 ? rest.deformation : state.deformation;
}

void measureState(Session& session, PostureRun& run, int step) {
  const SimulationSpec& spec = session.spec;
  const Eigen::Vector3d unread =
      spec.load_cell ? spec.load_cell->unread_force : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const AppliedLoad load =
      loadAtStep(*spec.loading, step, session.machine.gravity_in_base, run.posture.pull_direction, unread);
  const MachineState rest = session.rest(run.posture.q, load, step > 0 ? &run.anchors : nullptr);
  run.anchors = step > 0 ? slippedAnchors(session.machine, rest, std::move(run.anchors))
                         : arrivedAnchors(session.machine, rest);
  State row;
  row.pose = run.pose;
  row.step = step;
  row.time_s = session.now_s;
  row.q = session.reported(rest.q);
  if (spec.load_cell) {
    row.wrench_in_cell = loadWrenchInCell(session.machine, rest, cellParent(spec), spec.load_cell->declared,
                                          spec.load_cell->place_error);
  }
  session.campaign.states->rows.push_back(row);
  readTargets(session, run, load, rest, step);
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
    PostureRun run{postures[p], static_cast<int>(p), ReflectorSeats(spec.targets)};
    for (int step = 0; step <= loadSteps(*spec.loading); ++step) {
      if (step > 0) session.now_s += spec.timing.load_change_s;
      measureState(session, run, step);
    }
    measureNestsIfDue(session);
  }
}

}  // namespace stiffscope::simulation
