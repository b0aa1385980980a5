#include "core/audit/nest_network.h"

#include <Eigen/Dense>
#include <algorithm>

#include "metrology/rigid_registration.h"
#include "metrology/rigid_motion.h"

namespace stiffscope {

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

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

/// The normal equations of one Gauss-Newton step. A motion meets only its own round's places, so the motions go first,
/// each by itself, and the few places are what is left to solve together (Schur's complement): linear in the rounds.
struct RoundEquations {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_places;
};

class NetworkStep {
 public:
  NetworkStep(std::size_t rounds, std::size_t places)
      : size_(3 * static_cast<Eigen::Index>(places)), rounds_(rounds), normal_(Eigen::MatrixXd::Zero(size_, size_)),
        right_(Eigen::VectorXd::Zero(size_)) {
    for (RoundEquations& round : rounds_) round.by_places.setZero(6, size_);
  }

  /// One reading: residual = moved - place. The first round does not move.
  void add(std::size_t round, Eigen::Index place, const Eigen::Matrix<double, 3, 6>& by_motion,
           const Eigen::Matrix3d& weight, const Eigen::Vector3d& residual) {
    normal_.block<3, 3>(3 * place, 3 * place) += weight;
    right_.segment<3>(3 * place) += weight * residual;
    if (round == 0) return;
    RoundEquations& own = rounds_[round];
    own.normal += by_motion.transpose() * weight * by_motion;
    own.right -= by_motion.transpose() * weight * residual;
    own.by_places.middleCols<3>(3 * place) -= by_motion.transpose() * weight;
  }

  /// Moves the network; the covariance of a motion is N_e^-1 + B S^-1 B^T, B = N_e^-1 N_ep.
  void apply(NestNetwork& network) const {
    Eigen::MatrixXd left = normal_;
    Eigen::VectorXd right = right_;
    std::vector<Eigen::LDLT<Matrix6d>> own(rounds_.size());
    for (std::size_t e = 1; e < rounds_.size(); ++e) {
      own[e].compute(rounds_[e].normal);
      left -= rounds_[e].by_places.transpose() * own[e].solve(rounds_[e].by_places);
      right -= rounds_[e].by_places.transpose() * own[e].solve(rounds_[e].right);
    }
    const Eigen::MatrixXd covariance = left.ldlt().solve(Eigen::MatrixXd::Identity(size_, size_));
    const Eigen::VectorXd moved = covariance * right;
    for (std::size_t e = 1; e < rounds_.size(); ++e) {
      const Eigen::MatrixXd carried = own[e].solve(rounds_[e].by_places);
      network.epochs[e].motion += own[e].solve(rounds_[e].right) - carried * moved;
      network.epochs[e].covariance = own[e].solve(Matrix6d::Identity()) + carried * covariance * carried.transpose();
    }
    Eigen::Index at = 0;
    for (auto& [nest, place] : network.places) place += moved.segment<3>(at), at += 3;
  }

 private:
  Eigen::Index size_;
  std::vector<RoundEquations> rounds_;
  Eigen::MatrixXd normal_;  ///< of the places
  Eigen::VectorXd right_;
};

/// One step of Gauss-Newton; the covariance of the motions is that of the last.
void improve(const std::vector<NestRound>& rounds, const TrackerNoise& noise, const Eigen::Vector3d& centre,
             NestNetwork& network) {
  NetworkStep equations(rounds.size(), network.places.size());
  network.chi2 = 0.0;
  int coordinates = 0;
  for (std::size_t e = 0; e < rounds.size(); ++e) {
    const Eigen::Isometry3d first_from_now = motionAbout(centre, network.epochs[e].motion);
    const Eigen::Matrix3d turn = first_from_now.linear();
    for (const auto& [nest, reading] : rounds[e].readings) {
      const auto place = network.places.find(nest);
      const Eigen::Vector3d moved = first_from_now * reading->point;
      const Eigen::Vector3d residual = moved - place->second;
      const Eigen::Matrix3d weight = (turn * noise.covarianceAt(reading->point) * turn.transpose()).inverse();
      network.chi2 += residual.dot(weight * residual);
      coordinates += 3;
      Eigen::Matrix<double, 3, 6> by_motion;
      by_motion << -crossMatrix(moved - centre), Eigen::Matrix3d::Identity();
      equations.add(e, std::distance(network.places.begin(), place), by_motion, weight, residual);
    }
  }
  network.dof = coordinates - static_cast<int>(6 * (rounds.size() - 1) + 3 * network.places.size());
  equations.apply(network);
}

}  // namespace

}  // namespace stiffscope
