#include "core/calibration/unloaded_day.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/campaign/state_points.h"
#include "core/effects/all.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/frames/frames.h"
#include "core/numerics/parallel.h"

namespace stiffscope::calibration {

namespace {

/// A floor whose soft direction is not an axis of base_link: C of the turn C M is symmetric and full. By what it has
/// besides the two diagonal numbers of base_compliance.
std::vector<effects::BodyTwist> couplingTwists(const effects::LinearizationPoint&,
                                               const effects::PostureStates& posture, std::size_t i) {
  const robot::Wrench carried = effects::carried(posture[i], 0, Eigen::Vector3d::Zero());
  return {{.first_body = 1, .with_axis = true, .rotation = {carried.moment.y(), carried.moment.x(), 0.0}}};
}

effects::EffectModel baseCoupling() {
  effects::EffectModel model{.effect = effects::Effect::base_compliance, .twists = &couplingTwists};
  model.parts.push_back({.detail = "rocking",
                         .most = {1e-5},
                         .unit = "rad/Nm",
                         .names = {"rocking about x by the moment about y and about y by that about x"}});
  return model;
}

/// The structure's own compliances that the records of the loaded days have: their twists by the own weight alone.
class Bending {
 public:
  explicit Bending(const UnloadedDay& day) {
    geometry_.arm = day.arm;
    geometry_.weight = day.weight;
    for (const effects::Effect effect :
         {effects::Effect::link_compliance, effects::Effect::bearing_tilt, effects::Effect::base_compliance}) {
      for (effects::EffectModel& model : effects::modelsOf(effects::recordOf(effect), {day.arm.joints(), {}}))
        models_.push_back(model);
    }
    models_.push_back(baseCoupling());
  }
  Bending(const Bending&) = delete;
  Bending& operator=(const Bending&) = delete;

  /// Lets the arm sag by these from now on.
  void setSizes(const OwnCompliances& own) {
    geometry_.compliance = own.joints;
    if (own.bending.isZero(0.0)) return;
    Eigen::Index first = 0;
    for (const effects::EffectModel& model : models_) {
      const auto count = static_cast<Eigen::Index>(model.parameters());
      const Eigen::VectorXd sizes = own.bending.segment(first, count);
      if (!sizes.isZero(0.0)) point_.present.push_back({&model, sizes});
      first += count;
    }
  }

  std::vector<BendingTerm> terms() const {
    // Small arms turn softer than those that are loaded, and the own weight is a small load.
    constexpr double kFurther = 10.0;
    std::vector<BendingTerm> terms;
    for (const effects::EffectModel& model : models_) {
      for (const effects::EffectPart& part : model.parts) {
        for (std::size_t k = 0; k < part.most.size(); ++k) {
          terms.push_back({static_cast<std::size_t>(model.effect), part.detail, effects::parameterName(part, k),
                           effects::parameterUnit(part, k), kFurther * part.most[k], !part.positive});
        }
      }
    }
    return terms;
  }

  /// Where the arm comes to rest.
  effects::ArmState restAt(const JointVector& q) const { return effects::gravityEquilibrium(geometry_, point_, q); }

  std::vector<frames::SmallMotion> at(const effects::ArmState& rest) const {
    const effects::PostureStates states{rest};
    std::vector<frames::SmallMotion> motions;
    for (const effects::EffectModel& model : models_) {
      for (const effects::BodyTwist& twist : model.twists(point_, states, 0)) {
        motions.push_back({twist.rotation, twist.shift - twist.rotation.cross(twist.pivot)});
      }
    }
    return motions;
  }

 private:
  frames::LoadingGeometry geometry_;
  std::vector<effects::EffectModel> models_;
  effects::LinearizationPoint point_;
};

/// Of the body beyond each joint but the first on that joint; on the arm's joints those of the arm's bodies further
/// out, too (of six joints: on joint 2 the one beyond joint 3), since the forearm is as heavy. Axis 1 is upright.
/// Moments along a joint's own axis pull on nothing.
std::vector<FreeMoment> freeMoments(int joints) {
  std::vector<FreeMoment> moments;
  const auto add = [&](int joint, int body) {
    for (int k = 0; k < 3; ++k) moments.push_back({joint, body, Eigen::Vector3d::Unit(k)});
  };
  for (int joint = 1; joint < joints; ++joint) add(joint, joint);
  const int arm = std::max(3, robot::armJointsOf(joints));
  for (int joint = 1; joint < arm; ++joint) {
    for (int body = joint + 1; body < arm; ++body) add(joint, body);
  }
  return moments;
}

std::vector<double> pullsOf(const UnloadedDay& day, const JointVector& q, const Eigen::Vector3d& gravity) {
  const robot::ArmPosture posture = robot::postureAt(day.arm, q);
  std::vector<double> pulls;
  for (const FreeMoment& moment : day.free_moments) {
    const Eigen::Vector3d axis = robot::axisAt(day.arm, posture, moment.joint).direction;
    const Eigen::Vector3d arm = posture.motion[static_cast<std::size_t>(moment.body) + 1].linear() * moment.along;
    pulls.push_back(axis.dot(arm.cross(gravity)));
  }
  return pulls;
}

void setTimes(const std::vector<double>& times, UnloadedDay& day) {
  const std::size_t count = day.postures.size();
  day.times_known = std::all_of(times.begin(), times.end(), [](double t) { return std::isfinite(t); });
  if (count == 0) return;
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  if (day.times_known && *last > *first) {
    day.first_time_s = *first;
    day.time_span_s = *last - *first;
    for (std::size_t i = 0; i < count; ++i) day.postures[i].time = (times[i] - *first) / day.time_span_s;
    return;
  }
  day.times_known = false;
  for (std::size_t i = 0; i < count; ++i)
    day.postures[i].time = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
}

void setWarmth(std::vector<double> temperatures, UnloadedDay& day) {
  constexpr double kAlike = 0.1;  // K: thermometers of machines read no better
  if (temperatures.empty() ||
      !std::all_of(temperatures.begin(), temperatures.end(), [](double t) { return std::isfinite(t); }))
    return;
  const auto [least, most] = std::minmax_element(temperatures.begin(), temperatures.end());
  day.temperature_known = *most - *least >= kAlike;
  if (!day.temperature_known) return;
  const double mean =
      std::accumulate(temperatures.begin(), temperatures.end(), 0.0) / static_cast<double>(temperatures.size());
  for (std::size_t i = 0; i < temperatures.size(); ++i) day.postures[i].warmth = temperatures[i] - mean;
}

/// A row of `states` and the angles that the arm is taken to have stood at.
struct LoggedPosture {
  const campaign::State* state = nullptr;
  JointVector q;
};

std::vector<LoggedPosture> loggedPostures(const campaign::Campaign& campaign, JointAngles angles) {
  std::vector<LoggedPosture> log;
  if (!campaign.states) return log;
  const PerJoint<bool> commanded = commandedJoints(campaign);
  for (const campaign::State& state : campaign.states->rows) {
    log.push_back({&state, state.q});
    for (Eigen::Index j = 0; j < state.q.size() && angles == JointAngles::commanded; ++j) {
      // Rows under load need none.
      if (commanded[static_cast<std::size_t>(j)] && !std::isnan(state.extras().commanded[j]))
        log.back().q[j] = state.extras().commanded[j];
    }
  }
  // Rows of a table may be sorted by anything; without all times their order stands for time.
  if (std::all_of(log.begin(), log.end(), [](const LoggedPosture& at) { return std::isfinite(at.state->time_s); }))
    std::stable_sort(log.begin(), log.end(),
                     [](const LoggedPosture& a, const LoggedPosture& b) { return a.state->time_s < b.state->time_s; });
  return log;
}

/// Moves from posture to posture in the order of the log, those that were not read among them: the arm went there.
void setMoves(const std::vector<LoggedPosture>& log, UnloadedDay& day) {
  constexpr double kStill = 1e-5;  // rad: below the last digit of most logs
  struct Move {
    JointVector by, side;
  };
  const JointVector still = JointVector::Zero(day.arm.joints());
  std::vector<Move> moves(day.pose_ids.size(), {still, still});
  const LoggedPosture* before = nullptr;
  JointVector side = still;
  for (const LoggedPosture& at : log) {
    const JointVector by = before != nullptr ? JointVector(at.q - before->q) : still;
    for (Eigen::Index j = 0; j < by.size(); ++j) {
      if (std::abs(by[j]) >= kStill) side[j] = by[j] > 0.0 ? 1.0 : -1.0;
    }
    if (at.state->step == 0) moves[static_cast<std::size_t>(at.state->pose)] = {by, side};
    before = &at;
  }
  for (Posture& posture : day.postures) {
    posture.move = moves[static_cast<std::size_t>(posture.pose)].by;
    posture.side = moves[static_cast<std::size_t>(posture.pose)].side;
  }
}

}  // namespace

std::size_t UnloadedDay::readings() const {
  std::size_t sum = 0;
  for (const Posture& posture : postures) sum += posture.readings.size();
  return sum;
}

PerJoint<bool> commandedJoints(const campaign::Campaign& campaign) {
  PerJoint<bool> given(static_cast<std::size_t>(campaign.robot.joints()), campaign.states.has_value());
  if (!campaign.states) return given;
  for (const campaign::State& state : campaign.states->rows) {
    for (std::size_t j = 0; j < given.size(); ++j) {
      if (state.step == 0 && std::isnan(state.extras().commanded[static_cast<Eigen::Index>(j)])) given[j] = false;
    }
  }
  return given;
}

UnloadedDay unloadedDay(const campaign::Campaign& campaign, JointAngles angles) {
  UnloadedDay day;
  day.arm = campaign.robot;
  day.angles = angles;
  day.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, campaign.robot,
                                  Eigen::Isometry3d::Identity());
  day.masses_known = day.weight.links_known && day.weight.any();
  day.pose_ids = campaign.pose_ids;
  for (const campaign::Target& target : campaign.targets) day.targets.push_back(target.id);
  day.stations = campaign.stations;
  if (!campaign.loading || !campaign.states) return day;
  std::optional<metrology::TrackerNoise> noise;
  if (campaign.tracker) {
    noise = frames::trackerNoise(*campaign.tracker);
    day.station = campaign.tracker->station;
  }
  const std::vector<LoggedPosture> log = loggedPostures(campaign, angles);
  std::vector<const LoggedPosture*> at_pose(campaign.pose_ids.size(), nullptr);
  for (const LoggedPosture& at : log) {
    if (at.state->step == 0) at_pose[static_cast<std::size_t>(at.state->pose)] = &at;
  }
  if (day.masses_known) {
    day.bending = Bending(day).terms();
  } else if (!day.arm.coupled()) {
    // Of a coupled arm each body's weight pulls on several drives: masses have to be known.
    day.free_moments = freeMoments(day.arm.joints());
  }
  std::vector<const campaign::StatePoints*> in_order;
  const std::vector<campaign::StatePoints> all_points = campaign::statePoints(campaign);
  for (const campaign::StatePoints& points : all_points) {
    const bool unloaded = points.source == campaign::StatePoints::Source::loading && points.step == 0;
    if (unloaded && at_pose[static_cast<std::size_t>(points.pose)] != nullptr) in_order.push_back(&points);
  }
  const auto timeOf = [&](const campaign::StatePoints* points) {
    return at_pose[static_cast<std::size_t>(points->pose)]->state->time_s;
  };
  if (std::all_of(in_order.begin(), in_order.end(), [&](const auto* one) { return std::isfinite(timeOf(one)); }))
    std::stable_sort(in_order.begin(), in_order.end(),
                     [&](const auto* a, const auto* b) { return timeOf(a) < timeOf(b); });
  std::vector<double> times, temperatures;
  for (const campaign::StatePoints* one : in_order) {
    const campaign::StatePoints& points = *one;
    const LoggedPosture* at = at_pose[static_cast<std::size_t>(points.pose)];
    Posture posture(day.arm.joints());
    posture.pose = points.pose;
    posture.q = at->q;
    posture.pulls = pullsOf(day, posture.q, campaign.gravity_in_base);
    for (const campaign::ReflectorMean& mean : points.reflectors) {
      posture.readings.push_back({mean.target, mean.line, mean.point,
                                  noise ? mean.covariance(*noise) : Eigen::Matrix3d(Eigen::Matrix3d::Zero()), mean.from,
                                  mean.station});
    }
    times.push_back(at->state->time_s);
    temperatures.push_back(at->state->extras().temperature_c);
    day.postures.push_back(std::move(posture));
  }
  setTimes(times, day);
  setWarmth(std::move(temperatures), day);
  setMoves(log, day);
  letSag({JointVector::Zero(day.arm.joints()), {}}, day);
  return day;
}

void letSag(const OwnCompliances& own, UnloadedDay& day) {
  if (!day.masses_known) return;
  Bending bending(day);
  bending.setSizes(own);
  numerics::smallWorkOnAllCores(day.postures.size(), [&](std::size_t i) {
    Posture& posture = day.postures[i];
    const effects::ArmState rest = bending.restAt(posture.q);
    posture.torque = robot::weightTorque(day.arm, rest.posture, day.weight);
    posture.bends = bending.at(rest);
  });
}

}  // namespace stiffscope::calibration
