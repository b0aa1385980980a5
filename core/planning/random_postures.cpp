#include "core/planning/random_postures.h"

#include <algorithm>
#include <array>

namespace stiffscope::planning {

RandomPostures randomPostures(const DesignProblem& problem, int count, int sets, std::uint64_t seed) {
  RandomPostures result;
  std::array<std::vector<double>, 6> sds;
  double sum = 0.0;
  for (int set = 0; set < sets; ++set) {
    const auto chosen = randomDesign(problem, count, seed + static_cast<std::uint64_t>(set));
    result.postures = static_cast<int>(chosen.size());
    const Matrix6d information = informationOf(problem, chosen);
    sum += logDeterminant(information, problem.unknown);
    const Vector6d sd = standardDeviations(information, problem.unknown);
    for (std::size_t j = 0; j < 6; ++j) sds[j].push_back(sd[static_cast<Eigen::Index>(j)]);
  }
  if (sets < 1) return result;
  result.log_determinant = sum / sets;
  for (std::size_t j = 0; j < 6; ++j) {
    const auto middle = sds[j].begin() + static_cast<std::ptrdiff_t>(sds[j].size() / 2);
    if (problem.unknown[j]) std::nth_element(sds[j].begin(), middle, sds[j].end());
    result.sd[static_cast<Eigen::Index>(j)] = *middle;
  }
  return result;
}

}  // namespace stiffscope::planning
