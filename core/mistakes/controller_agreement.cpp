#include "core/mistakes/controller_agreement.h"

#include <algorithm>
#include <cmath>

#include "core/calibration/arm_fit.h"
#include "core/calibration/fitted_day.h"
#include "core/io/units.h"
#include "core/mistakes/arm_search.h"
#include "core/mistakes/remarks.h"
#include "core/robot/kinematics.h"

namespace stiffscope::mistakes {

namespace {

std::vector<const campaign::State*> statesWithPose(const campaign::Campaign& campaign) {
  std::vector<const campaign::State*> states;
  if (!campaign.states) return states;
  for (const campaign::State& row : campaign.states->rows) {
    if (!row.hasExtras() || !row.extras().tool_pose.hasPosition()) continue;
    // Load steps of one posture repeat its figures.
    const bool again =
        !states.empty() && states.back()->q == row.q &&
        states.back()->extras().tool_pose.position == row.extras().tool_pose.position &&
        (states.back()->extras().tool_pose.rpy == row.extras().tool_pose.rpy || !row.extras().tool_pose.hasTurn());
    if (!again) states.push_back(&row);
  }
  return states;
}

/// `most` of them, evenly.
std::vector<const campaign::State*> someOf(const std::vector<const campaign::State*>& states, std::size_t most) {
  if (states.size() <= most) return states;
  std::vector<const campaign::State*> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(states[i * states.size() / most]);
  return some;
}

/// A day whose reflectors are points of the controller's tool, read without noise where the controller says they are.
campaign::Campaign asReadings(const campaign::Campaign& campaign, const std::vector<const campaign::State*>& states,
                              bool turns) {
  campaign::Campaign day;
  day.robot = campaign.robot;
  day.base_link = campaign.base_link;
  day.flange_link = campaign.flange_link;
  day.gravity_in_base = campaign.gravity_in_base;
  day.tool = campaign.tool;
  // What is below the digits of any controller counts as equal.
  constexpr double kDigits = 10e-6;  // m
  day.tracker = campaign::Tracker{"controller", kDigits, 0.0, kDigits, 0.0, Eigen::Vector3d::Zero()};
  std::vector<Eigen::Vector3d> on_tool{Eigen::Vector3d::Zero()};
  day.targets.push_back({"tool", std::nullopt});
  for (int axis = 0; turns && axis < 3; ++axis) {
    on_tool.push_back(ControllerAgreement::kLever * Eigen::Vector3d::Unit(axis));
    day.targets.push_back({std::string("tool ") + "xyz"[axis], std::nullopt});
  }
  day.loading.emplace().file = campaign.states->file;
  day.states.emplace().file = campaign.states->file;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const campaign::State& state = *states[i];
    day.pose_ids.push_back(campaign.pose_ids[static_cast<std::size_t>(state.pose)]);
    campaign::State row(static_cast<int>(state.q.size()));
    row.pose = static_cast<int>(i);
    row.q = state.q;
    row.line = state.line;
    day.states->rows.push_back(row);
    const Eigen::Matrix3d turn =
        turns ? robot::rotationFromRpy(state.extras().tool_pose.rpy) : Eigen::Matrix3d::Identity();
    for (std::size_t t = 0; t < on_tool.size(); ++t) {
      campaign::LoadingReading reading;
      reading.pose = row.pose;
      reading.target = static_cast<int>(t);
      reading.point = state.extras().tool_pose.position + turn * on_tool[t];
      reading.line = state.line;
      day.loading->rows.push_back(std::move(reading));
    }
  }
  return day;
}

std::vector<int> stillJoints(const std::vector<const campaign::State*>& states) {
  constexpr double kMoves = 1.0 * io::kDegree;
  std::vector<int> still;
  for (Eigen::Index j = 0; j < states.front()->q.size(); ++j) {
    double least = states.front()->q[j], most = least;
    for (const campaign::State* state : states) {
      least = std::min(least, state->q[j]);
      most = std::max(most, state->q[j]);
    }
    if (most - least < kMoves) still.push_back(static_cast<int>(j) + 1);
  }
  return still;
}

ReadingsOfDay rigidReadings(const campaign::Campaign& day) {
  ReadingsOfDay readings = readingsOf(day);
  readings.weight = {};
  return readings;
}

/// Of all postures, by a fit to some.
void describe(const NominalFit& fit, const robot::Robot& robot, const campaign::Campaign& all,
              ControllerAgreement& agreement) {
  ReadingsOfDay day;
  day.robot = robot;
  double squares = 0.0;
  for (const campaign::LoadingReading& row : all.loading->rows) {
    UnloadedReading reading;
    reading.target = row.target;
    reading.q = all.states->rows[static_cast<std::size_t>(row.pose)].q;
    reading.point = row.point;
    const double miss = fit.missOf(day, reading);
    squares += miss * miss;
    if (miss <= agreement.largest) continue;
    agreement.largest = miss;
    agreement.line = row.line;
  }
  agreement.miss = std::sqrt(squares / static_cast<double>(all.loading->rows.size()));
}

/// What the axes fitted to the poses leave, and with them the joints' compliances under the own weight.
void fitModels(const campaign::Campaign& day, ControllerAgreement& agreement) {
  // Six coordinates each, for four parameters an axis and six of the frame.
  const auto enough = static_cast<std::size_t>(std::max(12, 2 * day.robot.joints()));
  const calibration::UnloadedDay unloaded = calibration::unloadedDay(day);
  const std::vector<double> weights(unloaded.readings(), 1.0);
  if (unloaded.postures.size() < enough) return;
  const auto place = calibration::placeArm(unloaded, weights);
  if (!place) return;
  const auto missOf = [&](const std::vector<calibration::EffectPart>& parts) -> std::optional<double> {
    const calibration::ArmFit fit =
        calibration::fitArm(unloaded, *place, parts, {.axes = true, .robust = false, .weights = weights});
    if (!fit.done) return std::nullopt;
    double squares = 0.0;
    for (const Eigen::Vector3d& residual : calibration::residualsOf(unloaded, fit)) squares += residual.squaredNorm();
    return std::sqrt(squares / static_cast<double>(weights.size()));
  };
  agreement.geometry_miss = missOf({});
  const std::vector<calibration::EffectPart> compliances = calibration::jointCompliances(unloaded);
  if (!compliances.empty()) agreement.elastic_miss = missOf(compliances);
}

/// Points of the controller's tool are not read: the columns are others, and its axes are no reflectors.
std::vector<Suspected> ofPoses(std::vector<ArmCure> cures) {
  std::vector<Suspected> suspected;
  for (ArmCure& cure : cures) {
    Suspected& one = cure.suspected;
    if (one.mistake == "reflectors_exchanged") continue;
    if (one.where.is(RemarkId::in_columns)) {
      auto& columns = std::get<std::string>(one.where.values.front());
      if (columns.starts_with("x_mm")) columns = "px_mm, py_mm, pz_mm";
    }
    one.shown = Remark(RemarkId::stated_pose_misses, one.before, one.after);
    suspected.push_back(std::move(one));
  }
  return suspected;
}

}  // namespace

ControllerAgreement controllerAgreement(const campaign::Campaign& campaign, double trusted) {
  ControllerAgreement agreement;
  const std::vector<const campaign::State*> states = statesWithPose(campaign);
  agreement.postures = states.size();
  if (states.size() < ControllerAgreement::kFewest) return agreement;
  agreement.turns = std::all_of(states.begin(), states.end(),
                                [](const campaign::State* one) { return one->extras().tool_pose.hasTurn(); });
  agreement.still = stillJoints(states);
  // As many as the search of mistakes tries.
  constexpr std::size_t kSearched = 40, kFitted = 200;
  const campaign::Campaign few = asReadings(campaign, someOf(states, kSearched), agreement.turns);
  const ReadingsOfDay readings = rigidReadings(few);
  const NominalFit fit = fitNominal(readings);
  if (!fit.done) return agreement;
  describe(fit, campaign.robot, asReadings(campaign, states, agreement.turns), agreement);
  if (*agreement.miss <= trusted) return agreement;
  if (agreement.turns)
    agreement.position_miss = fitNominal(rigidReadings(asReadings(campaign, someOf(states, kSearched), false))).rms;
  if (agreement.position_miss && *agreement.position_miss <= trusted) return agreement;
  agreement.cures = ofPoses(searchArm(few, readings, {.suspicious = trusted, .least_shift = trusted}).cures);
  if (agreement.cures.empty()) fitModels(asReadings(campaign, someOf(states, kFitted), agreement.turns), agreement);
  return agreement;
}

}  // namespace stiffscope::mistakes
