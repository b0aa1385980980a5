#include "reports/json/campaign_json.h"

#include <variant>

#include "core/io/units.h"
#include "core/robot/balancer.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json driftJson(const preparation::DriftCorrection& drift) {
  if (!drift.taken_off) return {{"taken_off", false}, {"reason", words(drift.reason)}};
  constexpr double kMicroradian = 1e-6;
  return {{"taken_off", true},
          {"largest_mm", drift.displacement / io::kMillimetre},
          {"largest_turn_urad", drift.turn / kMicroradian},
          {"until_s", drift.until_s},
          {"jumps_s", drift.jumps_s},
          {"readings", drift.readings},
          {"readings_without_time", drift.without_time}};
}

Json stationsJson(const preparation::JoinedStations& stations) {
  constexpr double kMicroradian = 1e-6;
  Json list = Json::array();
  for (std::size_t s = 0; s < stations.network.stations.size(); ++s) {
    const preparation::StationPose& pose = stations.network.stations[s];
    const preparation::PoseUncertainty at_arm = preparation::poseUncertainty(pose);
    list.push_back({{"station", pose.id},
                    {"readings", stations.readings[s]},
                    {"common_nests", s == 0 ? Json(nullptr) : Json(pose.common_nests)},
                    {"first_from_station", matrix(pose.first_from_station)},
                    {"sd_at_arm_um", at_arm.position / io::kMicrometre},
                    {"sd_turn_urad", at_arm.turn / kMicroradian}});
  }
  return list;
}

}  // namespace

Json rejectedJson(const std::vector<preparation::RejectedReading>& rejected) {
  Json list = Json::array();
  for (const preparation::RejectedReading& reading : rejected) {
    list.push_back({{"file", reading.file}, {"line", reading.line}, {"reason", words(reading.reason)}});
  }
  return list;
}

Json preparationJson(const preparation::Preparation& preparation) {
  Json json{{"raw", preparation.raw},
            {"rejected", rejectedJson(preparation.rejected)},
            {"drift", driftJson(preparation.drift)}};
  if (preparation.stations) json["stations"] = stationsJson(*preparation.stations);
  return json;
}

Json withPreparation(Json result, const preparation::Preparation& preparation) {
  result["preparation"] = preparationJson(preparation);
  return result;
}

const char* nameOf(campaign::DoubleEncoder state) {
  switch (state) {
    case campaign::DoubleEncoder::active:
      return "active";
    case campaign::DoubleEncoder::inactive:
      return "inactive";
    case campaign::DoubleEncoder::unspecified:
      break;
  }
  return "unspecified";
}

Json jointNumbers(const std::vector<int>& joints) {
  Json numbers = Json::array();
  for (const int joint : joints) numbers.push_back(joint + 1);
  return numbers;
}

namespace {

/// As the campaign states it: its bodies, and what it pulls with at the length that the data are of.
Json balancerJson(const robot::Balancer& balancer) {
  const double length = robot::statedLength(balancer);
  const robot::Tension tension = robot::tensionAt(balancer, length);
  return {{"kind", std::holds_alternative<robot::GasLaw>(balancer.law) ? "gas" : "spring"},
          {"from_body", balancer.from.body},
          {"to_body", balancer.to.body},
          {"length_mm", length / io::kMillimetre},
          {"tension_n", tension.force_n},
          {"rate_n_per_m", tension.slope_n_per_m}};
}

}  // namespace

Json campaignJson(const campaign::Campaign& campaign) {
  Json inputs = Json::array();
  for (const campaign::InputFile& input : campaign.inputs)
    inputs.push_back({{"file", input.name}, {"sha256", input.sha256}});
  Json json{{"name", campaign.name},
            {"date", campaign.date},
            {"robot", campaign.robot.name},
            {"double_encoder", nameOf(campaign.double_encoder)},
            {"inputs", inputs}};
  if (!campaign.double_encoder_joints.empty())
    json["double_encoder_joints"] = jointNumbers(campaign.double_encoder_joints);
  if (!campaign.robot.balancers.empty()) {
    Json balancers = Json::array();
    for (const robot::Balancer& balancer : campaign.robot.balancers) balancers.push_back(balancerJson(balancer));
    json["balancers"] = balancers;
  }
  if (!campaign.texts.robot_serial.empty()) json["robot_serial"] = campaign.texts.robot_serial;
  return json;
}

}  // namespace stiffscope::reports
