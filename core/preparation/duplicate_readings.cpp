#include "core/preparation/repeatability.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/campaign/repeated_keys.h"
#include "core/campaign/row_names.h"
#include "core/numerics/distributions.h"
#include "core/preparation/remarks.h"

namespace stiffscope::preparation {

namespace {

// Of one reflector at one place, as far as the commanded state says; a small load moves it by less than the last digit.
bool atOnePlace(const campaign::LoadingReading& a, const campaign::LoadingReading& b) {
  return a.pose == b.pose && a.target == b.target;
}
bool atOnePlace(const campaign::CircleReading& a, const campaign::CircleReading& b) {
  return a.target == b.target && a.q == b.q;
}
bool atOnePlace(const campaign::WristReading& a, const campaign::WristReading& b) {
  return a.target == b.target && a.q == b.q;
}
bool atOnePlace(const campaign::RailReading& a, const campaign::RailReading& b) {
  return a.target == b.target && a.rail == b.rail;
}
bool atOnePlace(const campaign::NestReading& a, const campaign::NestReading& b) { return a.nest == b.nest; }

/// The last digit that all coordinates are written with, m; 0 where they are written more finely than any noise.
template <class Row>
double lastDigit(const std::vector<Row>& rows) {
  for (const double digit : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    constexpr double kRounding = 1e-4;  // of a digit: 100 m in double precision keep it
    const bool whole = std::all_of(rows.begin(), rows.end(), [&](const Row& row) {
      const Eigen::Array3d digits = row.point.array() / digit;
      return ((digits - digits.round()).abs() < kRounding).all();
    });
    if (whole) return digit;
  }
  return 0.0;
}

/// That two readings there are written alike.
double chanceOfSameDigits(double digit, const Eigen::Vector3d& sd) {
  double chance = 1.0;
  for (const double s : sd) chance *= std::min(1.0, digit / (2.0 * std::sqrt(std::numbers::pi) * s));
  return chance;
}

}  // namespace

std::vector<RejectedReading> duplicateReadings(const campaign::Campaign& campaign) {
  std::vector<RejectedReading> found;
  const std::optional<metrology::TrackerNoise> noise = declaredNoise(campaign);
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    std::vector<RejectedReading> at_one_place;
    double chance = 0.0;  // of the likeliest pair
    std::optional<double> digit;
    campaign::RepeatCheck seen(table.rows.size());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto& row = table.rows[i];
      campaign::KeyHash place;
      for (const double coordinate : row.point) place.add(coordinate);
      const std::size_t first =
          seen.add(i, place, [&](std::size_t other) { return table.rows[other].point == row.point; });
      if (first == campaign::RepeatCheck::kNew) continue;
      const auto& earlier = table.rows[first];
      const RejectedReading reading{table.file, row.line, Remark(RemarkId::same_as_line, earlier.line)};
      if (!atOnePlace(row, earlier)) {
        found.push_back(reading);
        continue;
      }
      at_one_place.push_back(reading);
      if (!digit) digit = lastDigit(table.rows);
      constexpr double kGoodTracker = 5e-6;  // m: what is not known to be worse
      Eigen::Vector3d sd = Eigen::Vector3d::Constant(kGoodTracker);
      if (noise && table.frame == campaign::PointFrame::tracker)
        sd = noise->covarianceAt(row.point, row.from).diagonal().cwiseSqrt();
      chance = std::max(chance, chanceOfSameDigits(*digit, sd));
    }
    constexpr double kByChance = 1e-3;
    const double expected = chance * static_cast<double>(table.rows.size());  // a pair a reading, about
    if (numerics::poissonTail(at_one_place.size(), expected) < kByChance)
      found.insert(found.end(), at_one_place.begin(), at_one_place.end());
  });
  return found;
}

}  // namespace stiffscope::preparation
