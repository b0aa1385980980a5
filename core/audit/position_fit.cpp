#include "core/audit/position_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/frames/arm_parameters.h"
#include "core/numerics/distributions.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"
#include "core/preparation/finding.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::audit {

PostureWeights equalWeights(const frames::AbsoluteRows& rows) {
  return PostureWeights(static_cast<std::size_t>(*std::max_element(rows.poses.begin(), rows.poses.end())) + 1, 1.0);
}

namespace {

/// [J r]^T W [J r], lower triangle, and how many rows made it.
struct Products {
  Eigen::MatrixXd matrix;
  int rows = 0;

  Products& operator+=(const Products& other) {
    if (other.matrix.size() > 0) matrix = matrix.size() > 0 ? Eigen::MatrixXd(matrix + other.matrix) : other.matrix;
    rows += other.rows;
    return *this;
  }
};

Products productsOf(const frames::AbsoluteRows& rows, const PostureWeights& weights) {
  constexpr std::size_t kTogether = 32, kMicroseconds = 64;  // readings, and what they take
  const Eigen::Index size = rows.parameters;
  return numerics::sumInBlocks<Products>(
      (rows.rows.size() + kTogether - 1) / kTogether,
      [&](std::size_t block, Products& sum) {
        Eigen::MatrixXd whitened(3 * static_cast<Eigen::Index>(kTogether), size + 1);
        Eigen::Index filled = 0;
        const std::size_t end = std::min(rows.rows.size(), (block + 1) * kTogether);
        for (std::size_t i = block * kTogether; i < end; ++i) {
          const frames::AbsoluteRow& row = rows.rows[i];
          const double weight = weights[static_cast<std::size_t>(row.pose)];
          if (weight == 0.0) continue;
          const Eigen::Matrix3d root = std::sqrt(weight) * Eigen::Matrix3d(row.weight.llt().matrixU());
          whitened.block(filled, 0, 3, size).noalias() = root * row.jacobian;
          whitened.block<3, 1>(filled, size) = root * row.residual;
          filled += 3;
        }
        if (sum.matrix.size() == 0) sum.matrix.setZero(size + 1, size + 1);
        sum.matrix.selfadjointView<Eigen::Lower>().rankUpdate(whitened.topRows(filled).transpose());
        sum.rows += static_cast<int>(filled);
      },
      kMicroseconds);
}

}  // namespace

PositionNormal sumUp(const frames::AbsoluteRows& rows, const PostureWeights& weights) {
  const Eigen::Index size = rows.parameters;
  Products sum = productsOf(rows, weights);
  if (sum.matrix.size() == 0) sum.matrix.setZero(size + 1, size + 1);  // no row
  PositionNormal normal{rows.prior, sum.matrix.row(size).head(size).transpose(), sum.matrix(size, size), sum.rows};
  normal.matrix += Eigen::MatrixXd(sum.matrix.topLeftCorner(size, size).selfadjointView<Eigen::Lower>());
  // A reflector that no row of the postures left shows stays where it is.
  for (Eigen::Index i = 0; i < size; ++i) {
    if (normal.matrix(i, i) == 0.0) normal.matrix(i, i) = 1.0;
  }
  return normal;
}

double leastSquares(PositionNormal normal, std::optional<Eigen::Index> held) {
  if (held) {
    normal.matrix.middleRows<6>(*held).setZero();
    normal.matrix.middleCols<6>(*held).setZero();
    normal.matrix.block<6, 6>(*held, *held).setIdentity();
    normal.right.segment<6>(*held).setZero();
  }
  return normal.squares - normal.right.dot(Eigen::VectorXd(solveSymmetric(normal.matrix, normal.right)));
}

RobustFit robustFit(const frames::AbsoluteRows& rows) {
  RobustFit fit{Eigen::VectorXd::Zero(rows.parameters), equalWeights(rows)};
  Eigen::VectorXd& parameters = fit.parameters;
  PostureWeights& weights = fit.weights;
  constexpr int kRounds = 20;
  constexpr double kSettled = 1e-6;  // of the parameters' standard uncertainties
  for (int round = 0; round < kRounds; ++round) {
    const PositionNormal normal = sumUp(rows, weights);
    const Eigen::VectorXd before = std::exchange(parameters, solveSymmetric(normal.matrix, normal.right));
    const Eigen::VectorXd step = parameters - before;
    if (round > 0 && step.dot(normal.matrix * step) < kSettled * kSettled) break;
    std::vector<double> by_row(rows.rows.size());
    numerics::smallWorkOnAllCores(by_row.size(), [&](std::size_t i) {
      const frames::AbsoluteRow& row = rows.rows[i];
      const Eigen::Vector3d left = row.residual - row.jacobian * parameters;
      by_row[i] = left.dot(row.weight * left);
    });
    std::vector<double> misfits(weights.size(), 0.0), sorted;
    std::vector<bool> has_rows(weights.size(), false);
    for (std::size_t i = 0; i < by_row.size(); ++i) {
      const auto pose = static_cast<std::size_t>(rows.rows[i].pose);
      misfits[pose] += by_row[i];
      has_rows[pose] = true;
    }
    for (std::size_t pose = 0; pose < misfits.size(); ++pose) {
      if (has_rows[pose]) sorted.push_back(misfits[pose]);
    }
    constexpr double kCauchy = 2.385;
    const double scale = kCauchy * kCauchy * std::max(numerics::upperMedian(sorted), 1e-300);
    for (std::size_t pose = 0; pose < misfits.size(); ++pose) weights[pose] = 1.0 / (1.0 + misfits[pose] / scale);
  }
  return fit;
}

namespace {

constexpr double kSigmas = 3.0;  // of the share to which the sag is trusted

/// Joint angles by their normal equations, and the standard deviation of each. More joints than a body has freedoms
/// always leave a turn that no reflector shows; it takes no part, whatever rounding says of it.
struct SolvedAngles {
  JointVector angles, sd;
};

SolvedAngles solveAngles(const JointMatrix& normal, const JointVector& right) {
  constexpr Eigen::Index kFreedoms = 6;
  if (right.size() <= kFreedoms)
    return {leastSquaresSolution(normal, right), pseudoInverse(normal).diagonal().cwiseMax(0.0).cwiseSqrt()};
  constexpr double kNotSeen = 1e-12;  // of the largest eigenvalue, a square
  const SymmetricEigen eigen = symmetricEigen(normal);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(right.size());
  for (Eigen::Index k = 0; k < right.size(); ++k) {
    if (eigen.values[k] > kNotSeen * eigen.values[right.size() - 1]) inverse[k] = 1.0 / eigen.values[k];
  }
  const Eigen::MatrixXd covariance = eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
  return {covariance * right, covariance.diagonal().cwiseMax(0.0).cwiseSqrt()};
}

/// Joint angles of one posture from what the fit leaves of its reflectors.
PostureReadBack readBackOf(const std::vector<const frames::AbsoluteRow*>& rows, const Eigen::VectorXd& parameters) {
  const Eigen::Index joints = rows.front()->sag.size();
  PostureReadBack result(rows.front()->pose, static_cast<int>(joints));
  JointMatrix normal = JointMatrix::Zero(joints, joints);
  JointVector right = JointVector::Zero(joints);
  const JointVector& sag = rows.front()->sag;  // the same in all rows of a posture
  double squares = 0.0;
  for (const frames::AbsoluteRow* row : rows) {
    const Eigen::Vector3d left = row->residual - row->jacobian * parameters;
    normal += row->by_angles.transpose() * row->weight * row->by_angles;
    right += row->by_angles.transpose() * row->weight * left;
    squares += left.dot(row->weight * left);
  }
  const SolvedAngles solved = solveAngles(normal, right);
  const JointVector& sd = solved.sd;
  result.correction = solved.angles;
  double best = -1.0;
  for (int j = 0; j < joints; ++j) {
    result.significance[j] = sd[j] > 0.0 ? result.correction[j] / sd[j] : 0.0;
    const double alone = normal(j, j) > 0.0 ? right[j] * right[j] / normal(j, j) : 0.0;
    if (alone <= best) continue;
    best = alone;
    result.joint = j;
    result.joint_correction = right[j] / normal(j, j);
  }
  result.sag_doubt = kSigmas * frames::kSagShare * std::abs(sag[result.joint]);
  result.explained = squares > 0.0 ? right.dot(result.correction) / squares : 0.0;
  return result;
}

/// By which a joint's compliance changes at most from no torque to the largest that the own weight makes, where its
/// spring is not straight. A choice: gears of arms are a third to a half stiffer at full load than at their first
/// loads.
constexpr double kMostCurved = 0.6;

/// What springs c tau - h tau |tau| with h at that bound put into each posture's angles that a straight spring and a
/// joint's zero by the other postures do not: much where the own weight hardly turns the joint, or turns it the other
/// way than in the others.
std::vector<JointVector> curvedSprings(const std::vector<JointVector>& sags, int joints) {
  std::vector<JointVector> apart(sags.size(), JointVector::Zero(joints));
  const double count = static_cast<double>(sags.size());
  for (int j = 0; j < joints; ++j) {
    double largest = 0.0, mean = 0.0, mean_curved = 0.0;
    for (const JointVector& sag : sags) {
      largest = std::max(largest, std::abs(sag[j]));
      mean += sag[j] / count;
      mean_curved += sag[j] * std::abs(sag[j]) / count;
    }
    double squares = 0.0, product = 0.0;
    for (const JointVector& sag : sags) {
      squares += (sag[j] - mean) * (sag[j] - mean);
      product += (sag[j] - mean) * (sag[j] * std::abs(sag[j]) - mean_curved);
    }
    if (!(squares > 1e-12 * largest * largest)) continue;
    for (std::size_t i = 0; i < sags.size(); ++i) {
      const double off = sags[i][j] - mean;
      const double left = sags[i][j] * std::abs(sags[i][j]) - mean_curved - product / squares * off;
      const double leverage = 1.0 / count + off * off / squares;  // a posture pulls its own line
      apart[i][j] = kMostCurved * std::abs(left) / (largest * std::max(1e-6, 1.0 - leverage));
    }
  }
  return apart;
}

/// Of every posture that has rows, in the order of `rows.poses`.
std::vector<PostureReadBack> readBacks(const frames::AbsoluteRows& rows, const Eigen::VectorXd& parameters) {
  std::map<int, std::vector<const frames::AbsoluteRow*>> by_pose;
  for (const frames::AbsoluteRow& row : rows.rows) by_pose[row.pose].push_back(&row);
  std::vector<PostureReadBack> postures;
  std::vector<JointVector> sags;
  for (const int pose : rows.poses) {
    const auto own = by_pose.find(pose);
    postures.push_back(own == by_pose.end() ? PostureReadBack(pose, rows.joints) : readBackOf(own->second, parameters));
    sags.push_back(own == by_pose.end() ? JointVector::Zero(rows.joints) : own->second.front()->sag);
  }
  const std::vector<JointVector> curved = curvedSprings(sags, rows.joints);
  for (std::size_t i = 0; i < postures.size(); ++i)
    postures[i].sag_doubt = std::max(postures[i].sag_doubt, curved[i][postures[i].joint]);
  return postures;
}

/// Scores against the campaign's own scatter of each joint (median absolute deviation, never below the
/// reading noise), because geometry errors put more than noise into every posture.
void scorePostures(int joints, double limit, std::vector<PostureReadBack>& postures) {
  constexpr double kMadOfNormal = 1.4826;  // median absolute deviation to standard deviation
  for (PostureReadBack& posture : postures) posture.score = 0.0;
  for (int j = 0; j < joints; ++j) {
    std::vector<double> values;
    for (const PostureReadBack& posture : postures) values.push_back(posture.significance[j]);
    const double middle = numerics::upperMedian(values);
    for (double& value : values) value = std::abs(value - middle);
    const double scale = std::max(1.0, kMadOfNormal * numerics::upperMedian(values));
    for (PostureReadBack& posture : postures) {
      posture.score = std::max(posture.score, std::abs(posture.significance[j] - middle) / scale);
    }
  }
  for (PostureReadBack& posture : postures) {
    posture.outlier = posture.score > limit && std::abs(posture.joint_correction) > posture.sag_doubt;
  }
}

/// Limit of a score: Student's t, the median absolute deviation being worth 0.37 of its sample (its
/// efficiency).
double scoreLimit(int joints, std::size_t postures) {
  const double count = static_cast<double>(postures);
  return numerics::studentLimit(preparation::kLevel / (joints * count), std::max(1.0, 0.37 * (count - 1.0)));
}

Eigen::Index shiftAt(const frames::AbsoluteRows& rows) { return frames::ArmParameters(rows.axes).baseAt(); }

/// Equal weights but for postures whose angles stand apart.
PostureWeights withoutOutlying(const frames::AbsoluteRows& rows, double limit, std::vector<PostureReadBack>& postures) {
  postures = readBacks(rows, robustFit(rows).parameters);
  scorePostures(rows.joints, limit, postures);
  PostureWeights weights = equalWeights(rows);
  for (const PostureReadBack& posture : postures) {
    if (posture.outlier) weights[static_cast<std::size_t>(posture.pose)] = 0.0;
  }
  return weights;
}

void describe(const frames::AbsoluteRows& rows, const PostureWeights& weights, AbsoluteFit& fit) {
  const PositionNormal normal = sumUp(rows, weights);
  const Eigen::VectorXd parameters = solveSymmetric(normal.matrix, normal.right);
  const Eigen::Index shift_at = shiftAt(rows);
  fit.shift = -parameters.segment<6>(shift_at);  // what the readings' motion takes back
  const Eigen::Index size = normal.right.size();
  fit.shift_covariance = solveSymmetric(normal.matrix, Eigen::MatrixXd::Identity(size, size).middleCols<6>(shift_at))
                             .middleRows<6>(shift_at);
  fit.chi2 = leastSquares(normal);
  fit.shift_chi2 = leastSquares(normal, shift_at) - fit.chi2;
  fit.positions = normal.rows / 3;
  fit.dof = normal.rows - 6 - 3 * rows.targets;
  for (const frames::AbsoluteRow& row : rows.rows) {
    if (weights[static_cast<std::size_t>(row.pose)] == 0.0) continue;
    fit.rms_before += row.residual.squaredNorm() / normal.rows;
    fit.rms_after += (row.residual - row.jacobian * parameters).squaredNorm() / normal.rows;
  }
  fit.rms_before = std::sqrt(fit.rms_before);
  fit.rms_after = std::sqrt(fit.rms_after);
}

/// The joint whose zero, another in all of loading than in the sweeps, takes most of chi2 with it: beyond chance, and
/// more than is left. With everything else of the fit free (Schur complement); a joint whose zero a motion of the base
/// or of the reflectors imitates, as of the first and the last, is none.
std::optional<ZeroSinceSweeps> zeroSinceSweeps(const frames::AbsoluteRows& rows, const PostureWeights& weights,
                                               const AbsoluteFit& fit) {
  const PositionNormal normal = sumUp(rows, weights);
  const Eigen::Index size = normal.right.size();
  const Eigen::MatrixXd inverse = solveSymmetric(normal.matrix, Eigen::MatrixXd::Identity(size, size));
  const Eigen::VectorXd parameters = inverse * normal.right;
  std::optional<ZeroSinceSweeps> best;
  double most = 0.0;
  for (int j = 0; j < rows.joints; ++j) {
    Eigen::VectorXd cross = Eigen::VectorXd::Zero(size);
    double own = 0.0, right = 0.0, squares = 0.0;
    for (const frames::AbsoluteRow& row : rows.rows) {
      const double weight = weights[static_cast<std::size_t>(row.pose)];
      if (weight == 0.0) continue;
      const Eigen::Vector3d turned = row.by_angles.col(j), weighted = weight * row.weight * turned;
      cross += row.jacobian.transpose() * weighted;
      own += turned.dot(weighted);
      right += weighted.dot(row.residual);
      squares += turned.squaredNorm();
    }
    constexpr double kSeen = 1e-4;  // of the squares that the joint alone would make
    const double seen = own - cross.dot(inverse * cross), left = right - cross.dot(parameters);
    if (!(seen > kSeen * own) || left * left / seen <= most) continue;
    most = left * left / seen;
    best = {j, left / seen, std::abs(left / seen) * std::sqrt(squares / fit.positions), most / fit.chi2};
  }
  if (!best || best->explained < kExplains) return std::nullopt;
  const double misfit = std::max(1.0, (fit.chi2 - most) / fit.dof);
  const double limit = numerics::chiSquareLimit(preparation::kLevel / rows.joints, 1.0);
  return most > misfit * limit ? best : std::nullopt;
}

}  // namespace

AbsoluteFit fitAbsolutePositions(const campaign::Campaign& campaign, const frames::Frames& frames,
                                 const frames::LoadingGeometry& geometry,
                                 const std::vector<campaign::StatePoints>& states,
                                 const std::optional<metrology::TrackerNoise>& noise) {
  AbsoluteFit fit;
  frames::AbsoluteRows rows = frames::absoluteRows(campaign, frames, geometry, states, noise);
  if (!rows.reason.empty()) {
    fit.reason = rows.reason;
    return fit;
  }
  fit.centre = rows.centre;
  fit.sag_known = frames.weight.links_known && !geometry.compliance.isZero();
  constexpr std::size_t kLeastPostures = 4;  // more than shift and reflectors take, with some to check by
  if (rows.poses.size() < kLeastPostures) {
    fit.reason = Remark(MissingId::few_unloaded_postures, rows.poses.size(), kLeastPostures);
    return fit;
  }
  fit.score_limit = scoreLimit(rows.joints, rows.poses.size());
  const auto weights_of = [&fit](const frames::AbsoluteRows& now) {
    return withoutOutlying(now, fit.score_limit, fit.postures);
  };
  fit.moves = takeOffMoves(campaign, geometry, states, weights_of, rows);
  const PostureWeights weights = weights_of(rows);
  describe(rows, weights, fit);
  fit.zero = zeroSinceSweeps(rows, weights, fit);
  fit.done = true;
  return fit;
}

}  // namespace stiffscope::audit
