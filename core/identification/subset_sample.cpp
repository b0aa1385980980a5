#include "core/identification/subset_sample.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

using Postures = std::vector<std::size_t>;

/// Random subsets, each drawn from the order of the postures that the one before left.
class Draws {
 public:
  Draws(std::size_t postures, std::size_t size, std::uint64_t seed) : random_(seed), order_(postures), size_(size) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  /// The next subsets, postures as they were drawn.
  void next(std::size_t count, std::vector<Postures>& drawn) {
    drawn.resize(count);
    for (Postures& one : drawn) {
      for (std::size_t i = 0; i < size_; ++i) {
        std::swap(order_[i], order_[i + random_() % (order_.size() - i)]);  // Fisher-Yates; the bias of % is below 1e-15 here
      }
      one.assign(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(size_));
    }
  }

 private:
  std::mt19937_64 random_;
  Postures order_;
  std::size_t size_;
};

/// Normal equations without what the symmetry of the matrix repeats: postures drawn at random lie far apart in memory.
class Packed {
 public:
  Packed() = default;
  explicit Packed(const NormalEquations& normal) {
    Eigen::Index at = 0;
    for (Eigen::Index j = 0; j < 6; at += 6 - j, ++j) numbers_.segment(at, 6 - j) = normal.matrix.col(j).tail(6 - j);
    numbers_.segment<6>(at) = normal.right;
  }

  Packed& operator+=(const Packed& other) {
    numbers_ += other.numbers_;
    return *this;
  }

  NormalEquations whole() const {
    NormalEquations normal;
    Eigen::Index at = 0;
    for (Eigen::Index j = 0; j < 6; at += 6 - j, ++j) {
      normal.matrix.col(j).tail(6 - j) = numbers_.segment(at, 6 - j);
      normal.matrix.row(j).tail(6 - j) = numbers_.segment(at, 6 - j).transpose();
    }
    normal.right = numbers_.segment<6>(at);
    return normal;
  }

 private:
  Eigen::Matrix<double, 28, 1> numbers_ = Eigen::Matrix<double, 28, 1>::Zero();  // the last is none: an even number
};

std::vector<Packed> packed(const std::vector<NormalEquations>& normal) {
  std::vector<Packed> all;
  all.reserve(normal.size());
  for (const NormalEquations& one : normal) all.emplace_back(one);
  return all;
}

class Solver {
 public:
  explicit Solver(const SubsetMethod& method)
      : method_(method), normal_(packed(method.normal)), reflectors_(packed(method.reflectors)) {}

  void solve(const Postures& drawn, Subset& subset) const {
    subset.used.assign(normal_.size(), 0);
    for (const std::size_t posture : drawn) subset.used[posture] = 1;
    subset.compliance = solveSubset(method_, sum(normal_, drawn), sum(reflectors_, drawn));
  }

 private:
  static NormalEquations sum(const std::vector<Packed>& all, const Postures& drawn) {
    Packed sum;
    if (all.empty()) return {};
    for (const std::size_t posture : drawn) sum += all[posture];
    return sum.whole();
  }

  const SubsetMethod& method_;
  std::vector<Packed> normal_, reflectors_;
};

}  // namespace

SubsetSums sampleSubsets(const SubsetMethod& method, std::size_t size, std::size_t count, std::uint64_t seed) {
  // As many groups at the same time as keep many cores busy, and no more than a few megabytes of residuals.
  constexpr std::size_t kGroup = 8, kResiduals = 320'000;
  const std::size_t n = method.normal.size(), at_once = kGroup * std::max<std::size_t>(4, kResiduals / n / kGroup);
  const Solver solver(method);
  SubsetSums sums;
  Draws draws(n, size, seed);
  std::vector<Postures> drawn, drawn_next;
  std::vector<Subset> subsets, subsets_before;
  // A few to begin with: drawing them is the one thing that nothing else is done beside.
  draws.next(std::min(count, kGroup), drawn);
  for (std::size_t done = 0; !drawn.empty(); done += drawn.size(), drawn.swap(drawn_next), subsets.swap(subsets_before)) {
    const std::size_t groups = (drawn.size() + kGroup - 1) / kGroup;
    subsets.resize(drawn.size());
    // The first index draws what comes next, the second adds what came before; the others have a group each.
    onAllCores(2 + groups, [&](std::size_t i) {
      if (i == 0) {
        draws.next(std::min(at_once, count - done - drawn.size()), drawn_next);
      } else if (i == 1) {
        for (const Subset& one : subsets_before) add(one, sums);
      } else {
        const std::size_t from = (i - 2) * kGroup, to = std::min(drawn.size(), from + kGroup);
        for (std::size_t k = from; k < to; ++k) solver.solve(drawn[k], subsets[k]);
        judgeSubsets(method, std::span(subsets).subspan(from, to - from));
      }
    });
  }
  for (const Subset& one : subsets_before) add(one, sums);
  return sums;
}

}  // namespace stiffscope
