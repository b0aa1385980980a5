#include "core/diagnosis/evenly_spread.h"

#include "core/identification/without_postures.h"

namespace stiffscope {

Campaign evenlySpread(const Campaign& campaign, std::size_t most) {
  Campaign kept = campaign;
  const std::size_t postures = campaign.pose_ids.size();
  if (postures <= most) return kept;
  std::vector<bool> dropped(postures, true);
  for (std::size_t k = 0; k < most; ++k) dropped[k * postures / most] = false;
  dropPostures(dropped, kept);
  return Campaign(kept);  // a copy takes the room of what is left, not of what was there
}

}  // namespace stiffscope
