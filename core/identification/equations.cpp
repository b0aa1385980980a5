#include "core/identification/equations.h"

#include <Eigen/Dense>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/parallel.h"
#include "core/robot/geometric_stiffness.h"
#include "core/robot/kinematics.h"
#include "core/robot/wrench.h"
#include "metrology/linear_algebra.h"
#include "metrology/registration.h"
#include "metrology/trilateration.h"

namespace stiffscope::identification {

namespace {

/// R of A = Q R, A given in blocks of rows: the rows at hand under what the earlier ones left.
class TriangularFactor {
 public:
  void add(const JointRows& rows) {
    if (work_.cols() == 0) work_.resize(kRows, rows.cols());
    rows_ += rows.rows();
    for (Eigen::Index from = 0; from < rows.rows();) {
      const Eigen::Index count = std::min(rows.rows() - from, kRows - filled_);
      work_.middleRows(filled_, count) = rows.middleRows(from, count);
      filled_ += count, from += count;
      if (filled_ == kRows) reduce();
    }
  }

  /// With the rows under the other one's, too.
  TriangularFactor& operator+=(TriangularFactor& other) {
    if (other.work_.cols() == 0) return *this;
    add(other.triangle());
    rows_ += other.rows_ - other.work_.cols();
    return *this;
  }

  /// Of all rows.
  Eigen::Index rows() const { return rows_; }

  JointMatrix triangle() {
    reduce();
    return work_.topRows(work_.cols());
  }

 private:
  void reduce() {
    work_.bottomRows(kRows - filled_).setZero();
    const Eigen::Index joints = work_.cols();
    const JointMatrix triangle = work_.householderQr().matrixQR().topRows(joints).triangularView<Eigen::Upper>();
    work_.topRows(joints) = triangle;
    filled_ = joints;
  }

  static constexpr Eigen::Index kRows = 96;
  Eigen::Matrix<double, kRows, Eigen::Dynamic, Eigen::ColMajor, kRows, kMostJoints> work_;
  Eigen::Index filled_ = 0, rows_ = 0;
};

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  if (other.right.size() == 0) return *this;
  if (right.size() == 0) return *this = other;
  if (right.size() == 6) {  // as in add
    Eigen::Map<Matrix6d>(matrix.data()) += Eigen::Map<const Matrix6d>(other.matrix.data());
    Eigen::Map<Vector6d>(right.data()) += Eigen::Map<const Vector6d>(other.right.data());
    return *this;
  }
  matrix += other.matrix;
  right += other.right;
  return *this;
}

void NormalEquations::add(const PointJacobian& rows, const Eigen::Vector3d& values) {
  if (right.size() == 0) *this = NormalEquations(rows.cols());
  if (rows.cols() == 6) {  // most machines, at fixed size
    const Eigen::Map<const Eigen::Matrix<double, 3, 6>> six(rows.data());
    Eigen::Map<Matrix6d>(matrix.data()).noalias() += six.transpose() * six;
    Eigen::Map<Vector6d>(right.data()).noalias() += six.transpose() * values;
    return;
  }
  matrix.noalias() += rows.transpose().lazyProduct(rows);
  right.noalias() += rows.transpose().lazyProduct(values);
}

NormalEquations normalEquations(const CaseEquations& equations) {
  // By columns: for few rows a general matrix product costs more in its preparations than it computes.
  NormalEquations normal(equations.matrix.cols());
  for (Eigen::Index i = 0; i < equations.matrix.cols(); ++i) {
    const auto column = equations.matrix.col(i);
    for (Eigen::Index j = 0; j <= i; ++j) {
      normal.matrix(i, j) = normal.matrix(j, i) = column.dot(equations.matrix.col(j));
    }
    normal.right[i] = column.dot(equations.right);
  }
  return normal;
}

NormalEquations normalEquations(const std::vector<CaseEquations>& equations) {
  NormalEquations sum;
  for (const CaseEquations& one : equations) sum += normalEquations(one);
  return sum;
}

NormalEquations sumOf(const std::vector<NormalEquations>& normal) {
  NormalEquations sum;
  for (const NormalEquations& one : normal) sum += one;
  return sum;
}

ScaledNormal scaledNormal(const JointMatrix& matrix, const robot::JointMask& unknown) {
  // Joints left out get a unit diagonal: one solve serves every mask.
  const auto joints = static_cast<Eigen::Index>(unknown.size());
  if (matrix.size() == 0) return {JointMatrix::Identity(joints, joints), JointVector::Zero(joints)};  // no equations
  ScaledNormal scaled{matrix, JointVector::Zero(joints)};
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    if (unknown[static_cast<std::size_t>(j)] && matrix(j, j) > 0.0) scaled.scale[j] = 1.0 / std::sqrt(matrix(j, j));
  }
  scaled.matrix = scaled.scale.asDiagonal() * matrix * scaled.scale.asDiagonal();
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    if (scaled.scale[j] == 0.0) scaled.matrix(j, j) = 1.0;
  }
  return scaled;
}

JointVector solveNormal(const NormalEquations& sum, const robot::JointMask& unknown) {
  if (sum.right.size() == 0) return JointVector::Zero(static_cast<Eigen::Index>(unknown.size()));
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  const JointVector right = scaled.scale.cwiseProduct(sum.right);
  // The plain Cholesky factors are twice as quick, which counts over 92,378 subsets; the pivoted ones bear a
  // rank loss.
  return scaled.scale.cwiseProduct(solvePositive(scaled.matrix, right));
}

double conditionNumber(const std::vector<CaseEquations>& equations, const robot::JointMask& unknown) {
  auto factor = numerics::sumInBlocks<TriangularFactor>(
      equations.size(), [&](std::size_t i, TriangularFactor& sum) { sum.add(equations[i].matrix); });
  // Q turns columns and leaves their lengths: the triangular factor has those of the stacked matrix.
  if (factor.rows() == 0) return std::numeric_limits<double>::infinity();
  const JointMatrix triangle = factor.triangle();
  JointMatrix unit(triangle.rows(), 0);
  for (Eigen::Index j = 0; j < triangle.cols(); ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const double length = triangle.col(j).norm();
    if (length == 0.0) return std::numeric_limits<double>::infinity();
    unit.conservativeResize(triangle.rows(), unit.cols() + 1);
    unit.rightCols<1>() = triangle.col(j) / length;
  }
  if (unit.cols() == 0 || factor.rows() < unit.cols()) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd values = singularValues(unit);
  return values[0] / values[unit.cols() - 1];
}

namespace {

using Three = std::array<const TargetMove*, 3>;

std::optional<Three> largestTriangle(const LoadCase& load_case, const std::vector<double>& radii) {
  boost::container::small_vector<const TargetMove*, kFewReflectors> known;
  for (const TargetMove& move : load_case.targets) {
    if (!std::isnan(radii[static_cast<std::size_t>(move.target)])) known.push_back(&move);
  }
  std::optional<Three> best;
  double most = 0.0;
  for (std::size_t a = 0; a < known.size(); ++a) {
    for (std::size_t b = a + 1; b < known.size(); ++b) {
      for (std::size_t c = b + 1; c < known.size(); ++c) {
        const double area =
            (known[b]->unloaded - known[a]->unloaded).cross(known[c]->unloaded - known[a]->unloaded).norm();
        if (area > most) most = area, best = Three{known[a], known[b], known[c]};
      }
    }
  }
  return best;
}

}  // namespace

Eigen::Vector3d modelledWrist(const robot::Robot& arm, const LoadCase& load_case,
                              const Eigen::Vector3d& centre_at_zero) {
  const auto carrying = static_cast<std::size_t>(arm.armAxes());
  return unloadedPosture(arm, load_case).motion[carrying] * centre_at_zero;
}

std::optional<WristMove> wristMove(const LoadCase& load_case, const std::vector<double>& radii,
                                   const Eigen::Vector3d& modelled) {
  if (!load_case.absolute) return std::nullopt;
  const auto three = largestTriangle(load_case, radii);
  if (!three) return std::nullopt;
  const auto& [a, b, c] = *three;
  // Of reflectors on one line the readings' noise would place the centre on a circle about it.
  if (metrology::nearlyOnOneLine({a->unloaded, b->unloaded, c->unloaded})) return std::nullopt;
  const std::array<double, 3> known{radii[static_cast<std::size_t>(a->target)],
                                    radii[static_cast<std::size_t>(b->target)],
                                    radii[static_cast<std::size_t>(c->target)]};
  const auto unloaded = metrology::trilaterate({a->unloaded, b->unloaded, c->unloaded}, known);
  const auto loaded = metrology::trilaterate({a->loaded, b->loaded, c->loaded}, known);
  if (!unloaded || !loaded) return std::nullopt;
  return WristMove{metrology::nearerRoot(*unloaded, modelled), metrology::nearerRoot(*loaded, modelled)};
}

Eigen::Matrix<double, 3, Eigen::Dynamic> wristByReflectors(const LoadCase& load_case, const std::vector<double>& radii,
                                                           const WristMove& wrist) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> map =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, static_cast<Eigen::Index>(3 * load_case.targets.size()));
  const auto three = largestTriangle(load_case, radii);
  if (!three) return map;
  const Eigen::Vector3d centre = 0.5 * (wrist.unloaded + wrist.loaded);
  // The distance to each reflector stays: (w - p_i) . (dw - dp_i) = 0.
  Eigen::Matrix3d toward;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const TargetMove& move = *(*three)[static_cast<std::size_t>(i)];
    toward.row(i) = (centre - 0.5 * (move.unloaded + move.loaded)).transpose();
  }
  const Eigen::Matrix3d inverse = toward.inverse();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = (*three)[static_cast<std::size_t>(i)] - load_case.targets.data();
    map.middleCols<3>(3 * at) = inverse.col(i) * toward.row(i);
  }
  return map;
}

CaseEquations wristEquations(const LoadCase& load_case, const WristMove& wrist, const JointVector& torque) {
  const Eigen::Vector3d point = jacobianPoint(load_case, wrist.unloaded, wrist.loaded);
  return {pointRows(jacobianAxes(load_case), point, torque), wrist.displacement(), load_case.pose};
}

namespace {

/// By how K_c turns torques into torques, K_c c; the own weight's part depends on the posture alone.
class SpringTorque {
 public:
  SpringTorque(const frames::LoadingGeometry& geometry, const LoadCase& load_case, const JointVector& compliance)
      : axes_(load_case.axes),
        by_weight_(JointMatrix::Zero(compliance.size(), compliance.size())),
        compliance_(compliance) {
    if (geometry.weight.any()) {
      by_weight_ = robot::geometricStiffness(axes_, unloadedPosture(geometry.arm, load_case), geometry.weight);
    }
  }

  /// Solves s = tau + K_c c s.
  JointVector under(const robot::Wrench& wrench) const {
    const JointMatrix change = robot::geometricStiffness(axes_, wrench) + by_weight_;
    const Eigen::Index joints = compliance_.size();
    const JointMatrix system = JointMatrix::Identity(joints, joints) - change * compliance_.asDiagonal();
    return solveLu(system, robot::jointTorque(axes_, wrench));
  }

 private:
  const robot::ArmAxes& axes_;
  JointMatrix by_weight_;
  const JointVector& compliance_;
};

/// The wrench as the model's turn of its body by these joint angles directs it.
robot::Wrench turnedWrench(const robot::Robot& arm, const LoadCase& load_case, const JointVector& loaded) {
  const auto body = static_cast<std::size_t>(load_case.wrench_turns_with);
  const Eigen::Matrix3d turn = robot::postureAt(arm, loaded).motion[body].linear() * load_case.unturned.transpose();
  return {load_case.wrench.point, turn * load_case.wrench_unturned.force, turn * load_case.wrench_unturned.moment};
}

robot::ArmAxes middleOf(const robot::Robot& arm, const LoadCase& load_case, const JointVector& compliance,
                        const JointVector& torque) {
  return robot::axesAt(arm, robot::postureAt(arm, load_case.q_sagged + 0.5 * compliance.cwiseProduct(torque)));
}

}  // namespace

std::vector<JointVector> jointTorques(const std::vector<LoadCase>& cases) {
  std::vector<JointVector> torques(cases.size());
  numerics::smallWorkOnAllCores(
      cases.size(), [&](std::size_t i) { torques[i] = robot::jointTorque(cases[i].axes, cases[i].wrench); });
  return torques;
}

std::vector<JointVector> jointTorquesWithGeometricStiffness(const frames::LoadingGeometry& geometry,
                                                            const std::vector<LoadCase>& cases,
                                                            const JointVector& compliance) {
  std::vector<JointVector> torques(cases.size());
  numerics::smallWorkOnAllCores(cases.size(), [&](std::size_t i) {
    torques[i] = SpringTorque(geometry, cases[i], compliance).under(cases[i].wrench);
  });
  return torques;
}

void updateLoadedConfiguration(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                               std::vector<LoadCase>& cases, std::vector<JointVector>& torques) {
  torques.resize(cases.size());
  numerics::smallWorkOnAllCores(cases.size(), [&](std::size_t i) {
    LoadCase& load_case = cases[i];
    const SpringTorque springs(geometry, load_case, compliance);
    torques[i] = springs.under(load_case.wrench);
    if (load_case.wrench_turns_with != 0) {
      load_case.wrench =
          turnedWrench(geometry.arm, load_case, load_case.q_sagged + compliance.cwiseProduct(torques[i]));
      torques[i] = springs.under(load_case.wrench);
    }
    load_case.middle = middleOf(geometry.arm, load_case, compliance, torques[i]);
  });
}

void takeJacobiansAtMiddle(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                           const std::vector<JointVector>& torques, std::vector<LoadCase>& cases) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].middle = middleOf(geometry.arm, cases[i], compliance, torques[i]);
  }
}

PointJacobian pointRows(const robot::ArmAxes& axes, const Eigen::Vector3d& point, const JointVector& torque) {
  PointJacobian rows = robot::pointJacobianAt(axes, point);
  for (Eigen::Index j = 0; j < rows.cols(); ++j) rows.col(j) *= torque[j];
  return rows;
}

}  // namespace stiffscope::identification
