#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/identification/equations.h"

namespace stiffscope {

/// A^T A and A^T b of one load case or of a sum of them.
struct NormalEquations {
  Matrix6d matrix = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();

  NormalEquations& operator+=(const NormalEquations& other);
  /// Of three rows more, a point's.
  void add(const Matrix36d& rows, const Eigen::Vector3d& values) {
    matrix.noalias() += rows.transpose() * rows;
    right.noalias() += rows.transpose() * values;
  }
};

NormalEquations normalEquations(const CaseEquations& equations);
NormalEquations normalEquations(const std::vector<CaseEquations>& equations);
NormalEquations sumOf(const std::vector<NormalEquations>& normal);

/// A normal matrix with columns scaled to unit length; joints that are no unknowns have scale 0 and a unit
/// diagonal.
struct ScaledNormal {
  Matrix6d matrix;
  Vector6d scale;
};

ScaledNormal scaledNormal(const Matrix6d& matrix, const JointMask& unknown);

/// Least squares over the joints of the mask, the others zero. Columns are scaled to unit length first.
Vector6d solveNormal(const NormalEquations& sum, const JointMask& unknown);

/// Condition number (2-norm) of the stacked matrix over the joints of the mask, columns scaled to unit
/// length.
double conditionNumber(const std::vector<CaseEquations>& equations, const JointMask& unknown);

}  // namespace stiffscope
