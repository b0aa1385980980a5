#include "core/planning/plan.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"

#include "core/campaign/joint_reading.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

void addReading(const campaign::Campaign& campaign, const JointVector& q, Json& row) {
  if (campaign.joint_readings.empty()) return;
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  row["reading_deg"] = array(convention.figures(q), 1.0 / io::kDegree);
}

namespace {

/// Standard deviations of c, and of k = 1/c where an identified campaign has c.
void addUncertainties(const planning::Plan& plan, const JointVector& sd, Json& row) {
  row["sd_compliance_rad_per_nm"] = array(sd);
  if (!plan.compliance) return;
  JointVector of_k = sd;
  for (Eigen::Index j = 0; j < of_k.size(); ++j) of_k[j] /= (*plan.compliance)[j] * (*plan.compliance)[j];
  row["sd_nm_per_rad"] = array(of_k);
}

Json rowJson(const campaign::Campaign& campaign, const planning::Plan& plan, const planning::PlannedPosture& posture) {
  Json row{{"pose", posture.id},
           {"q_deg", array(posture.candidate.q, 1.0 / io::kDegree)},
           {"load_n", plan.arm.load},
           {"direction_in_base_link", array(posture.pull_in_base)},
           {"expected_force_in_cell_n", array(posture.reading.head<3>())},
           {"expected_moment_in_cell_nm", array(posture.reading.tail<3>())},
           {"dexterity", posture.dexterity},
           {"tracker_distance_m", posture.tracker_distance ? Json(*posture.tracker_distance) : Json(nullptr)}};
  addReading(campaign, posture.candidate.q, row);
  Json gain{{"log_det", number(posture.log_det_gain)}};
  addUncertainties(plan, posture.sd, gain);
  row["gain"] = gain;
  row["separates"] = posture.separates;
  return row;
}

Json randomJson(const planning::Plan& plan, const planning::RandomPostures& random) {
  Json json{{"postures", random.postures}, {"log_det", number(random.log_determinant)}};
  addUncertainties(plan, random.sd, json);
  json["d_efficiency_of_plan"] = number(random.efficiency);
  return json;
}

}  // namespace

Json planJson(const campaign::Campaign& campaign, const planning::Plan& plan) {
  Json json{{"campaign", campaignJson(campaign)},
            {"load_n", plan.arm.load},
            {"load", plan.arm.pull ? "pull" : "hanging"},
            {"hook_in_flange_mm", array(plan.arm.hook_in_flange, 1.0 / io::kMillimetre)},
            {"candidates", plan.candidates},
            {"drawn", plan.drawn},
            {"assumed", words(plan.arm.assumed)}};
  if (!plan.usable) {
    json["unavailable"] = words(plan.reason);
    return json;
  }
  Json identifiable = Json::array(), reasons = Json::object();
  for (std::size_t j = 0; j < plan.unknown.size(); ++j) {
    identifiable.push_back(static_cast<bool>(plan.unknown[j]));
    if (!plan.unknown[j]) reasons["k" + std::to_string(j + 1)] = words(plan.not_seen[j]);
  }
  json["identifiable"] = identifiable;
  json["not_identifiable"] = reasons;
  json["measured_postures"] = plan.measured;
  if (plan.measured > 0) {
    Json measured;
    addUncertainties(plan, plan.sd_measured, measured);
    json["measured"] = measured;
  }
  json["sd_meaning"] = words(Remark(planning::RemarkId::sd_of_weighted_fit));
  json["log_det"] = number(plan.log_determinant);
  Json rows = Json::array();
  for (const planning::PlannedPosture& posture : plan.postures) rows.push_back(rowJson(campaign, plan, posture));
  json["rows"] = rows;
  json["random"] = randomJson(plan, plan.random_same);
  json["random_twice"] = randomJson(plan, plan.random_double);
  return json;
}

}  // namespace stiffscope::reports
