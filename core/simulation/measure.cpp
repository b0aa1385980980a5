#include "core/simulation/measure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/campaign/campaign.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/numerics/random.h"
#include "core/simulation/carriage.h"
#include "core/simulation/equilibrium.h"
#include "core/simulation/gears.h"
#include "core/simulation/instruments.h"
#include "core/simulation/machine.h"
#include "core/simulation/postures.h"
#include "core/simulation/rotation.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The day in progress: what has been measured, and the clock. Only the truth; errors are added afterwards.
struct Session {
  const SimulationSpec& spec;
  const ElasticMachine& machine;
  campaign::Campaign campaign;
  Station station;
  double now_s = 0.0;
  double last_nests_s = 0.0;
  int standing_at = 0;  ///< index of the tracker's station
  Arrival arrival{spec.nominal.joints()};
  Carriage carriage{spec};

  /// The clock and the arm move on to the next posture.
  void moveTo(const JointVector& q);
  /// As it is now at q, with its links where their play leaves them.
  ElasticMachine machineNow(const JointVector& q, const JointVector& ahead) const;
  /// The machine at rest, now, its controller holding q. Throws InputError where it is not stable or collapses.
  MachineState rest(const JointVector& q, const AppliedLoad& load = {}, const Eigen::VectorXd* anchors = nullptr) const;
  JointVector reported(const JointVector& q) const;  ///< rounded to the read-back resolution
  /// What the controller logs of this state: where it stands still, or a little before.
  JointVector logged(const MachineState& state) const;
  /// Of the carriage, for the rows of an arm on a rail.
  double reportedRail() const { return carriage.onRail() ? carriage.reported() : campaign::kNotGiven; }
  /// A point of the robot in base_link with its carriage at zero, read now.
  Eigen::Vector3d read(const Eigen::Vector3d& point) const {
    return station.readRobot(point + carriage.displacement(), now_s);
  }
  /// The time a reading is finished; the clock moves on to it.
  double takeReading();
};

void measureNests(Session& session);       ///< one reading of every nest, now
void measureNestsIfDue(Session& session);  ///< if their interval has passed
void measureCircleSweeps(Session& session);
void measureWristSweep(Session& session);
void measureRailSweep(Session& session);
void measureLoading(Session& session);

namespace {

constexpr double kCarried = 1800.0;  ///< s, from one station of the tracker to the next: it settles there

const robot::LinkFrame& cellParent(const SimulationSpec& spec) {
  const std::string& name = spec.load_cell->declared.parent;
  const auto found = std::find_if(spec.nominal.links.begin(), spec.nominal.links.end(),
                                  [&](const robot::LinkFrame& link) { return link.name == name; });
  if (found == spec.nominal.links.end()) {
    throw io::InputError({spec.file.string(), 0, "parent"}, name, "expected a link on the chain of the URDF");
  }
  return *found;
}

/// Where a reflector is in base_link: on its seat, on a plate that may hang loose, on the arm as it stands.
Eigen::Vector3d reflectorPlace(const Session& session, const MachineState& state, ReflectorSeats& seats,
                               std::size_t target) {
  const TrueTarget& reflector = session.spec.targets[target];
  const std::optional<LoosePlate>& plate = session.spec.machine.loose_plate;
  if (!plate && !reflector.motion) return state.targets_in_base[target];
  const Eigen::Matrix3d flange = state.base_from_flange.linear();
  const Eigen::Vector3d force_in_flange = flange.transpose() * state.load_force_in_base;
  Eigen::Vector3d moved = seats.under(force_in_flange, session.now_s)[target];
  const Eigen::Vector3d gravity_in_flange = flange.transpose() * session.machine.gravity_in_base;
  if (plate && plate->direction.dot(gravity_in_flange) > 0.0) {
    const Eigen::Vector3d place = reflector.position_in_flange + moved;
    moved += rotationExp(plate->turn) * place + plate->shift - place;
  }
  return state.targets_in_base[target] + flange * moved;
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
MachineState stateNow(const Session& session, const PostureRun& run, const AppliedLoad& load, const MachineState& rest,
                      const Eigen::VectorXd& late, double since_s) {
  const SimulationSpec& spec = session.spec;
  const AppliedLoad swung = spec.loading ? swungLoad(*spec.loading, load, session.now_s) : load;
  const bool swings = spec.loading && spec.loading->swing != 0.0 && std::holds_alternative<DeadForce>(load);
  if (!swings && late.size() == 0) return rest;
  MachineState state = swings ? session.rest(rest.held, swung, &run.anchors) : rest;
  if (late.size() == 0) return state;
  const Eigen::VectorXd x = state.deformation - std::exp(-since_s / spec.machine.creep->time_constant) * late;
  return stateAt(session.machineNow(rest.q, rest.ahead), rest.q, swung, x);
}

void readTargets(Session& session, PostureRun& run, const AppliedLoad& load, const MachineState& rest, int step) {
  const SimulationSpec& spec = session.spec;
  const double changed_s = session.now_s;
  Eigen::VectorXd late;  // of the deformation, at the change of load
  if (spec.machine.creep && step > 0) {
    late = spec.machine.creep->share * (rest.deformation - run.deformation);
  }
  MachineState state = rest;
  const int repeats = spec.loading ? spec.loading->repeats : spec.unloaded_repeats;
  for (int repeat = 1; repeat <= repeats; ++repeat) {
    for (std::size_t t = 0; t < spec.targets.size(); ++t) {
      campaign::LoadingReading reading;
      reading.pose = run.pose;
      reading.step = step;
      reading.repeat = repeat;
      reading.target = static_cast<int>(t);
      reading.station = session.standing_at;
      reading.time_s = session.takeReading();
      state = stateNow(session, run, load, rest, late, session.now_s - changed_s);
      reading.point = session.read(reflectorPlace(session, state, run.seats, t));
      session.campaign.loading->rows.push_back(reading);
    }
  }
  run.deformation = late.size() == 0 ? rest.deformation : state.deformation;
}

void measureState(Session& session, PostureRun& run, int step) {
  const SimulationSpec& spec = session.spec;
  const Eigen::Vector3d unread =
      spec.load_cell ? spec.load_cell->unread_force : Eigen::Vector3d(Eigen::Vector3d::Zero());
  AppliedLoad load;
  if (spec.loading) {
    load = loadAtStep(*spec.loading, step, session.machine.gravity_in_base, run.posture.pull_direction, unread);
    // An anchor stands on the floor, and the machine's frame goes with the carriage.
    if (auto* cable = std::get_if<AnchoredCable>(&load)) cable->anchor_in_base -= session.carriage.displacement();
  }
  const MachineState rest = session.rest(run.posture.q, load, step > 0 ? &run.anchors : nullptr);
  run.anchors =
      step > 0 ? slippedAnchors(session.machine, rest, std::move(run.anchors)) : arrivedAnchors(session.machine, rest);
  campaign::State row(spec.nominal.joints());
  row.pose = run.pose;
  row.step = step;
  row.time_s = session.now_s;
  row.q = session.logged(rest);
  row.rail = session.reportedRail();
  if (spec.temperature) row.extras().temperature_c = spec.temperature->at(session.now_s);
  for (int i = 0; i < session.machine.joints(); ++i) {
    if (session.machine.truth.joints[static_cast<std::size_t>(i)].gear) row.extras().motor_side[i] = rest.motor_side[i];
  }
  if (spec.load_cell) {
    row.wrench_in_cell = loadWrenchInCell(session.machine, rest, cellParent(spec), spec.load_cell->declared,
                                          spec.load_cell->place_error);
  }
  session.campaign.states->rows.push_back(row);
  readTargets(session, run, load, rest, step);
}

}  // namespace

namespace {

/// To its next station where that begins with this posture; nests are read before and after.
void carryTracker(Session& session, int posture) {
  const std::vector<LaterStation>& later = session.spec.tracker.later;
  const auto next = static_cast<std::size_t>(session.standing_at);
  if (next >= later.size() || posture < later[next].before_posture) return;
  measureNests(session);
  session.station.stand(later[next].base_from_tracker);
  ++session.standing_at;
  session.now_s += kCarried;
  measureNests(session);
}

}  // namespace

void measureLoading(Session& session) {
  const SimulationSpec& spec = session.spec;
  if (!spec.loading && spec.postures.empty() && !spec.posture_draw) return;
  const int later_steps = spec.loading ? loadSteps(*spec.loading) : 0;
  session.campaign.loading = campaign::Loading{"loading.csv", campaign::PointFrame::tracker, {}};
  session.campaign.states = campaign::States{"states.csv", campaign::PointFrame::tracker, {}};
  const std::vector<Posture> postures = loadingPostures(spec);
  const std::vector<double> positions = carriagePositions(spec, postures.size());
  for (std::size_t p = 0; p < postures.size(); ++p) {
    session.campaign.pose_ids.push_back(std::to_string(p + 1));
    carryTracker(session, static_cast<int>(p + 1));
    session.carriage.driveTo(positions[p]);
    session.moveTo(postures[p].q);
    PostureRun run{postures[p], static_cast<int>(p), ReflectorSeats(spec, static_cast<int>(p))};
    for (int step = 0; step <= later_steps; ++step) {
      if (step > 0) session.now_s += spec.timing.load_change_s;
      measureState(session, run, step);
    }
    measureNestsIfDue(session);
  }
}

namespace {

/// Angles as stated; none are zeros.
JointVector orAtZero(const JointVector& angles, int count) {
  return angles.size() == 0 ? JointVector(JointVector::Zero(count)) : angles;
}

/// One target at a true state, read now.
template <class Row>
Row reading(Session& session, const MachineState& state, ReflectorSeats& seats, int index, int target) {
  Row row;
  row.index = std::to_string(index);
  row.target = target;
  row.q = session.logged(state);
  row.rail = session.reportedRail();
  row.time_s = session.takeReading();
  row.point = session.read(reflectorPlace(session, state, seats, static_cast<std::size_t>(target)));
  return row;
}

}  // namespace

void measureCircleSweeps(Session& session) {
  const SimulationSpec& spec = session.spec;
  if (spec.circle_sweeps.empty()) return;
  campaign::CircleSweeps table{"circle_sweeps.csv", campaign::PointFrame::tracker, {}};
  for (const CircleSweepSpec& sweep : spec.circle_sweeps) {
    for (int stop = 0; stop < sweep.count; ++stop) {
      JointVector q = orAtZero(sweep.others, spec.nominal.joints());
      q[sweep.axis] = sweep.start + (sweep.stop - sweep.start) * stop / (sweep.count - 1);
      session.moveTo(q);
      const MachineState state = session.rest(q);
      ReflectorSeats seats(spec, stop);
      for (std::size_t t = 0; t < spec.targets.size(); ++t) {
        table.rows.push_back(reading<campaign::CircleReading>(session, state, seats, stop, static_cast<int>(t)));
        table.rows.back().axis = sweep.axis;
      }
      measureNestsIfDue(session);
    }
  }
  session.campaign.circle_sweeps = std::move(table);
}

void measureWristSweep(Session& session) {
  const SimulationSpec& spec = session.spec;
  if (!spec.wrist_sweep) return;
  const WristSweepSpec& sweep = *spec.wrist_sweep;
  const int joints = spec.nominal.joints(), arm = robot::armJointsOf(joints);
  const int targets = static_cast<int>(spec.targets.size());
  const bool one = sweep.scheme == WristScheme::one_target;
  const int stops = one ? sweep.readings : sweep.readings / targets;
  numerics::RandomStream random(spec.seed, "wrist sweep");
  campaign::WristSweep table{"wrist_sweep.csv", campaign::PointFrame::tracker, {}};
  for (int stop = 0; stop < stops; ++stop) {
    JointVector q(joints);
    q.head(arm) = orAtZero(sweep.arm, arm);
    for (int k = 0; arm + k < joints; ++k) q[arm + k] = random.uniform(sweep.low[k], sweep.high[k]);
    session.moveTo(q);
    const MachineState state = session.rest(q);
    ReflectorSeats seats(spec, stop);
    // One target after the other: the first `readings % targets` of them get one reading more.
    const int share = sweep.readings / targets, longer = sweep.readings % targets;
    const int first = !one                          ? 0
                      : stop < longer * (share + 1) ? stop / (share + 1)
                                                    : longer + (stop - longer * (share + 1)) / share;
    for (int t = first; t < (one ? first + 1 : targets); ++t) {
      table.rows.push_back(reading<campaign::WristReading>(session, state, seats, stop, t));
    }
    measureNestsIfDue(session);
  }
  session.campaign.wrist_sweep = std::move(table);
}

void measureRailSweep(Session& session) {
  const SimulationSpec& spec = session.spec;
  const RailSpec& rail = spec.rail;
  if (!session.carriage.onRail() || rail.stops == 0) return;
  campaign::RailSweep table{"rail_sweep.csv", campaign::PointFrame::tracker, {}};
  const JointVector q = JointVector::Zero(spec.nominal.joints());
  for (int stop = 0; stop < rail.stops; ++stop) {
    session.carriage.driveTo(rail.low + (rail.high - rail.low) * stop / (rail.stops - 1));
    session.moveTo(q);
    const MachineState state = session.rest(q);
    ReflectorSeats seats(spec, stop);
    for (std::size_t t = 0; t < spec.targets.size(); ++t) {
      campaign::RailReading row;
      row.index = std::to_string(stop);
      row.target = static_cast<int>(t);
      row.rail = session.carriage.reported();
      row.station = session.standing_at;
      row.time_s = session.takeReading();
      row.point = session.read(reflectorPlace(session, state, seats, t));
      table.rows.push_back(row);
    }
    measureNestsIfDue(session);
  }
  session.carriage.driveTo(rail.sweeps_at);
  session.campaign.rail_sweep = std::move(table);
}

namespace {

constexpr double kLargest = 0.1;  ///< m and rad: what gives more has collapsed, and linear springs no longer hold

}  // namespace

void Session::moveTo(const JointVector& q) {
  now_s += spec.timing.move_s;
  arrival.moveTo(q);
}

ElasticMachine Session::machineNow(const JointVector& q, const JointVector& ahead) const {
  ElasticMachine now = machine.changes() ? machineAt(machine, q, now_s) : machine;
  if (carriage.onRail()) now.carryTo(carriage.reported());
  for (int i = 0; i < now.joints(); ++i) now.turnMotor(i, ahead[i]);
  return now;
}

MachineState Session::rest(const JointVector& q, const AppliedLoad& load, const Eigen::VectorXd* anchors) const {
  const bool link_side_held = spec.double_encoder == campaign::DoubleEncoder::active;
  const auto restsWith = [&](const JointVector& ahead) {
    const bool as_built = !machine.changes() && ahead.isZero(0.0);
    MachineState at = as_built ? equilibriumOnGears(machine, q, link_side_held, load, anchors)
                               : equilibriumOnGears(machineNow(q, ahead), q, link_side_held, load, anchors);
    at.ahead = ahead;
    return at;
  };
  const JointVector no_play = JointVector::Zero(q.size());
  MachineState state = restsWith(no_play);
  // Play turns the torque by nothing that would change its side.
  if (state.converged && hasLostMotion(machine.truth)) {
    const JointVector torques = driveTorques(machineNow(q, no_play), state, load, anchors);
    state = restsWith(lostMotions(machine.truth, arrival, torques));
  }
  const bool small = state.deformation.size() == 0 || state.deformation.cwiseAbs().maxCoeff() < kLargest;
  if (!state.converged || !small) {
    const JointVector deg = q / io::kDegree;
    throw io::InputError({spec.file.string(), 0, "q_deg"},
                         fmt::format("{:.3f}", fmt::join(deg.data(), deg.data() + deg.size(), " ")),
                         "expected a posture where the machine rests stably, giving less than 0.1 rad; stiffness "
                         "is too low or the "
                         "load too large");
  }
  return state;
}

JointVector Session::reported(const JointVector& q) const {
  const double step = spec.read_back_resolution;
  if (step <= 0.0) return q;
  return (q / step).array().round().matrix() * step;
}

JointVector Session::logged(const MachineState& state) const {
  // What gears hold elsewhere than the controller's target they hold from the arrival on.
  return reported(loggedAngles(spec.early_log, arrival) + (state.q - arrival.at));
}

double Session::takeReading() {
  now_s += spec.timing.reading_s;
  return now_s;
}

void measureNests(Session& session) {
  if (session.spec.nests.empty()) return;
  if (!session.campaign.nests) session.campaign.nests = campaign::Nests{"nests.csv", campaign::PointFrame::tracker, {}};
  for (std::size_t n = 0; n < session.spec.nests.size(); ++n) {
    campaign::NestReading reading;
    reading.time_s = session.takeReading();
    reading.nest = static_cast<int>(n);
    reading.station = session.standing_at;
    reading.point = session.station.readFloor(session.spec.nests[n].position_in_base, session.now_s);
    session.campaign.nests->rows.push_back(reading);
  }
  session.last_nests_s = session.now_s;
}

void measureNestsIfDue(Session& session) {
  if (session.now_s - session.last_nests_s >= session.spec.timing.nest_interval_s) measureNests(session);
}

namespace {

/// A spring or cylinder as its maker's sheet has it.
robot::Balancer declaredBalancer(const LinkSpring& spring) {
  const double length = (spring.to_in_base_at_zero - spring.from_in_base_at_zero).norm();
  robot::Balancer balancer;
  balancer.law = robot::SpringLaw{spring.rate, spring.tension, length};
  if (const auto& gas = spring.gas)
    balancer.law = robot::GasLaw{gas->pressure, gas->area, gas->volume, length, gas->exponent, gas->pushes};
  balancer.from = {spring.from_body, spring.from_in_base_at_zero};
  balancer.to = {spring.to_body, spring.to_in_base_at_zero};
  return balancer;
}

/// What the laboratory declares, before anything is measured.
campaign::Campaign declared(const ElasticMachine& machine, const SimulationSpec& spec) {
  campaign::Campaign campaign;
  campaign.name = spec.name;
  campaign.date = spec.date;
  campaign.robot = spec.nominal;
  for (const LinkSpring& spring : spec.machine.link_springs) {
    if (spring.declared) campaign.robot.balancers.push_back(declaredBalancer(spring));
  }
  campaign.base_link = spec.base_link;
  campaign.flange_link = spec.flange_link;
  campaign.double_encoder = spec.double_encoder;
  campaign.double_encoder_joints = spec.double_encoder_joints;
  if (spec.machine.base_tilt_declared) campaign.gravity_in_base = machine.gravity_in_base;
  campaign.tracker = spec.tracker.declared;
  for (const auto& target : spec.targets) campaign.targets.push_back({target.id, std::nullopt});
  if (spec.load_cell) campaign.load_cell = spec.load_cell->declared;
  if (spec.machine.tool.mass_kg > 0.0) campaign.tool = spec.machine.tool;
  for (const auto& nest : spec.nests) campaign.nest_ids.push_back(nest.id);
  if (!spec.tracker.later.empty()) campaign.stations.push_back({spec.tracker.station});
  for (const LaterStation& later : spec.tracker.later) campaign.stations.push_back({later.id});
  return campaign;
}

}  // namespace

campaign::Campaign measureWithoutNoise(const ElasticMachine& machine, const SimulationSpec& spec) {
  using namespace simulation;
  Session session{spec, machine, declared(machine, spec), Station(spec)};
  measureNests(session);
  measureCircleSweeps(session);
  measureWristSweep(session);
  measureRailSweep(session);
  if (spec.nests_after_sweeps) measureNests(session);
  session.station.startLoading();
  measureLoading(session);
  measureNests(session);
  return std::move(session.campaign);
}

namespace {

/// Lines as the written tables have them: readings are rejected by file and line.
void numberRows(campaign::Campaign& campaign) {
  const auto number = [](auto& table) {
    if (!table) return;
    std::size_t line = 2;
    for (auto& row : table->rows) row.line = line++;
  };
  number(campaign.circle_sweeps);
  number(campaign.wrist_sweep);
  number(campaign.rail_sweep);
  number(campaign.loading);
  number(campaign.states);
  number(campaign.displacements);
  number(campaign.nests);
}

}  // namespace

campaign::Campaign simulate(const SimulationSpec& spec) {
  using namespace simulation;
  campaign::Campaign campaign = measureWithoutNoise(buildMachine(spec), spec);
  const std::uint64_t noise_seed = noiseSeed(spec);
  if (spec.load_cell && campaign.states) addLoadCellErrors(*spec.load_cell, noise_seed, *campaign.states);
  if (campaign.states) addEncoderErrors(spec.machine.joints, noise_seed, *campaign.states);
  addTrackerNoise(spec.tracker.true_noise_factor, noise_seed, campaign);
  numberRows(campaign);
  return campaign;
}

}  // namespace stiffscope::simulation
