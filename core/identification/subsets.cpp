#include "core/identification/subsets.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "core/identification/decoupled_partial_pose.h"

namespace stiffscope {

namespace {

/// Results of the subsets of one chunk, in their order.
struct Chunk {
  std::vector<Vector6d> compliances;
  SubsetJudgement at_wrist, at_targets;  // sums
  std::vector<std::uint64_t> held_out;   // subsets that leave each posture out
};

/// Solves and judges one subset after another; each thread has its own.
class Solver {
 public:
  explicit Solver(const SubsetMethod& method) : method_(method) {}

  void add(const NormalEquations& normal, const NormalEquations& reflectors, const std::vector<char>& used,
           Chunk& chunk) {
    const Vector6d compliance = method_.reflectors.empty()
                                    ? solveNormal(normal, method_.unknown)
                                    : solveDecoupled(normal, reflectors, method_.unknown);
    chunk.compliances.push_back(compliance);
    chunk.held_out.resize(used.size(), 0);
    for (std::size_t p = 0; p < used.size(); ++p) chunk.held_out[p] += used[p] == 0;
    judge(method_.at_wrist, compliance, used, chunk.at_wrist);
    judge(method_.at_targets, compliance, used, chunk.at_targets);
  }

 private:
  void judge(const DeflectionJudge& judge, const Vector6d& compliance, const std::vector<char>& used,
             SubsetJudgement& sum) {
    if (judge.postures() == 0) return;
    judge.residual(compliance, residual_);
    sum.left_held_out.resize(residual_.size(), 0.0);
    std::array<double, 2> left{}, whole{};
    for (std::size_t p = 0; p < residual_.size(); ++p) {
      const auto side = static_cast<std::size_t>(used[p] != 0);
      left[side] += residual_[p];
      whole[side] += judge.displacement()[p];
      if (side == 0) sum.left_held_out[p] += residual_[p];
    }
    sum.compensated.used += 1.0 - left[1] / whole[1];
    sum.compensated.held_out += 1.0 - left[0] / whole[0];
    sum.compensated.all += 1.0 - (left[0] + left[1]) / (whole[0] + whole[1]);
  }

  const SubsetMethod& method_;
  std::vector<double> residual_;
};

/// All subsets whose two lowest postures are given: a depth-first walk that carries the sums of normal
/// equations along, about two additions a subset.
class Walk {
 public:
  Walk(const SubsetMethod& method, int size)
      : method_(method),
        solver_(method),
        n_(static_cast<int>(method.normal.size())),
        size_(size),
        normal_(static_cast<std::size_t>(size) + 1),
        reflectors_(static_cast<std::size_t>(size) + 1),
        used_(method.normal.size(), 0) {}

  void from(int first, Chunk& chunk) {
    take(0, first);
    descend(1, first + 1, chunk);
    used_[static_cast<std::size_t>(first)] = 0;
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
    used_[p] = 1;
  }

  void descend(int depth, int next, Chunk& chunk) {
    if (depth == size_) {
      solver_.add(normal_.back(), reflectors_.back(), used_, chunk);
      return;
    }
    for (int posture = next; posture <= n_ - (size_ - depth); ++posture) {
      take(depth, posture);
      descend(depth + 1, posture + 1, chunk);
      used_[static_cast<std::size_t>(posture)] = 0;
    }
  }

  const SubsetMethod& method_;
  Solver solver_;
  int n_, size_;
  std::vector<NormalEquations> normal_, reflectors_;
  std::vector<char> used_;
};

std::vector<Chunk> walkAll(const SubsetMethod& method, int size) {
  const int n = static_cast<int>(method.normal.size());
  std::vector<Chunk> chunks(static_cast<std::size_t>(n - size + 1));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    Walk walk(method, size);
    for (std::size_t at = next++; at < chunks.size(); at = next++)
      walk.from(static_cast<int>(at), chunks[at]);
  };
  std::thread helper(work);
  work();
  helper.join();
  return chunks;
}

Chunk drawSample(const SubsetMethod& method, int size, std::uint64_t count, std::uint64_t seed) {
  Chunk chunk;
  Solver solver(method);
  std::mt19937_64 random(seed);
  const std::size_t n = method.normal.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<char> used(n);
  for (std::uint64_t k = 0; k < count; ++k) {
    NormalEquations normal, reflectors;
    std::fill(used.begin(), used.end(), 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
      std::swap(order[i], order[i + random() % (n - i)]);  // Fisher-Yates; the bias of % is below 1e-15 here
      used[order[i]] = 1;
      normal += method.normal[order[i]];
      if (!method.reflectors.empty()) reflectors += method.reflectors[order[i]];
    }
    solver.add(normal, reflectors, used, chunk);
  }
  return chunk;
}

void addTo(SubsetJudgement& sum, const SubsetJudgement& other) {
  sum.compensated.used += other.compensated.used;
  sum.compensated.held_out += other.compensated.held_out;
  sum.compensated.all += other.compensated.all;
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
    chunks.push_back(drawSample(method, study.size, std::min(options.sample, affordable), options.seed));
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
