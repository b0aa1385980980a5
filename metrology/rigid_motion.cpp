#include "metrology/rigid_motion.h"

namespace stiffscope {

Eigen::Isometry3d motionAbout(const Eigen::Vector3d& centre, const Eigen::Matrix<double, 6, 1>& motion) {
  const Eigen::Vector3d turn = motion.head<3>();
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  if (turn.norm() > 0.0)
    result.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  result.translation() = centre + motion.tail<3>() - result.linear() * centre;
  return result;
}

std::vector<NestRound> nestRounds(const Nests& nests) {
  std::vector<const NestReading*> rows;
  for (const NestReading& row : nests.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const NestReading* a, const NestReading* b) { return a->time_s < b->time_s; });
  std::vector<NestRound> rounds;
  for (const NestReading* row : rows) {
    if (rounds.empty() || rounds.back().readings.contains(row->nest)) rounds.emplace_back();
    rounds.back().readings[row->nest] = row;
  }
  for (NestRound& round : rounds) {
    for (const auto& [nest, row] : round.readings) {
      round.time_s += row->time_s / static_cast<double>(round.readings.size());
    }
  }
  return rounds;
}

NestNetwork fitNestNetwork(const std::vector<NestRound>& rounds, const TrackerNoise& noise,
                           const Eigen::Vector3d& centre, int left_out) {
  NestNetwork network;
  const std::vector<NestRound> used = usable(rounds, left_out);
  if (used.size() < 2 || !start(used, centre, network)) return network;
  constexpr int kSteps =
      4;  // from a registration that is near the optimum already; the last gives chi2 there
  for (int step = 0; step < kSteps; ++step) improve(used, noise, centre, network);
  network.determined = true;
  return network;
}

}  // namespace stiffscope
