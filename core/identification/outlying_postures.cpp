#include "core/identification/outlying_postures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/identification/posture_influence.h"
#include "metrology/tail_probability.h"

namespace stiffscope {

namespace {

constexpr double kLevel = 0.001;
constexpr std::size_t kFewest = 5;

struct Posture {
  const CaseEquations* equations;
  NormalEquations normal;
};

NormalEquations sumWithout(const std::vector<Posture>& postures, std::size_t left_out) {
  NormalEquations sum;
  for (std::size_t p = 0; p < postures.size(); ++p) {
    if (p != left_out) sum += postures[p].normal;
  }
  return sum;
}

/// r^T (I - H)^-1 r of a posture in a fit that has it in, by the fit without it: e^T (I - H) e, with
/// (I - H)^-1 = I + A (N - A^T A)^-1 A^T.
double studentised(const Eigen::VectorXd& deleted, const CaseEquations& own, const Matrix6d& inverse_of_others) {
  // I - H = (I + A M A^T)^-1, M = (N - A^T A)^-1.
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Identity(deleted.size(), deleted.size()) +
                                 own.matrix * inverse_of_others * own.matrix.transpose();
  return deleted.dot(spread.llt().solve(deleted));
}

/// How many independent numbers a posture's residual is.
double degreesOf(const std::vector<Posture>& postures, const Vector6d& compliance) {
  const Eigen::Index rows = postures.front().equations->right.size();
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(rows, rows);
  for (const Posture& one : postures) {
    if (one.equations->right.size() != rows) return 1.0;  // no common coordinates: the least there can be
    const Eigen::VectorXd residual = one.equations->right - one.equations->matrix * compliance;
    moments += residual * residual.transpose();
  }
  return std::max(1.0, satterthwaite(moments));
}

OutlyingPosture judge(const std::vector<Posture>& postures, std::size_t at, const JointMask& unknown, double unknowns) {
  const NormalEquations others = sumWithout(postures, at);
  const Vector6d compliance = solveNormal(others, unknown);
  const Matrix6d inverse = inverseNormal(others, unknown);
  const CaseEquations& own = *postures[at].equations;
  const Eigen::VectorXd deleted = own.right - own.matrix * compliance;
  OutlyingPosture result;
  result.posture = own.posture;
  result.rms = std::sqrt(deleted.squaredNorm() / static_cast<double>(deleted.size()));
  double sum = 0.0;
  Eigen::Index rows = 0;
  std::vector<Posture> rest;
  for (std::size_t p = 0; p < postures.size(); ++p) {
    if (p == at) continue;
    rest.push_back(postures[p]);
    sum += (postures[p].equations->right - postures[p].equations->matrix * compliance).squaredNorm();
    rows += postures[p].equations->right.size();
  }
  result.others = std::sqrt(sum / static_cast<double>(rows));
  const double left = static_cast<double>(rows) - unknowns;
  if (!(left > 0.0) || !(sum > 0.0)) return result;
  const double per_posture = degreesOf(rest, compliance);
  result.f = studentised(deleted, own, inverse) / static_cast<double>(deleted.size()) / (sum / left);
  const double below = per_posture * left / static_cast<double>(deleted.size());
  const double tail = fTail(result.f, std::max(1, static_cast<int>(per_posture)), std::max(1.0, below));
  result.p_value = std::min(1.0, tail * static_cast<double>(postures.size()));
  return result;
}

}  // namespace

std::vector<OutlyingPosture> outlyingPostures(const std::vector<CaseEquations>& equations, const JointMask& unknown) {
  std::vector<OutlyingPosture> found;
  std::vector<Posture> postures;
  for (const CaseEquations& one : equations) postures.push_back({&one, normalEquations(one)});
  const auto unknowns = static_cast<double>(std::count(unknown.begin(), unknown.end(), true));
  if (unknowns == 0.0) return found;
  while (postures.size() >= kFewest && 2 * postures.size() > equations.size()) {
    std::size_t worst = 0;
    OutlyingPosture most;
    for (std::size_t p = 0; p < postures.size(); ++p) {
      const OutlyingPosture one = judge(postures, p, unknown, unknowns);
      if (one.p_value < most.p_value) most = one, worst = p;
    }
    if (most.p_value >= kLevel) break;
    found.push_back(most);
    postures.erase(postures.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  return found;
}

}  // namespace stiffscope
