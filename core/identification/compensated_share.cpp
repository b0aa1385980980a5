#include "core/identification/subsets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"

namespace stiffscope::identification {

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
  const auto end = [&](std::size_t posture) {
    return posture + 1 < first.size() ? first[posture + 1] : equations.size();
  };
  std::vector<std::size_t> from(first.size());
  std::size_t count = 0;
  for (std::size_t posture = 0; posture < first.size(); ++posture) {
    from[posture] = count;
    for (std::size_t i = first[posture]; i < end(posture); ++i) {
      count += static_cast<std::size_t>(equations[i].right.size()) / 3;
    }
    points_[posture] = static_cast<int>(count - from[posture]);
    posture_of_point_.resize(count, posture);
  }
  blocks_.resize((count + PointBlock::kPoints - 1) / PointBlock::kPoints);
  numerics::smallWorkOnAllCores(first.size(), [&](std::size_t posture) {
    std::size_t at = from[posture];
    double sum = 0.0;
    for (std::size_t i = first[posture]; i < end(posture); ++i) {
      const CaseEquations& one = equations[i];
      for (Eigen::Index row = 0; row < one.right.size(); row += 3, ++at) {
        PointBlock& block = blocks_[at / PointBlock::kPoints];
        const std::size_t point = at % PointBlock::kPoints;
        for (int axis = 0; axis < 3; ++axis) {
          for (Eigen::Index joint = 0; joint < one.matrix.cols(); ++joint)
            block.matrix[axis][joint][point] = one.matrix(row + axis, joint);
          block.right[axis][point] = one.right[row + axis];
        }
        sum += one.right.segment<3>(row).norm();
      }
    }
    displacement_[posture] = sum;
  });
}

namespace {

constexpr std::size_t kTogether = 8;  // blocks at a time: they stay in the nearest cache for all compliances

}  // namespace

void DeflectionJudge::addResidual(std::size_t from_block, std::size_t blocks, const JointVector& compliance,
                                  std::vector<double>& per_posture) const {
  std::array<double, kTogether * PointBlock::kPoints> norms;
  residualNorms(std::span(blocks_).subspan(from_block, blocks), compliance, norms);
  // A posture's points follow one another: its sum stays in a register.
  const std::size_t from = from_block * PointBlock::kPoints;
  const std::size_t size = std::min(blocks * PointBlock::kPoints, posture_of_point_.size() - from);
  const std::size_t* const posture_of = posture_of_point_.data() + from;
  for (std::size_t point = 0; point < size;) {
    const std::size_t posture = posture_of[point];
    double sum = per_posture[posture];
    for (; point < size && posture_of[point] == posture; ++point) sum += norms[point];
    per_posture[posture] = sum;
  }
}

void DeflectionJudge::residuals(std::span<const JointVector> compliances,
                                std::span<std::vector<double>* const> per_posture) const {
  for (std::vector<double>* one : per_posture) one->assign(displacement_.size(), 0.0);
  for (std::size_t from = 0; from < blocks_.size(); from += kTogether) {
    for (std::size_t k = 0; k < compliances.size(); ++k) {
      addResidual(from, std::min(kTogether, blocks_.size() - from), compliances[k], *per_posture[k]);
    }
  }
}

std::vector<double> DeflectionJudge::residual(const JointVector& compliance) const {
  std::vector<double> per_posture;
  std::vector<double>* const into = &per_posture;
  residuals({&compliance, 1}, {&into, 1});
  return per_posture;
}

double DeflectionJudge::compensated(const JointVector& compliance) const {
  const std::vector<double> left = residual(compliance);
  return 1.0 - std::accumulate(left.begin(), left.end(), 0.0) /
                   std::accumulate(displacement_.begin(), displacement_.end(), 0.0);
}

// Where the processor has registers of four numbers they are used: over ten thousand postures twice as quick. Without
// fused products, which would round otherwise. Not under sanitizers, which are not up yet when the version is chosen;
// g++ says by a macro that one is on, clang by a feature.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define STIFFSCOPE_SANITIZED
#endif
#endif
#if defined(__x86_64__) && defined(__has_attribute) && !defined(__SANITIZE_ADDRESS__) && !defined(STIFFSCOPE_SANITIZED)
#if __has_attribute(target_clones)
#define STIFFSCOPE_BY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#endif
#endif
#ifndef STIFFSCOPE_BY_PROCESSOR
#define STIFFSCOPE_BY_PROCESSOR
#endif

namespace {

/// `joints` is a number for the compiler where it is that of most machines.
template <class Joints>
[[gnu::always_inline]] inline void normsOf(std::span<const PointBlock> blocks, const double* c, double* norm,
                                           Joints joints) {
  constexpr std::size_t kPoints = PointBlock::kPoints;
  for (const PointBlock& block : blocks) {
    // Points innermost: every compiler puts those side by side into registers.
    double square[kPoints] = {};
    for (int axis = 0; axis < 3; ++axis) {
      double residual[kPoints];
      for (std::size_t point = 0; point < kPoints; ++point) residual[point] = block.right[axis][point];
      for (int joint = 0; joint < joints; ++joint) {
        for (std::size_t point = 0; point < kPoints; ++point)
          residual[point] -= block.matrix[axis][joint][point] * c[joint];
      }
      for (std::size_t point = 0; point < kPoints; ++point) square[point] += residual[point] * residual[point];
    }
    for (std::size_t point = 0; point < kPoints; ++point) norm[point] = std::sqrt(square[point]);
    norm += PointBlock::kPoints;
  }
}

}  // namespace

STIFFSCOPE_BY_PROCESSOR
void residualNorms(std::span<const PointBlock> blocks, const JointVector& compliance, std::span<double> norms) {
  if (compliance.size() == 6) return normsOf(blocks, compliance.data(), norms.data(), std::integral_constant<int, 6>());
  normsOf(blocks, compliance.data(), norms.data(), static_cast<int>(compliance.size()));
}

}  // namespace stiffscope::identification
