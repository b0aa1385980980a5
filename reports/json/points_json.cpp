#include "reports/json/interchange_json.h"
#include "reports/words/interchange_words.h"

namespace stiffscope::reports {

namespace {

Json nameJson(const std::string& name) { return name.empty() ? Json(nullptr) : Json(name); }

Json timeJson(const std::optional<interchange::Timestamp>& time) {
  if (!time) return nullptr;
  return time->dated ? Json(isoTime(*time)) : number(time->seconds);
}

Json pointJson(const interchange::PointReading& point) {
  return {{"collection", nameJson(point.collection())},
          {"group", nameJson(point.group())},
          {"name", nameJson(point.name)},
          {"occurrence", point.occurrence},
          {"xyz_m", array(point.point)},
          {"u_m", point.sigma ? array(*point.sigma) : Json(nullptr)},
          {"time", timeJson(point.time)},
          {"line", point.line}};
}

}  // namespace

JsonDocument pointsJson(const interchange::PointFile& file) {
  JsonDocument json(Json{{"format", interchange::nameOf(file.format)},
                         {"encoding", interchange::nameOf(file.encoding)},
                         {"frame", nameJson(file.frame)}});
  json.setRows("points", {file.points.size(), [&file](std::size_t i) { return pointJson(file.points[i]); }});
  json.setRows("skipped", {file.skipped.size(), [&file](std::size_t i) {
                             const interchange::SkippedRow& row = file.skipped[i];
                             return Json{{"line", row.line}, {"reason", skipWords(row.reason)}};
                           }});
  return json;
}

JsonDocument pointsJson(const std::vector<NamedPoints>& files) {
  if (files.size() == 1) return pointsJson(files.front().points);
  JsonDocument json(Json{{"files", Json::array()}});
  for (std::size_t i = 0; i < files.size(); ++i) {
    json.json["files"].push_back(nullptr);
    JsonDocument one = pointsJson(files[i].points);
    one.json["file"] = files[i].file;
    json.set(Json::json_pointer("/files") / i, std::move(one));
  }
  return json;
}

}  // namespace stiffscope::reports
