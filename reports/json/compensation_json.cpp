#include "reports/json/compensation_json.h"

#include "core/input/units.h"
#include "reports/method_names.h"

namespace stiffscope {

Json compensationJson(const Campaign& campaign, Method method, const std::vector<CompensatedPosture>& postures) {
  Json rows = Json::array();
  for (const CompensatedPosture& posture : postures) {
    Json row{{"pose", posture.posture.id},
             {"q_deg", array(posture.posture.q, 1.0 / kDegree)},
             {"tcp_deflection_mm", array(posture.deflection, 1.0 / kMillimetre)},
             {"sd_tcp_deflection_mm", array(posture.deflection_sd, 1.0 / kMillimetre)},
             {"flange_rotation_deg", array(posture.rotation, 1.0 / kDegree)},
             {"conditioning", posture.conditioning}};
    if (posture.solved) {
      row["command_deg"] = array(posture.commands, 1.0 / kDegree);
      row["change_deg"] = array(Vector6d(posture.commands - posture.posture.q), 1.0 / kDegree);
      row["remaining_mm"] = posture.remaining / kMillimetre;
    } else {
      row["command_deg"] = nullptr;
      row["refused"] = posture.reason;
    }
    rows.push_back(row);
  }
  return {{"campaign", campaignJson(campaign)}, {"method", namesOf(method).key}, {"frame", "r0"}, {"rows", rows}};
}

}  // namespace stiffscope
