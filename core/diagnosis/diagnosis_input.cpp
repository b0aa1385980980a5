#include "core/diagnosis/diagnosis_input.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/diagnosis/remarks.h"
#include "core/frames/geometry_calibration.h"
#include "core/identification/identify.h"
#include "core/identification/load_point.h"
#include "core/robot/wrench.h"

namespace stiffscope::diagnosis {

void boundDriftByNests(DiagnosisInput& start, SystemInput& input) {
  if (start.station.course != preparation::StationCourse::still) return;
  if (!input.absolute || start.station.rate_weight.isZero()) return;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = start.state.r0_from_sweeps.linear();
  const double span = start.state.at.time_span;
  input.drift = -span * (turn * start.station.rate);
  input.drift_weight = turn * start.station.rate_weight * turn.transpose() / (span * span);
  start.state.at.sweep_time = 0.5 * (start.station.motion.epochs.front().time_s + start.state.at.first_time);
}

namespace {

/// Stiffnesses to start from: those of identification on the largest load.
JointVector startCompliance(const campaign::Campaign& campaign, identification::LoadedArm arm) {
  return arm.cases.empty() ? JointVector(JointVector::Zero(campaign.robot.joints()))
                           : identification::sagCompliance(campaign, {}, arm);
}

bool sameFrame(const campaign::Campaign& campaign) {
  return campaign.circle_sweeps && campaign.loading && campaign.circle_sweeps->frame == campaign.loading->frame &&
         (!campaign.wrist_sweep || campaign.wrist_sweep->frame == campaign.loading->frame);
}

/// Joint angles of the sweep of the rail, which no table states: those of the arm's reading whose reflector stands
/// nearest to where that sweep has it, `places` of the reflectors with the carriage at zero.
JointVector anglesOfRailSweep(const campaign::Campaign& campaign, const std::map<int, Eigen::Vector3d>& places) {
  JointVector nearest = campaign.states->rows.front().q;
  double least = std::numeric_limits<double>::infinity();
  const auto search = [&](const auto& table) {
    if (!table || table->frame != campaign.rail_sweep->frame) return;
    for (const auto& row : table->rows) {
      const auto place = places.find(row.target);
      if (place == places.end() || !((row.point - place->second).norm() < least)) continue;
      least = (row.point - place->second).norm();
      nearest = row.q;
    }
  };
  search(campaign.circle_sweeps);
  search(campaign.wrist_sweep);
  return nearest;
}

/// What the sweep's straight line has taken in (effects::RailTravel).
void addRailLine(const campaign::Campaign& campaign, const preparation::RailCourse& course,
                 const frames::LoadingGeometry& geometry, effects::RailTravel& travel) {
  std::map<int, std::pair<Eigen::Vector3d, double>> sums;
  double x1 = 0.0, x2 = 0.0, x3 = 0.0, count = 0.0;
  for (const campaign::RailReading& row : campaign.rail_sweep->rows) {
    auto& [sum, readings] =
        sums.emplace(row.target, std::pair(Eigen::Vector3d(Eigen::Vector3d::Zero()), 0.0)).first->second;
    sum += row.point - row.rail * course.per_metre;
    readings += 1.0;
    const double x = (row.rail - travel.mean) / travel.scale;
    x1 += x, x2 += x * x, x3 += x * x * x, count += 1.0;
  }
  const double spread = x2 - x1 * x1 / count;
  if (!(spread > 0.0)) return;
  travel.line_by_x = 1.0 / travel.scale;
  travel.line_by_square = (x3 - x1 * x2 / count) / spread / travel.scale;
  std::map<int, Eigen::Vector3d> places;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& [target, sum] : sums) middle += places[target] = sum.first / sum.second;
  travel.reflectors_at_sweep = *geometry.r0_from_loading * (middle / static_cast<double>(sums.size()));
  const JointVector q = anglesOfRailSweep(campaign, places);
  travel.weight_at_sweep =
      effects::carried(effects::stateAt(geometry, q, JointVector::Zero(q.size())), 0, Eigen::Vector3d::Zero());
}

effects::RailTravel railTravel(const preparation::PreparedCampaign& prepared, const frames::LoadingGeometry& geometry) {
  effects::RailTravel travel;
  std::vector<double> positions;
  for (const campaign::State& row : prepared.campaign.states->rows) {
    if (row.step == 0 && std::isfinite(row.carriage)) positions.push_back(row.carriage);
  }
  if (positions.empty()) return travel;
  const auto [low, high] = std::minmax_element(positions.begin(), positions.end());
  const auto count = static_cast<double>(positions.size());
  travel.mean = std::accumulate(positions.begin(), positions.end(), 0.0) / count;
  if (*high > *low) travel.scale = 0.5 * (*high - *low);
  for (const double position : positions)
    travel.mean_square += std::pow((position - travel.mean) / travel.scale, 2) / count;
  const campaign::Campaign& campaign = prepared.campaign;
  const std::optional<campaign::Loading>& loading = campaign.loading;
  const bool by_line = prepared.rail && loading && loading->frame == campaign.rail_sweep->frame &&
                       loading->frame == campaign::PointFrame::tracker && geometry.r0_from_loading;
  if (by_line) addRailLine(campaign, *prepared.rail, geometry, travel);
  return travel;
}

}  // namespace

DiagnosisInput diagnosisInput(const preparation::PreparedCampaign& prepared) {
  DiagnosisInput start;
  start.campaign = prepared.campaign;
  start.campaign.nests.reset();  // they have said what they know
  start.station = prepared.drift;
  start.noise = prepared.noise;
  const identification::SolvedDay day = identification::solveDay(start.campaign);
  start.geometry = day.arm.geometry;
  start.absolute = start.campaign.loading && start.geometry.r0_from_loading.has_value();
  // A sag that is not known would be taken for geometry, frames and springs.
  if (!start.geometry.weight.links_known) start.absolute = false;
  start.sweeps = start.absolute && day.frames.arm.points_placed && sameFrame(start.campaign);
  identification::LoadedArm arm = day.arm;
  if (start.campaign.loading && !start.geometry.r0_from_loading) {
    const frames::GeometryCalibration calibration = frames::calibrateGeometry(start.campaign, start.geometry);
    start.absolute = calibration.done && start.geometry.weight.links_known;
    if (!calibration.done) {
      start.reason = Remark(RemarkId::readings_not_in_robot_frame, calibration.reason);
      return start;
    }
    start.geometry = calibration.geometry;
    arm = identification::loadedArm(start.campaign, start.geometry, day.frames.wrist,
                                    {*identification::heaviestStep(start.campaign)});
  }
  if (arm.cases.empty()) {
    start.reason = Remark(RemarkId::no_usable_posture);
    return start;
  }
  const JointVector compliance = startCompliance(start.campaign, arm);
  start.geometric_stiffness_share = identification::geometricStiffnessShare(arm, compliance);
  if (start.geometry.weight.links_known) start.geometry.compliance = compliance;
  start.state = startState(start.campaign, start.geometry, arm.cases);
  start.state.at.compliance = compliance;
  if (start.campaign.robot.rail) start.state.at.rail = railTravel(prepared, start.geometry);
  if (!start.noise.known) start.reason = Remark(RemarkId::noise_not_known, start.noise.source);
  return start;
}

Eigen::Vector3d loadOffset(const robot::Robot& arm, const std::vector<identification::LoadCase>& cases,
                           double moment_sigma) {
  std::vector<identification::ToolLoad> loads;
  for (const identification::LoadCase& one : cases) {
    const Eigen::Matrix3d flange_from_base =
        one.flange_unloaded.value_or(robot::flangeAt(arm, identification::unloadedPosture(arm, one)))
            .linear()
            .transpose();
    loads.push_back({flange_from_base * one.wrench.force, flange_from_base * one.wrench.moment});
  }
  const identification::LoadPointFit fit(loads);
  constexpr double kExpected = 0.3;    // m
  constexpr double kRounding = 1e-12;  // of the readings, where their noise is not stated
  const double doubt = moment_sigma * moment_sigma / (kExpected * kExpected) + kRounding * fit.normal().trace();
  return doubt > 0.0 ? fit.point(doubt) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

namespace {

JointVector largestTorque(const frames::LoadingGeometry& geometry, const std::vector<identification::LoadCase>& cases) {
  const int joints = geometry.arm.joints();
  JointVector largest = JointVector::Zero(joints);
  for (const identification::LoadCase& one : cases) {
    const JointVector weight =
        geometry.weight.links_known
            ? robot::weightTorque(geometry.arm, identification::unloadedPosture(geometry.arm, one), geometry.weight)
            : JointVector(JointVector::Zero(joints));
    const JointVector load = robot::jointTorque(one.axes, one.wrench);
    largest = largest.cwiseMax(weight.cwiseAbs()).cwiseMax((weight + load).cwiseAbs());
  }
  return largest;
}

}  // namespace

SystemState startState(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                       const std::vector<identification::LoadCase>& cases) {
  SystemState state(geometry.arm.joints());
  state.geometry = geometry;
  if (geometry.compliance.size() > 0) state.at.compliance = geometry.compliance.cwiseMax(0.0);
  state.at.targets = static_cast<int>(campaign.targets.size());
  state.at.r0_from_base_link = geometry.r0_from_base_link;
  if (geometry.weight.gravity_in_base.norm() > 0.0) state.at.down = geometry.weight.gravity_in_base.normalized();
  if (campaign.robot.rail) state.at.rail_in_base = campaign.robot.rail->direction_in_base;
  state.at.load_offset = loadOffset(geometry.arm, cases, campaign.load_cell->moment_sigma);
  state.at.largest_torque = largestTorque(geometry, cases);
  if (geometry.r0_from_loading) state.r0_from_sweeps = *geometry.r0_from_loading;
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const campaign::State& row : campaign.states->rows) {
    state.at.largest_force = std::max(state.at.largest_force, row.wrench_in_cell.head<3>().norm());
    if (std::isfinite(row.time_s)) first = std::min(first, row.time_s), last = std::max(last, row.time_s);
  }
  if (last > first) state.at.first_time = first, state.at.time_span = last - first;
  state.at.sweep_time = std::isfinite(first) ? first : 0.0;
  if (geometry.r0_from_loading && campaign.loading && !campaign.loading->rows.empty()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const campaign::LoadingReading& row : campaign.loading->rows) sum += row.point;
    state.at.epoch_centre = *geometry.r0_from_loading * (sum / static_cast<double>(campaign.loading->rows.size()));
  }
  return state;
}

}  // namespace stiffscope::diagnosis
