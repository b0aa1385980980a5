#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <tuple>

#include "core/campaign/repeated_keys.h"
#include "core/campaign/row_names.h"
#include "core/numerics/distributions.h"
#include "core/preparation/declared_noise.h"
#include "core/preparation/remarks.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::preparation {

namespace {

// Of one reflector at one place, as far as the commanded state says; a small load moves it by less than the last digit.
bool atOnePlace(const campaign::LoadingReading& a, const campaign::LoadingReading& b) {
  return a.station == b.station && a.pose == b.pose && a.target == b.target;
}
bool atOnePlace(const campaign::CircleReading& a, const campaign::CircleReading& b) {
  return a.station == b.station && a.target == b.target && a.q == b.q;
}
bool atOnePlace(const campaign::WristReading& a, const campaign::WristReading& b) {
  return a.station == b.station && a.target == b.target && a.q == b.q;
}
bool atOnePlace(const campaign::RailReading& a, const campaign::RailReading& b) {
  return a.station == b.station && a.target == b.target && a.rail == b.rail;
}
bool atOnePlace(const campaign::NestReading& a, const campaign::NestReading& b) {
  return a.station == b.station && a.nest == b.nest;
}

// What readings at one place have in common.
void addPlace(const campaign::LoadingReading& row, campaign::KeyHash& place) {
  place.add(row.pose);
  place.add(row.target);
}
void addPlace(const campaign::CircleReading& row, campaign::KeyHash& place) {
  place.add(row.target);
  for (const double angle : row.q) place.add(angle);
}
void addPlace(const campaign::WristReading& row, campaign::KeyHash& place) {
  place.add(row.target);
  for (const double angle : row.q) place.add(angle);
}
void addPlace(const campaign::RailReading& row, campaign::KeyHash& place) {
  place.add(row.target);
  place.add(row.rail);
}
void addPlace(const campaign::NestReading& row, campaign::KeyHash& place) { place.add(row.nest); }

int stepOf(const campaign::LoadingReading& row) { return row.step; }
template <class Row>
int stepOf(const Row&) {
  return 0;
}

/// Repeats of one reflector at one place under one load.
struct RepeatsUnderLoad {
  double count = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();  ///< of a reading
};

/// That two readings are written with the same digits in one coordinate, `apart` what their true values differ by.
/// Two that differ by x are where none of the digits' limits falls between them, in 1 - |x| / digit of all cases; that
/// on average over x, normal with sqrt(2) sd.
double chanceOfSameDigits(double digit, double sd, double apart) {
  const double spread = std::numbers::sqrt2 * sd;
  const auto meanAbove = [&](double limit) {  // of max(x - limit, 0)
    const double z = (apart - limit) / spread;
    const double below = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
    return spread * (z * below + density);
  };
  return std::max(0.0, (meanAbove(-digit) - 2.0 * meanAbove(0.0) + meanAbove(digit)) / digit);
}

/// Pairs that come out alike of all that these repeats make, one of `a` with one of `b`.
double expectedPairs(double digit, const RepeatsUnderLoad& a, const RepeatsUnderLoad& b, double pairs, bool same) {
  constexpr double kSigmas = 2.0;  // by which their means may be nearer to each other than they look
  const double mean_sd = same ? 0.0 : kSigmas * std::sqrt(1.0 / a.count + 1.0 / b.count);
  double chance = 1.0;
  for (int c = 0; c < 3; ++c) {
    const double apart = same ? 0.0 : std::max(0.0, std::abs(a.mean[c] - b.mean[c]) - mean_sd * a.sd[c]);
    chance *= chanceOfSameDigits(digit, a.sd[c], apart);
  }
  return pairs * chance;
}

/// The noise of readings, as far as chance goes by it.
class ReadingNoise {
 public:
  /// `typical`: how far repeats scatter, in parts of the declared noise and of the rounding.
  ReadingNoise(const std::optional<metrology::TrackerNoise>& declared, double typical)
      : declared_(declared), typical_(std::min(1.0, typical)) {}

  /// Standard deviations whose product is that of the noise's own directions, which need not be those of the axes.
  Eigen::Vector3d at(const Eigen::Vector3d& point, const Eigen::Vector3d& from, double digit) const {
    constexpr double kGoodTracker = 5e-6;  // m: what is not known to be worse
    if (!declared_) return Eigen::Vector3d::Constant(kGoodTracker);
    const Eigen::Matrix3d covariance = declared_->covarianceAt(point, from);
    const Eigen::Vector3d variances = covariance.diagonal();
    const double rounding = digit * digit / (4.0 * covariance.trace());  // digit^2 / 12 over the mean variance
    // Copies scatter less than readings: all of them copies must not pass for a quiet tracker.
    constexpr double kQuietest = 0.25 * 0.25;
    const double quiet = std::clamp(typical_ * typical_ * (1.0 + rounding) - rounding, kQuietest, 1.0);
    return std::sqrt(quiet) * std::pow(covariance.determinant() / variances.prod(), 1.0 / 6.0) * variances.cwiseSqrt();
  }

 private:
  std::optional<metrology::TrackerNoise> declared_;
  double typical_;
};

/// How many pairs of a table's readings at one place chance makes alike.
template <class Row>
double expectedByChance(const std::vector<Row>& rows, double digit, const ReadingNoise& noise) {
  if (digit == 0.0) return 0.0;
  struct Placed {
    std::uint64_t place;
    int step;
    std::size_t row;
  };
  std::vector<Placed> placed;
  placed.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    campaign::KeyHash place;
    place.add(rows[i].station);
    addPlace(rows[i], place);
    placed.push_back({place.value(), stepOf(rows[i]), i});
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.place, a.step, a.row) < std::tie(b.place, b.step, b.row);
  });
  double expected = 0.0;
  std::vector<RepeatsUnderLoad> here;  // of one place, load by load
  for (auto first = placed.begin(); first != placed.end();) {
    const bool another_place = first == placed.begin() || (first - 1)->place != first->place;
    if (another_place) here.clear();
    const auto end = std::find_if(
        first, placed.end(), [&](const Placed& one) { return one.place != first->place || one.step != first->step; });
    RepeatsUnderLoad repeats;
    repeats.count = static_cast<double>(end - first);
    for (auto one = first; one != end; ++one) repeats.mean += rows[one->row].point / repeats.count;
    repeats.sd = noise.at(rows[first->row].point, rows[first->row].from, digit);
    expected += expectedPairs(digit, repeats, repeats, 0.5 * repeats.count * (repeats.count - 1.0), true);
    for (const RepeatsUnderLoad& other : here)
      expected += expectedPairs(digit, repeats, other, repeats.count * other.count, false);
    here.push_back(repeats);
    first = end;
  }
  return expected;
}

}  // namespace

std::vector<RejectedReading> duplicateReadings(const campaign::Campaign& campaign) {
  std::vector<RejectedReading> found;
  const std::optional<metrology::TrackerNoise> declared = declaredNoise(campaign);
  std::optional<double> typical;
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    std::vector<RejectedReading> at_one_place;
    campaign::RepeatCheck seen(table.rows.size());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto& row = table.rows[i];
      campaign::KeyHash place;
      for (const double coordinate : row.point) place.add(coordinate);
      const std::size_t first =
          seen.add(i, place, [&](std::size_t other) { return table.rows[other].point == row.point; });
      if (first == campaign::RepeatCheck::kNew) continue;
      const auto& earlier = table.rows[first];
      auto& like = atOnePlace(row, earlier) ? at_one_place : found;
      like.push_back({table.file, row.line, Remark(RemarkId::same_as_line, earlier.line)});
    }
    if (at_one_place.empty()) return;
    if (!typical) typical = repeatScatter(campaign, roundingOf(campaign).arm).typical;
    const bool tracked = table.frame == campaign::PointFrame::tracker;
    const double expected =
        expectedByChance(table.rows, lastDigit(table.rows), ReadingNoise(tracked ? declared : std::nullopt, *typical));
    // A thousandth a day, which has five tables at most. The noise is known to a tenth, what it makes of pairs to a
    // third.
    constexpr double kByChance = 1e-3 / 5.0, kMost = 4.0 / 3.0;
    if (numerics::poissonTail(at_one_place.size(), kMost * expected) < kByChance)
      found.insert(found.end(), at_one_place.begin(), at_one_place.end());
  });
  return found;
}

}  // namespace stiffscope::preparation
