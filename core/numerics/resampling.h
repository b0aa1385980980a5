#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <utility>
#include <vector>

// Which postures take part, and how often: bootstrap samples, subsets, leave-one-out. What is solved on them is the
// caller's. Everything is seeded: std::mt19937_64 is fully specified by the standard, and so is what is done with its
// words.

namespace stiffscope::numerics {

/// How often each takes part.
using Weights = std::vector<double>;

/// Value below which `share` of the ascending values lie, linear between neighbours. Needs at least one value.
double quantile(const std::vector<double>& ascending, double share);
/// The same of values in any order, which need not be sorted for one.
double quantileOf(std::vector<double> values, double share);

/// From and to where `share` of ascending draws lie, as short as it can be: what they leave out is shared out between
/// both ends in ten steps, since the very shortest follows the draws' chance. Needs at least one value.
std::pair<double, double> shortestInterval(const std::vector<double>& ascending, double share);

/// The middle value; for an even number of values the mean of the two in the middle, 0 for none.
double median(std::vector<double> values);
/// The middle value; for an even number of values the higher of the two in the middle. Needs at least one value.
double upperMedian(std::vector<double> values);

/// A random index below `count`; the bias of % is below 1e-15 for a few thousand.
inline std::size_t randomIndex(std::mt19937_64& random, std::size_t count) { return random() % count; }

/// A bootstrap sample (Efron): calls visit(index) `count` times with an index below `count`.
template <class Visit>
void drawWithReplacement(std::mt19937_64& random, std::size_t count, const Visit& visit) {
  for (std::size_t draw = 0; draw < count; ++draw) visit(randomIndex(random, count));
}

/// The same sample as weights.
Weights drawWeights(std::mt19937_64& random, std::size_t count);

/// What the spread of a bootstrap over `count` lacks: drawing with replacement shrinks the variance by (n - 1) / n, and
/// a 95 % quantile of draws knows nothing of the variance's own error, which Student's t does. Two at least.
double spreadOfFew(double count);

/// How far below and above their middle 95 % of bootstrap draws over `count` reach, widened by spreadOfFew.
struct BootstrapSpread {
  double middle = 0.0, below = 0.0, above = 0.0;
};
BootstrapSpread bootstrapSpread(std::vector<double> draws, double count);

/// All but one.
Weights leaveOneOut(std::size_t count, std::size_t left_out);

/// Number of subsets of m out of n; saturates at the largest 64-bit value.
std::uint64_t subsetCount(int n, int m);

/// Random subsets of a size, each drawn (Fisher-Yates) from the order that the one before left.
class SubsetDraws {
 public:
  SubsetDraws(std::size_t count, std::size_t size, std::uint64_t seed);

  /// The next subset's indices as they were drawn; valid until the next call.
  std::span<const std::uint32_t> next();

 private:
  std::mt19937_64 random_;
  std::vector<std::uint32_t> order_;
  std::size_t size_;
};

/// Calls `visit` with every subset of m of n as weights, those of the lowest indices first; with `most` drawn ones
/// where there are more subsets than that.
void forEachSubset(int n, int m, std::uint64_t most, std::uint64_t seed,
                   const std::function<void(const Weights&)>& visit);

}  // namespace stiffscope::numerics
