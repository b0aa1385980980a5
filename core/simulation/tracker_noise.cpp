#include "core/simulation/tracker_noise.h"

#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

namespace {

template <class Row>
void addToTable(const Tracker& tracker, double factor, RandomStream random,
                std::optional<Table<Row>>& table) {
  if (!table) return;
  for (Row& row : table->rows) row.point += trackerError(tracker, factor, row.point, random);
}

}  // namespace

Eigen::Vector3d trackerError(const Tracker& tracker, double factor, const Eigen::Vector3d& point,
                             RandomStream& random) {
  const Eigen::Vector3d sight = point - tracker.station;
  const double distance = sight.norm();
  const Eigen::Matrix3d axes = frameAlong(tracker.station, sight).linear();  // z along the line of sight
  const double along = tracker.range_fixed + tracker.range_per_m * distance;
  const double across = tracker.angle_fixed + tracker.angle_per_m * distance;
  const Eigen::Vector3d draw = random.normal3();
  return factor * (axes.col(2) * (along * draw[0]) + axes.col(0) * (across * draw[1]) +
                   axes.col(1) * (across * draw[2]));
}

void addTrackerNoise(double factor, std::uint64_t noise_seed, Campaign& campaign) {
  const Tracker& tracker = campaign.tracker.value();
  addToTable(tracker, factor, {noise_seed, "tracker sweeps"}, campaign.circle_sweeps);
  addToTable(tracker, factor, {noise_seed, "tracker wrist"}, campaign.wrist_sweep);
  addToTable(tracker, factor, {noise_seed, "tracker loading"}, campaign.loading);
  addToTable(tracker, factor, {noise_seed, "tracker nests"}, campaign.nests);
}

}  // namespace stiffscope::simulation
