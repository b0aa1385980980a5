#include "core/identification/subset_sample.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

using Postures = std::vector<std::uint32_t>;

/// Random subsets, each drawn from the order of the postures that the one before left.
class Draws {
 public:
  Draws(std::size_t postures, std::size_t size, std::uint64_t seed) : random_(seed), order_(postures), size_(size) {
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
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

/// Normal equations without what the symmetry of the matrix repeats.
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

/// Solves some subsets together: of each few postures, which then are in the nearest cache, what every subset uses.
class Solver {
 public:
  explicit Solver(const SubsetMethod& method)
      : method_(method), normal_(packed(method.normal)), reflectors_(packed(method.reflectors)) {}

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
  static std::vector<NormalEquations> sums(const std::vector<Packed>& all, const std::vector<Subset>& subsets) {
    constexpr std::size_t kPostures = 128;
    std::vector<Packed> sums(subsets.size());
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
        Packed sum = sums[k];
        for (std::size_t i = 0; i < count; ++i) sum += all[here[i]];
        sums[k] = sum;
      }
    }
    std::vector<NormalEquations> whole;
    for (const Packed& one : sums) whole.push_back(one.whole());
    return whole;
  }

  const SubsetMethod& method_;
  std::vector<Packed> normal_, reflectors_;
};

}  // namespace

std::vector<SubsetSums> sampleSubsets(const SubsetMethod& method, std::size_t size, std::size_t count,
                                      std::uint64_t seed) {
  // As many groups at the same time as keep many cores busy, and no more than some megabytes of drawn postures.
  constexpr std::size_t kGroup = 8, kDrawn = 500'000;
  const std::size_t at_once = kGroup * std::max<std::size_t>(4, kDrawn / size / kGroup);
  const Solver solver(method);
  std::vector<SubsetSums> sums((count + kGroup - 1) / kGroup);
  Draws draws(method.normal.size(), size, seed);
  std::vector<Postures> drawn, drawn_next;
  // A few to begin with, then twice as many each time: drawing goes on beside the work on what was drawn before.
  draws.next(std::min(count, kGroup), drawn);
  for (std::size_t done = 0; !drawn.empty(); done += drawn.size(), drawn.swap(drawn_next)) {
    const std::size_t groups = (drawn.size() + kGroup - 1) / kGroup;
    onAllCores(1 + groups, [&](std::size_t i) {
      if (i == 0) return draws.next(std::min({at_once, 2 * drawn.size(), count - done - drawn.size()}), drawn_next);
      const std::size_t from = (i - 1) * kGroup, to = std::min(drawn.size(), from + kGroup);
      std::vector<Subset> subsets = solver.solve(std::span(drawn).subspan(from, to - from));
      judgeSubsets(method, subsets);
      for (const Subset& one : subsets) add(one, sums[(done + from) / kGroup]);
    });
  }
  return sums;
}

}  // namespace stiffscope
