#include "core/audit/forces_stand_out.h"

#include <algorithm>

namespace stiffscope {

bool forcesStandOut(const Campaign& campaign) {
  if (!campaign.states || !campaign.load_cell) return false;
  constexpr double kStandsOut = 10.0;
  const double limit = kStandsOut * campaign.load_cell->force_sigma;
  return std::any_of(campaign.states->rows.begin(), campaign.states->rows.end(),
                     [&](const State& row) { return row.wrench_in_cell.head<3>().norm() > limit; });
}

}  // namespace stiffscope
