#include "core/campaign/campaign.h"
#include "core/frames/frames.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"

#include <cmath>

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json optionalNumber(const std::optional<double>& value, double factor) {
  return value ? number(*value * factor) : Json(nullptr);
}

template <class Derived>
Json rows(const Eigen::MatrixBase<Derived>& matrix, double factor) {
  Json list = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    list.push_back(array(Eigen::VectorXd(matrix.row(row).transpose()), factor));
  }
  return list;
}

/// Of R0's error in its own axes, and how the distances between axes go together: consecutive ones share an axis.
void addCovariances(const frames::Frames& frames, Json& json) {
  if (!frames.arm.points_placed) {
    json["r0_covariance"] = nullptr;
    return;
  }
  const Eigen::MatrixXd total = frames.covariance.total();
  json["r0_covariance"] = {
      {"order", {"rotation_x_rad", "rotation_y_rad", "rotation_z_rad", "origin_x_m", "origin_y_m", "origin_z_m"}},
      {"frame", "R0: rotation vector and origin of R0 as measured against the true one, in its own axes"},
      {"matrix", rows(total.topLeftCorner<6, 6>(), 1.0)}};
  const auto links = static_cast<Eigen::Index>(frames.links.size());
  json["link_lengths_covariance_mm2"] =
      rows(total.block(frames::FramesLayout::kDistances, frames::FramesLayout::kDistances, links, links),
           1.0 / (io::kMillimetre * io::kMillimetre));
}

Json circlesJson(const campaign::Campaign& campaign, const frames::MeasuredAxis& axis) {
  Json circles = Json::array();
  for (std::size_t k = 0; k < axis.fit.circles.size(); ++k) {
    const metrology::AxisCircle& circle = axis.fit.circles[k];
    circles.push_back({{"target", campaign.targets[static_cast<std::size_t>(axis.targets[k])].id},
                       {"radius_mm", circle.radius / io::kMillimetre},
                       {"arc_deg", circle.arc / io::kDegree},
                       {"rms_um", circle.rms / io::kMicrometre}});
  }
  return circles;
}

Json axisJson(const campaign::Campaign& campaign, const frames::Frames& frames, std::size_t i) {
  const frames::MeasuredAxis& axis = frames.axes[i];
  const metrology::Line& line = frames.arm.arm.axes_in_base_at_zero[i];
  Json json{{"axis", i + 1}, {"measured", axis.measured}, {"from", sourceOf(frames, {i})}};
  if (!axis.measured) json["reason"] = words(axis.reason);
  json["point_m"] = array(line.point);
  json["direction"] = array(line.direction);
  if (!axis.measured) return json;
  double arc = 0.0;
  for (const metrology::AxisCircle& circle : axis.fit.circles) arc = std::max(arc, circle.arc);
  json["arc_deg"] = axis.fit.circles.empty() ? Json(nullptr) : Json(arc / io::kDegree);
  json["rms_um"] = axis.fit.rms / io::kMicrometre;
  const AxisSd sd = sdAcross(axis);
  json["sd_point_um"] = sd.point / io::kMicrometre;
  json["sd_direction_deg"] = sd.direction / io::kDegree;
  json["chi2_per_dof"] = number(axis.fit.chi2_per_dof);
  json["circles"] = circlesJson(campaign, axis);
  return json;
}

Json linkJson(const frames::Frames& frames, std::size_t i) {
  const frames::LinkGeometry& link = frames.links[i];
  Json json{{"between_axes", {i + 1, i + 2}},
            {"from", sourceOf(frames, {i, i + 1})},
            {"length_mm", link.distance / io::kMillimetre},
            {"sd_length_mm", optionalNumber(link.distance_sd, 1.0 / io::kMillimetre)},
            {"sd_length_by_sag_stiffness_mm", number(link.distance_sag_sd / io::kMillimetre)},
            {"length_moved_by_sag_mm", number(link.distance_by_sag / io::kMillimetre)},
            {"nominal_length_mm", link.nominal_distance / io::kMillimetre},
            {"angle_deg", link.angle / io::kDegree},
            {"sd_angle_deg", optionalNumber(link.angle_sd, 1.0 / io::kDegree)},
            {"nominal_angle_deg", link.nominal_angle / io::kDegree},
            {"near_parallel", link.near_parallel}};
  if (link.near_parallel) json["length_at_point_m"] = array(link.at_point_in_r0);
  return json;
}

/// "axes_5_6" of the two from that one on, counted from 0.
std::string axesKey(int first) { return "axes_" + std::to_string(first + 1) + "_" + std::to_string(first + 2); }

Json missesJson(const frames::Frames& frames) {
  Json json;
  for (const frames::WristAxesMiss& one : frames.wrist.misses) {
    const std::string axes = axesKey(one.first);
    const auto at = static_cast<std::size_t>(one.first);
    json[axes] = one.distance / io::kMillimetre;
    json["sd_" + axes] = one.sd / io::kMillimetre;
    json["from_" + axes] = sourceOf(frames, {at, at + 1});
  }
  return json;
}

Json wristJson(const campaign::Campaign& campaign, const frames::Frames& frames) {
  const frames::WristCentre& wrist = frames.wrist;
  Json json{{"measured", wrist.measured}};
  if (!wrist.measured) json["reason"] = words(wrist.reason);
  json["center_m"] = wrist.measured ? array(wrist.centre_in_r0) : Json(nullptr);
  const int joints = campaign.robot.joints(), arm = robot::armJointsOf(joints);
  std::string carried = "center_at";
  for (int joint = 1; joint <= arm; ++joint) carried += "_q" + std::to_string(joint);
  json[carried + "_deg"] = array(JointVector(wrist.q.head(arm)), 1.0 / io::kDegree);
  json["miss_mm"] = missesJson(frames);
  if (wrist.offset()) json["meet_apart_mm"] = wrist.apart / io::kMillimetre;
  const auto last = static_cast<std::size_t>(campaign.robot.axes()) - 1;
  const std::string nearest = "nearest_" + axesKey(campaign.robot.axes() - 2);
  json[nearest + "_from"] = sourceOf(frames, {last - 1, last});
  json[nearest + "_m"] = array(wrist.nearest_last_axes_in_r0);
  json["reflector_barycenter_m"] = array(wrist.reflector_barycentre_in_r0);
  if (!wrist.measured) return json;
  json["sd_center_um"] = array(Eigen::Vector3d(wrist.covariance.diagonal().cwiseSqrt()), 1.0 / io::kMicrometre);
  json["sd_mm"] = array(Eigen::Vector3d(wrist.covariance.diagonal().cwiseSqrt()), 1.0 / io::kMillimetre);
  json["covariance_mm2"] = rows(wrist.covariance, 1.0 / (io::kMillimetre * io::kMillimetre));
  json["covariance_of_readings_alone_mm2"] =
      rows(wrist.spheres.covariance.topLeftCorner<3, 3>(), 1.0 / (io::kMillimetre * io::kMillimetre));
  Json radii = Json::object(), radii_sd = Json::object();
  for (std::size_t k = 0; k < wrist.radii.size(); ++k)
    radii[campaign.targets[k].id] = number(wrist.radii[k] / io::kMillimetre);
  for (std::size_t k = 0; k < wrist.targets.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 + k);
    radii_sd[campaign.targets[static_cast<std::size_t>(wrist.targets[k])].id] =
        number(std::sqrt(wrist.spheres.covariance(at, at)) / io::kMillimetre);
  }
  json["radii_mm"] = radii;
  json["sd_radii_mm"] = radii_sd;
  json["rms_um"] = wrist.spheres.rms / io::kMicrometre;
  Json table = Json::array();
  for (const frames::WristTableRow& row : wrist.table) {
    table.push_back({{"target", campaign.targets[static_cast<std::size_t>(row.target)].id},
                     {"center_mm", array(row.centre_in_r0, 1.0 / io::kMillimetre)},
                     {"sd_center_by_own_readings_mm",
                      array(Eigen::Vector3d(row.covariance.diagonal().cwiseSqrt()), 1.0 / io::kMillimetre)},
                     {"offset_mm", row.offset / io::kMillimetre},
                     {"radius_mm", row.radius / io::kMillimetre},
                     {"rms_um", row.rms / io::kMicrometre},
                     {"readings", row.readings}});
  }
  json["table"] = table;
  json["table_mean_mm"] = array(wrist.table_mean_in_r0, 1.0 / io::kMillimetre);
  json["sd_table_mean_mm"] =
      array(Eigen::Vector3d(wrist.table_mean_covariance.diagonal().cwiseSqrt()), 1.0 / io::kMillimetre);
  return json;
}

}  // namespace

Json framesJson(const campaign::Campaign& campaign, const frames::Frames& frames) {
  Json json{{"campaign", campaignJson(campaign)}};
  const bool tracker = frames.arm.points_placed && frames.points_frame == campaign::PointFrame::tracker;
  json["r0_placed_by"] = frames.arm.points_placed ? "sweeps" : "nominal";
  json["r0_from_tracker"] = tracker ? matrix(frames.arm.r0_from_points) : Json(nullptr);
  const bool measured_in_base = frames.arm.points_placed && frames.points_frame == campaign::PointFrame::base_link;
  json["r0_from_base_link"] = matrix(measured_in_base ? frames.arm.r0_from_points : frames.arm.r0_from_base_link);
  addCovariances(frames, json);
  json["own_weight"] = {{"removed", frames.sag_removed}, {"note", words(frames.sag_note)}};
  Json axes = Json::array();
  for (std::size_t i = 0; i < frames.axes.size(); ++i) axes.push_back(axisJson(campaign, frames, i));
  json["axes"] = axes;
  Json lengths = Json::array(), sources = Json::array(), links = Json::array();
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    lengths.push_back(frames.links[i].distance / io::kMillimetre);
    sources.push_back(sourceOf(frames, {i, i + 1}));
    links.push_back(linkJson(frames, i));
  }
  json["link_lengths_mm"] = lengths;
  json["link_lengths_from"] = sources;
  json["links"] = links;
  json["wrist"] = wristJson(campaign, frames);
  json["tcp_in_flange_m"] = array(frames.tcp_in_flange);
  const std::size_t last = frames.axes.size() - 1;
  json["tcp_in_flange_from"] =
      frames.tcp_at_origin ? "origin of the flange"
                           : sourceOf(frames, {frames::axisAcrossLast(frames.arm.arm.axes_in_base_at_zero), last});
  Json targets = Json::object();
  for (std::size_t k = 0; k < campaign.targets.size(); ++k) {
    const auto& target = frames.targets_in_r0_at_zero[k];
    targets[campaign.targets[k].id] = target ? array(*target) : Json(nullptr);
  }
  json["targets_in_r0_at_zero_m"] = targets;
  return json;
}

}  // namespace stiffscope::reports
