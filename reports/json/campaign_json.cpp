#include "reports/json/campaign_json.h"

namespace stiffscope {

const char* nameOf(DoubleEncoder state) {
  switch (state) {
    case DoubleEncoder::active:
      return "active";
    case DoubleEncoder::inactive:
      return "inactive";
    case DoubleEncoder::unspecified:
      break;
  }
  return "unspecified";
}

Json campaignJson(const Campaign& campaign) {
  Json inputs = Json::array();
  for (const InputFile& input : campaign.inputs) inputs.push_back({{"file", input.name}, {"sha256", input.sha256}});
  return {{"name", campaign.name},
          {"date", campaign.date},
          {"robot", campaign.robot.name},
          {"double_encoder", nameOf(campaign.double_encoder)},
          {"inputs", inputs}};
}

}  // namespace stiffscope
