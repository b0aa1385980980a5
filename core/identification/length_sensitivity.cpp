#include "core/identification/method_runs.h"

#include <algorithm>
#include <cmath>

#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"

namespace stiffscope::identification {

namespace {

/// Sums of squares of displacements and of rotations.
struct BlockSquares {
  double displacement = 0.0, rotation = 0.0;

  explicit BlockSquares(const std::vector<CaseEquations>& pose_rows) {
    for (const CaseEquations& one : pose_rows) {
      displacement += one.right.head<3>().squaredNorm();
      rotation += one.right.tail<3>().squaredNorm();
    }
  }
};

/// What the compliances leave of them: b^T b - 2 c^T A^T b + c^T A^T A c.
double leftOf(double squares, const NormalEquations& normal, const JointVector& compliance) {
  return squares + compliance.dot(normal.matrix * compliance - 2.0 * normal.right);
}

std::vector<PoseNormal> poseNormalByPosture(const std::vector<CaseEquations>& pose_rows) {
  std::vector<PoseNormal> postures;
  postures.reserve(pose_rows.size());
  for (std::size_t i = 0; i < pose_rows.size(); ++i) {
    if (i == 0 || !sharePosture(pose_rows[i - 1], pose_rows[i])) postures.emplace_back();
    postures.back().add(pose_rows[i]);
  }
  return postures;
}

PoseNormal sumOfAll(const std::vector<PoseNormal>& postures) {
  PoseNormal sum;
  for (const PoseNormal& one : postures) sum += one;
  return sum;
}

/// Complete Pose at any length.
class LengthStudy {
 public:
  LengthStudy(const MethodResult& method, const SubsetOptions& options)
      : postures_(poseNormalByPosture(method.pose_rows)), sum_(sumOfAll(postures_)), options_(options) {
    subset_.unknown = method.estimate.identifiable;
    if (!method.wrist_rows.empty()) subset_.at_wrist = DeflectionJudge::byPosture(method.wrist_rows);
    subset_.at_targets = DeflectionJudge::byPosture(method.target_rows);
  }

  void solve(LengthSensitivity& at) {
    at.compliance = solveNormal(sum_.at(at.length), subset_.unknown);
    subset_.normal.resize(postures_.size());
    numerics::smallWorkOnAllCores(postures_.size(),
                                  [&](std::size_t p) { subset_.normal[p] = postures_[p].at(at.length); });
    const SubsetStudy study = studySubsets(subset_, options_);
    at.subsets = study.compliances.size();
    const auto judged = [&](const DeflectionJudge& judge, const SubsetJudgement& own) {
      return Compensation{judge.compensated(at.compliance), own.compensated, meanOverSubsets(own.held_out).sd};
    };
    if (subset_.at_wrist.postures() > 0) at.at_wrist = judged(subset_.at_wrist, study.at_wrist);
    at.at_targets = judged(subset_.at_targets, study.at_targets);
  }

 private:
  std::vector<PoseNormal> postures_;
  PoseNormal sum_;
  SubsetOptions options_;
  SubsetMethod subset_;
};

}  // namespace

std::optional<double> residualVarianceLength(const std::vector<CaseEquations>& pose_rows,
                                             const robot::JointMask& unknown, double start) {
  if (pose_rows.empty()) return std::nullopt;
  const auto sum = numerics::sumInBlocks<PoseNormal>(pose_rows.size(),
                                                     [&](std::size_t i, PoseNormal& all) { all.add(pose_rows[i]); });
  constexpr int kMostRounds = 100;
  constexpr double kClose = 1e-9;
  const BlockSquares whole(pose_rows);
  double length = start;
  for (int round = 0; round < kMostRounds; ++round) {
    const JointVector compliance = solveNormal(sum.at(length), unknown);
    const double next = std::sqrt(leftOf(whole.displacement, sum.displacements, compliance) /
                                  leftOf(whole.rotation, sum.rotations, compliance));
    if (!(next >= kShortestLength && next <= kLongestLength)) return std::nullopt;
    if (std::abs(next - length) <= kClose * length) return next;
    length = next;
  }
  return std::nullopt;
}

std::vector<LengthSensitivity> shownLengths(const CharacteristicLength& chosen) {
  constexpr std::size_t kEvery = 5;
  std::vector<LengthSensitivity> shown;
  for (std::size_t i = 0; i < chosen.curve.size(); i += kEvery) {
    LengthSensitivity& one = shown.emplace_back();
    one.length = chosen.curve[i].first;
    one.condition = chosen.curve[i].second;
  }
  return shown;
}

SubsetOptions subsetsOfALength(const SubsetOptions& asked, std::size_t postures, std::size_t lengths) {
  constexpr std::uint64_t kMost = 500, kLeast = 20, kWork = 500'000;  // postures added over all lengths
  const std::uint64_t affordable =
      std::clamp<std::uint64_t>(kWork / std::max<std::uint64_t>(1, postures * lengths), kLeast, kMost);
  SubsetOptions few = asked;
  few.most_all = std::min(asked.most_all, affordable);
  few.sample = std::min(asked.sample, affordable);
  return few;
}

void studyLengths(const std::vector<LoadCase>& cases, const IdentifyOptions& options, Identification& result) {
  const MethodResult& method = result.of(Method::complete_pose);
  result.length_sensitivity = shownLengths(result.characteristic_length);
  const std::optional<double> residual =
      residualVarianceLength(method.pose_rows, method.estimate.identifiable, result.characteristic_length.length);
  const std::size_t lengths = result.length_sensitivity.size() + 1;
  LengthStudy study(method, subsetsOfALength(options.subsets, method.pose_rows.size(), lengths));
  for (LengthSensitivity& one : result.length_sensitivity) study.solve(one);
  if (!residual) return;
  LengthSensitivity& own = result.residual_length.emplace();
  own.length = *residual;
  own.condition = jacobianCondition(cases, result.frames.tcp_in_flange, own.length);
  study.solve(own);
}

}  // namespace stiffscope::identification
