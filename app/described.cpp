#include "app/described.h"

namespace stiffscope {

Campaign described(const Campaign& campaign) {
  Campaign words;
  words.name = campaign.name;
  words.date = campaign.date;
  words.robot = campaign.robot;
  words.double_encoder = campaign.double_encoder;
  words.inputs = campaign.inputs;
  return words;
}

}  // namespace stiffscope
