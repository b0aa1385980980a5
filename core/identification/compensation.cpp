#include "core/identification/compensation.h"

#include <algorithm>
#include <numeric>

#include "core/identification/posture_influence.h"
#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

std::vector<std::size_t> eachOf(const std::vector<CaseEquations>& equations) {
  std::vector<std::size_t> all(equations.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> firstsOfPostures(const std::vector<CaseEquations>& equations) {
  std::vector<std::size_t> firsts;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (i == 0 || !sharePosture(equations[i - 1], equations[i])) firsts.push_back(i);
  }
  return firsts;
}

}  // namespace

DeflectionJudge::DeflectionJudge(const std::vector<CaseEquations>& equations)
    : DeflectionJudge(equations, eachOf(equations)) {}

DeflectionJudge DeflectionJudge::byPosture(const std::vector<CaseEquations>& equations) {
  return {equations, firstsOfPostures(equations)};
}

DeflectionJudge::DeflectionJudge(const std::vector<CaseEquations>& equations, const std::vector<std::size_t>& first)
    : points_(first.size()), displacement_(first.size()) {
  const auto end = [&](std::size_t posture) { return posture + 1 < first.size() ? first[posture + 1] : equations.size(); };
  std::vector<Eigen::Index> from(first.size());
  Eigen::Index count = 0;
  for (std::size_t posture = 0; posture < first.size(); ++posture) {
    from[posture] = count;
    for (std::size_t i = first[posture]; i < end(posture); ++i) count += equations[i].right.size() / 3;
    points_[posture] = static_cast<int>(count - from[posture]);
    posture_of_point_.resize(static_cast<std::size_t>(count), posture);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    matrix_[axis].resize(count, 6);
    right_[axis].resize(count);
  }
  smallWorkOnAllCores(first.size(), [&](std::size_t posture) {
    Eigen::Index at = from[posture];
    double sum = 0.0;
    for (std::size_t i = first[posture]; i < end(posture); ++i) {
      const CaseEquations& one = equations[i];
      for (Eigen::Index row = 0; row < one.right.size(); row += 3, ++at) {
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          matrix_[static_cast<std::size_t>(axis)].row(at) = one.matrix.row(row + axis).array();
          right_[static_cast<std::size_t>(axis)][at] = one.right[row + axis];
        }
        sum += one.right.segment<3>(row).norm();
      }
    }
    displacement_[posture] = sum;
  });
}

namespace {

constexpr Eigen::Index kBlock = 64;  // points at a time, on the stack

}  // namespace

void DeflectionJudge::addResidual(Eigen::Index from, Eigen::Index size, const Vector6d& compliance,
                                  std::vector<double>& per_posture) const {
  std::array<double, kBlock> norms;
  Eigen::Map<Eigen::ArrayXd> squares(norms.data(), size);
  squares.setZero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto rows = matrix_[axis].middleRows(from, size);
    squares += (right_[axis].segment(from, size) - rows.col(0) * compliance[0] -
                rows.col(1) * compliance[1] - rows.col(2) * compliance[2] - rows.col(3) * compliance[3] -
                rows.col(4) * compliance[4] - rows.col(5) * compliance[5])
                   .square();
  }
  squares = squares.sqrt();
  // A posture's points follow one another: its sum stays in a register.
  const std::size_t* const posture_of = posture_of_point_.data() + from;
  for (Eigen::Index point = 0; point < size;) {
    const std::size_t posture = posture_of[point];
    double sum = per_posture[posture];
    for (; point < size && posture_of[point] == posture; ++point) sum += norms[static_cast<std::size_t>(point)];
    per_posture[posture] = sum;
  }
}

void DeflectionJudge::residuals(std::span<const Vector6d> compliances,
                                std::span<std::vector<double>* const> per_posture) const {
  for (std::vector<double>* one : per_posture) one->assign(displacement_.size(), 0.0);
  const Eigen::Index count = right_[0].size();
  for (Eigen::Index from = 0; from < count; from += kBlock) {
    for (std::size_t k = 0; k < compliances.size(); ++k) {
      addResidual(from, std::min(kBlock, count - from), compliances[k], *per_posture[k]);
    }
  }
}

std::vector<double> DeflectionJudge::residual(const Vector6d& compliance) const {
  std::vector<double> per_posture;
  std::vector<double>* const into = &per_posture;
  residuals({&compliance, 1}, {&into, 1});
  return per_posture;
}

double DeflectionJudge::compensated(const Vector6d& compliance) const {
  const std::vector<double> left = residual(compliance);
  return 1.0 - std::accumulate(left.begin(), left.end(), 0.0) /
                   std::accumulate(displacement_.begin(), displacement_.end(), 0.0);
}

}  // namespace stiffscope
