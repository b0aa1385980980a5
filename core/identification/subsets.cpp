#include "core/identification/subsets.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/identification/decoupled_partial_pose.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"

namespace stiffscope::identification {

/// One subset's result at one kind of point.
struct SubsetResidual {
  std::vector<double> left;  ///< per posture, m; empty where these points are not measured
  SubsetCompensation compensated;
};

/// One subset, solved and judged.
struct Subset {
  Eigen::ArrayXd used;  ///< a posture each: 1 where the subset uses it, else 0
  JointVector compliance;
  SubsetResidual at_wrist, at_targets;
};

/// Judges solved subsets: some at a time are quicker than one by one.
void evaluateSubsets(const SubsetMethod& method, std::span<Subset> subsets);

/// Results of some subsets, in the order in which they were added.
struct SubsetSums {
  std::vector<JointVector> compliances;
  SubsetJudgement at_wrist, at_targets;  ///< sums
  Eigen::ArrayXd held_out;               ///< subsets that leave each posture out
};

void add(const SubsetCompensation& one, SubsetCompensation& sum);
void add(const Subset& subset, SubsetSums& sums);

/// `count` random subsets of `size` postures, by the Mersenne twister of that seed, some in each of the sums, in
/// the order in which they are drawn; solved and judged on all cores, with the same results whatever their number.
std::vector<SubsetSums> sampleSubsets(const SubsetMethod& method, std::size_t size, std::size_t count,
                                      std::uint64_t seed);

namespace {

/// The order statistics at `shares` (ascending), each by partitioning only what lies above the one before.
template <std::size_t N>
std::array<double, N> quantiles(std::vector<double>& values, const std::array<double, N>& shares) {
  std::array<double, N> found{};
  auto from = values.begin();
  for (std::size_t k = 0; k < N; ++k) {
    const auto at = values.begin() + std::lround(shares[k] * static_cast<double>(values.size() - 1));
    std::nth_element(from, at, values.end());
    found[k] = *at;
    from = at;
  }
  return found;
}

}  // namespace

MeanOverSubsets meanOverSubsets(std::span<const double> values) {
  if (values.size() < 2) return {};
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), static_cast<Eigen::Index>(values.size()));
  const double mean = all.mean();
  return {mean, std::sqrt((all - mean).square().sum() / static_cast<double>(values.size() - 1))};
}

StiffnessSpread spreadOf(const SubsetStudy& study, int joint) {
  StiffnessSpread spread;
  std::vector<double> stiffness;
  stiffness.reserve(study.compliances.size());
  double sum = 0.0, square = 0.0, c_sum = 0.0, c_square = 0.0;
  for (const JointVector& compliance : study.compliances) {
    const double c = compliance[joint], k = 1.0 / c;
    stiffness.push_back(k);
    sum += k;
    c_sum += c;
    if (c < 0.0) spread.share_negative += 1.0;
  }
  const double n = static_cast<double>(stiffness.size());
  if (stiffness.size() < 2) return spread;
  spread.mean = sum / n;
  spread.compliance_mean = c_sum / n;
  for (const JointVector& compliance : study.compliances) {
    square += std::pow(1.0 / compliance[joint] - spread.mean, 2);
    c_square += std::pow(compliance[joint] - spread.compliance_mean, 2);
  }
  spread.sd = std::sqrt(square / (n - 1.0));
  spread.compliance_sd = std::sqrt(c_square / (n - 1.0));
  spread.share_negative /= n;
  const auto at = quantiles<5>(stiffness, {0.05, 0.25, 0.5, 0.75, 0.95});
  spread.low = at[0];
  spread.quartile_low = at[1];
  spread.median = at[2];
  spread.quartile_high = at[3];
  spread.high = at[4];
  return spread;
}

namespace {

using Postures = std::vector<std::uint32_t>;

void drawNext(numerics::SubsetDraws& draws, std::size_t count, std::vector<Postures>& drawn) {
  drawn.resize(count);
  for (Postures& one : drawn) {
    const std::span<const std::uint32_t> next = draws.next();
    one.assign(next.begin(), next.end());
  }
}

/// How many numbers normal equations have without what the symmetry of the matrix repeats, rounded up to an even one.
constexpr int packedSize(int joints) { return (joints * (joints + 1) / 2 + joints + 1) / 2 * 2; }

/// Normal equations as these numbers, `Numbers` or fewer; the others are zero.
template <int Numbers>
class Packed {
 public:
  Packed() = default;
  explicit Packed(const NormalEquations& normal) {
    // Of most machines by loops whose lengths the compiler knows.
    normal.right.size() == 6 ? take<6>(normal) : take<Eigen::Dynamic>(normal);
  }

  Packed& operator+=(const Packed& other) {
    numbers_ += other.numbers_;
    return *this;
  }

  NormalEquations whole(Eigen::Index joints) const {
    NormalEquations normal(joints);
    Eigen::Index at = 0;
    for (Eigen::Index j = 0; j < joints; at += joints - j, ++j) {
      normal.matrix.col(j).tail(joints - j) = numbers_.segment(at, joints - j);
      normal.matrix.row(j).tail(joints - j) = numbers_.segment(at, joints - j).transpose();
    }
    normal.right = numbers_.segment(at, joints);
    return normal;
  }

 private:
  template <int Joints>
  void take(const NormalEquations& normal) {
    const Eigen::Index joints = Joints == Eigen::Dynamic ? normal.right.size() : Joints;
    double* to = numbers_.data();
    for (Eigen::Index j = 0; j < joints; ++j) {
      const double* const column = normal.matrix.data() + j * joints;
      for (Eigen::Index i = j; i < joints; ++i) *to++ = column[i];
    }
    for (Eigen::Index i = 0; i < joints; ++i) *to++ = normal.right.data()[i];
  }

  Eigen::Matrix<double, Numbers, 1> numbers_ = Eigen::Matrix<double, Numbers, 1>::Zero();
};

template <int Numbers>
std::vector<Packed<Numbers>> packed(const std::vector<NormalEquations>& normal) {
  std::vector<Packed<Numbers>> all;
  all.reserve(normal.size());
  for (const NormalEquations& one : normal) all.emplace_back(one);
  return all;
}

/// Solves some subsets together: of each few postures, which then are in the nearest cache, what every subset uses.
template <int Numbers>
class Solver {
 public:
  explicit Solver(const SubsetMethod& method)
      : method_(method), normal_(packed<Numbers>(method.normal)), reflectors_(packed<Numbers>(method.reflectors)) {}

  std::vector<Subset> solve(std::span<const Postures> drawn) const {
    std::vector<Subset> subsets(drawn.size());
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      subsets[k].used.setZero(static_cast<Eigen::Index>(normal_.size()));
      for (const std::uint32_t posture : drawn[k]) subsets[k].used[posture] = 1.0;
    }
    const std::vector<NormalEquations> normal = sums(normal_, subsets), reflectors = sums(reflectors_, subsets);
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      subsets[k].compliance = solveSubset(method_, normal[k], reflectors[k]);
    }
    return subsets;
  }

 private:
  std::vector<NormalEquations> sums(const std::vector<Packed<Numbers>>& all, const std::vector<Subset>& subsets) const {
    constexpr std::size_t kPostures = 128;
    std::vector<Packed<Numbers>> sums(subsets.size());
    for (std::size_t from = 0; from < all.size(); from += kPostures) {
      const std::size_t size = std::min(kPostures, all.size() - from);
      for (std::size_t k = 0; k < subsets.size(); ++k) {
        const double* const used = subsets[k].used.data() + from;
        // Without a branch: which postures are used is as good as random.
        std::array<std::size_t, kPostures> here;
        std::size_t count = 0;
        for (std::size_t i = 0; i < size; ++i) {
          here[count] = from + i;
          count += used[i] != 0.0;
        }
        Packed<Numbers> sum = sums[k];
        for (std::size_t i = 0; i < count; ++i) sum += all[here[i]];
        sums[k] = sum;
      }
    }
    std::vector<NormalEquations> whole;
    const auto joints = static_cast<Eigen::Index>(method_.unknown.size());
    for (const Packed<Numbers>& one : sums) whole.push_back(one.whole(joints));
    return whole;
  }

  const SubsetMethod& method_;
  std::vector<Packed<Numbers>> normal_, reflectors_;
};

template <int Numbers>
std::vector<SubsetSums> sampleBy(const Solver<Numbers>& solver, const SubsetMethod& method, std::size_t size,
                                 std::size_t count, std::uint64_t seed) {
  // As many groups at the same time as keep many cores busy, and no more than some megabytes of drawn postures.
  constexpr std::size_t kGroup = 8, kDrawn = 500'000;
  const std::size_t at_once = kGroup * std::max<std::size_t>(4, kDrawn / size / kGroup);
  std::vector<SubsetSums> sums((count + kGroup - 1) / kGroup);
  numerics::SubsetDraws draws(method.normal.size(), size, seed);
  std::vector<Postures> drawn, drawn_next;
  // A few to begin with, then twice as many each time: drawing goes on beside the work on what was drawn before.
  drawNext(draws, std::min(count, kGroup), drawn);
  for (std::size_t done = 0; !drawn.empty(); done += drawn.size(), drawn.swap(drawn_next)) {
    const std::size_t groups = (drawn.size() + kGroup - 1) / kGroup;
    numerics::onAllCores(1 + groups, [&](std::size_t i) {
      if (i == 0)
        return drawNext(draws, std::min({at_once, 2 * drawn.size(), count - done - drawn.size()}), drawn_next);
      const std::size_t from = (i - 1) * kGroup, to = std::min(drawn.size(), from + kGroup);
      std::vector<Subset> subsets = solver.solve(std::span(drawn).subspan(from, to - from));
      evaluateSubsets(method, subsets);
      for (const Subset& one : subsets) add(one, sums[(done + from) / kGroup]);
    });
  }
  return sums;
}

}  // namespace

std::vector<SubsetSums> sampleSubsets(const SubsetMethod& method, std::size_t size, std::size_t count,
                                      std::uint64_t seed) {
  // Of most machines as few numbers as there are.
  if (method.unknown.size() <= 6) return sampleBy(Solver<packedSize(6)>(method), method, size, count, seed);
  return sampleBy(Solver<packedSize(kMostJoints)>(method), method, size, count, seed);
}

namespace {

using PostureArray = Eigen::Map<const Eigen::ArrayXd>;

PostureArray each(const std::vector<double>& posture) {
  return {posture.data(), static_cast<Eigen::Index>(posture.size())};
}

void judge(const DeflectionJudge& judge, std::span<Subset> subsets, SubsetResidual Subset::*points) {
  if (judge.postures() == 0) return;
  std::vector<JointVector> compliances;
  std::vector<std::vector<double>*> left;
  for (Subset& one : subsets) {
    compliances.push_back(one.compliance);
    left.push_back(&(one.*points).left);
  }
  judge.residuals(compliances, left);
  const PostureArray displacement = each(judge.displacement());
  const double whole = displacement.sum();
  for (Subset& one : subsets) {
    const PostureArray left = each((one.*points).left);
    const double left_used = (left * one.used).sum(), left_whole = left.sum(), used = (displacement * one.used).sum();
    (one.*points).compensated = {1.0 - left_used / used, 1.0 - (left_whole - left_used) / (whole - used),
                                 1.0 - left_whole / whole};
  }
}

void add(const SubsetResidual& one, const Eigen::ArrayXd& used, SubsetJudgement& sum) {
  if (one.left.empty()) return;
  add(one.compensated, sum.compensated);
  sum.held_out.push_back(one.compensated.held_out);
  sum.left_held_out.resize(one.left.size(), 0.0);
  Eigen::Map<Eigen::ArrayXd>(sum.left_held_out.data(), used.size()) += (1.0 - used) * each(one.left);
}

}  // namespace

JointVector solveSubset(const SubsetMethod& method, const NormalEquations& normal, const NormalEquations& reflectors) {
  return method.reflectors.empty() ? solveNormal(normal, method.unknown)
                                   : solveDecoupled(normal, reflectors, method.unknown);
}

void evaluateSubsets(const SubsetMethod& method, std::span<Subset> subsets) {
  judge(method.at_wrist, subsets, &Subset::at_wrist);
  judge(method.at_targets, subsets, &Subset::at_targets);
}

void add(const SubsetCompensation& one, SubsetCompensation& sum) {
  sum.used += one.used;
  sum.held_out += one.held_out;
  sum.all += one.all;
}

void add(const Subset& subset, SubsetSums& sums) {
  sums.compliances.push_back(subset.compliance);
  if (sums.held_out.size() == 0) sums.held_out.setZero(subset.used.size());
  sums.held_out += 1.0 - subset.used;
  add(subset.at_wrist, subset.used, sums.at_wrist);
  add(subset.at_targets, subset.used, sums.at_targets);
}

namespace {

/// All subsets whose two lowest postures are given: a depth-first walk that carries the sums of normal
/// equations along, about two additions a subset.
class Walk {
 public:
  Walk(const SubsetMethod& method, int size)
      : method_(method),
        n_(static_cast<int>(method.normal.size())),
        size_(size),
        normal_(static_cast<std::size_t>(size) + 1),
        reflectors_(static_cast<std::size_t>(size) + 1),
        subset_{Eigen::ArrayXd::Zero(n_), {}, {}, {}} {}

  void from(int first, SubsetSums& chunk) {
    take(0, first);
    descend(1, first + 1, chunk);
    subset_.used[first] = 0.0;
  }

 private:
  void take(int depth, int posture) {
    const auto d = static_cast<std::size_t>(depth), p = static_cast<std::size_t>(posture);
    normal_[d + 1] = normal_[d];
    normal_[d + 1] += method_.normal[p];
    if (!method_.reflectors.empty()) {
      reflectors_[d + 1] = reflectors_[d];
      reflectors_[d + 1] += method_.reflectors[p];
    }
    subset_.used[posture] = 1.0;
  }

  void descend(int depth, int next, SubsetSums& chunk) {
    if (depth == size_) {
      subset_.compliance = solveSubset(method_, normal_.back(), reflectors_.back());
      evaluateSubsets(method_, {&subset_, 1});
      add(subset_, chunk);
      return;
    }
    for (int posture = next; posture <= n_ - (size_ - depth); ++posture) {
      take(depth, posture);
      descend(depth + 1, posture + 1, chunk);
      subset_.used[posture] = 0.0;
    }
  }

  const SubsetMethod& method_;
  int n_, size_;
  std::vector<NormalEquations> normal_, reflectors_;
  Subset subset_;
};

std::vector<SubsetSums> walkAll(const SubsetMethod& method, int size) {
  const int n = static_cast<int>(method.normal.size());
  std::vector<SubsetSums> chunks(static_cast<std::size_t>(n - size + 1));
  numerics::onAllCores(chunks.size(),
                       [&](std::size_t first) { Walk(method, size).from(static_cast<int>(first), chunks[first]); });
  return chunks;
}

void addTo(SubsetJudgement& sum, const SubsetJudgement& other) {
  add(other.compensated, sum.compensated);
  sum.held_out.insert(sum.held_out.end(), other.held_out.begin(), other.held_out.end());
  sum.left_held_out.resize(other.left_held_out.size(), 0.0);
  for (std::size_t p = 0; p < other.left_held_out.size(); ++p) sum.left_held_out[p] += other.left_held_out[p];
}

void divide(SubsetJudgement& sum, double subsets, const Eigen::ArrayXd& held_out) {
  sum.compensated.used /= subsets;
  sum.compensated.held_out /= subsets;
  sum.compensated.all /= subsets;
  for (std::size_t p = 0; p < sum.left_held_out.size(); ++p) {
    sum.left_held_out[p] /= held_out[static_cast<Eigen::Index>(p)];
  }
}

}  // namespace

SubsetStudy studySubsets(const SubsetMethod& method, const SubsetOptions& options) {
  SubsetStudy study;
  study.of = static_cast<int>(method.normal.size());
  study.size = options.size > 0 ? options.size : static_cast<int>(std::lround(study.of * 10.0 / 19.0));
  if (study.size < 1 || study.size >= study.of) return study;
  study.every_subset = numerics::subsetCount(study.of, study.size) <= options.most_all;
  std::vector<SubsetSums> chunks;
  if (study.every_subset) {
    chunks = walkAll(method, study.size);
  } else {
    constexpr std::uint64_t kWork = 2'000'000;  // postures added in all: keeps ten thousand postures quick
    const std::uint64_t affordable = std::max<std::uint64_t>(200, kWork / static_cast<std::uint64_t>(study.of));
    chunks =
        sampleSubsets(method, static_cast<std::size_t>(study.size), std::min(options.sample, affordable), options.seed);
  }
  Eigen::ArrayXd held_out = Eigen::ArrayXd::Zero(study.of);
  for (const SubsetSums& chunk : chunks) {
    study.compliances.insert(study.compliances.end(), chunk.compliances.begin(), chunk.compliances.end());
    held_out += chunk.held_out;
    addTo(study.at_wrist, chunk.at_wrist);
    addTo(study.at_targets, chunk.at_targets);
  }
  const double subsets = static_cast<double>(study.compliances.size());
  divide(study.at_wrist, subsets, held_out);
  divide(study.at_targets, subsets, held_out);
  return study;
}

}  // namespace stiffscope::identification
