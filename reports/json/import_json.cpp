#include <cmath>

#include "reports/json/interchange_json.h"
#include "reports/words/interchange_words.h"

namespace stiffscope::reports {

namespace {

constexpr double kMillimetres = 1e3, kMicrometres = 1e6;

Json statedNumber(const std::optional<double>& value, double factor = 1.0) {
  return value ? number(*value * factor) : Json(nullptr);
}

Json fileJson(const interchange::ImportedFile& file) {
  Json json{{"name", file.name}, {"role", file.role}};
  if (!file.format.empty()) json["format"] = file.format;
  if (!file.encoding.empty()) json["encoding"] = file.encoding;
  json["sha256"] = file.sha256;
  return json;
}

Json clockJson(const interchange::ClockReport& clock) {
  return {{"log", clock.log},
          {"offset_s", number(clock.offset_s)},
          {"uncertainty_s", clock.stated ? Json(nullptr) : number(clock.uncertainty_s)},
          {"stated", clock.stated},
          {"readings", clock.readings},
          {"inside", clock.inside},
          {"standstills", clock.standstills},
          {"misfit_mm", statedNumber(clock.misfit, kMillimetres)}};
}

JsonRows originRows(const std::vector<interchange::RowOrigin>& rows) {
  return {rows.size(), [&rows](std::size_t i) {
            Json origin{{"file", rows[i].file}, {"line", rows[i].line}};
            if (rows[i].last_line != rows[i].line) origin["last_line"] = rows[i].last_line;
            return origin;
          }};
}

}  // namespace

JsonDocument importJson(const interchange::ImportedDay& day) {
  JsonDocument document(Json{{"import", 1},
                             {"start", day.start.empty() ? Json(nullptr) : Json(day.start)},
                             {"files", Json::array()},
                             {"clocks", Json::array()},
                             {"misfit_mm", Json::object()}});
  Json& json = document.json;
  for (const auto& file : day.files) json["files"].push_back(fileJson(file));
  for (const auto& clock : day.clocks) json["clocks"].push_back(clockJson(clock));
  for (const auto& [table, misfit] : day.misfit) json["misfit_mm"][table] = number(kMillimetres * misfit);
  json["stated_sigma_um"] = statedNumber(day.stated_sigma, kMicrometres);
  json["stated_over_declared"] = statedNumber(day.stated_over_declared);
  JsonDocument tables(Json::object());
  for (const auto& [table, rows] : day.rows) tables.setRows(table, originRows(rows));
  document.set(Json::json_pointer("/rows"), std::move(tables));
  if (!day.wrenches.empty()) document.setRows("wrenches", originRows(day.wrenches));
  document.setRows(
      "skipped",
      {day.skipped.size(), [&day](std::size_t i) {
         const interchange::SkippedOrigin& skipped = day.skipped[i];
         return Json{{"file", skipped.file}, {"line", skipped.row.line}, {"reason", skipWords(skipped.row.reason)}};
       }});
  document.json["warnings"] = day.warnings;
  return document;
}

}  // namespace stiffscope::reports
