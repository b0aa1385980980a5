#include "reports/json/identification_json.h"

#include <algorithm>
#include <utility>

#include "core/cartesian_stiffness/posture_stiffness.h"
#include "core/identification/geometric_stiffness_cost.h"
#include "core/identification/posture_count.h"
#include "core/identification/stiffness_spread.h"
#include "core/input/units.h"
#include "reports/json/posture_stiffness_json.h"
#include "reports/json/uncertainty_json.h"
#include "reports/method_names.h"

namespace stiffscope {

namespace {

Json byJoint(const StiffnessEstimate& estimate, const auto& entry) {
  Json list = Json::array();
  for (int joint = 0; joint < 6; ++joint) {
    list.push_back(estimate.identifiable[static_cast<std::size_t>(joint)] ? Json(entry(joint)) : Json(nullptr));
  }
  return list;
}

/// `used`, `held_out` and `all` are means over the subsets; `all_postures` is identified and judged on all postures.
Json compensationJson(const std::optional<Compensation>& compensation, bool subsets) {
  if (!compensation) return nullptr;
  const SubsetCompensation& mean = compensation->subsets;
  return {{"used", subsets ? number(mean.used) : Json(nullptr)},
          {"held_out", subsets ? number(mean.held_out) : Json(nullptr)},
          {"all", subsets ? number(mean.all) : number(compensation->all_postures)},
          {"all_postures", number(compensation->all_postures)}};
}

Json spreadJson(const MethodResult& method) {
  const SubsetStudy& study = method.subsets;
  Json json{{"postures_used", study.size}, {"of", study.of}, {"subsets", study.compliances.size()},
            {"every_subset", study.every_subset}};
  Json joints = Json::array();
  for (int joint = 0; joint < 6; ++joint) {
    if (!method.estimate.identifiable[static_cast<std::size_t>(joint)]) {
      joints.push_back(nullptr);
      continue;
    }
    const StiffnessSpread spread = spreadOf(study, joint);
    joints.push_back({{"mean_nm_per_rad", number(spread.mean)},
                      {"sd_nm_per_rad", number(spread.sd)},
                      {"median_nm_per_rad", number(spread.median)},
                      {"p5_nm_per_rad", number(spread.low)},
                      {"p95_nm_per_rad", number(spread.high)},
                      {"mean_compliance_rad_per_nm", number(spread.compliance_mean)},
                      {"sd_compliance_rad_per_nm", number(spread.compliance_sd)},
                      {"share_negative", number(spread.share_negative)}});
  }
  json["joints"] = joints;
  return json;
}

Json methodJson(const MethodResult& method) {
  if (!method.available) return {{"unavailable", method.reason}};
  const StiffnessEstimate& estimate = method.estimate;
  Json json;
  json["stiffness_nm_per_rad"] = byJoint(estimate, [&](int j) { return number(estimate.stiffness(j)); });
  json["sd_nm_per_rad"] = byJoint(estimate, [&](int j) { return number(estimate.stiffnessSd(j)); });
  json["compliance_rad_per_nm"] = byJoint(estimate, [&](int j) { return number(estimate.compliance[j]); });
  json["identifiable"] = estimate.identifiable;
  json["mark"] = byJoint(estimate, [&](int j) { return Json(estimate.mark(j)); });
  addUncertainty(method, json);
  json["condition"] = number(estimate.condition);
  json["rms_residual_mm"] = estimate.rms_residual / kMillimetre;
  json["sigma_mm"] = estimate.sigma / kMillimetre;
  const bool subsets = !method.subsets.compliances.empty();
  json["compensated"] = compensationJson(method.at_wrist, subsets);
  json["compensated_at_targets"] = compensationJson(method.at_targets, subsets);
  json["subsets"] = subsets ? spreadJson(method) : Json(nullptr);
  return json;
}

Json identifiabilityJson(const Identifiability& judged) {
  Json joints = Json::array();
  for (std::size_t j = 0; j < 6; ++j) {
    const JointIdentifiability& joint = judged.joints[j];
    Json one{{"joint", j + 1}, {"identifiable", joint.identifiable}};
    if (!joint.identifiable) one["reason"] = joint.reason;
    one["torque_rms_nm"] = joint.torque_rms;
    one["trusted_torque_rms_nm"] = joint.trusted_rms;
    one["torque_uncertainty_nm"] = joint.uncertainty_rms;
    joints.push_back(one);
  }
  return {{"load_hangs", judged.load_hangs},
          {"force_to_gravity_rms_deg", judged.gravity_angle_rms / kDegree},
          {"joints", joints}};
}

Json calibrationJson(const GeometryCalibration& calibration) {
  if (!calibration.done) return {{"unavailable", calibration.reason}};
  return {{"positions", calibration.positions},
          {"parameters", calibration.parameters},
          {"fixed", calibration.fixed},
          {"rms_before_mm", calibration.rms_before / kMillimetre},
          {"rms_after_mm", calibration.rms_after / kMillimetre}};
}

/// What one posture's displacement is, and what the methods leave of it.
Json postureJson(const Campaign& campaign, const Identification& result, const std::vector<Method>& methods, std::size_t i) {
  Json posture{{"pose", campaign.pose_ids[static_cast<std::size_t>(result.cases[i].pose)]}};
  if (result.steps.size() > 1) posture["step"] = result.cases[i].step;
  if (!result.wrist_displacement.empty()) posture["wrist_mm"] = result.wrist_displacement[i] / kMillimetre;
  posture["targets_mean_mm"] = result.target_displacement[i] / kMillimetre;
  for (const Method which : methods) {
    const MethodResult& method = result.of(which);
    if (!method.available) continue;
    const std::string key = namesOf(which).key;
    if (i < method.wrist_residual.size()) posture["wrist_after_" + key + "_mm"] = method.wrist_residual[i] / kMillimetre;
    if (i < method.target_residual.size()) {
      posture["targets_mean_after_" + key + "_mm"] = method.target_residual[i] / kMillimetre;
    }
  }
  return posture;
}

/// Cartesian stiffness and what neglecting K_c costs, by the best of the methods there is.
JsonDocument cartesianJson(const Campaign& campaign, const Identification& result, const std::vector<Method>& methods) {
  for (const Method which : {Method::decoupled_partial_pose, Method::partial_pose, Method::complete_pose}) {
    if (!result.of(which).available || std::find(methods.begin(), methods.end(), which) == methods.end()) continue;
    JsonDocument document(Json{{"method", namesOf(which).key}});
    const auto row = [stiffnesses = PostureStiffnesses(campaign, result, which),
                      costs = geometricStiffnessCosts(result, which)](std::size_t i) {
      Json posture = postureStiffnessJson(stiffnesses.at(i));
      posture["k_c_cost_um"] = costs[i].at_targets / kMicrometre;
      posture["k_c_cost_share"] = costs[i].share;
      return posture;
    };
    document.setRows("rows", {result.cases.size(), row});
    return document;
  }
  return {};
}

Json outlyingJson(const Campaign& campaign, const Identification& result) {
  Json list = Json::array();
  for (const OutlyingPosture& one : result.outlying) {
    list.push_back({{"pose", campaign.pose_ids[static_cast<std::size_t>(one.posture)]},
                    {"rms_um", one.rms / kMicrometre},
                    {"others_rms_um", one.others / kMicrometre},
                    {"f_ratio", number(one.f)},
                    {"p_value", number(one.p_value)},
                    {"left_out", result.robust}});
  }
  return list;
}

}  // namespace

JsonDocument identificationJson(const Campaign& campaign, const Identification& result, const std::vector<Method>& methods) {
  JsonDocument document(Json::object());
  Json& json = document.json;
  json["campaign"] = campaignJson(campaign);
  json["step"] = result.step;
  json["steps"] = result.steps;
  json["postures"] = postureCount(result);
  json["left_out"] = result.left_out;
  json["outlying"] = outlyingJson(campaign, result);
  json["cautions"] = result.cautions;
  Json by_method = Json::object();
  for (const Method which : methods) by_method[namesOf(which).key] = methodJson(result.of(which));
  json["methods"] = by_method;
  json["identifiability"] = identifiabilityJson(result.identifiability);
  json["noise_share"] = result.noise ? Json{{"wrist", result.noise->at_wrist ? number(*result.noise->at_wrist) : Json(nullptr)},
                                          {"targets", number(result.noise->at_targets)},
                                          {"per_coordinate_um", result.noise->per_coordinate / kMicrometre}}
                                     : Json(nullptr);
  json["geometric_stiffness"] = {{"included", result.finite_deflection},
                                 {"torque_change_share", result.geometric_stiffness_share}};
  json["servo_change_deg"] = result.servo_change / kDegree;
  json["calibration"] = calibrationJson(result.calibration);
  json["own_weight"] = {{"removed", result.frames.sag_removed}, {"note", result.frames.sag_note}};
  if (!result.length_sensitivity.empty()) {
    Json curve = Json::array();
    for (const LengthSensitivity& at : result.length_sensitivity) {
      Json stiffness = Json::array();
      for (int j = 0; j < 6; ++j) stiffness.push_back(at.compliance[j] == 0.0 ? Json(nullptr) : number(1.0 / at.compliance[j]));
      curve.push_back({{"length_m", at.length}, {"jacobian_condition", at.condition}, {"stiffness_nm_per_rad", stiffness}});
    }
    json["characteristic_length"] = {{"length_m", result.characteristic_length.length},
                                     {"jacobian_condition", result.characteristic_length.condition},
                                     {"sensitivity", curve}};
  }
  const auto posture = [&campaign, &result, methods](std::size_t i) { return postureJson(campaign, result, methods, i); };
  document.setRows("per_posture", {result.cases.size(), posture});
  document.set("/posture_stiffness"_json_pointer, cartesianJson(campaign, result, methods));
  return document;
}

}  // namespace stiffscope
