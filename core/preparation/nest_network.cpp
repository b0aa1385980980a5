#include "core/preparation/nest_network.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "metrology/linear_algebra.h"
#include "metrology/registration.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::preparation {

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The rounds of three nests or more, `left_out` taken out, with their nests in the order of their indices.
std::vector<NestSet> usable(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise, int left_out) {
  std::vector<NestSet> sets;
  for (const NestRound& round : rounds) {
    NestSet set{round.time_s, {}, noise};
    for (const auto& [nest, reading] : round.readings) {
      if (nest != left_out) set.readings.push_back(reading);
    }
    if (set.readings.size() < 3) continue;
    set.noise = noise.seenFrom(set.readings.front()->from);
    sets.push_back(std::move(set));
  }
  return sets;
}

/// Starts at the rigid registration of each set onto the first.
bool start(const std::vector<NestSet>& sets, const Eigen::Vector3d& centre, NestNetwork& network) {
  for (const campaign::NestReading* reading : sets.front().readings)
    network.places.try_emplace(reading->nest, reading->point);
  for (const NestSet& set : sets) {
    std::vector<Eigen::Vector3d> now, first;
    for (const campaign::NestReading* reading : set.readings) {
      const auto known = network.places.find(reading->nest);
      if (known == network.places.end()) continue;
      now.push_back(reading->point);
      first.push_back(known->second);
    }
    const metrology::RigidRegistration fit = metrology::registerRigid(now, first);
    if (!fit.determined) return false;
    StationEpoch epoch;
    epoch.time_s = set.time_s;
    const Eigen::AngleAxisd turn(fit.to_from_source.linear());
    epoch.motion << turn.angle() * turn.axis(), fit.to_from_source * centre - centre;
    network.epochs.push_back(epoch);
    for (const campaign::NestReading* reading : set.readings)
      network.places.try_emplace(reading->nest, fit.to_from_source * reading->point);
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
      : size_(3 * static_cast<Eigen::Index>(places)),
        rounds_(rounds),
        normal_(Eigen::MatrixXd::Zero(size_, size_)),
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
  void apply(NestNetwork& network) {
    Eigen::MatrixXd left = normal_;
    Eigen::VectorXd right = right_;
    // Of each round N_e^-1 of [N_ep, right, I].
    std::vector<Eigen::MatrixXd> own(rounds_.size());
    for (std::size_t e = 1; e < rounds_.size(); ++e) {
      Eigen::MatrixXd columns(6, size_ + 7);
      columns << rounds_[e].by_places, rounds_[e].right, Matrix6d::Identity();
      own[e] = solveSymmetric(rounds_[e].normal, columns);
      left -= rounds_[e].by_places.transpose() * own[e].leftCols(size_);
      right -= rounds_[e].by_places.transpose() * own[e].col(size_);
    }
    of_places_ = solveSymmetric(left, Eigen::MatrixXd::Identity(size_, size_));
    const Eigen::VectorXd moved = of_places_ * right;
    carried_.assign(rounds_.size(), Eigen::MatrixXd::Zero(6, size_));
    for (std::size_t e = 1; e < rounds_.size(); ++e) {
      carried_[e] = own[e].leftCols(size_);
      network.epochs[e].motion += own[e].col(size_) - carried_[e] * moved;
      network.epochs[e].covariance = own[e].rightCols(6) + carried_[e] * of_places_ * carried_[e].transpose();
    }
    Eigen::Index at = 0;
    for (auto& [nest, place] : network.places) place += moved.segment<3>(at), at += 3;
  }

  /// Covariance of moved - place as fitted, once applied; what the readings' own noise leaves of it is the residual's.
  Eigen::Matrix3d fitted(const NestNetwork& network, std::size_t round, Eigen::Index place,
                         const Eigen::Matrix<double, 3, 6>& by_motion) const {
    const Eigen::Matrix<double, 6, 3> with_place = -carried_[round] * of_places_.middleCols<3>(3 * place);
    const Eigen::Matrix3d crossed = by_motion * with_place;
    return by_motion * network.epochs[round].covariance * by_motion.transpose() - crossed - crossed.transpose() +
           of_places_.block<3, 3>(3 * place, 3 * place);
  }

 private:
  Eigen::Index size_;
  std::vector<RoundEquations> rounds_;
  Eigen::MatrixXd normal_;  ///< of the places
  Eigen::VectorXd right_;
  Eigen::MatrixXd of_places_;             ///< their covariance
  std::vector<Eigen::MatrixXd> carried_;  ///< B of each round
};

/// A reading brought onto the first round against its nest's place, and what that hangs on.
struct NestEquation {
  std::size_t round = 0;
  Eigen::Index place = 0;  ///< index into the places
  const campaign::NestReading* reading = nullptr;
  Eigen::Vector3d residual;
  Eigen::Matrix3d covariance;  ///< of the reading, turned with it
  Eigen::Matrix<double, 3, 6> by_motion;
};

std::vector<NestEquation> equationsOf(const std::vector<NestSet>& sets, const Eigen::Vector3d& centre,
                                      const NestNetwork& network) {
  std::vector<NestEquation> equations;
  for (std::size_t e = 0; e < sets.size(); ++e) {
    const Eigen::Isometry3d first_from_now = metrology::motionAbout(centre, network.epochs[e].motion);
    const Eigen::Matrix3d turn = first_from_now.linear();
    for (const campaign::NestReading* reading : sets[e].readings) {
      const auto place = network.places.find(reading->nest);
      const Eigen::Vector3d moved = first_from_now * reading->point;
      NestEquation& one = equations.emplace_back();
      one.round = e;
      one.place = std::distance(network.places.begin(), place);
      one.reading = reading;
      one.residual = moved - place->second;
      one.covariance = turn * sets[e].noise.covarianceAt(reading->point) * turn.transpose();
      one.by_motion << -metrology::crossMatrix(moved - centre), Eigen::Matrix3d::Identity();
    }
  }
  return equations;
}

/// One step of Gauss-Newton; the covariance of the motions and of the residuals is that of the last.
void improve(const std::vector<NestSet>& sets, const Eigen::Vector3d& centre, bool last, NestNetwork& network) {
  const std::vector<NestEquation> equations = equationsOf(sets, centre, network);
  NetworkStep step(sets.size(), network.places.size());
  network.chi2 = 0.0;
  for (const NestEquation& one : equations) {
    const Eigen::Matrix3d weight = one.covariance.inverse();
    const double chi2 = one.residual.dot(weight * one.residual);
    network.chi2 += chi2;
    step.add(one.round, one.place, one.by_motion, weight, one.residual);
    if (last) network.residuals.push_back({one.reading, one.round, one.residual, one.covariance, chi2});
  }
  network.dof = 3 * static_cast<int>(equations.size()) - 6 * static_cast<int>(sets.size() - 1) -
                3 * static_cast<int>(network.places.size());
  step.apply(network);
  for (std::size_t i = 0; i < network.residuals.size(); ++i) {
    const NestEquation& one = equations[i];
    network.residuals[i].covariance -= step.fitted(network, one.round, one.place, one.by_motion);
  }
}

}  // namespace

std::vector<NestRound> nestRounds(const campaign::Nests& nests) {
  std::vector<const campaign::NestReading*> rows;
  for (const campaign::NestReading& row : nests.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(), [](const campaign::NestReading* a, const campaign::NestReading* b) {
    return a->time_s < b->time_s;
  });
  std::vector<NestRound> rounds;
  std::map<int, std::size_t> latest;  // of each station: two trackers may read at the same time
  for (const campaign::NestReading* row : rows) {
    const auto [place, first] = latest.try_emplace(row->station, rounds.size());
    if (first || rounds[place->second].readings.contains(row->nest))
      place->second = rounds.size(), rounds.emplace_back();
    rounds[place->second].readings[row->nest] = row;
  }
  for (NestRound& round : rounds) {
    for (const auto& [nest, row] : round.readings) {
      round.time_s += row->time_s / static_cast<double>(round.readings.size());
    }
  }
  if (latest.size() > 1) {
    std::stable_sort(rounds.begin(), rounds.end(),
                     [](const NestRound& a, const NestRound& b) { return a.time_s < b.time_s; });
  }
  return rounds;
}

NestNetwork fitNestNetwork(const std::vector<NestSet>& sets, const Eigen::Vector3d& centre) {
  NestNetwork network;
  if (sets.size() < 2 || !start(sets, centre, network)) return network;
  constexpr int kSteps = 4;  // from a registration that is near the optimum already; the last gives chi2 there
  for (int step = 0; step < kSteps; ++step) improve(sets, centre, step + 1 == kSteps, network);
  network.determined = true;
  return network;
}

NestNetwork fitNestNetwork(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise,
                           const Eigen::Vector3d& centre, int left_out) {
  return fitNestNetwork(usable(rounds, noise, left_out), centre);
}

Eigen::Vector3d whereTheArmWasRead(const campaign::Campaign& campaign) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  const auto add = [&](const auto& table) {
    for (const auto& row : table.rows) sum += row.point, count += 1.0;
  };
  if (campaign.loading) {
    add(*campaign.loading);
  } else if (campaign.circle_sweeps) {
    add(*campaign.circle_sweeps);
  } else {
    add(*campaign.nests);
  }
  return count > 0.0 ? Eigen::Vector3d(sum / count) : sum;
}

}  // namespace stiffscope::preparation
