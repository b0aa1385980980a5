#include "core/identification/posture_count.h"

#include <algorithm>
#include <vector>

namespace stiffscope {

std::size_t postureCount(const Identification& result) {
  std::vector<int> poses;
  poses.reserve(result.cases.size());
  for (const LoadCase& one : result.cases) poses.push_back(one.pose);
  std::sort(poses.begin(), poses.end());
  return static_cast<std::size_t>(std::unique(poses.begin(), poses.end()) - poses.begin());
}

}  // namespace stiffscope
