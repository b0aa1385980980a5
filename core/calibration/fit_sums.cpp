#include "core/calibration/fitted_day.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/parallel.h"

namespace stiffscope::calibration {

/// Of some postures. A reading has no derivative by where the other reflectors stand: sums are kept reflector by
/// reflector, by what all have in common, the reflector's own place and the residual.
struct FitSums::Block {
  std::vector<Eigen::MatrixXd> normals;
  FitSum plain;

  Block& operator+=(const Block& other) {
    for (std::size_t t = 0; t < normals.size(); ++t) normals[t] += other.normals[t];
    plain.weighted_chi2 += other.plain.weighted_chi2;
    plain.weight += other.plain.weight;
    plain.squares_together += other.plain.squares_together;
    plain.squares_apart += other.plain.squares_apart;
    return *this;
  }
};

/// Weighted equations of one reflector, a column each.
struct FitSums::Equations {
  Eigen::MatrixXd columns;
  Eigen::Index count = 0;
};

FitSums::FitSums(const UnloadedDay& day, const ArmFit& fit) : day_(day), terms_(fit.sizes.size()) {
  first_.reserve(day.postures.size());
  std::size_t at = 0;
  for (const Posture& posture : day.postures) {
    first_.push_back(at);
    at += posture.readings.size();
  }
  by_terms_.resize(day.arm.joints(), terms_ * static_cast<Eigen::Index>(day.postures.size()));
  if (terms_ == 0) return;
  const FittedDay fitted(day, fit);
  numerics::smallWorkOnAllCores(day.postures.size(), [&](std::size_t i) {
    by_terms_.middleCols(static_cast<Eigen::Index>(i) * terms_, terms_) = fitted.anglesByTerms(day.postures[i]);
  });
}

FitSum FitSums::over(const ArmFit& fit, const std::vector<std::size_t>& postures, const std::vector<int>& places,
                     std::vector<double>& distances) const {
  const FittedDay fitted(day_, fit);
  const std::size_t targets = fit.place.targets_at_zero.size();
  std::vector<int> common, own;
  std::vector<bool> asked(static_cast<std::size_t>(fit.steps.size()), false);
  for (const int place : places) {
    const bool target = place >= fit.places().targetsAt() && place < fit.steps.size();
    if (target) {
      asked[static_cast<std::size_t>(place)] = true;
    } else {
      common.push_back(place);
    }
  }
  own = common;
  for (int k = 0; k < 3; ++k) own.push_back(ReadingDerivatives::ofReadReflector(k));
  const auto count = static_cast<Eigen::Index>(own.size());
  // Some postures together: their rows make a product of matrices that is worth its name.
  constexpr std::size_t kTogether = 32, kMicroseconds = 80;
  const std::size_t groups = (postures.size() + kTogether - 1) / kTogether;
  Block all = numerics::sumInBlocks<Block>(
      groups,
      [&](std::size_t group, Block& sum) {
        const std::size_t from = group * kTogether, end = std::min(postures.size(), from + kTogether);
        if (sum.normals.empty()) sum.normals.assign(targets, Eigen::MatrixXd::Zero(count + 1, count + 1));
        std::vector<Eigen::Index> rows(targets, 0);
        for (std::size_t v = from; v < end; ++v) {
          for (const Reading& reading : day_.postures[postures[v]].readings)
            rows[static_cast<std::size_t>(reading.target)] += 3;
        }
        std::vector<Equations> equations(targets);
        for (std::size_t t = 0; t < targets; ++t) equations[t].columns.resize(count + 1, rows[t]);
        ReadingDerivatives derivatives(fitted, own);
        for (std::size_t v = from; v < end; ++v)
          addPosture(fitted, postures[v], derivatives, equations, sum, distances);
        for (std::size_t t = 0; t < targets; ++t) {
          // Where every reading of a group has lost its weight Eigen would divide by the number of its rows.
          if (equations[t].count == 0) continue;
          sum.normals[t].selfadjointView<Eigen::Lower>().rankUpdate(equations[t].columns.leftCols(equations[t].count));
        }
      },
      kMicroseconds);
  FitSum sum = std::move(all.plain);
  const Eigen::Index last = fit.steps.size() + fit.sizes.size();
  sum.normal = Eigen::MatrixXd::Zero(last + 1, last + 1);
  for (std::size_t t = 0; t < all.normals.size(); ++t) {
    // Where each of the reflector's rows belongs; below zero: nobody asked.
    std::vector<Eigen::Index> at(common.begin(), common.end());
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Index place = fit.places().targetAt(t) + k;
      at.push_back(asked[static_cast<std::size_t>(place)] ? place : -1);
    }
    at.push_back(last);
    for (std::size_t c = 0; c < at.size(); ++c) {
      for (std::size_t r = c; r < at.size(); ++r) {
        if (at[r] < 0 || at[c] < 0) continue;
        sum.normal(std::max(at[r], at[c]), std::min(at[r], at[c])) +=
            all.normals[t](static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
      }
    }
  }
  return sum;
}

void FitSums::addPosture(const FittedDay& fitted, std::size_t i, ReadingDerivatives& derivatives,
                         std::vector<Equations>& equations, Block& sum, std::vector<double>& distances) const {
  const Posture& posture = day_.postures[i];
  const auto by_terms = anglesByTerms(i);
  const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture, by_terms));
  derivatives.enter(placed, by_terms);
  Eigen::Vector3d together = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < posture.readings.size(); ++k) {
    const Reading& reading = posture.readings[k];
    const double weight = fitted.fit().weights[first_[i] + k];
    const ReflectorAt reflector = fitted.reflector(placed, reading);
    const Eigen::Matrix3d white = fitted.whitening(reading);
    const Eigen::Vector3d residual = white * fitted.residual(posture, reading, reflector);
    const double square = residual.squaredNorm();
    distances[first_[i] + k] = square;
    if (weight <= 0.0) continue;
    const double root = std::sqrt(weight);
    const ReadingDerivatives::Rows& rows = derivatives.of(posture, reflector, root * white);
    Equations& own = equations[static_cast<std::size_t>(reading.target)];
    const Eigen::Index last = own.columns.rows() - 1;
    for (Eigen::Index row = 0; row < 3; ++row, ++own.count) {
      own.columns.col(own.count).head(last) = rows.row(row).transpose();
      own.columns(last, own.count) = root * residual[row];
    }
    sum.plain.weighted_chi2 += weight * square;
    sum.plain.weight += weight;
    together += residual;
    sum.plain.squares_apart += square;
  }
  sum.plain.squares_together += together.squaredNorm();
}

void FitSums::distancesOf(const ArmFit& fit, const std::vector<std::size_t>& postures,
                          std::vector<double>& distances) const {
  const FittedDay fitted(day_, fit);
  numerics::smallWorkOnAllCores(postures.size(), [&](std::size_t v) {
    const std::size_t i = postures[v];
    const Posture& posture = day_.postures[i];
    const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture, anglesByTerms(i)));
    for (std::size_t k = 0; k < posture.readings.size(); ++k) {
      const Reading& reading = posture.readings[k];
      const Eigen::Vector3d residual =
          fitted.whitening(reading) * fitted.residual(posture, reading, fitted.reflector(placed, reading));
      distances[first_[i] + k] = residual.squaredNorm();
    }
  });
}

}  // namespace stiffscope::calibration
