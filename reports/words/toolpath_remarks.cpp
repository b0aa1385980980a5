#include "core/toolpath/remarks.h"

#include <fmt/format.h>

#include "core/io/units.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string toolpathWords(toolpath::RemarkId id, const RemarkValues& values) {
  using enum toolpath::RemarkId;
  switch (id) {
    case not_reached:
      return fmt::format("no joint angles hold the tool there: the nearest ones miss it by {:.1f} mm and {:.1f} deg",
                         values.number(0) / io::kMillimetre, values.number(1) / io::kDegree);
    case leaves_branch:
      return fmt::format("joint {} would jump by {:.0f} deg: the path leads through a singularity", values.count(0),
                         values.number(1) / io::kDegree);
    case no_feed_direction:
      return "the tool moves along its axis, or not at all: the process load has no direction of feed";
    case arm_does_not_rest:
      return "the arm that its own weight bends does not come to rest at the pose";
    case fewer_than_six_joints:
      return fmt::format(
          "a machine of {} joints holds a tool at some poses only, and which one is meant a path does not say: give "
          "joint angles, as postures or as a program",
          values.count(0));
  }
  return {};
}

}  // namespace stiffscope::reports
