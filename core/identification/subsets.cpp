#include "core/identification/subsets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/subset_sample.h"
#include "core/parallel/on_all_cores.h"

namespace stiffscope {

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
      judgeSubsets(method_, {&subset_, 1});
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
  onAllCores(chunks.size(),
             [&](std::size_t first) { Walk(method, size).from(static_cast<int>(first), chunks[first]); });
  return chunks;
}

void addTo(SubsetJudgement& sum, const SubsetJudgement& other) {
  add(other.compensated, sum.compensated);
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

std::uint64_t subsetCount(int n, int m) {
  std::uint64_t count = 1;
  for (int i = 1; i <= m; ++i) {
    const auto factor = static_cast<std::uint64_t>(n - m + i);
    if (count > std::numeric_limits<std::uint64_t>::max() / factor)
      return std::numeric_limits<std::uint64_t>::max();
    count = count * factor / static_cast<std::uint64_t>(i);
  }
  return count;
}

SubsetStudy studySubsets(const SubsetMethod& method, const SubsetOptions& options) {
  SubsetStudy study;
  study.of = static_cast<int>(method.normal.size());
  study.size = options.size > 0 ? options.size : static_cast<int>(std::lround(study.of * 10.0 / 19.0));
  if (study.size < 1 || study.size >= study.of) return study;
  study.every_subset = subsetCount(study.of, study.size) <= options.most_all;
  std::vector<SubsetSums> chunks;
  if (study.every_subset) {
    chunks = walkAll(method, study.size);
  } else {
    constexpr std::uint64_t kWork = 2'000'000;  // postures added in all: keeps ten thousand postures quick
    const std::uint64_t affordable =
        std::max<std::uint64_t>(200, kWork / static_cast<std::uint64_t>(study.of));
    chunks = sampleSubsets(method, static_cast<std::size_t>(study.size), std::min(options.sample, affordable),
                           options.seed);
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

}  // namespace stiffscope
