#include "core/identification/subsets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "core/identification/decoupled_partial_pose.h"
#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

/// Results of the subsets of one chunk, in their order.
struct Chunk {
  std::vector<Vector6d> compliances;
  SubsetJudgement at_wrist, at_targets;  // sums
  std::vector<std::uint64_t> held_out;   // subsets that leave each posture out
};

/// One subset's result at one kind of point.
struct Judged {
  std::vector<double> left;  ///< per posture, m; empty where these points are not measured
  SubsetCompensation compensated;
};

/// One subset, solved and judged.
struct Subset {
  std::vector<char> used;  ///< a posture each
  Vector6d compliance;
  Judged at_wrist, at_targets;
};

// Adding 0 instead of branching: which postures are used is as good as random.
double where(bool condition, double value) { return condition ? value : 0.0; }

void judge(const DeflectionJudge& judge, const Subset& subset, Judged& judged) {
  if (judge.postures() == 0) return;
  judge.residual(subset.compliance, judged.left);
  double left_used = 0.0, left_held_out = 0.0, used = 0.0, held_out = 0.0;
  for (std::size_t p = 0; p < judged.left.size(); ++p) {
    const bool in = subset.used[p] != 0;
    left_used += where(in, judged.left[p]);
    left_held_out += where(!in, judged.left[p]);
    used += where(in, judge.displacement()[p]);
    held_out += where(!in, judge.displacement()[p]);
  }
  judged.compensated = {1.0 - left_used / used, 1.0 - left_held_out / held_out,
                        1.0 - (left_held_out + left_used) / (held_out + used)};
}

/// Solves and judges the subset whose postures `used` names and whose equations these are.
void solve(const SubsetMethod& method, const NormalEquations& normal, const NormalEquations& reflectors, Subset& subset) {
  subset.compliance = method.reflectors.empty() ? solveNormal(normal, method.unknown)
                                                : solveDecoupled(normal, reflectors, method.unknown);
  judge(method.at_wrist, subset, subset.at_wrist);
  judge(method.at_targets, subset, subset.at_targets);
}

void add(const SubsetCompensation& one, SubsetCompensation& sum) {
  sum.used += one.used;
  sum.held_out += one.held_out;
  sum.all += one.all;
}

void add(const Judged& one, const std::vector<char>& used, SubsetJudgement& sum) {
  if (one.left.empty()) return;
  add(one.compensated, sum.compensated);
  sum.left_held_out.resize(one.left.size(), 0.0);
  for (std::size_t p = 0; p < one.left.size(); ++p) sum.left_held_out[p] += where(used[p] == 0, one.left[p]);
}

void add(const Subset& subset, Chunk& chunk) {
  chunk.compliances.push_back(subset.compliance);
  chunk.held_out.resize(subset.used.size(), 0);
  for (std::size_t p = 0; p < subset.used.size(); ++p) chunk.held_out[p] += subset.used[p] == 0;
  add(subset.at_wrist, subset.used, chunk.at_wrist);
  add(subset.at_targets, subset.used, chunk.at_targets);
}

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
        subset_{std::vector<char>(method.normal.size(), 0), {}, {}, {}} {}

  void from(int first, Chunk& chunk) {
    take(0, first);
    descend(1, first + 1, chunk);
    subset_.used[static_cast<std::size_t>(first)] = 0;
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
    subset_.used[p] = 1;
  }

  void descend(int depth, int next, Chunk& chunk) {
    if (depth == size_) {
      solve(method_, normal_.back(), reflectors_.back(), subset_);
      add(subset_, chunk);
      return;
    }
    for (int posture = next; posture <= n_ - (size_ - depth); ++posture) {
      take(depth, posture);
      descend(depth + 1, posture + 1, chunk);
      subset_.used[static_cast<std::size_t>(posture)] = 0;
    }
  }

  const SubsetMethod& method_;
  int n_, size_;
  std::vector<NormalEquations> normal_, reflectors_;
  Subset subset_;
};

std::vector<Chunk> walkAll(const SubsetMethod& method, int size) {
  const int n = static_cast<int>(method.normal.size());
  std::vector<Chunk> chunks(static_cast<std::size_t>(n - size + 1));
  onAllCores(chunks.size(),
             [&](std::size_t first) { Walk(method, size).from(static_cast<int>(first), chunks[first]); });
  return chunks;
}

/// Random subsets, each drawn from the order of the postures that the one before left.
class Sample {
 public:
  Sample(std::size_t postures, std::size_t size, std::uint64_t seed) : random_(seed), order_(postures), size_(size) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  /// Postures of the next subset, as they were drawn.
  std::vector<std::size_t> next() {
    for (std::size_t i = 0; i < size_; ++i) {
      std::swap(order_[i], order_[i + random_() % (order_.size() - i)]);  // Fisher-Yates; the bias of % is below 1e-15 here
    }
    return {order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(size_)};
  }

 private:
  std::mt19937_64 random_;
  std::vector<std::size_t> order_;
  std::size_t size_;
};

void solveDrawn(const SubsetMethod& method, const std::vector<std::size_t>& drawn, Subset& subset) {
  subset.used.assign(method.normal.size(), 0);
  NormalEquations normal, reflectors;
  for (const std::size_t posture : drawn) {
    subset.used[posture] = 1;
    normal += method.normal[posture];
    if (!method.reflectors.empty()) reflectors += method.reflectors[posture];
  }
  solve(method, normal, reflectors, subset);
}

/// Drawn and summed in their order; in between, some at a time, on all cores.
Chunk drawSample(const SubsetMethod& method, std::size_t size, std::size_t count, std::uint64_t seed) {
  constexpr std::size_t kResiduals = 200'000;  // a posture and subset each, held at the same time
  const std::size_t n = method.normal.size(), at_once = std::max<std::size_t>(16, kResiduals / n);
  Chunk chunk;
  Sample sample(n, size, seed);
  std::vector<Subset> subsets(std::min(count, at_once));
  std::vector<std::vector<std::size_t>> drawn(subsets.size());
  for (std::size_t done = 0; done < count; done += at_once) {
    const std::size_t more = std::min(at_once, count - done);
    for (std::size_t k = 0; k < more; ++k) drawn[k] = sample.next();
    onAllCores(more, [&](std::size_t k) { solveDrawn(method, drawn[k], subsets[k]); });
    for (std::size_t k = 0; k < more; ++k) add(subsets[k], chunk);
  }
  return chunk;
}

void addTo(SubsetJudgement& sum, const SubsetJudgement& other) {
  add(other.compensated, sum.compensated);
  sum.left_held_out.resize(other.left_held_out.size(), 0.0);
  for (std::size_t p = 0; p < other.left_held_out.size(); ++p) sum.left_held_out[p] += other.left_held_out[p];
}

void divide(SubsetJudgement& sum, double subsets, const std::vector<std::uint64_t>& held_out) {
  sum.compensated.used /= subsets;
  sum.compensated.held_out /= subsets;
  sum.compensated.all /= subsets;
  for (std::size_t p = 0; p < sum.left_held_out.size(); ++p) {
    sum.left_held_out[p] /= static_cast<double>(held_out[p]);
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
  std::vector<Chunk> chunks;
  if (study.every_subset) {
    chunks = walkAll(method, study.size);
  } else {
    constexpr std::uint64_t kWork = 2'000'000;  // postures added in all: keeps ten thousand postures quick
    const std::uint64_t affordable =
        std::max<std::uint64_t>(200, kWork / static_cast<std::uint64_t>(study.of));
    chunks.push_back(drawSample(method, static_cast<std::size_t>(study.size), std::min(options.sample, affordable), options.seed));
  }
  std::vector<std::uint64_t> held_out(static_cast<std::size_t>(study.of), 0);
  for (const Chunk& chunk : chunks) {
    study.compliances.insert(study.compliances.end(), chunk.compliances.begin(), chunk.compliances.end());
    for (std::size_t p = 0; p < held_out.size(); ++p) held_out[p] += chunk.held_out[p];
    addTo(study.at_wrist, chunk.at_wrist);
    addTo(study.at_targets, chunk.at_targets);
  }
  const double subsets = static_cast<double>(study.compliances.size());
  divide(study.at_wrist, subsets, held_out);
  divide(study.at_targets, subsets, held_out);
  return study;
}

}  // namespace stiffscope
