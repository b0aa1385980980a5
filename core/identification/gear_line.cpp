#include "core/identification/gear_states.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/numerics/resampling.h"

namespace stiffscope::identification {

namespace {

/// Angles are written to 1e-5 deg, so that a difference of two scatters by as much at least.
constexpr double kLeastScatter = 1.7e-7;  // rad

/// A state this many robust standard deviations from the line is a wrong reading: one in a million is not by chance.
constexpr double kWrongReading = 5.0;

constexpr std::size_t kFewestTurns = 3;  ///< postures whose torque turns round, for a lost motion

/// Value with a weight; see weightedMedian.
struct Weighted {
  double value, weight;
};

double weightedMedian(std::vector<Weighted> values) {
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  const double half = 0.5 * std::accumulate(values.begin(), values.end(), 0.0,
                                            [](double sum, const Weighted& one) { return sum + one.weight; });
  double below = 0.0;
  for (const Weighted& one : values) {
    below += one.weight;
    if (below >= half) return one.value;
  }
  return 0.0;
}

/// Slope and lost motion that single wrong readings do not move.
struct RobustLine {
  double slope = 0.0, width = 0.0;
};

/// By differences of two states of a posture: the slope from those whose torques have one sign, the lost motion from
/// the others. Where no two have one sign the slope is from all, and no lost motion is looked for.
RobustLine robustLine(const JointStates& joint) {
  std::vector<Weighted> slopes, all_slopes, widths;
  const auto forPairs = [&](const auto& work) {
    joint.byPosture([&](std::size_t from, std::size_t to) {
      for (std::size_t a = from; a < to; ++a) {
        for (std::size_t b = a + 1; b < to; ++b) work(a, b);
      }
    });
  };
  forPairs([&](std::size_t a, std::size_t b) {
    const double turned = joint.torque[b] - joint.torque[a];
    if (turned == 0.0) return;
    const Weighted slope{(joint.windup[b] - joint.windup[a]) / turned, std::abs(turned)};
    all_slopes.push_back(slope);
    if (joint.side[a] == joint.side[b]) slopes.push_back(slope);
  });
  if (slopes.empty()) return {weightedMedian(std::move(all_slopes)), 0.0};
  const double slope = weightedMedian(std::move(slopes));
  forPairs([&](std::size_t a, std::size_t b) {
    const double sides = joint.side[b] - joint.side[a];
    if (sides == 0.0) return;
    const double rest = joint.windup[b] - joint.windup[a] - slope * (joint.torque[b] - joint.torque[a]);
    widths.push_back({rest / sides, std::abs(sides)});
  });
  return {slope, weightedMedian(std::move(widths))};
}

bool turnsRound(const JointStates& joint, const std::vector<double>& side, const std::vector<double>& torque) {
  std::size_t turns = 0;
  joint.byPosture([&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (side[i] != 0.0) {
        ++turns;
        break;
      }
    }
  });
  if (turns < kFewestTurns) return false;
  constexpr double kAlike = 0.98;  // correlation beyond which the two columns cannot be told apart
  const double product = dot(side, torque);
  return product * product < kAlike * kAlike * dot(side, side) * dot(torque, torque);
}

}  // namespace

void leaveOutWrongReadings(JointStates& joint) {
  const auto [slope, width] = robustLine(joint);
  std::vector<double> residual(joint.size()), sizes;
  const std::size_t postures = joint.posture_end.size();
  if (joint.size() <= postures) return;
  joint.byPosture([&, slope = slope, width = width](std::size_t from, std::size_t to) {
    std::vector<double> own;
    for (std::size_t i = from; i < to; ++i) {
      own.push_back(joint.windup[i] - slope * joint.torque[i] - width * joint.side[i]);
    }
    const double level = numerics::median(own);
    for (std::size_t i = from; i < to; ++i) residual[i] = own[i - from] - level;
  });
  for (const double one : residual) sizes.push_back(std::abs(one));
  // 1.4826: from the median of absolute values to a normal standard deviation; the levels take their degrees of
  // freedom.
  const double n = static_cast<double>(joint.size());
  const double scatter = 1.4826 * numerics::median(sizes) * std::sqrt(n / (n - static_cast<double>(postures)));
  const double most = kWrongReading * std::max(scatter, kLeastScatter);
  for (std::size_t i = 0; i < joint.size(); ++i) joint.used[i] = std::abs(residual[i]) <= most;
}

std::vector<double> withinPostures(const JointStates& joint, const std::vector<double>& column) {
  std::vector<double> within(column.size(), 0.0);
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      if (joint.used[i]) sum += column[i], ++count;
    }
    for (std::size_t i = from; i < to; ++i) {
      if (joint.used[i]) within[i] = column[i] - sum / count;
    }
  });
  return within;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<double> acrossOf(std::vector<double> a, const std::vector<double>& b) {
  const double factor = dot(a, b) / dot(b, b);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= factor * b[i];
  return a;
}

JointColumns columnsOf(const JointStates& joint) {
  JointColumns columns{withinPostures(joint, joint.torque), withinPostures(joint, joint.windup),
                       withinPostures(joint, joint.reported), withinPostures(joint, joint.side)};
  if (!turnsRound(joint, columns.side, columns.torque)) columns.side.clear();
  if (columns.side.empty()) return columns;
  columns.torque = acrossOf(std::move(columns.torque), columns.side);
  columns.windup = acrossOf(std::move(columns.windup), columns.side);
  columns.reported = acrossOf(std::move(columns.reported), columns.side);
  return columns;
}

Slope slopeOf(const JointStates& joint, const std::vector<double>& column, const std::vector<double>& values,
              const std::vector<double>& residual) {
  const double square = dot(column, column);
  double squares = 0.0, postures = 0.0;
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double sum = 0.0, any = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += column[i] * residual[i], any += column[i] * column[i];
    squares += sum * sum;
    postures += any > 0.0;
  });
  const double rest = postures > 1.0 ? postures / (postures - 1.0) : 0.0;
  return {dot(column, values) / square, std::sqrt(squares * rest) / square};
}

std::vector<double> residualOf(const std::vector<double>& values, const std::vector<double>& column, double slope) {
  std::vector<double> residual(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) residual[i] = values[i] - slope * column[i];
  return residual;
}

Slope slopeOf(const JointStates& joint, const std::vector<double>& column, const std::vector<double>& values) {
  return slopeOf(joint, column, values, residualOf(values, column, dot(column, values) / dot(column, column)));
}

}  // namespace stiffscope::identification
