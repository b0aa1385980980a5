#include "core/toolpath/tool_path.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/campaign/read_table.h"
#include "core/io/read_file.h"
#include "core/toolpath/remarks.h"
#include "metrology/lines.h"

namespace stiffscope::toolpath {

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

struct PathRow {
  std::string id;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Constant(kAbsent);
  Eigen::Vector4d quaternion = Eigen::Vector4d::Constant(kAbsent);  ///< w first
  Vector6d wrench_in_cell = Vector6d::Constant(kAbsent);
  double share = 1.0;
  std::size_t line = 0;
};

campaign::Column<PathRow> ratioColumn(const char* name, campaign::Column<PathRow>::Number member,
                                      const char* together) {
  campaign::Column<PathRow> column{name, campaign::CellKind::ratio, member, false};
  column.together = together;
  return column;
}

const campaign::TableLayout<PathRow>& pathLayout() {
  using Row = PathRow;
  static const campaign::TableLayout<Row> layout{
      "path",
      campaign::joined<Row>({{{"pose", campaign::CellKind::text, [](Row& row) -> std::string& { return row.id; }}},
                             campaign::pointColumns<Row>(),
                             {ratioColumn(
                                  "i", [](Row& row) -> double& { return row.axis[0]; }, "axis"),
                              ratioColumn(
                                  "j", [](Row& row) -> double& { return row.axis[1]; }, "axis"),
                              ratioColumn(
                                  "k", [](Row& row) -> double& { return row.axis[2]; }, "axis"),
                              ratioColumn(
                                  "qw", [](Row& row) -> double& { return row.quaternion[0]; }, "quaternion"),
                              ratioColumn(
                                  "qx", [](Row& row) -> double& { return row.quaternion[1]; }, "quaternion"),
                              ratioColumn(
                                  "qy", [](Row& row) -> double& { return row.quaternion[2]; }, "quaternion"),
                              ratioColumn(
                                  "qz", [](Row& row) -> double& { return row.quaternion[3]; }, "quaternion"),
                              ratioColumn(
                                  "load_share", [](Row& row) -> double& { return row.share; }, "")},
                             campaign::wrenchColumns<Row>(false)}),
      {"pose"}};
  return layout;
}

void requireUnit(const std::string& file, const PathRow& row, const char* columns, double length) {
  constexpr double kWithin = 0.01;
  if (std::abs(length - 1.0) <= kWithin) return;
  throw io::InputError({file, row.line, columns}, fmt::format("{:.6g}", length),
                       "expected a length of one, within 1 %");
}

/// The least turn that brings one direction to another.
Eigen::Matrix3d carried(const Eigen::Matrix3d& axes, const Eigen::Vector3d& z) {
  return Eigen::Quaterniond::FromTwoVectors(axes.col(2), z).toRotationMatrix() * axes;
}

Eigen::Matrix3d anyAxesAbout(const Eigen::Vector3d& z) {
  Eigen::Matrix3d axes;
  Eigen::Vector3d u, v;
  metrology::basisAcross(z, u, v);
  axes << u, v, z;
  return axes;
}

}  // namespace

ToolPath readToolPath(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string bytes = io::readTextFile(file);
  ToolPath path;
  path.file = file.string();
  campaign::CampaignNames names;
  const std::vector<PathRow> rows = campaign::readTable<PathRow>({path.file, bytes}, pathLayout(), names, warnings);
  path.turn_free = std::isnan(rows.front().quaternion[0]);
  path.has_wrenches = !std::isnan(rows.front().wrench_in_cell[0]);
  if (!path.turn_free && !std::isnan(rows.front().axis[0]))
    throw io::InputError({path.file, 1, "i, qw"}, "", "expected the tool's axis or a quaternion, not both");
  for (const PathRow& row : rows) {
    PathPose pose;
    pose.id = row.id;
    pose.workpiece_from_tool.translation() = row.point;
    if (path.turn_free) {
      const bool given = !std::isnan(row.axis[0]);
      if (given) requireUnit(path.file, row, "i, j, k", row.axis.norm());
      const Eigen::Vector3d z = given ? Eigen::Vector3d(-row.axis.normalized()) : Eigen::Vector3d(0.0, 0.0, -1.0);
      pose.workpiece_from_tool.linear() =
          path.poses.empty() ? anyAxesAbout(z) : carried(path.poses.back().workpiece_from_tool.linear(), z);
    } else {
      const Eigen::Vector4d& q = row.quaternion;
      requireUnit(path.file, row, "qw, qx, qy, qz", q.norm());
      pose.workpiece_from_tool.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    }
    if (row.share < 0.0)
      throw io::InputError({path.file, row.line, "load_share"}, fmt::format("{:g}", row.share),
                           "expected a share from 0 to 1");
    pose.share = row.share;
    if (path.has_wrenches) pose.wrench = row.wrench_in_cell;
    path.poses.push_back(std::move(pose));
  }
  return path;
}

std::vector<double> lengthsAlong(const ToolPath& path) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const double step =
        i == 0 ? 0.0
               : (path.poses[i].workpiece_from_tool.translation() - path.poses[i - 1].workpiece_from_tool.translation())
                     .norm();
    lengths.push_back(i == 0 ? 0.0 : lengths.back() + step);
  }
  return lengths;
}

namespace {

/// Feed axes at each pose as columns in the workpiece's axes; empty where there is no feed yet.
std::vector<std::optional<Eigen::Matrix3d>> feedAxes(const ToolPath& path) {
  constexpr double kStandsStill = 1e-9;  // m
  std::vector<std::optional<Eigen::Matrix3d>> all;
  std::optional<Eigen::Vector3d> feed;  // the last that was seen
  const auto tip = [&](std::size_t i) { return path.poses[i].workpiece_from_tool.translation(); };
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const Eigen::Vector3d up = -path.poses[i].workpiece_from_tool.linear().col(2);
    const auto across = [&](const Eigen::Vector3d& along) { return Eigen::Vector3d(along - along.dot(up) * up); };
    const Eigen::Vector3d whole = tip(std::min(i + 1, path.poses.size() - 1)) - tip(i > 0 ? i - 1 : 0);
    const Eigen::Vector3d step = across(whole);
    // A tool that goes down its own axis feeds to no side; one that stands keeps the feed before.
    constexpr double kPlunges = 1e-3;  // of the way
    if (whole.norm() > kStandsStill && step.norm() < kPlunges * whole.norm()) {
      all.emplace_back();
      continue;
    }
    if (step.norm() > kStandsStill) feed = step.normalized();
    std::optional<Eigen::Matrix3d> axes;
    if (feed && across(*feed).norm() > kStandsStill) {
      axes.emplace();
      axes->col(0) = across(*feed).normalized();
      axes->col(1) = up.cross(axes->col(0));
      axes->col(2) = up;
    }
    all.push_back(axes);
  }
  return all;
}

}  // namespace

std::vector<ToolWrench> toolWrenches(const ToolPath& path, const Eigen::Isometry3d& base_from_workpiece,
                                     const ProcessLoad& load) {
  const bool by_feed = load.cutting || load.axes == WrenchAxes::feed;
  const std::vector<std::optional<Eigen::Matrix3d>> feeds =
      by_feed ? feedAxes(path) : std::vector<std::optional<Eigen::Matrix3d>>(path.poses.size());
  const CuttingForce cut = load.cutting ? meanCuttingForce(*load.cutting) : CuttingForce();
  std::vector<ToolWrench> wrenches(path.poses.size());
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const PathPose& pose = path.poses[i];
    ToolWrench& wrench = wrenches[i];
    if (pose.share == 0.0) continue;
    if (by_feed && !feeds[i]) {
      wrench.reason = Remark(RemarkId::no_feed_direction);
      continue;
    }
    if (load.cutting) {
      wrench.point_in_tool.z() = -0.5 * load.cutting->depth;
      wrench.force = pose.share * (*feeds[i] * cut.force);
      wrench.moment = pose.share * cut.torque * feeds[i]->col(2);
      continue;
    }
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (load.axes == WrenchAxes::feed) axes = *feeds[i];
    if (load.axes == WrenchAxes::tool) axes = pose.workpiece_from_tool.linear();
    if (load.axes == WrenchAxes::base_link) axes = base_from_workpiece.linear().transpose();
    const Vector6d& stated = pose.wrench ? *pose.wrench : load.constant;
    wrench.force = pose.share * (axes * stated.head<3>());
    wrench.moment = pose.share * (axes * stated.tail<3>());
  }
  return wrenches;
}

}  // namespace stiffscope::toolpath
