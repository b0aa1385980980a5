#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <string>
#include <vector>

#include "core/identification/remarks.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

/// Values: see RemarkId::two_joints_combined.
std::string twoJointsWords(const RemarkValues& values) {
  const std::int64_t a = values.count(0), b = values.count(1);
  const double ratio = values.number(2);
  return fmt::format(
      "these postures only see a combination of joints {}, {}: the two move the reflectors in proportion in every "
      "posture, so that only 1/k{} {} {:.3g}/k{} is determined; postures in which axis {} stands otherwise to the load "
      "than axis {} would part them",
      a, b, a, ratio < 0.0 ? "-" : "+", std::abs(ratio), b, a, b);
}

/// Values: see RemarkId::joints_combined.
std::string jointsWords(const RemarkValues& values) {
  const std::vector<std::int64_t>& joints = values.counts(0);
  const std::vector<double>& steps = values.numbers(1);
  std::string terms;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    terms +=
        i == 0 ? fmt::format("1/k{}", joints[i])
               : fmt::format(" {} {:.3g} at 1/k{}", steps[i] < 0.0 ? "and -" : "and +", std::abs(steps[i]), joints[i]);
  }
  return fmt::format("these postures only see a combination of joints {}: adding +1 at {} changes no displacement",
                     fmt::join(joints, ", "), terms);
}

std::string implausibleWords(const identification::ApparentStiffness& apparent) {
  using namespace identification;
  const double value = apparent.value();
  const bool beyond_any = value < kSofterThanAnyArm || value > kStifferThanAnyArm;
  return fmt::format(
      "{:.4g} N rms move the reflectors by {:.4g} mm rms, {:.2g} N/mm, and six-axis arms give from about {:.0f} to "
      "{:.0f} N/mm: {}{} in another unit",
      apparent.force, apparent.displacement / io::kMillimetre, value * io::kMillimetre, kSoftArm * io::kMillimetre,
      kStiffArm * io::kMillimetre, beyond_any ? "" : "perhaps ",
      value < kSoftArm ? "forces (kN for N) or lengths (um for mm)" : "forces (mN for N) or lengths (m for mm)");
}

/// Values: see RemarkId::outlying_postures.
std::string outlyingWords(const RemarkValues& values) {
  const std::vector<std::string>& names = values.names(0);
  const std::vector<double>&left = values.numbers(1), &others = values.numbers(2);
  const bool one = names.size() == 1, left_out = values.count(3) != 0;
  std::vector<std::string> postures;
  for (std::size_t i = 0; i < names.size(); ++i) {
    postures.push_back(fmt::format("{} ({:.0f} µm per coordinate against {:.0f} µm of the others)", names[i],
                                   left[i] / io::kMicrometre, others[i] / io::kMicrometre));
  }
  return fmt::format("outlying posture{}: {}: the springs of the other postures do not explain {}; {}", one ? "" : "s",
                     fmt::join(postures, ", "), one ? "it" : "them",
                     left_out ? "left out as asked" : "used nevertheless; `identify --robust` leaves out");
}

}  // namespace

std::string identificationWords(identification::RemarkId id, const RemarkValues& values) {
  using identification::RemarkId;
  switch (id) {
    case RemarkId::no_states:
      return "no 'states': joint angles and load-cell readings are needed to identify";
    case RemarkId::no_load_cell:
      return "no 'load_cell': where the measured wrench acts is needed to identify";
    case RemarkId::no_readings_under_load:
      return "neither 'loading' nor 'displacements': readings under load are needed to identify";
    case RemarkId::displacements_not_placed:
      return "the displacements are in the tracker's frame: circle sweeps of axes 1 and 2 would place it, or "
             "frame=\"base_link\" if they are in the robot's";
    case RemarkId::loading_not_placed:
      return "the loading's readings cannot be brought into R0: circle sweeps of axes 1 and 2 would place them";
    case RemarkId::no_posture_in_both_states:
      return "no posture has readings unloaded and under this load";
    case RemarkId::no_joint_turned:
      return "the load turns no joint enough to see its stiffness";
    case RemarkId::flange_pose_not_everywhere:
      return "a flange pose needs three reflectors, placed by circle sweeps, in every posture";
    case RemarkId::flange_pose_by_displacements:
      return fmt::format(
          "a flange pose needs absolute positions of three reflectors; this campaign has displacements of {} point(s): "
          "measure `loading` with three",
          values.count(0));
    case RemarkId::wrist_point_not_everywhere:
      return "P_wrist needs absolute readings of three reflectors of known radius in every posture: measure `loading` "
             "and the wrist sweep with three";
    case RemarkId::wrist_centre_not_measured:
      return "the wrist centre is not measured: " + words(values.remark(0));
    case RemarkId::wrist_sweep_wanted:
      return words(values.remark(0)) + "; measure a wrist sweep (axes 4-6 moving) and `loading` with three reflectors";
    case RemarkId::wrist_sweep_wanted_too:
      return words(values.remark(0)) + "; and P_wrist needs a wrist sweep (axes 4-6 moving) with three reflectors";
    case RemarkId::wrist_axes_apart:
      return fmt::format(
          "the wrist's axes do not meet (4 and 5 miss by {:.3f} mm, 5 and 6 by {:.3f} mm): turning in joints 4-6 moves "
          "P_wrist by {:.1f} % of its displacement, more than the {:.0f} % that decoupling bears",
          1e3 * values.number(0), 1e3 * values.number(1), 100.0 * values.number(2), 100.0 * values.number(3));
    case RemarkId::geometry_not_calibrated:
      return "the geometry cannot be calibrated: " + words(values.remark(0));
    case RemarkId::displacements_by_model_only:
      return "the campaign has displacements only, no absolute positions: the URDF's geometry stands";
    case RemarkId::points_on_axis:
      return fmt::format("the measured points stand {:.2f} mm rms from axis {}: its turning does not move them",
                         1e3 * values.number(1), values.count(0));
    case RemarkId::load_hangs:
      return fmt::format(
          "the load only hangs and does not turn axis {}: {:.1f} Nm rms of torque, of which a load along gravity gives "
          "{:.1f} Nm",
          values.count(0), values.number(1), values.number(2));
    case RemarkId::load_turns_too_little:
      return fmt::format(
          "the load turns axis {} by {:.1f} Nm rms, no more than {:g} times the {:.1f} Nm that wrench, frame and angle "
          "uncertainty put there",
          values.count(0), values.number(1), values.number(2), values.number(3));
    case RemarkId::two_joints_combined:
      return twoJointsWords(values);
    case RemarkId::joints_combined:
      return jointsWords(values);
    case RemarkId::no_state_of_step:
      return "no state of this load step";
    case RemarkId::no_reflector_in_both_states:
      return "no reflector was read both unloaded and in this load step";
    case RemarkId::under_three_reflectors:
      return "fewer than three reflectors read in both states";
    case RemarkId::no_wrist_point:
      return "no P_wrist from reflectors of known radius";
    case RemarkId::disagrees:
      return fmt::format("disagrees with the other postures by {:.0f} µm per coordinate, {:.1f} times theirs",
                         values.number(0) / io::kMicrometre, values.number(1));
    case RemarkId::in_step:
      return fmt::format("{} (step {})", words(values.remark(0)), values.count(1));
    case RemarkId::geometry_missed:
      return fmt::format(
          "the unloaded reflectors stand {:.0f} mm rms from where sweeps and joint angles put them: units, angles or "
          "the "
          "tracker's place are wrong in one of the tables",
          values.number(0) / io::kMillimetre);
    case RemarkId::implausible_load:
      return implausibleWords({values.number(0), values.number(1)});
    case RemarkId::all_negative:
      return "every stiffness is negative: the wrench may be that of the robot on the load, not of the load on the "
             "robot";
    case RemarkId::residual_above_noise:
      return fmt::format(
          "the residual of {:.0f} µm per coordinate is {:.0f} times the {:.1f} µm of the tracker's noise: something "
          "other than joint springs is in the data, and the stated uncertainties hold it only as far as it scatters "
          "between postures",
          values.number(0) / io::kMicrometre, values.number(0) / values.number(1), values.number(1) / io::kMicrometre);
    case RemarkId::too_few_postures:
      return fmt::format("{} posture{} too few to state uncertainties from scatter", values.count(0),
                         values.count(0) == 1 ? " is" : "s are");
    case RemarkId::outlying_postures:
      return outlyingWords(values);
    case RemarkId::mostly_noise:
      return "the tracker's noise is more than half of the deflection: this load step hardly moves the arm";
    case RemarkId::sag_in_sweeps:
      return fmt::format(
          "axes and lengths stand on sweeps from which up to {:.1f} mm of the arm's own sag was taken off by the "
          "identified stiffnesses; what those get wrong of it is not in the stated uncertainties",
          values.number(0) / io::kMillimetre);
    case RemarkId::sweep_above_noise:
      return fmt::format(
          "the circles of axis {} leave {:.0f} µm, {:.0f} times the tracker's noise: the axis bent during its sweep or "
          "a reading is wrong, and its uncertainty is of scatter only",
          values.count(0), values.number(1) / io::kMicrometre, values.number(2));
    case RemarkId::negative:
      return "negative";
    case RemarkId::imprecise:
      return "imprecise";
  }
  return {};
}

}  // namespace stiffscope::reports
