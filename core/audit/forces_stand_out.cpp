#include "core/audit/forces_stand_out.h"

#include <algorithm>
#include <limits>
#include <map>

namespace stiffscope {

bool forcesStandOut(const Campaign& campaign) {
  if (!campaign.states) return false;
  struct Sum {
    double squares = 0.0, count = 0.0;
  };
  std::map<int, Sum> by_step;
  for (const State& row : campaign.states->rows) {
    Sum& sum = by_step[row.step];
    sum.squares += row.wrench_in_cell.head<3>().squaredNorm();
    sum.count += 1.0;
  }
  double least = std::numeric_limits<double>::infinity(), most = 0.0;  // N^2
  for (const auto& [step, sum] : by_step) {
    least = std::min(least, sum.squares / sum.count);
    most = std::max(most, sum.squares / sum.count);
  }
  constexpr double kStandsOut = 3.0;
  return by_step.size() == 1 || most > kStandsOut * kStandsOut * least;
}

}  // namespace stiffscope
