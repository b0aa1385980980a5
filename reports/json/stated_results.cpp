#include "reports/stated_results.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/effects/effect.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "reports/json/json_document.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"

namespace stiffscope::reports {

namespace {

double numberIn(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : kNotStated;
}

const Json* partOf(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? &*found : nullptr;
}

/// The parts of a campaign: of results.json as they are there, of another command's JSON the one that it is.
Json partsOf(const Json& json) {
  const auto has = [&json](const char* key) { return json.contains(key); };
  Json parts = Json::object();
  if (has("campaign") && has("classes"))
    parts[json.value("unloaded", false) ? "diagnosis" : "diagnose"] = json;
  else if (has("campaign") && has("checks"))
    parts["audit"] = json;
  else if (has("campaign") && has("folds"))
    parts["calibration"] = json;
  else if (has("campaign") && has("methods") && has("identifiability"))
    parts["identify"] = json;
  else if (has("campaign") && has("links"))
    parts["frames"] = json;
  return parts;
}

std::vector<std::optional<comparison::StatedCompliance>> compliancesOf(const Json& method) {
  const Json& values = method.at("compliance_rad_per_nm");
  std::vector<std::optional<comparison::StatedCompliance>> compliances(values.size());
  const Json& intervals = method.at("interval_compliance_rad_per_nm");
  for (std::size_t j = 0; j < compliances.size(); ++j) {
    if (!values.at(j).is_number() || !intervals.at(j).is_array()) continue;
    compliances[j] = {values[j], {intervals[j].at(0), intervals[j].at(1)}};
  }
  return compliances;
}

StatedPosture& postureNamed(const std::string& pose, StatedCampaign& campaign) {
  const auto found = std::find_if(campaign.postures.begin(), campaign.postures.end(),
                                  [&](const StatedPosture& one) { return one.pose == pose; });
  if (found != campaign.postures.end()) return *found;
  campaign.postures.push_back({});
  campaign.postures.back().pose = pose;
  return campaign.postures.back();
}

void addIdentification(const Json& json, StatedCampaign& campaign) {
  for (const identification::Method method : identification::kMethods) {
    const std::string key = namesOf(method).key;
    const auto found = json.at("methods").find(key);
    if (found == json.at("methods").end() || !found->contains("compliance_rad_per_nm")) continue;
    campaign.compliances[static_cast<std::size_t>(method)] = compliancesOf(*found);
    campaign.states_stiffness = true;
    if (const Json* shown = partOf(json, "shown_first"); shown != nullptr && shown->at("method") == key)
      campaign.shown_first = method;
  }
  for (const Json& row : json.at("per_posture")) {
    StatedPosture& posture = postureNamed(row.at("pose"), campaign);
    posture.wrist.deflection_mm = numberIn(row, "wrist_mm");
    posture.targets.deflection_mm = numberIn(row, "targets_mean_mm");
    for (const identification::Method method : identification::kMethods) {
      const std::size_t m = static_cast<std::size_t>(method);
      const std::string key = namesOf(method).key;
      posture.wrist.residual_mm[m] = numberIn(row, ("wrist_after_" + key + "_mm").c_str());
      posture.targets.residual_mm[m] = numberIn(row, ("targets_mean_after_" + key + "_mm").c_str());
    }
  }
}

void addAngles(const Json& workspace, StatedCampaign& campaign) {
  for (const Json& row : workspace.at("postures"))
    postureNamed(row.at("pose"), campaign).q_deg = row.at("q_deg").get<std::vector<double>>();
}

std::optional<comparison::Uncertain> measuredIn(const Json& link, const char* value, const char* sd) {
  const double number = numberIn(link, value), u = numberIn(link, sd);
  if (!std::isfinite(number) || !std::isfinite(u) || link.value("from", std::string()) != "sweeps") return {};
  return comparison::Uncertain{number, u, 1e6};
}

void addLinks(const Json& frames, StatedCampaign& campaign) {
  for (const Json& link : frames.at("links")) {
    StatedLink stated;
    stated.axis = link.at("between_axes").at(0);
    stated.nominal_mm = numberIn(link, "nominal_length_mm"), stated.nominal_deg = numberIn(link, "nominal_angle_deg");
    stated.length_mm = measuredIn(link, "length_mm", "sd_length_mm");
    stated.angle_deg = measuredIn(link, "angle_deg", "sd_angle_deg");
    campaign.links.push_back(std::move(stated));
  }
}

StatedAudit auditOf(const Json& json) {
  StatedAudit audit{json.at("verdict"), json.at("purpose"), {}, {}};
  for (const Json& check : json.at("checks")) {
    const std::string verdict = check.at("verdict"), id = check.at("id");
    if (verdict != "fail" && verdict != "warn") continue;
    std::vector<std::string>& ids = verdict == "fail" ? audit.failed : audit.warned;
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);  // a check may have several rows
  }
  return audit;
}

std::string effectWords(const std::string& id) {
  const auto effect = effects::effectOf(id);
  if (effect) return effectName(*effect);
  std::string words = id;  // of a day without a load
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

void addDiagnosis(const Json& json, bool unloaded, StatedCampaign& campaign) {
  StatedDiagnosis diagnosis;
  diagnosis.usable = json.at("usable"), diagnosis.unloaded = unloaded;
  const Json& groups = json.at("verdict");
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::string group;
    for (const Json& id : groups[i]) group += (group.empty() ? "" : " or ") + effectWords(id);
    const std::string detail = json.at("verdict_details").at(i);
    diagnosis.verdict += (i == 0 ? "" : "; ") + group + (detail.empty() ? "" : " (" + detail + ")");
  }
  if (const Json* gap = partOf(json, "gap")) {
    diagnosis.gap_um = numberIn(*gap, "before_um"), diagnosis.after_um = numberIn(*gap, "after_um");
    diagnosis.noise_um = numberIn(*gap, "noise_um");
  }
  const auto add = [&](const char* table, double StatedPosture::*member) {
    const Json* where = partOf(json, table);
    if (where == nullptr || !where->contains("posture")) return;
    for (const Json& row : where->at("posture"))
      postureNamed(row.at("name"), campaign).*member = numberIn(row, "rms_um");
  };
  add("where", &StatedPosture::gap_um);
  add("where_after", &StatedPosture::gap_after_um);
  campaign.diagnosis = std::move(diagnosis);
}

void addCampaignFacts(const Json& json, StatedCampaign& campaign) {
  campaign.name = json.at("name"), campaign.date = json.at("date"), campaign.robot = json.at("robot");
  campaign.serial = json.value("robot_serial", std::string());
  campaign.double_encoder = json.at("double_encoder");
  for (const Json& input : json.at("inputs")) {
    const std::string file = input.at("file");
    if (file.ends_with(".urdf")) campaign.urdf_sha256 = input.at("sha256");
  }
}

/// The file's name, and the campaign that is named behind '#', from 1; 0: none is.
std::pair<std::string, std::size_t> fileAndNumber(const std::string& named) {
  const std::size_t at = named.rfind('#');
  if (at == std::string::npos || named.ends_with(".json")) return {named, 0};
  const auto number = io::parseInteger(named.substr(at + 1));
  if (!number || *number < 1)
    throw io::InputError({named.substr(0, at)}, named.substr(at), "expected # and the number of a campaign, from 1");
  return {named.substr(0, at), static_cast<std::size_t>(*number)};
}

constexpr const char* kExpected =
    "expected results.json of `report`, or what audit, frames, identify, calibrate or diagnose wrote by --json";

/// The parts of the campaign that is meant.
Json chosenCampaign(const Json& json, const std::string& file, std::size_t number) {
  const auto list = json.is_object() ? json.find("campaigns") : json.end();
  if (list == json.end() || !list->is_array()) {
    const Json parts = json.is_object() ? partsOf(json) : Json::object();
    if (parts.empty()) throw io::InputError({file}, "", kExpected);
    if (number > 1)
      throw io::InputError({file}, fmt::format("#{}", number), "expected no more than #1: it is one result");
    return parts;
  }
  if (list->empty()) throw io::InputError({file}, "", "expected a campaign in it");
  if (number == 0 && list->size() > 1)
    throw io::InputError({file}, "",
                         fmt::format("expected which of its {} campaigns is meant, such as {}#1", list->size(), file));
  if (number > list->size())
    throw io::InputError({file}, fmt::format("#{}", number), fmt::format("expected #1 to #{}", list->size()));
  return list->at(number == 0 ? 0 : number - 1);
}

}  // namespace

bool namesResults(const std::string& named) {
  const std::string file = named.substr(0, named.rfind('#'));
  std::error_code none;
  return (named.ends_with(".json") && !std::filesystem::is_directory(named, none)) ||
         (file.ends_with(".json") && !std::filesystem::is_directory(file, none));
}

StatedCampaign readStatedCampaign(const std::string& named) {
  const auto [file, number] = fileAndNumber(named);
  const io::TextFile text = io::readTextFileWithStamp(file);
  StatedCampaign campaign;
  campaign.file = named;
  try {
    const Json parts = chosenCampaign(Json::parse(text.text()), file, number);
    for (const auto& [key, part] : parts.items()) {
      if (!part.is_object() || !part.contains("campaign")) continue;
      addCampaignFacts(part.at("campaign"), campaign);
      break;
    }
    if (const Json* part = partOf(parts, "identify")) addIdentification(*part, campaign);
    if (const Json* part = partOf(parts, "stiffness")) addAngles(*part, campaign);
    if (const Json* part = partOf(parts, "frames")) addLinks(*part, campaign);
    if (const Json* part = partOf(parts, "audit")) campaign.audit = auditOf(*part);
    if (const Json* part = partOf(parts, "diagnose")) addDiagnosis(*part, false, campaign);
    if (const Json* part = partOf(parts, "diagnosis")) addDiagnosis(*part, true, campaign);
    if (const Json* part = partOf(parts, "calibration")) {
      for (const Json& model : part->at("models"))
        campaign.accuracy.push_back(
            {model.at("model"), numberIn(model, "held_out_mm"), numberIn(model, "held_out_max_mm")});
    }
  } catch (const Json::exception& error) {
    throw io::InputError({file}, "", std::string(kExpected) + "; " + error.what());
  }
  return campaign;
}

}  // namespace stiffscope::reports
