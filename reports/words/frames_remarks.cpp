#include <fmt/format.h>
#include <array>

#include "core/frames/remarks.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string framesWords(frames::RemarkId id, const RemarkValues& values) {
  using frames::RemarkId;
  static constexpr std::array<const char*, 4> kAxisParameters{"place (u)", "place (v)", "direction (u)",
                                                              "direction (v)"};
  switch (id) {
    case RemarkId::no_circle_sweeps:
      return "the campaign has no circle sweeps";
    case RemarkId::not_swept:
      return "it was not swept";
    case RemarkId::other_joints_moved:
      return "other joints moved during its sweep";
    case RemarkId::coupled_joints:
      return "a joint that turns several axes ('mimic' in the URDF) moves the reflectors on circles without a common "
             "axis: all axes are found together from all sweeps";
    case RemarkId::coupled_axes_not_placed:
      return "joints are coupled ('mimic' in the URDF), and the sweeps show fewer than three reflectors in three "
             "postures, or do not turn the flange";
    case RemarkId::coupled_flange_level:
      return "joints are coupled ('mimic' in the URDF) and the flange stays level: reflectors on it show where axes "
             "and they themselves stand in sum only, so that the axes stay the URDF's; Partial Pose finds the base by "
             "unloaded postures";
    case RemarkId::coupled_axes_not_settling:
      return "joints are coupled ('mimic' in the URDF), and the fit of all axes to the sweeps does not settle: "
             "readings and URDF contradict each other";
    case RemarkId::earlier_axis_not_known:
      return fmt::format("axis {} stood away from zero during its sweep and is not measured itself", values.count(0));
    case RemarkId::wrist_turns_arm:
      return "joints are coupled ('mimic' in the URDF), and one of the wrist's turns axes before the wrist, so that no "
             "point stands apart from it";
    case RemarkId::no_wrist_sweep:
      return "the campaign has no wrist sweep";
    case RemarkId::r0_not_in_frame_of_readings:
      return "R0 is not known in the frame of the readings: axes 1 and 2 were not swept";
    case RemarkId::wrist_sweep_in_other_frame:
      return "the wrist sweep's readings are in another frame than the circle sweeps'";
    case RemarkId::arm_moved_in_wrist_sweep:
      return fmt::format("axes 1-{} moved during the wrist sweep", values.count(0));
    case RemarkId::wrist_reflectors_under_four:
      return "no reflector has four readings in the wrist sweep";
    case RemarkId::sag_without_stiffness:
      return "no stiffness is known, so the arm's own sag is left in";
    case RemarkId::sag_without_masses:
      return "the robot's link masses are not known, so the arm's own sag is left in";
    case RemarkId::sag_taken_off:
      return "the arm's own sag is taken off the readings by the identified stiffnesses and the URDF's masses";
    case RemarkId::sag_by_known_stiffness:
      return "the arm's own sag is taken off the readings by the stiffnesses that the campaign states and the URDF's "
             "masses";
    case RemarkId::sag_allowed_for:
      return fmt::format(
          "of some joints no stiffness is known, so the sag by them is left in; the uncertainties have what it does "
          "where "
          "such a joint turns by {:.0f} mrad (one standard uncertainty, a judgement) under the largest torque of the "
          "own "
          "weight in the sweeps",
          1e3 * values.number(0));
    case RemarkId::no_unloaded_positions:
      return "there are no absolute unloaded positions (loading, step 0) to calibrate on";
    case RemarkId::base_not_placed:
      return "the base's place is not known from sweeps, and finding it from postures needs three "
             "reflectors in three postures that turn the flange about different axes, or about one while it goes to "
             "places that are on no one circle about that axis; differences need no place: a table `displacements` "
             "with frame=\"base_link\", and each `target` with its x_mm y_mm z_mm on the flange, identifies without it";
    case RemarkId::too_few_positions:
      return fmt::format("{} unloaded positions do not determine {} parameters", values.count(0), values.count(1));
    case RemarkId::calibration_not_settling:
      return "the calibration did not converge: " + values.name(0);
    case RemarkId::axis_parameter:
      return fmt::format("axis {} {}", values.count(0), kAxisParameters.at(static_cast<std::size_t>(values.count(1))));
    case RemarkId::base_against_reflectors:
      return fmt::format(
          "{} combination{} of the base's place with the reflectors' on the flange, which no posture tells apart: of a "
          "flange that stays level, how high they stand, which turns no spring",
          values.count(0), values.count(0) == 1 ? "" : "s");
    case RemarkId::no_absolute_readings:
      return "no absolute readings unloaded: measure `loading` with step 0";
    case RemarkId::tracker_noise_not_declared:
      return "the tracker's noise is not declared: state `tracker` in campaign.xml";
    case RemarkId::axis_not_measured:
      return fmt::format("axis {} is not measured: {}", values.count(0), words(values.remark(1)));
    case RemarkId::loading_in_other_frame:
      return "the loading's readings are in another frame than the sweeps'";
  }
  return {};
}

}  // namespace stiffscope::reports
