#include "core/workspace/slice.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/numerics/parallel.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"

namespace stiffscope::workspace {

namespace {

bool withinLimits(const robot::Robot& arm, const Vector6d& q) {
  for (int joint = 0; joint < 6; ++joint) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(joint)];
    if (q[joint] < limits.lower || q[joint] > limits.upper) return false;
  }
  return true;
}

double niceSpacing(double about) {
  const double decade = std::pow(10.0, std::floor(std::log10(about)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= about) return step * decade;
  return decade;
}

}  // namespace

std::optional<Vector6d> continuedAngles(const robot::Robot& arm, const Eigen::Isometry3d& base_from_flange,
                                        const Vector6d& start, double least_conditioning) {
  constexpr double kFarthest = 90.0 * io::kDegree;  // of all steps together: the arm has turned over
  const robot::InverseKinematics found =
      robot::inverseKinematics(arm, base_from_flange, Eigen::Isometry3d::Identity(), start);
  if (!found.reached || (found.q - start).cwiseAbs().maxCoeff() >= kFarthest || !withinLimits(arm, found.q))
    return std::nullopt;
  const robot::ArmAxes axes = robot::axesAt(arm, robot::postureAt(arm, found.q));
  if (robot::conditioningAt(axes, base_from_flange.translation()) < least_conditioning) return std::nullopt;
  return found.q;
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
  Vector6d mean = Vector6d::Zero();
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
  const auto angles = [&](const Cell& cell, const Vector6d& start) {
    Eigen::Isometry3d wanted = flange;
    const Eigen::Vector3d at =
        cell.second * slice.spacing * slice.outward + cell.first * slice.spacing * Eigen::Vector3d::UnitZ();
    wanted.pretranslate(at - tcp);
    return continuedAngles(machine, wanted, start, options.least_conditioning);
  };
  std::map<Cell, Vector6d> reached;
  std::deque<Cell> open;
  const auto visit = [&](const Cell& cell, const Vector6d& start) {
    if (cell.second < 0 || reached.contains(cell)) return;
    const auto q = angles(cell, start);
    if (!q) return;
    reached.emplace(cell, *q);
    open.push_back(cell);
    if (reached.size() > options.most)
      throw io::InputError({"--spacing"}, fmt::format("{:g}", slice.spacing / io::kMillimetre),
                           fmt::format("expected a spacing with at most {} places", options.most));
  };
  const double across = std::hypot(tcp.x(), tcp.y()) / slice.spacing, up = tcp.z() / slice.spacing;
  for (const double h : {std::floor(up), std::ceil(up)})
    for (const double r : {std::floor(across), std::ceil(across)})
      visit({static_cast<int>(h), static_cast<int>(r)}, middle.q);
  while (!open.empty()) {
    const Cell cell = open.front();
    open.pop_front();
    const Vector6d start = reached.at(cell);
    for (const Cell& step : {Cell{0, 1}, Cell{0, -1}, Cell{1, 0}, Cell{-1, 0}})
      visit({cell.first + step.first, cell.second + step.second}, start);
  }

  std::vector<std::pair<Cell, Vector6d>> cells(reached.begin(), reached.end());
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
