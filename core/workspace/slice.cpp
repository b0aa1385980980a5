#include "core/workspace/slice.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/compensation/joint_correction.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/numerics/parallel.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"

namespace stiffscope::workspace {

namespace {

bool withinLimits(const robot::Robot& arm, const JointVector& q) {
  for (int joint = 0; joint < arm.joints(); ++joint) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(joint)];
    if (q[joint] < limits.lower || q[joint] > limits.upper) return false;
  }
  return robot::withinAxisLimits(arm, q);
}

/// Joint angles of an arm of fewer than six joints at which a point of the flange is where it is to be, and the flange
/// turned by no more than `most_turned` from its pose. Steps are shortened, so that they stay on their branch.
std::optional<JointVector> positionFirstAngles(const robot::Robot& arm, const Eigen::Isometry3d& base_from_flange,
                                               const Eigen::Vector3d& tcp_in_flange, const JointVector& start,
                                               double most_turned) {
  constexpr int kMostSteps = 100;
  constexpr double kLongest = 0.3, kClose = 1e-10;  // rad; m and rad
  JointVector q = start;
  for (int step = 0; step < kMostSteps; ++step) {
    const robot::ArmPosture posture = robot::postureAt(arm, q);
    const Eigen::Isometry3d flange = robot::flangeAt(arm, posture);
    const Eigen::Vector3d point = flange * tcp_in_flange;
    Vector6d left;
    left << base_from_flange * tcp_in_flange - point,
        robot::rotationVector(base_from_flange.linear() * flange.linear().transpose());
    JointVector change = compensation::jointStep(robot::jacobianAt(arm, posture, point), left, q - start);
    if (!change.allFinite()) return std::nullopt;
    const double longest = change.cwiseAbs().maxCoeff();
    if (longest < kClose && left.head<3>().cwiseAbs().maxCoeff() < kClose)
      return left.tail<3>().norm() <= most_turned ? std::optional<JointVector>(q) : std::nullopt;
    if (longest > kLongest) change *= kLongest / longest;
    q += change;
  }
  return std::nullopt;
}

double niceSpacing(double about) {
  const double decade = std::pow(10.0, std::floor(std::log10(about)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= about) return step * decade;
  return decade;
}

}  // namespace

std::optional<JointVector> continuedAngles(const robot::Robot& arm, const Eigen::Isometry3d& base_from_flange,
                                           const Eigen::Vector3d& tcp_in_flange, const JointVector& start,
                                           double least_conditioning, double most_turned) {
  constexpr double kFarthest = 90.0 * io::kDegree;  // of all steps together: the arm has turned over
  std::optional<JointVector> q;
  Eigen::Vector3d point = base_from_flange.translation();
  if (arm.joints() < 6) {
    point = base_from_flange * tcp_in_flange;
    q = positionFirstAngles(arm, base_from_flange, tcp_in_flange, start, most_turned);
  } else {
    const robot::InverseKinematics found =
        robot::inverseKinematics(arm, base_from_flange, Eigen::Isometry3d::Identity(), start);
    if (found.reached) q = found.q;
  }
  if (!q || (*q - start).cwiseAbs().maxCoeff() >= kFarthest || !withinLimits(arm, *q)) return std::nullopt;
  const robot::ArmAxes axes = robot::axesAt(arm, robot::postureAt(arm, *q));
  if (compensation::stepConditioning(axes, point) < least_conditioning) return std::nullopt;
  return q;
}

std::vector<NamedPosture> identifiedPostures(const campaign::Campaign& campaign,
                                             const identification::Identification& result) {
  std::vector<NamedPosture> postures;
  std::set<int> seen;
  for (const identification::LoadCase& one : result.cases) {
    if (seen.insert(one.pose).second)
      postures.push_back({campaign.pose_ids[static_cast<std::size_t>(one.pose)], one.q});
  }
  return postures;
}

const NamedPosture& middlePosture(const std::vector<NamedPosture>& postures) {
  JointVector mean = JointVector::Zero(postures.front().q.size());
  for (const NamedPosture& one : postures) mean += one.q / static_cast<double>(postures.size());
  return *std::min_element(postures.begin(), postures.end(), [&](const NamedPosture& a, const NamedPosture& b) {
    return (a.q - mean).squaredNorm() < (b.q - mean).squaredNorm();
  });
}

namespace {

const NamedPosture& slicedPosture(const std::vector<NamedPosture>& postures, const std::string& pose) {
  if (pose.empty()) return middlePosture(postures);
  const auto found =
      std::find_if(postures.begin(), postures.end(), [&](const NamedPosture& one) { return one.pose == pose; });
  if (found != postures.end()) return *found;
  std::vector<std::string> names;
  for (const NamedPosture& one : postures) names.push_back(one.pose);
  throw io::InputError({"--slice"}, pose, "expected a posture that identifies" + io::nearestNameHint(pose, names));
}

}  // namespace

StiffnessSlice stiffnessSlice(const DeflectingArm& arm, const std::vector<NamedPosture>& postures,
                              const SliceOptions& options) {
  const robot::Robot& machine = arm.geometry.arm;
  const NamedPosture& middle = slicedPosture(postures, options.pose);
  const Eigen::Isometry3d flange = robot::flangeAt(machine, robot::postureAt(machine, middle.q));
  const Eigen::Vector3d tcp = flange * arm.tcp_in_flange;
  StiffnessSlice slice;
  slice.pose = middle.pose;
  slice.q = middle.q;
  slice.azimuth = std::atan2(tcp.y(), tcp.x());
  slice.outward = {std::cos(slice.azimuth), std::sin(slice.azimuth), 0.0};
  double reach = 0.0;
  for (const NamedPosture& one : postures)
    reach = std::max(reach, (robot::flangeAt(machine, robot::postureAt(machine, one.q)) * arm.tcp_in_flange).norm());
  constexpr double kAcross = 12.0;
  slice.spacing = options.spacing > 0.0 ? options.spacing : niceSpacing(reach / kAcross);

  // Places are multiples of the spacing, so that slices of two days lie on one grid. Neighbours are reached from each
  // other, the nearest to the posture first.
  using Cell = std::pair<int, int>;  // height, radius
  constexpr double kTurned = 10.0 * io::kDegree;
  const auto angles = [&](const Cell& cell, const JointVector& start) {
    Eigen::Isometry3d wanted = flange;
    const Eigen::Vector3d at =
        cell.second * slice.spacing * slice.outward + cell.first * slice.spacing * Eigen::Vector3d::UnitZ();
    wanted.pretranslate(at - tcp);
    return continuedAngles(machine, wanted, arm.tcp_in_flange, start, options.least_conditioning, kTurned);
  };
  const auto tooFine = [&] {
    return io::InputError({"--spacing"}, fmt::format("{:g}", slice.spacing / io::kMillimetre),
                          fmt::format("expected a spacing with at most {} places", options.most));
  };
  std::map<Cell, JointVector> reached;
  std::deque<Cell> open;
  const auto visit = [&](const Cell& cell, const JointVector& start) {
    if (cell.second < 0 || reached.contains(cell)) return;
    const auto q = angles(cell, start);
    if (!q) return;
    reached.emplace(cell, *q);
    open.push_back(cell);
    if (reached.size() > options.most) throw tooFine();
  };
  const double across = std::hypot(tcp.x(), tcp.y()) / slice.spacing, up = tcp.z() / slice.spacing;
  constexpr double kCells = 1e6;  // from the base to the posture: far more than places are taken, and an int
  if (std::max(across, std::abs(up)) > kCells) throw tooFine();
  for (const double h : {std::floor(up), std::ceil(up)})
    for (const double r : {std::floor(across), std::ceil(across)})
      visit({static_cast<int>(h), static_cast<int>(r)}, middle.q);
  while (!open.empty()) {
    const Cell cell = open.front();
    open.pop_front();
    const JointVector start = reached.at(cell);
    for (const Cell& step : {Cell{0, 1}, Cell{0, -1}, Cell{1, 0}, Cell{-1, 0}})
      visit({cell.first + step.first, cell.second + step.second}, start);
  }

  std::vector<std::pair<Cell, JointVector>> cells(reached.begin(), reached.end());
  std::vector<std::optional<PointStiffness>> found(cells.size());
  numerics::onAllCores(cells.size(), [&](std::size_t i) { found[i] = pointStiffness(arm, cells[i].second); });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (found[i])
      slice.places.push_back(
          {cells[i].first.second * slice.spacing, cells[i].first.first * slice.spacing, std::move(*found[i])});
  }
  return slice;
}

}  // namespace stiffscope::workspace
