#include "core/audit/nest_network.h"

#include <Eigen/Dense>
#include <algorithm>

#include "metrology/rigid_registration.h"

namespace stiffscope {

namespace {

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

std::vector<NestRound> usable(const std::vector<NestRound>& rounds, int left_out) {
  std::vector<NestRound> result = rounds;
  for (NestRound& round : result) round.readings.erase(left_out);
  std::erase_if(result, [](const NestRound& round) { return round.readings.size() < 3; });
  return result;
}

/// Starts at the rigid registration of each round onto the first.
bool start(const std::vector<NestRound>& rounds, const Eigen::Vector3d& centre, NestNetwork& network) {
  for (const auto& [nest, reading] : rounds.front().readings) network.places[nest] = reading->point;
  for (const NestRound& round : rounds) {
    std::vector<Eigen::Vector3d> now, first;
    for (const auto& [nest, reading] : round.readings) {
      const auto known = network.places.find(nest);
      if (known == network.places.end()) continue;
      now.push_back(reading->point);
      first.push_back(known->second);
    }
    const RigidRegistration fit = registerRigid(now, first);
    if (!fit.determined) return false;
    StationEpoch epoch;
    epoch.time_s = round.time_s;
    const Eigen::AngleAxisd turn(fit.to_from_source.linear());
    epoch.motion << turn.angle() * turn.axis(), fit.to_from_source * centre - centre;
    network.epochs.push_back(epoch);
    for (const auto& [nest, reading] : round.readings) {
      network.places.try_emplace(nest, fit.to_from_source * reading->point);
    }
  }
  network.epochs.front().motion.setZero();
  return true;
}

/// One step of Gauss-Newton; the covariance of the motions is that of the last.
void improve(const std::vector<NestRound>& rounds, const TrackerNoise& noise, const Eigen::Vector3d& centre,
             NestNetwork& network) {
  const auto motions = static_cast<Eigen::Index>(6 * (rounds.size() - 1));
  const Eigen::Index size = motions + 3 * static_cast<Eigen::Index>(network.places.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  network.chi2 = 0.0;
  int coordinates = 0;
  for (std::size_t e = 0; e < rounds.size(); ++e) {
    const Eigen::Isometry3d first_from_now = motionAbout(centre, network.epochs[e].motion);
    const Eigen::Index at_motion = 6 * (static_cast<Eigen::Index>(e) - 1);
    for (const auto& [nest, reading] : rounds[e].readings) {
      const auto place = network.places.find(nest);
      const Eigen::Index at_place = motions + 3 * std::distance(network.places.begin(), place);
      const Eigen::Vector3d moved = first_from_now * reading->point;
      const Eigen::Vector3d residual = moved - place->second;
      const Eigen::Matrix3d turn = first_from_now.linear();
      const Eigen::Matrix3d weight = (turn * noise.covarianceAt(reading->point) * turn.transpose()).inverse();
      network.chi2 += residual.dot(weight * residual);
      coordinates += 3;
      Eigen::Matrix<double, 3, 6> by_motion;
      by_motion << -crossMatrix(moved - centre), Eigen::Matrix3d::Identity();
      normal.block<3, 3>(at_place, at_place) += weight;
      right.segment<3>(at_place) += weight * residual;
      if (e == 0) continue;
      normal.block<6, 6>(at_motion, at_motion) += by_motion.transpose() * weight * by_motion;
      normal.block<6, 3>(at_motion, at_place) -= by_motion.transpose() * weight;
      normal.block<3, 6>(at_place, at_motion) -= weight * by_motion;
      right.segment<6>(at_motion) -= by_motion.transpose() * weight * residual;
    }
  }
  network.dof = coordinates - static_cast<int>(size);
  const Eigen::MatrixXd covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::VectorXd step = covariance * right;
  for (std::size_t e = 1; e < rounds.size(); ++e) {
    const Eigen::Index at = 6 * (static_cast<Eigen::Index>(e) - 1);
    network.epochs[e].motion += step.segment<6>(at);
    network.epochs[e].covariance = covariance.block<6, 6>(at, at);
  }
  Eigen::Index at = motions;
  for (auto& [nest, place] : network.places) place += step.segment<3>(at), at += 3;
}

}  // namespace

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
