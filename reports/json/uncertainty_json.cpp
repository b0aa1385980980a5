#include "reports/json/uncertainty_json.h"

#include <cmath>

#include "core/identification/stiffness_interval.h"
#include "reports/method_names.h"

namespace stiffscope {

namespace {

Json maskedByJoint(const JointMask& identifiable, const auto& entry) {
  Json list = Json::array();
  for (int joint = 0; joint < 6; ++joint) {
    list.push_back(identifiable[static_cast<std::size_t>(joint)] ? Json(entry(joint)) : Json(nullptr));
  }
  return list;
}

Json intervalJson(const CoverageInterval& interval) { return Json::array({number(interval.low), number(interval.high)}); }

Json correlationJson(const StiffnessEstimate& estimate) {
  const Matrix6d matrix = correlation(estimate);
  return maskedByJoint(estimate.identifiable, [&](int row) {
    return maskedByJoint(estimate.identifiable, [&](int column) { return number(matrix(row, column)); });
  });
}

Json contributionsJson(const StiffnessEstimate& estimate) {
  const auto part = [&](const Matrix6d& covariance) {
    return maskedByJoint(estimate.identifiable, [&](int j) { return number(std::sqrt(covariance(j, j))); });
  };
  Json json{{"scatter_rad_per_nm", part(estimate.parts.scatter)},
            {"frames_rad_per_nm", part(estimate.parts.frames)},
            {"wrist_rad_per_nm", part(estimate.parts.wrist)},
            {"geometry_rad_per_nm", part(estimate.parts.geometry)}};
  if (!estimate.parts.effects.isZero(0.0)) json["effects_rad_per_nm"] = part(estimate.parts.effects);
  return json;
}

Json stepsJson(const StepsOfMethod& steps, const JointMask& identifiable) {
  if (steps.steps.empty()) return nullptr;
  Json rows = Json::array();
  for (const StepEstimate& one : steps.steps) {
    const StiffnessEstimate& estimate = one.estimate;
    rows.push_back(
        {{"step", one.step},
         {"mean_force_n", one.mean_force},
         {"stiffness_nm_per_rad", maskedByJoint(identifiable, [&](int j) { return number(estimate.stiffness(j)); })},
         {"sd_nm_per_rad", maskedByJoint(identifiable, [&](int j) { return number(estimate.stiffnessSd(j)); })},
         {"interval_nm_per_rad",
          maskedByJoint(identifiable, [&](int j) { return intervalJson(stiffnessInterval(estimate, j)); })}});
  }
  const auto dependence = [&](const auto& member) {
    return maskedByJoint(identifiable, [&](int j) { return number(steps.joints[static_cast<std::size_t>(j)].*member); });
  };
  return {{"steps", rows},
          {"compliance_change", dependence(&LoadDependence::change)},
          {"compliance_change_sd", dependence(&LoadDependence::change_sd)},
          {"p_change", dependence(&LoadDependence::p_change)},
          {"p_linear", dependence(&LoadDependence::p_linear)}};
}

}  // namespace

void addUncertainty(const MethodResult& method, Json& json) {
  const StiffnessEstimate& estimate = method.estimate;
  const JointMask& seen = estimate.identifiable;
  json["coverage"] = kStatedCoverage;
  json["interval_nm_per_rad"] = maskedByJoint(seen, [&](int j) { return intervalJson(stiffnessInterval(estimate, j)); });
  json["dof"] = maskedByJoint(seen, [&](int j) { return number(estimate.dof(j)); });
  json["sd_compliance_rad_per_nm"] =
      maskedByJoint(seen, [&](int j) { return number(std::sqrt(estimate.covariance(j, j))); });
  json["interval_compliance_rad_per_nm"] =
      maskedByJoint(seen, [&](int j) { return intervalJson(complianceInterval(estimate, j)); });
  json["correlation"] = correlationJson(estimate);
  json["contributions"] = contributionsJson(estimate);
  if (method.bootstrap.compliances.empty()) return;
  json["bootstrap"] = {
      {"draws", method.bootstrap.compliances.size()},
      {"interval_nm_per_rad", maskedByJoint(seen, [&](int j) { return intervalJson(method.bootstrap.stiffness(j)); })},
      {"interval_compliance_rad_per_nm",
       maskedByJoint(seen, [&](int j) { return intervalJson(method.bootstrap.compliance(j)); })}};
}

Json withSteps(Json json, const StepStudy& study, const Identification& result, const std::vector<Method>& methods) {
  Json by_method = Json::object();
  for (const Method which : methods) {
    by_method[namesOf(which).key] =
        stepsJson(study.methods[static_cast<std::size_t>(which)], result.of(which).estimate.identifiable);
  }
  json["by_step"] = by_method;
  return json;
}

}  // namespace stiffscope
