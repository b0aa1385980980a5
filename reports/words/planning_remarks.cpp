#include "core/planning/remarks.h"

#include <fmt/format.h>

#include "core/io/units.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string planningWords(planning::RemarkId id, const RemarkValues& values) {
  using enum planning::RemarkId;
  switch (id) {
    case cell_in_flange:
      return "a load cell in the flange, its axes the flange's: none is declared";
    case reflectors_on_ring:
      return fmt::format(
          "three reflectors on a ring of {:.0f} mm radius, {:.0f} mm ahead of the flange: the campaign gives no x_mm, "
          "y_mm, z_mm of its targets and no sweep places them",
          values.number(0) / io::kMillimetre, values.number(1) / io::kMillimetre);
    case load_of_step:
      return fmt::format("the load of the measured step {}: {:.0f} N", values.count(0), values.number(1));
    case load_where_measured: {
      const std::vector<double>& place = values.numbers(0);
      return fmt::format("the load acts at {:.0f} {:.0f} {:.0f} mm on the flange, where the measured wrenches have it",
                         1e3 * place[0], 1e3 * place[1], 1e3 * place[2]);
    }
    case load_at_cell:
      return fmt::format(
          "the load acts at the load cell's point: --hook says where it does, and a hook aside of axis {0} is what "
          "turns joint {0}",
          values.count(0));
    case tracker_not_placed:
      return "no line of sight is looked at, and noise is the same everywhere: where the tracker will stand is not "
             "known (--tracker)";
    case effects_as_known_now:
      return "the effects in the model, known as well as the measured postures know them; what else could hide is in "
             "no "
             "line of these uncertainties";
    case noise_not_declared:
      return fmt::format("{:.0f} um of noise in each coordinate of a reading: no tracker is declared",
                         1e6 * values.number(0));
    case usual_effects:
      return fmt::format("effects of a size that moves the reflectors by {:.2f} mm (rms), each unknown by that much",
                         values.number(0) / io::kMillimetre);
    case calibrated_before:
      return fmt::format(
          "arm, reflectors and tracker as the {} measured postures calibrate them; the model leaves {:.3f} mm in a "
          "coordinate, and will again",
          values.count(0), values.number(1) / io::kMillimetre);
    case sd_of_weighted_fit:
      return "of a fit of all joints together that weighs each reading by its noise: Partial Pose comes to 1.2 to 1.5 "
             "times it, Complete Pose and Decoupled Partial Pose to some times it; the load cell's noise and what "
             "effects could hide are not in it";
    case no_joint_seen:
      return "this load turns no joint enough to see its stiffness";
  }
  return {};
}

}  // namespace stiffscope::reports
