#include <cmath>

#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "reports/json/identification_json.h"
#include "reports/json/json.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"
#include "reports/words/transmission_words.h"

namespace stiffscope::reports {

namespace {

Json structureJson(const identification::GearAndStructure& apart) {
  return {{"in_series", apart.in_series},
          {"compliance_rad_per_nm", number(apart.structure)},
          {"sd_compliance_rad_per_nm", number(apart.sd)},
          {"interval_compliance_rad_per_nm", intervalJson(apart.interval)},
          {"stiffness_nm_per_rad", number(1.0 / apart.structure)},
          {"interval_nm_per_rad", intervalJson(identification::stiffnessInterval(apart.interval))},
          {"gear_share", number(apart.gear_share)},
          {"agreement", keyOf(apart.agreement)}};
}

Json gearJson(const identification::Identification& result, const std::vector<identification::Method>& methods,
              int joint) {
  const identification::Transmission& transmission = *result.transmission;
  const identification::StiffnessEstimate& estimate = transmission.estimate;
  const identification::GearTorsion& gear = transmission.joints[static_cast<std::size_t>(joint)];
  if (!gear.measured) return {{"joint", joint + 1}, {"measured", false}, {"reason", words(gear.reason)}};
  const identification::CovarianceParts& parts = estimate.parts;
  Json json{{"joint", joint + 1},
            {"measured", true},
            {"compliance_rad_per_nm", number(estimate.compliance[joint])},
            {"sd_compliance_rad_per_nm", number(std::sqrt(estimate.covariance(joint, joint)))},
            {"interval_compliance_rad_per_nm", intervalJson(identification::complianceInterval(estimate, joint))},
            {"stiffness_nm_per_rad", number(estimate.stiffness(joint))},
            {"sd_nm_per_rad", number(estimate.stiffnessSd(joint))},
            {"interval_nm_per_rad", intervalJson(identification::stiffnessInterval(estimate, joint))},
            {"dof", number(estimate.dof(joint))},
            {"mark", words(estimate.mark(joint))},
            {"contributions",
             {{"scatter_rad_per_nm", number(std::sqrt(parts.scatter(joint, joint)))},
              {"frames_rad_per_nm", number(std::sqrt(parts.frames(joint, joint)))},
              {"load_cell_gain_rad_per_nm", number(std::sqrt(parts.effects(joint, joint)))}}},
            {"points", gear.states},
            {"postures", gear.postures},
            {"left_out", gear.left_out},
            {"torque_rms_nm", gear.rms_torque},
            {"rms_residual_rad", gear.rms_residual},
            {"held", keyOf(gear.held)},
            {"link_side_rad_per_nm", number(gear.link_turn)},
            {"sd_link_side_rad_per_nm", number(gear.link_turn_sd)},
            {"offset_rad", number(gear.offset)},
            {"offset_sd_rad", number(gear.offset_sd)},
            {"offset_holds_own_weight", gear.offset_holds_weight},
            {"lost_motion_rad", gear.lost_motion ? number(gear.lost_motion->width) : Json(nullptr)},
            {"sd_lost_motion_rad", gear.lost_motion ? number(gear.lost_motion->sd) : Json(nullptr)},
            {"caution", words(gear.caution)}};
  Json structure = Json::object();
  for (const identification::Method which : methods) {
    if (!result.of(which).available) continue;
    const auto apart = identification::gearAndStructure(transmission, result.of(which).estimate, joint);
    structure[namesOf(which).key] = apart ? structureJson(*apart) : Json(nullptr);
  }
  json["structure"] = structure;
  return json;
}

}  // namespace

Json transmissionJson(const identification::Identification& result,
                      const std::vector<identification::Method>& methods) {
  Json joints = Json::array();
  for (int joint = 0; joint < result.transmission->estimate.joints(); ++joint)
    joints.push_back(gearJson(result, methods, joint));
  return {{"coverage", identification::kStatedCoverage}, {"joints", joints}};
}

}  // namespace stiffscope::reports
