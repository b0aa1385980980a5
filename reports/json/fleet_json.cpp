#include "reports/json/fleet_json.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/words/names.h"

namespace stiffscope::reports {

namespace {

using fleet::CampaignResult;
using fleet::PairResult;
using fleet::SpringsOfDay;
using fleet::Stated;

constexpr std::array kDayKinds{fleet::DayKind::loaded, fleet::DayKind::unloaded, fleet::DayKind::sweeps};
constexpr std::array kEncoderStates{campaign::DoubleEncoder::unspecified, campaign::DoubleEncoder::active,
                                    campaign::DoubleEncoder::inactive};
using preparation::AuditVerdict;
constexpr std::array kVerdicts{AuditVerdict::pass, AuditVerdict::warn, AuditVerdict::fail, AuditVerdict::not_testable};

/// The value whose name stands in the file.
template <class Values, class Name>
auto valueNamed(const Values& values, const Json& json, const Name& name) {
  const std::string text = json.get<std::string>();
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const auto& value) { return std::string_view(name(value)) == text; });
  if (found == values.end()) throw std::runtime_error("no result of a fleet's campaign: '" + text + "'");
  return *found;
}

double keptNumber(const Json& json) { return json.is_null() ? fleet::kUnknown : json.get<double>(); }

Json statedJson(const Stated& one) {
  return {{"value", number(one.value)}, {"low", number(one.low)}, {"high", number(one.high)}};
}

Stated stated(const Json& json) {
  Stated one{keptNumber(json.at("value")), keptNumber(json.at("low")), keptNumber(json.at("high"))};
  if (std::isfinite(one.low) && !std::isfinite(one.high)) one.high = std::numeric_limits<double>::infinity();
  return one;
}

Json statedJson(const PerJoint<Stated>& joints) {
  Json list = Json::array();
  for (const Stated& one : joints) list.push_back(statedJson(one));
  return list;
}

void readStated(const Json& json, PerJoint<Stated>& joints) {
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = stated(json.at(j));
}

/// Of as many joints as the campaign has, whose stiffnesses are a list of that length.
int jointsIn(const Json& stiffnesses) {
  const std::size_t joints = stiffnesses.size();
  if (joints < static_cast<std::size_t>(kFewestJoints) || joints > static_cast<std::size_t>(kMostJoints))
    throw std::runtime_error("no result of a fleet's campaign: stiffnesses of " + std::to_string(joints) + " joints");
  return static_cast<int>(joints);
}

JointVector vectorOf(const Json& json, int joints) {
  JointVector values(joints);
  for (Eigen::Index j = 0; j < joints; ++j) values[j] = keptNumber(json.at(static_cast<std::size_t>(j)));
  return values;
}

Eigen::Vector3d pointOf(const Json& json) {
  return {keptNumber(json.at(0)), keptNumber(json.at(1)), keptNumber(json.at(2))};
}

Json methodJson(const std::optional<identification::Method>& method) {
  return method ? Json(namesOf(*method).key) : Json(nullptr);
}

std::optional<identification::Method> methodOf(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return valueNamed(identification::kMethods, json, [](identification::Method method) { return namesOf(method).key; });
}

Json springsJson(const SpringsOfDay& springs) {
  if (!springs.available) return nullptr;
  Json json;
  json["compliance_rad_per_nm"] = array(springs.compliance);
  json["identifiable"] = springs.identifiable;
  json["shared_variance"] = array(springs.shared);
  json["degrees_of_freedom"] = array(springs.dof);
  json["influences"] = Json::array();
  for (const JointVector& one : springs.influences) json["influences"].push_back(array(one));
  return json;
}

SpringsOfDay springsOf(const Json& json, int joints) {
  SpringsOfDay springs(joints);
  springs.available = !json.is_null();
  if (!springs.available) return springs;
  springs.compliance = vectorOf(json.at("compliance_rad_per_nm"), joints);
  for (std::size_t j = 0; j < springs.identifiable.size(); ++j)
    springs.identifiable[j] = json.at("identifiable").at(j).get<bool>();
  springs.shared = vectorOf(json.at("shared_variance"), joints);
  springs.dof = vectorOf(json.at("degrees_of_freedom"), joints);
  for (const Json& one : json.at("influences")) springs.influences.push_back(vectorOf(one, joints));
  return springs;
}

/// What people and programs are told of a campaign.
Json toldJson(const CampaignResult& result) {
  Json json;
  json["name"] = result.name, json["date"] = result.date, json["robot"] = result.robot;
  json["kind"] = keyOf(result.kind), json["double_encoders"] = nameOf(result.encoders);
  json["audit"] = nameOf(result.audit);
  json["failed_checks"] = result.failed_checks, json["warned_checks"] = result.warned_checks;
  json["postures"] = result.postures;
  json["method"] = methodJson(result.method);
  json["stiffness_nm_per_rad"] = statedJson(result.stiffness);
  json["deflection_m"] = number(result.deflection);
  json["compensated"] = statedJson(result.compensated);
  json["nominal_rms_m"] = statedJson(result.nominal), json["calibrated_rms_m"] = statedJson(result.calibrated);
  json["gap_before_m"] = number(result.gap_before), json["gap_noise_m"] = number(result.gap_noise);
  json["gap_after_m"] = number(result.gap_after);
  json["diagnosed"] = result.diagnosed;
  json["effects"] = Json::array();
  for (const fleet::EffectFound& one : result.effects)
    json["effects"].push_back({{"effects", one.effects}, {"detail", one.detail}});
  return json;
}

}  // namespace

const char* keyOf(fleet::DayKind kind) {
  constexpr std::array kNames{"loaded", "unloaded", "sweeps"};
  return kNames[static_cast<std::size_t>(kind)];
}

const char* keyOf(fleet::NeedId id) {
  constexpr std::array kNames{"no_result",       "several_machines",   "audit_failed",    "changed",
                              "unknown_gap",     "audit_not_testable", "perhaps_changed", "dates_scatter",
                              "joint_imprecise", "audit_warned",       "nothing"};
  return kNames[static_cast<std::size_t>(id)];
}

Json keptJson(const CampaignResult& result) {
  Json json = toldJson(result);
  json["springs_method"] = methodJson(result.springs_method);
  json["springs"] = Json::array();
  for (const SpringsOfDay& one : result.springs) json["springs"].push_back(springsJson(one));
  json["own_weight"] = springsJson(result.own_weight);
  json["loaded_postures"] = Json::array();
  for (const fleet::LoadedPosture& one : result.loaded_postures)
    json["loaded_postures"].push_back({{"pose", one.pose}, {"q_rad", array(one.q)}, {"force_n", array(one.force)}});
  json["axes"] = Json::array();
  for (const metrology::Line& axis : result.axes)
    json["axes"].push_back({{"point_m", array(axis.point)}, {"direction", array(axis.direction)}});
  return json;
}

CampaignResult keptCampaign(const Json& json) {
  const int joints = jointsIn(json.at("stiffness_nm_per_rad"));
  CampaignResult result(joints);
  result.name = json.at("name"), result.date = json.at("date"), result.robot = json.at("robot");
  result.kind = valueNamed(kDayKinds, json.at("kind"), [](fleet::DayKind kind) { return keyOf(kind); });
  result.encoders = valueNamed(kEncoderStates, json.at("double_encoders"),
                               [](campaign::DoubleEncoder state) { return nameOf(state); });
  result.audit = valueNamed(kVerdicts, json.at("audit"), [](AuditVerdict verdict) { return nameOf(verdict); });
  json.at("failed_checks").get_to(result.failed_checks), json.at("warned_checks").get_to(result.warned_checks);
  result.postures = json.at("postures");
  result.method = methodOf(json.at("method"));
  readStated(json.at("stiffness_nm_per_rad"), result.stiffness);
  result.deflection = keptNumber(json.at("deflection_m"));
  result.compensated = stated(json.at("compensated"));
  result.nominal = stated(json.at("nominal_rms_m")), result.calibrated = stated(json.at("calibrated_rms_m"));
  result.gap_before = keptNumber(json.at("gap_before_m")), result.gap_noise = keptNumber(json.at("gap_noise_m"));
  result.gap_after = keptNumber(json.at("gap_after_m"));
  result.diagnosed = json.at("diagnosed");
  for (const Json& one : json.at("effects"))
    result.effects.push_back({one.at("effects").get<std::vector<std::string>>(), one.at("detail")});
  result.springs_method = methodOf(json.at("springs_method"));
  for (std::size_t m = 0; m < 3; ++m) result.springs[m] = springsOf(json.at("springs").at(m), joints);
  result.own_weight = springsOf(json.at("own_weight"), joints);
  for (const Json& one : json.at("loaded_postures")) {
    result.loaded_postures.push_back({one.at("pose"), vectorOf(one.at("q_rad"), joints), pointOf(one.at("force_n"))});
  }
  for (const Json& one : json.at("axes")) {
    if (result.axes.size() == result.axes.capacity())
      throw std::runtime_error("no result of a fleet's campaign: more axes than an arm has");
    result.axes.push_back({pointOf(one.at("point_m")), pointOf(one.at("direction"))});
  }
  return result;
}

Json keptJson(const PairResult& result) {
  return {{"reason", result.reason},
          {"same_postures", result.same_postures},
          {"postures", result.postures},
          {"machine_p", number(result.machine_p)},
          {"at_targets_m", number(result.at_targets)},
          {"at_targets_sd_m", number(result.at_targets_sd)},
          {"cause", result.cause}};
}

PairResult keptPair(const Json& json, int joints) {
  PairResult result(joints);
  result.kind = fleet::DayKind::unloaded;
  result.reason = json.at("reason"), result.same_postures = json.at("same_postures");
  result.postures = json.at("postures"), result.machine_p = keptNumber(json.at("machine_p"));
  result.at_targets = keptNumber(json.at("at_targets_m")),
  result.at_targets_sd = keptNumber(json.at("at_targets_sd_m"));
  result.cause = json.at("cause");
  return result;
}

std::string fleetJsonLines(const fleet::Fleet& fleet) {
  std::string lines;
  for (const fleet::FleetCampaign& one : fleet.campaigns) {
    Json json{{"machine", one.machine}, {"date", one.date}, {"folder", one.folder}};
    json["failure"] = one.result ? Json(nullptr) : Json(one.failure);
    if (!one.report.empty()) json["report"] = one.report;
    if (!one.report_failure.empty()) json["report_failure"] = one.report_failure;
    if (one.result) json.update(toldJson(*one.result));
    constexpr int kOneLine = -1;
    lines += json.dump(kOneLine, ' ', false, Json::error_handler_t::replace) + '\n';
  }
  return lines;
}

}  // namespace stiffscope::reports
