#include "reports/json/preparation_json.h"

#include "core/input/units.h"

namespace stiffscope {

namespace {

Json driftJson(const DriftCorrection& drift) {
  if (!drift.taken_off) return {{"taken_off", false}, {"reason", drift.reason}};
  constexpr double kMicroradian = 1e-6;
  return {{"taken_off", true},
          {"largest_mm", drift.displacement / kMillimetre},
          {"largest_turn_urad", drift.turn / kMicroradian},
          {"until_s", drift.until_s},
          {"jumps_s", drift.jumps_s},
          {"readings", drift.readings},
          {"readings_without_time", drift.without_time}};
}

}  // namespace

Json rejectedJson(const std::vector<RejectedReading>& rejected) {
  Json list = Json::array();
  for (const RejectedReading& reading : rejected) {
    list.push_back({{"file", reading.file}, {"line", reading.line}, {"reason", reading.reason}});
  }
  return list;
}

Json preparationJson(const Preparation& preparation) {
  return {{"raw", preparation.raw},
          {"rejected", rejectedJson(preparation.rejected)},
          {"drift", driftJson(preparation.drift)}};
}

Json withPreparation(Json result, const Preparation& preparation) {
  result["preparation"] = preparationJson(preparation);
  return result;
}

}  // namespace stiffscope
