#include "core/compensation/remarks.h"

#include <fmt/format.h>
#include <cmath>

#include "core/io/units.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string compensationWords(compensation::RemarkId id, const RemarkValues& values) {
  using enum compensation::RemarkId;
  const auto degrees = [&](std::size_t place) { return values.number(place) / io::kDegree; };
  switch (id) {
    case unloaded_arm_does_not_rest:
      return "the unloaded arm does not come to rest under its own weight";
    case loaded_arm_does_not_rest:
      return "the loaded arm does not come to rest: the load is too large for these stiffnesses";
    case posture_outside_limits:
      return fmt::format("joint {} stands at {:.3f} deg, outside its limits {:.1f} to {:.1f} deg", values.count(0),
                         degrees(1), degrees(2), degrees(3));
    case command_outside_limits:
      return fmt::format("joint {} would have to go to {:.3f} deg, outside its limits {:.1f} to {:.1f} deg",
                         values.count(0), degrees(1), degrees(2), degrees(3));
    case follower_outside_limits:
      return fmt::format(
          "axis '{}', which follows other joints, would stand at {:.3f} deg, outside its limits {:.1f} to "
          "{:.1f} deg",
          values.name(0), degrees(1), degrees(2), degrees(3));
    case balancer_outside_stroke:
      return fmt::format("balancer {} would be {:.1f} mm long, outside its stroke", values.count(0),
                         values.number(1) / io::kMillimetre);
    case near_singularity:
      return fmt::format("too near a singularity: conditioning {:.4f}, at least {:g} is asked for", values.number(0),
                         values.number(1));
    case turns_joint_of_negative_k:
      return fmt::format("the load turns axis {} by {:.0f} Nm and k{} came out negative: no spring has that",
                         values.count(0), values.number(1), values.count(0));
    case turns_joint_of_unknown_k:
      return fmt::format(
          "the load turns axis {} by {:.0f} Nm and k{} is not known: the deflection shown lacks its part",
          values.count(0), values.number(1), values.count(0));
    case steps_do_not_converge:
      return "the steps towards the wanted pose do not converge";
    case load_far_beyond:
      return fmt::format(
          "the load is {:.1f} times the largest that the stiffnesses come from; beyond {:g} times nothing the day "
          "showed "
          "says how the arm gives",
          values.number(0), values.number(1));
    case posture_far_beyond:
      return fmt::format(
          "joint {} stands at {:.1f} deg, more than {:.0f} deg outside the {:.1f} to {:.1f} deg that the stiffnesses "
          "come "
          "from",
          values.count(0), degrees(1), degrees(4), degrees(2), degrees(3));
    case uncertainty_unknown:
      return "the postures are too few for an uncertainty of the deflection";
    case uncertain_as_itself:
      return fmt::format(
          "U of {:.3f} mm is as large as the deflection of {:.3f} mm: the day says too little of such a load in such a "
          "posture",
          values.number(0) / io::kMillimetre, values.number(1) / io::kMillimetre);
    case load_beyond:
      return fmt::format("the load is {:.1f} times the largest that the stiffnesses come from", values.number(0));
    case torque_beyond:
      return fmt::format("axis {} is turned by {:.0f} Nm, where the stiffnesses come from {:.0f} Nm at most",
                         values.count(0), values.number(1), values.number(2));
    case posture_beyond:
      return fmt::format(
          "joint {} stands at {:.1f} deg, outside the {:.1f} to {:.1f} deg that the stiffnesses come from",
          values.count(0), degrees(1), degrees(2), degrees(3));
    case uncertain:
      return fmt::format("U is {:.3f} mm, more than half of the deflection of {:.3f} mm",
                         values.number(0) / io::kMillimetre, values.number(1) / io::kMillimetre);
    case turn_left:
      return fmt::format(
          "the commands leave the flange turned by {:.4f} deg: {:+.4f} deg about x0, {:+.4f} deg about y0, {:+.4f} deg "
          "about z0",
          degrees(0), degrees(1), degrees(2), degrees(3));
    case position_first:
      return fmt::format(
          "a machine of {} joints cannot bring the flange back in position and orientation: the commands bring "
          "P_TCP "
          "back, and the orientation as far as the remaining freedom allows; what is left is said of each posture",
          values.count(0));
    case least_turns:
      return fmt::format(
          "of the many corrections that {} joints allow the commands are the one with the least sum of squares of the "
          "joints' turns",
          values.count(0));
    case implausible_command:
      return fmt::format(
          "posture {} would turn joint {} by {:.1f} deg, which no load does to a sound arm: its wrench "
          "may not be in N and Nm",
          values.name(0), values.count(1), degrees(2));
  }
  return {};
}

}  // namespace stiffscope::reports
