#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "core/interchange/taught_program.h"
#include "core/toolpath/compensate_path.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"

#include "core/io/units.h"
#include "reports/words/compensation_words.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json deflectionIntervalJson(const compensation::PointDeflection& point) {
  Json list = Json::array();
  for (const identification::CoverageInterval& one : point.interval)
    list.push_back(Json::array({number(one.low / io::kMillimetre), number(one.high / io::kMillimetre)}));
  return list;
}

Json targetsJson(const campaign::Campaign& campaign, const std::vector<compensation::PointDeflection>& targets) {
  Json list = Json::array();
  for (std::size_t k = 0; k < targets.size(); ++k) {
    list.push_back({{"target", campaign.targets[k].id},
                    {"deflection_mm", array(targets[k].deflection, 1.0 / io::kMillimetre)},
                    {"sd_deflection_mm", array(targets[k].sd, 1.0 / io::kMillimetre)},
                    {"interval_deflection_mm", deflectionIntervalJson(targets[k])},
                    {"u_deflection_mm", number(targets[k].expanded / io::kMillimetre)}});
  }
  return list;
}

Json rowJson(const campaign::Campaign& campaign, const compensation::CompensatedPosture& posture) {
  Json row{{"pose", posture.posture.id}, {"q_deg", array(posture.posture.q, 1.0 / io::kDegree)}};
  if (posture.predicted) {
    row["tcp_deflection_mm"] = array(posture.tcp.deflection, 1.0 / io::kMillimetre);
    row["sd_tcp_deflection_mm"] = array(posture.tcp.sd, 1.0 / io::kMillimetre);
    row["interval_tcp_deflection_mm"] = deflectionIntervalJson(posture.tcp);
    row["u_tcp_deflection_mm"] = number(posture.tcp.expanded / io::kMillimetre);
    row["flange_rotation_deg"] = array(posture.rotation, 1.0 / io::kDegree);
    row["sd_flange_rotation_deg"] = array(posture.rotation_sd, 1.0 / io::kDegree);
    row["targets"] = targetsJson(campaign, posture.targets);
    row["conditioning"] = posture.conditioning;
    row["load_ratio"] = posture.load_ratio > 0.0 ? Json(posture.load_ratio) : Json(nullptr);
  } else {
    row["tcp_deflection_mm"] = nullptr;
  }
  if (posture.solved) {
    row["command_deg"] = array(posture.commands, 1.0 / io::kDegree);
    addReading(campaign, posture.commands, row);
    row["change_deg"] = array(JointVector(posture.commands - posture.posture.q), 1.0 / io::kDegree);
    row["remaining_mm"] = posture.remaining / io::kMillimetre;
    row["remaining_mirrored_once_mm"] = posture.mirrored_remaining / io::kMillimetre;
    constexpr Eigen::Index kOfPose = 6;  // fewer joints cannot bring the orientation back, too
    if (posture.commands.size() < kOfPose) row["remaining_turn_deg"] = array(posture.remaining_turn, 1.0 / io::kDegree);
  } else {
    row["command_deg"] = nullptr;
    row["refused"] = words(posture.reason);
  }
  row["cautions"] = words(posture.cautions);
  return row;
}

Json summaryJson(const std::vector<compensation::CompensatedPosture>& postures) {
  const compensation::CompensationSummary summary = compensation::summaryOf(postures);
  Json refused = Json::array();
  for (const auto& [reason, count] : summary.refused)
    refused.push_back({{"because", refusalWords(reason)}, {"postures", count}});
  return {{"postures", summary.asked},
          {"compensated", summary.compensated},
          {"cautioned", summary.cautioned},
          {"refused", refused},
          {"text", summaryWords(summary)}};
}

Json knownJson(const std::vector<campaign::KnownStiffness>& known) {
  Json list = Json::array();
  for (const campaign::KnownStiffness& one : known)
    list.push_back(
        {{"joint", one.joint + 1}, {"nm_per_rad", one.stiffness}, {"sd_nm_per_rad", one.sd}, {"source", one.source}});
  return list;
}

}  // namespace

Json compensationJson(const campaign::Campaign& campaign, identification::Method method,
                      const std::vector<compensation::CompensatedPosture>& postures,
                      const std::vector<campaign::KnownStiffness>& known) {
  Json rows = Json::array();
  for (const compensation::CompensatedPosture& posture : postures) {
    rows.push_back(rowJson(campaign, posture));
  }
  return {{"campaign", campaignJson(campaign)},
          {"method", namesOf(method).key},
          {"frame", "r0"},
          {"known_stiffness", knownJson(known)},
          {"rows", rows},
          {"summary", summaryJson(postures)}};
}

namespace {

void addPathKeys(const toolpath::CompensatedPathPose& pose, Json& row) {
  const toolpath::ToolWrench at_tip = pose.wrenchAtTip();
  row["along_mm"] = pose.along / io::kMillimetre;
  row["tip_mm"] = array(pose.tip_in_workpiece, 1.0 / io::kMillimetre);
  row["process"] = {{"force_n", array(at_tip.force)}, {"moment_nm", array(at_tip.moment)}};
  if (!at_tip.reason.empty()) row["process"] = nullptr;
  const bool held = pose.joints.q.allFinite();
  row["turn_deg"] = held ? number(pose.joints.turn / io::kDegree) : Json(nullptr);
  row["limit_margin_deg"] = held ? number(pose.joints.limit_margin / io::kDegree) : Json(nullptr);
  row["nearest_limit"] = held ? Json(pose.joints.nearest_limit + 1) : Json(nullptr);
  const bool predicted = pose.compensated.predicted;
  row["deflection_in_workpiece_mm"] = predicted ? array(pose.deflection.shift, 1.0 / io::kMillimetre) : Json(nullptr);
  row["joint_torque_nm"] = predicted ? array(pose.joint_torque) : Json(nullptr);
  row["offset"] = pose.compensated.solved ? Json{{"shift_mm", array(pose.offset.shift, 1.0 / io::kMillimetre)},
                                                 {"rotation_deg", array(pose.offset.turn, 1.0 / io::kDegree)}}
                                          : Json(nullptr);
}

}  // namespace

Json pathJson(const campaign::Campaign& campaign, identification::Method method, const toolpath::PathJob& job,
              const toolpath::CompensatedPath& path, const std::vector<campaign::KnownStiffness>& known) {
  Json json = compensationJson(campaign, method, path.postures(), known);
  std::size_t reached = 0;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    addPathKeys(path.poses[i], json["rows"][i]);
    reached += path.poses[i].joints.q.allFinite() ? 1 : 0;
  }
  json["joints"] = {{"reached", reached}, {"branches", path.branches}, {"turn_free", job.turn_free}};
  return json;
}

Json withProgram(Json json, const interchange::TaughtProgram& program, const std::string& out,
                 const std::vector<compensation::CompensatedPosture>& targets, double rounding) {
  Json in_space = Json::array(), computed = Json::array();
  for (const interchange::SkippedRow& skipped : program.log.skipped) {
    if (skipped.reason == interchange::Skip::joints_not_given) in_space.push_back(skipped.line);
    if (skipped.reason == interchange::Skip::joints_computed) computed.push_back(skipped.line);
  }
  const std::size_t replaced = compensation::summaryOf(targets).compensated;
  json["program"] = {{"file", program.file},
                     {"out", replaced > 0 ? Json(out) : Json(nullptr)},
                     {"format", interchange::nameOf(program.log.format)},
                     {"replaced", replaced},
                     {"rounding_mm", rounding / io::kMillimetre},
                     {"in_space", in_space},
                     {"computed", computed}};
  return json;
}

}  // namespace stiffscope::reports
