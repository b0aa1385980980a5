#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/io/units.h"
#include "reports/page/facts.h"
#include "reports/page/sections.h"
#include "reports/report_content.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

// The result of the days in one small table, for the first screen.

namespace stiffscope::page {

namespace {

/// Column heads for campaigns of a kind: their names, or `alone` where there is one.
std::vector<std::string> headsOf(const reports::ReportContent& content, const About& about, const std::string& alone) {
  if (content.campaigns.size() == 1) return {alone};
  const std::vector<std::string> names = columnNames(content);
  std::vector<std::string> heads;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (about(content.campaigns[i])) heads.push_back(names[i]);
  }
  return heads;
}

/// `alone`: the only day of its table, which has room for words.
std::string stiffnessWords(const reports::ReportCampaign& one, int joint, const reports::StiffnessUnit& unit,
                           bool alone) {
  const auto shown = reports::shownMethod(one.identification);
  if (!shown) return "–";
  const identification::StiffnessEstimate& estimate = one.identification.of(*shown).estimate;
  if (joint >= estimate.joints()) return "–";
  const auto at = static_cast<std::size_t>(joint);
  if (!estimate.identifiable[at])
    return alone ? reports::unseenWords(one.identification.identifiability.joints[at]) : "not seen";
  const std::string mark = reports::words(estimate.mark(joint));
  const std::string words = reports::uncertainStiffness(estimate, joint, unit.size);
  if (mark.empty()) return words;
  if (words.ends_with(')')) return fmt::format("{}; {})", words.substr(0, words.size() - 1), mark);
  return fmt::format("{} ({})", words, mark);
}

/// The effects in the model beside the joint springs, where all days have the same.
std::string modelOf(const reports::ReportContent& content) {
  std::optional<std::vector<effects::Effect>> all;
  for (const reports::ReportCampaign& one : content.campaigns) {
    if (!isLoaded(one)) continue;
    std::vector<effects::Effect> own;
    if (one.improved != nullptr) {
      for (const extended_model::AddedEffect& added : one.improved->effects.added) own.push_back(added.effect);
    }
    if (all && *all != own) return {};
    all = own;
  }
  if (!all || all->empty()) return {};
  return fmt::format(", {} in the model", reports::effectNames(*all, ", "));
}

void addStiffnesses(const reports::ReportContent& content, reports::Table& table) {
  std::vector<std::string> methods;
  for (const reports::ReportCampaign& one : content.campaigns) {
    const auto shown = reports::shownMethod(one.identification);
    if (!isLoaded(one) || !shown) continue;
    if (const std::string name = reports::longName(*shown);
        std::find(methods.begin(), methods.end(), name) == methods.end())
      methods.push_back(name);
  }
  if (methods.empty()) return;  // the verdict says why
  const bool one_method = methods.size() == 1;
  std::vector<double> stiffnesses;
  bool brackets = false;
  for (const reports::ReportCampaign& one : content.campaigns) {
    const auto shown = reports::shownMethod(one.identification);
    if (!isLoaded(one) || !shown) continue;
    const identification::StiffnessEstimate& estimate = one.identification.of(*shown).estimate;
    for (int joint = 0; joint < estimate.joints(); ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      stiffnesses.push_back(estimate.stiffness(joint));
      brackets = brackets || reports::farFromSymmetric(estimate, joint);
    }
  }
  const reports::StiffnessUnit unit = reports::stiffnessUnit(stiffnesses);
  table.caption = fmt::format("Joint stiffness k ± U{} (95 %), {}{}{}", brackets ? ", or its interval," : "", unit.name,
                              one_method ? ", by " + methods.front() : "", modelOf(content));
  table.columns = {"Joint"};
  for (const std::string& head : headsOf(content, isLoaded, "k ± U")) table.columns.push_back(head);
  if (methods.size() > 1) {
    std::size_t column = 1;
    for (const reports::ReportCampaign& one : content.campaigns) {
      const auto shown = reports::shownMethod(one.identification);
      if (isLoaded(one) && shown) table.columns[column] += " (" + reports::shortName(*shown) + ")";
      if (isLoaded(one)) ++column;
    }
  }
  const int joints = reports::mostJointsOf(reports::ofKind(content.campaigns, reports::DayKind::loaded));
  for (int joint = 0; joint < joints; ++joint) {
    reports::Row row{reports::jointName(joint)};
    for (const reports::ReportCampaign& one : content.campaigns) {
      if (isLoaded(one)) row.emplace_back(stiffnessWords(one, joint, unit, table.columns.size() == 2));
    }
    table.groups.front().rows.push_back(std::move(row));
  }
}

bool isUnloaded(const reports::ReportCampaign& one) { return one.accuracy != nullptr; }

void addErrors(const reports::ReportContent& content, reports::Table& table) {
  table.caption = "Position error in postures that took no part, mm";
  table.columns = {"Model"};
  const bool several = content.campaigns.size() > 1;
  for (const std::string& head : headsOf(content, isUnloaded, "")) {
    table.columns.push_back(several ? head + ": rms" : "rms");
    table.columns.push_back("largest");
  }
  using calibration::CalibratedModel;
  for (const CalibratedModel model : {CalibratedModel::nominal, CalibratedModel::geometry, CalibratedModel::effects}) {
    reports::Row row{reports::capitalised(reports::modelWords(model))};
    bool any = false;
    for (const reports::ReportCampaign& one : content.campaigns) {
      if (!isUnloaded(one)) continue;
      const auto& models = one.accuracy->calibration.models;
      const auto found =
          std::find_if(models.begin(), models.end(), [model](const auto& m) { return m.model == model; });
      any = any || found != models.end();
      const bool there = found != models.end() && found->held_out.readings > 0;
      const calibration::PositionErrors errors = there ? found->held_out : calibration::PositionErrors{};
      row.emplace_back(there ? reports::significant(errors.rms / io::kMillimetre, 3) : "–");
      row.emplace_back(there ? reports::significant(errors.largest / io::kMillimetre, 3) : "–");
    }
    if (any) table.groups.front().rows.push_back(std::move(row));
  }
}

void addDistances(const reports::ReportContent& content, reports::Table& table) {
  table.caption = "Distance of axes from the URDF's ± U, mm";
  table.columns = {"Axes"};
  for (const std::string& head : headsOf(content, isAny, "Difference")) table.columns.push_back(head);
  const auto links = static_cast<std::size_t>(reports::mostJointsOf(content.campaigns)) - 1;
  for (std::size_t i = 0; i < links; ++i) {
    reports::Row row{fmt::format("{} and {}", i + 1, i + 2)};
    bool any = false;
    for (const reports::ReportCampaign& one : content.campaigns) {
      if (i >= one.identification.frames.links.size()) {
        row.emplace_back("–");
        continue;
      }
      const frames::LinkGeometry& link = one.identification.frames.links[i];
      any = any || link.distance_sd.has_value();
      row.emplace_back(link.distance_sd
                           ? reports::withUncertainty((link.distance - link.nominal_distance) / io::kMillimetre,
                                                      reports::expanded(*link.distance_sd) / io::kMillimetre)
                           : "–");
    }
    if (any) table.groups.front().rows.push_back(std::move(row));
  }
}

}  // namespace

reports::Table resultTable(const reports::ReportContent& content) {
  reports::Table table;
  table.on_page_alone = true;
  table.groups.emplace_back();
  const bool loaded = reports::anyOfKind(content.campaigns, reports::DayKind::loaded);
  const bool unloaded = reports::anyOfKind(content.campaigns, reports::DayKind::unloaded);
  if (loaded)
    addStiffnesses(content, table);
  else if (unloaded)
    addErrors(content, table);
  else
    addDistances(content, table);
  return table;
}

}  // namespace stiffscope::page
