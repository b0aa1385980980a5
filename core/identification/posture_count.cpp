#include "core/identification/posture_count.h"

#include <set>

namespace stiffscope {

std::size_t postureCount(const Identification& result) {
  std::set<int> poses;
  for (const LoadCase& one : result.cases) poses.insert(one.pose);
  return poses.size();
}

}  // namespace stiffscope
