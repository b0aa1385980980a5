#include "core/compensation/remarks.h"

#include <fmt/format.h>

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
    case implausible_command:
      return fmt::format(
          "posture {} would turn joint {} by {:.1f} deg, which no load does to a sound arm: its wrench "
          "may not be in N and Nm",
          values.name(0), values.count(1), degrees(2));
  }
  return {};
}

}  // namespace stiffscope::reports
