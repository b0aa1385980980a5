#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/identification/equations.h"
#include "core/robot/robot.h"

namespace stiffscope::identification {

/// Equations b = A c of some points, three rows each, laid out so that all residuals of a block are computed at once: a
/// coordinate of all points stands together. Points that are not there have zeros.
struct alignas(64) PointBlock {
  static constexpr std::size_t kPoints = 8;
  double matrix[3][6][kPoints] = {};  ///< A by coordinate, joint and point
  double right[3][kPoints] = {};      ///< b by coordinate and point, m
};

/// |b - A c| of each point, m; `norms`: kPoints a block. The same numbers with wide registers and without.
void residualNorms(std::span<const PointBlock> blocks, const Vector6d& compliance, std::span<double> norms);

/// How much of the deflection a model takes away at some points: 1 - sum |residual| / sum |displacement|,
/// over postures (method: Before and after). Prepared for many evaluations.
class DeflectionJudge {
 public:
  DeflectionJudge() = default;
  /// `equations`: one a posture, three rows a point, positions only.
  explicit DeflectionJudge(const std::vector<CaseEquations>& equations);
  /// As of byPosture(equations) (estimate.h), without a copy of them.
  static DeflectionJudge byPosture(const std::vector<CaseEquations>& equations);

  std::size_t postures() const { return displacement_.size(); }

  /// Per posture: sum over its points of |displacement|, m.
  const std::vector<double>& displacement() const { return displacement_; }

  /// Per posture: sum over its points of |b - A c|, m.
  std::vector<double> residual(const Vector6d& compliance) const;
  /// The same of some compliances, for each into its vector: quicker than one by one.
  void residuals(std::span<const Vector6d> compliances, std::span<std::vector<double>* const> per_posture) const;

  /// Over all postures.
  double compensated(const Vector6d& compliance) const;

  /// Points of a posture, for turning sums into means.
  int pointsOf(std::size_t posture) const { return points_[posture]; }

 private:
  /// `first`: of the equations of each posture, the first.
  DeflectionJudge(const std::vector<CaseEquations>& equations, const std::vector<std::size_t>& first);
  void addResidual(std::size_t from_block, std::size_t blocks, const Vector6d& compliance,
                   std::vector<double>& per_posture) const;

  std::vector<PointBlock> blocks_;  // its points in the order of the equations
  std::vector<std::size_t> posture_of_point_;
  std::vector<int> points_;
  std::vector<double> displacement_;
};

}  // namespace stiffscope::identification
