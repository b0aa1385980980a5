#include "core/planning/candidates.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::planning {

namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();

/// A joint whose figure is its angle has no element of its own.
campaign::JointReading readingOf(const std::vector<campaign::JointReading>& readings, int joint) {
  for (const campaign::JointReading& reading : readings) {
    if (reading.joint == joint) return reading;
  }
  return {joint};
}

robot::JointLimits turned(const robot::JointLimits& figures, const campaign::JointReading& reading) {
  const double one = reading.sign * figures.lower + reading.offset,
               other = reading.sign * figures.upper + reading.offset;
  return {std::min(one, other), std::max(one, other)};
}

/// Of the angle, by the limits of the figures that it is made of.
robot::JointLimits angleLimits(const JointRules& rules, const campaign::JointReading& reading) {
  const auto figures = [&](int joint) { return robot::JointLimits{rules.low[joint], rules.high[joint]}; };
  robot::JointLimits limits = turned(figures(reading.joint), reading);
  if (reading.plus >= 0) {
    limits.lower += figures(reading.plus).lower;
    limits.upper += figures(reading.plus).upper;
  }
  // One turn at most of a joint that turns on and on.
  constexpr double kHalfTurn = std::numbers::pi;
  if (limits.lower == -kOpen && limits.upper > -kHalfTurn) limits.lower = -kHalfTurn;
  if (limits.upper == kOpen && limits.lower < kHalfTurn) limits.upper = kHalfTurn;
  return limits;
}

[[noreturn]] void refuseEmpty(const robot::Robot& arm, const JointRules& rules, const campaign::JointReading& reading,
                              bool angles_too_large) {
  const int joint = reading.joint;
  const bool by_low = angles_too_large == (reading.sign > 0.0);
  robot::JointLimits own = arm.limits[static_cast<std::size_t>(joint)];
  std::string of_what;
  if (reading.plus >= 0) {
    of_what = fmt::format("; these are of the URDF's angle, to which joint {} adds", reading.plus + 1);
  } else if (reading.sign != 1.0 || reading.offset != 0.0) {
    own = turned(own, {joint, reading.sign, -reading.sign * reading.offset});
    of_what = ", as the controller states them";
  }
  throw io::InputError(
      {by_low ? "--min-deg" : "--max-deg"}, fmt::format("{:g}", (by_low ? rules.low : rules.high)[joint] / io::kDegree),
      fmt::format("expected a range of joint {} within its limits {:.1f} to {:.1f} deg less {:.0f} deg "
                  "at each end{}",
                  joint + 1, own.lower / io::kDegree, own.upper / io::kDegree, rules.limit_margin / io::kDegree,
                  of_what));
}

}  // namespace

PostureLimits::PostureLimits(const robot::Robot& arm, const std::vector<campaign::JointReading>& readings,
                             const JointRules& rules)
    : box_(arm.limits.size()), low_(rules.low.head(arm.joints())), high_(rules.high.head(arm.joints())) {
  for (int joint = 0; joint < arm.joints(); ++joint) {
    if (low_[joint] > high_[joint]) {
      throw io::InputError(
          {"--min-deg"}, fmt::format("{:g}", low_[joint] / io::kDegree),
          fmt::format("expected at most the {:g} of --max-deg for joint {}", high_[joint] / io::kDegree, joint + 1));
    }
    const campaign::JointReading reading = readingOf(readings, joint);
    const robot::JointLimits asked = angleLimits(rules, reading);
    const robot::JointLimits& own = arm.limits[static_cast<std::size_t>(joint)];
    robot::JointLimits& box = box_[static_cast<std::size_t>(joint)];
    box.lower = std::max(own.lower + rules.limit_margin, asked.lower);
    box.upper = std::min(own.upper - rules.limit_margin, asked.upper);
    if (box.lower > box.upper) refuseEmpty(arm, rules, reading, asked.lower > own.upper - rules.limit_margin);
    const bool limited = std::isfinite(low_[joint]) || std::isfinite(high_[joint]);
    if (reading.plus >= 0 && limited && !convention_) convention_.emplace(readings, arm.joints());
  }
}

bool PostureLimits::hold(const JointVector& q) const {
  if (!convention_) return true;
  constexpr double kRounding = 1e-9;  // rad
  const JointVector figures = convention_->figures(q);
  return (figures.array() >= low_.array() - kRounding).all() && (figures.array() <= high_.array() + kRounding).all();
}

}  // namespace stiffscope::planning
