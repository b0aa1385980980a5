#include "reports/json/identification_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identification/estimate.h"
#include "core/identification/geometric_stiffness_cost.h"
#include "core/identification/posture_stiffness.h"
#include "core/identification/subsets.h"
#include "core/io/units.h"
#include "reports/json/json_document.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

/// A posture's conditioning and Cartesian stiffness at P_TCP, R0 axes; the principal stiffnesses are those with
/// K_c.
Json postureStiffnessJson(const identification::PostureStiffness& posture);

Json intervalJson(const identification::CoverageInterval& interval) {
  return Json::array({number(interval.low), number(interval.high)});
}

namespace {

Json principalJson(const robot::CartesianStiffness& stiffness) {
  Json principal = Json::array();
  for (const robot::PrincipalStiffness& one : stiffness.principal) {
    principal.push_back({{"stiffness_n_per_m", number(one.stiffness)}, {"direction", array(one.direction)}});
  }
  return principal;
}

}  // namespace

Json postureStiffnessJson(const identification::PostureStiffness& posture) {
  Json rigid = Json::array();
  for (const int joint : posture.rigid_joints) rigid.push_back(joint + 1);
  return {{"pose", posture.pose},
          {"kappa", number(posture.conditioning.kappa)},
          {"kappa_2_norm", number(posture.conditioning.kappa_two)},
          {"k_x", principalJson(posture.with_kc)},
          {"k_x_without_kc", principalJson(posture.without_kc)},
          {"anisotropy", number(posture.with_kc.anisotropy())},
          {"kc_share", number(posture.kc_share)},
          {"joints_taken_as_rigid", rigid}};
}

namespace {

Json maskedByJoint(const robot::JointMask& identifiable, const auto& entry) {
  Json list = Json::array();
  for (std::size_t joint = 0; joint < identifiable.size(); ++joint) {
    list.push_back(identifiable[joint] ? Json(entry(static_cast<int>(joint))) : Json(nullptr));
  }
  return list;
}

Json correlationJson(const identification::StiffnessEstimate& estimate) {
  const JointMatrix matrix = identification::correlation(estimate);
  return maskedByJoint(estimate.identifiable, [&](int row) {
    return maskedByJoint(estimate.identifiable, [&](int column) { return number(matrix(row, column)); });
  });
}

Json contributionsJson(const identification::StiffnessEstimate& estimate) {
  const auto part = [&](const JointMatrix& covariance) {
    return maskedByJoint(estimate.identifiable, [&](int j) { return number(std::sqrt(covariance(j, j))); });
  };
  Json json{{"scatter_rad_per_nm", part(estimate.parts.scatter)},
            {"frames_rad_per_nm", part(estimate.parts.frames)},
            {"wrist_rad_per_nm", part(estimate.parts.wrist)},
            {"geometry_rad_per_nm", part(estimate.parts.geometry)}};
  if (!estimate.parts.effects.isZero(0.0)) json["effects_rad_per_nm"] = part(estimate.parts.effects);
  return json;
}

Json stepsJson(const identification::StepsOfMethod& steps, const robot::JointMask& identifiable) {
  if (steps.steps.empty()) return nullptr;
  Json rows = Json::array();
  for (const identification::StepEstimate& one : steps.steps) {
    const identification::StiffnessEstimate& estimate = one.estimate;
    rows.push_back(
        {{"step", one.step},
         {"mean_force_n", one.mean_force},
         {"stiffness_nm_per_rad", maskedByJoint(identifiable, [&](int j) { return number(estimate.stiffness(j)); })},
         {"sd_nm_per_rad", maskedByJoint(identifiable, [&](int j) { return number(estimate.stiffnessSd(j)); })},
         {"interval_nm_per_rad", maskedByJoint(identifiable, [&](int j) {
            return intervalJson(identification::stiffnessInterval(estimate, j));
          })}});
  }
  const auto dependence = [&](const auto& member) {
    return maskedByJoint(identifiable,
                         [&](int j) { return number(steps.joints[static_cast<std::size_t>(j)].*member); });
  };
  return {{"steps", rows},
          {"compliance_change", dependence(&identification::LoadDependence::change)},
          {"compliance_change_sd", dependence(&identification::LoadDependence::change_sd)},
          {"p_change", dependence(&identification::LoadDependence::p_change)},
          {"p_linear", dependence(&identification::LoadDependence::p_linear)}};
}

}  // namespace

Json shownFirstJson(const std::optional<identification::ShownFirst>& first) {
  using Judged = identification::ShownFirst::Judged;
  if (!first) return nullptr;
  Json json{{"method", namesOf(first->method).key}, {"judged_at", nullptr}, {"reason", words(first->reason)}};
  if (first->judged != Judged::not_at_all)
    json["judged_at"] = first->judged == Judged::at_wrist ? "P_wrist" : "reflectors";
  return json;
}

void addUncertainty(const identification::MethodResult& method, Json& json) {
  const identification::StiffnessEstimate& estimate = method.estimate;
  const robot::JointMask& seen = estimate.identifiable;
  json["coverage"] = identification::kStatedCoverage;
  json["interval_nm_per_rad"] =
      maskedByJoint(seen, [&](int j) { return intervalJson(identification::stiffnessInterval(estimate, j)); });
  json["dof"] = maskedByJoint(seen, [&](int j) { return number(estimate.dof(j)); });
  json["sd_compliance_rad_per_nm"] =
      maskedByJoint(seen, [&](int j) { return number(std::sqrt(estimate.covariance(j, j))); });
  json["interval_compliance_rad_per_nm"] =
      maskedByJoint(seen, [&](int j) { return intervalJson(identification::complianceInterval(estimate, j)); });
  json["correlation"] = correlationJson(estimate);
  json["contributions"] = contributionsJson(estimate);
  if (method.bootstrap.compliances.empty()) return;
  json["bootstrap"] = {
      {"draws", method.bootstrap.compliances.size()},
      {"interval_nm_per_rad", maskedByJoint(seen, [&](int j) { return intervalJson(method.bootstrap.stiffness(j)); })},
      {"interval_compliance_rad_per_nm",
       maskedByJoint(seen, [&](int j) { return intervalJson(method.bootstrap.compliance(j)); })}};
}

Json withSteps(Json json, const identification::StepStudy& study, const identification::Identification& result,
               const std::vector<identification::Method>& methods) {
  Json by_method = Json::object();
  for (const identification::Method which : methods) {
    by_method[namesOf(which).key] =
        stepsJson(study.methods[static_cast<std::size_t>(which)], result.of(which).estimate.identifiable);
  }
  json["by_step"] = by_method;
  return json;
}

namespace {

Json byJoint(const identification::StiffnessEstimate& estimate, const auto& entry) {
  return maskedByJoint(estimate.identifiable, entry);
}

/// `used`, `held_out` and `all` are means over the subsets, `sd_held_out` the standard deviation over them;
/// `all_postures` is identified and judged on all postures.
Json compensationJson(const std::optional<identification::Compensation>& compensation, bool subsets) {
  if (!compensation) return nullptr;
  const identification::SubsetCompensation& mean = compensation->subsets;
  return {{"used", subsets ? number(mean.used) : Json(nullptr)},
          {"held_out", subsets ? number(mean.held_out) : Json(nullptr)},
          {"sd_held_out", subsets ? number(compensation->held_out_sd) : Json(nullptr)},
          {"all", subsets ? number(mean.all) : number(compensation->all_postures)},
          {"all_postures", number(compensation->all_postures)}};
}

Json spreadJson(const identification::MethodResult& method) {
  const identification::SubsetStudy& study = method.subsets;
  Json json{{"postures_used", study.size},
            {"of", study.of},
            {"subsets", study.compliances.size()},
            {"every_subset", study.every_subset}};
  Json joints = Json::array();
  for (int joint = 0; joint < method.estimate.joints(); ++joint) {
    if (!method.estimate.identifiable[static_cast<std::size_t>(joint)]) {
      joints.push_back(nullptr);
      continue;
    }
    const identification::StiffnessSpread spread = identification::spreadOf(study, joint);
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

Json methodJson(const identification::MethodResult& method) {
  if (!method.available) return {{"unavailable", words(method.reason)}};
  const identification::StiffnessEstimate& estimate = method.estimate;
  Json json;
  json["stiffness_nm_per_rad"] = byJoint(estimate, [&](int j) { return number(estimate.stiffness(j)); });
  json["sd_nm_per_rad"] = byJoint(estimate, [&](int j) { return number(estimate.stiffnessSd(j)); });
  json["compliance_rad_per_nm"] = byJoint(estimate, [&](int j) { return number(estimate.compliance[j]); });
  json["identifiable"] = estimate.identifiable;
  json["mark"] = byJoint(estimate, [&](int j) { return Json(words(estimate.mark(j))); });
  addUncertainty(method, json);
  json["condition"] = number(estimate.condition);
  json["rms_residual_mm"] = estimate.rms_residual / io::kMillimetre;
  json["sigma_mm"] = estimate.sigma / io::kMillimetre;
  const bool subsets = !method.subsets.compliances.empty();
  json["compensated"] = compensationJson(method.at_wrist, subsets);
  json["compensated_at_targets"] = compensationJson(method.at_targets, subsets);
  json["subsets"] = subsets ? spreadJson(method) : Json(nullptr);
  return json;
}

/// `loaded`: whether there are postures under load; without them nothing is known of any load.
Json identifiabilityJson(const identification::Identifiability& judged, bool loaded) {
  const auto ofLoad = [loaded](double value) { return loaded ? number(value) : Json(nullptr); };
  Json joints = Json::array();
  for (std::size_t j = 0; j < judged.joints.size(); ++j) {
    const identification::JointIdentifiability& joint = judged.joints[j];
    Json one{{"joint", j + 1}, {"identifiable", joint.identifiable}};
    if (!joint.identifiable) one["reason"] = words(joint.reason);
    one["torque_rms_nm"] = ofLoad(joint.torque_rms);
    one["trusted_torque_rms_nm"] = ofLoad(joint.trusted_rms);
    one["torque_uncertainty_nm"] = ofLoad(joint.uncertainty_rms);
    joints.push_back(one);
  }
  return {{"load_hangs", loaded ? Json(judged.load_hangs) : Json(nullptr)},
          {"force_to_gravity_rms_deg", ofLoad(judged.gravity_angle_rms / io::kDegree)},
          {"joints", joints}};
}

Json geometryCalibrationJson(const frames::GeometryCalibration& calibration) {
  if (!calibration.done) return {{"unavailable", words(calibration.reason)}};
  return {{"positions", calibration.positions},
          {"parameters", calibration.parameters},
          {"fixed", words(calibration.fixed)},
          {"rms_before_mm", calibration.rms_before / io::kMillimetre},
          {"rms_after_mm", calibration.rms_after / io::kMillimetre}};
}

/// What one posture's displacement is, and what the methods leave of it.
Json postureJson(const campaign::Campaign& campaign, const identification::Identification& result,
                 const std::vector<identification::Method>& methods, std::size_t i) {
  Json posture{{"pose", campaign.pose_ids[static_cast<std::size_t>(result.cases[i].pose)]}};
  if (result.steps.size() > 1) posture["step"] = result.cases[i].step;
  if (!result.wrist_displacement.empty()) posture["wrist_mm"] = result.wrist_displacement[i] / io::kMillimetre;
  posture["targets_mean_mm"] = result.target_displacement[i] / io::kMillimetre;
  for (const identification::Method which : methods) {
    const identification::MethodResult& method = result.of(which);
    if (!method.available) continue;
    const std::string key = namesOf(which).key;
    if (i < method.wrist_residual.size())
      posture["wrist_after_" + key + "_mm"] = method.wrist_residual[i] / io::kMillimetre;
    if (i < method.target_residual.size()) {
      posture["targets_mean_after_" + key + "_mm"] = method.target_residual[i] / io::kMillimetre;
    }
  }
  return posture;
}

/// Cartesian stiffness and what neglecting K_c costs, by the best of the methods there is.
JsonDocument cartesianJson(const campaign::Campaign& campaign, const identification::Identification& result,
                           const std::vector<identification::Method>& methods) {
  const std::optional<identification::Method> best = identification::bestMethodOf(result, methods);
  if (!best) return {};
  JsonDocument document(Json{{"method", namesOf(*best).key}});
  const auto row = [stiffnesses = identification::PostureStiffnesses(campaign, result, *best),
                    costs = identification::geometricStiffnessCosts(result, *best)](std::size_t i) {
    Json posture = postureStiffnessJson(stiffnesses.at(i));
    posture["k_c_cost_um"] = costs[i].at_targets / io::kMicrometre;
    posture["k_c_cost_share"] = costs[i].share;
    return posture;
  };
  document.setRows("rows", {result.cases.size(), row});
  return document;
}

Json lengthJson(const identification::LengthSensitivity& at) {
  Json stiffness = Json::array();
  for (Eigen::Index j = 0; j < at.compliance.size(); ++j)
    stiffness.push_back(at.compliance[j] == 0.0 ? Json(nullptr) : number(1.0 / at.compliance[j]));
  return {{"length_m", at.length},
          {"jacobian_condition", at.condition},
          {"stiffness_nm_per_rad", stiffness},
          {"subsets", at.subsets},
          {"compensated", compensationJson(at.at_wrist, at.subsets > 0)},
          {"compensated_at_targets", compensationJson(at.at_targets, at.subsets > 0)}};
}

Json outlyingJson(const campaign::Campaign& campaign, const identification::Identification& result) {
  Json list = Json::array();
  for (const identification::OutlyingPosture& one : result.outlying) {
    list.push_back({{"pose", campaign.pose_ids[static_cast<std::size_t>(one.posture)]},
                    {"rms_um", one.rms / io::kMicrometre},
                    {"others_rms_um", one.others / io::kMicrometre},
                    {"f_ratio", number(one.f)},
                    {"p_value", number(one.p_value)},
                    {"left_out", result.robust}});
  }
  return list;
}

}  // namespace

JsonDocument identificationJson(const campaign::Campaign& campaign, const identification::Identification& result,
                                const std::vector<identification::Method>& methods) {
  JsonDocument document(Json::object());
  Json& json = document.json;
  json["campaign"] = campaignJson(campaign);
  const bool loaded = !result.cases.empty();
  json["step"] = result.steps.empty() ? Json(nullptr) : Json(result.step);
  json["steps"] = result.steps;
  json["postures"] = identification::postureCount(result);
  json["left_out"] = Json::array();
  for (const identification::LeftOutPosture& one : result.left_out) json["left_out"].push_back(leftOutWords(one));
  json["outlying"] = outlyingJson(campaign, result);
  json["cautions"] = words(result.cautions);
  Json by_method = Json::object();
  for (const identification::Method which : methods) by_method[namesOf(which).key] = methodJson(result.of(which));
  json["methods"] = by_method;
  json["shown_first"] = shownFirstJson(identification::shownFirstOf(result, methods));
  json["identifiability"] = identifiabilityJson(result.identifiability, loaded);
  json["noise_share"] = result.noise
                            ? Json{{"wrist", result.noise->at_wrist ? number(*result.noise->at_wrist) : Json(nullptr)},
                                   {"targets", number(result.noise->at_targets)},
                                   {"per_coordinate_um", result.noise->per_coordinate / io::kMicrometre}}
                            : Json(nullptr);
  // Of what joint stiffnesses make of the load: without one there is no share.
  const bool identified = std::any_of(result.methods.begin(), result.methods.end(),
                                      [](const identification::MethodResult& one) { return one.available; });
  json["geometric_stiffness"] = {
      {"included", result.finite_deflection},
      {"torque_change_share", identified ? number(result.geometric_stiffness_share) : Json(nullptr)}};
  json["servo_change_deg"] = loaded ? number(result.servo_change / io::kDegree) : Json(nullptr);
  json["calibration"] = geometryCalibrationJson(result.calibration);
  if (result.transmission) json["transmission"] = transmissionJson(result, methods);
  json["own_weight"] = {{"removed", result.frames.sag_removed}, {"note", words(result.frames.sag_note)}};
  if (!result.length_sensitivity.empty()) {
    Json curve = Json::array();
    for (const identification::LengthSensitivity& at : result.length_sensitivity) curve.push_back(lengthJson(at));
    json["characteristic_length"] = {
        {"length_m", result.characteristic_length.length},
        {"jacobian_condition", result.characteristic_length.condition},
        {"sensitivity", curve},
        {"by_residual_variances", result.residual_length ? lengthJson(*result.residual_length) : Json(nullptr)}};
  }
  const auto posture = [&campaign, &result, methods](std::size_t i) {
    return postureJson(campaign, result, methods, i);
  };
  document.setRows("per_posture", {result.cases.size(), posture});
  document.set("/posture_stiffness"_json_pointer, cartesianJson(campaign, result, methods));
  return document;
}

}  // namespace stiffscope::reports
