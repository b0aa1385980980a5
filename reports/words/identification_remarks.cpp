#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/identification/identification.h"
#include "core/identification/remarks.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
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

/// Values: see RemarkId::wrist_axes_apart.
std::string wristAxesApart(const RemarkValues& values) {
  const std::vector<double>& misses = values.numbers(0);
  const std::int64_t first = values.count(3);
  std::string apart;
  for (std::size_t k = 0; k < misses.size(); ++k) {
    const std::int64_t axis = first + static_cast<std::int64_t>(k);
    apart += fmt::format("{}{} and {}{} by {:.3f} mm", k > 0 ? ", " : "", axis, axis + 1, k > 0 ? "" : " miss",
                         1e3 * misses[k]);
  }
  return fmt::format(
      "the wrist's axes do not meet in one point ({}): turning in joints {}-{} moves P_wrist by {:.1f} % of its "
      "displacement, more than the {:.0f} % that decoupling bears",
      apart, first, first + static_cast<std::int64_t>(misses.size()), 100.0 * values.number(1),
      100.0 * values.number(2));
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

/// Tenths of a millimetre; of a sag that these do not show, micrometres.
std::string sagWords(double metres) {
  constexpr double kShown = 0.05 * io::kMillimetre;
  return metres < kShown ? withMicro(lengthWords(metres, 0)) : fmt::format("{:.1f} mm", metres / io::kMillimetre);
}

/// Values: see RemarkId::outlying_postures.
std::string outlyingWords(const RemarkValues& values) {
  const std::vector<std::string>& names = values.names(0);
  const std::vector<double>&left = values.numbers(1), &others = values.numbers(2);
  const bool one = names.size() == 1, left_out = values.count(3) != 0;
  std::vector<std::string> postures;
  for (std::size_t i = 0; i < names.size(); ++i) {
    postures.push_back(fmt::format("{} ({} per coordinate against {} of the others)", names[i],
                                   withMicro(lengthWords(left[i], 0)), withMicro(lengthWords(others[i], 0))));
  }
  return fmt::format("outlying posture{}: {}: the springs of the other postures do not explain {}; {}", one ? "" : "s",
                     fmt::join(postures, ", "), one ? "it" : "them",
                     left_out ? "left out as asked" : "used nevertheless; `identify --robust` leaves out");
}

std::string briefOf(std::int64_t method) { return namesOf(static_cast<identification::Method>(method)).brief; }

/// "PP 90.45 %, DPP 89.11 %": the largest first.
std::string sharesWords(const std::vector<std::int64_t>& methods, const std::vector<double>& shares) {
  std::vector<std::size_t> order(methods.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  std::vector<std::string> parts;
  for (const std::size_t i : order) parts.push_back(fmt::format("{} {:.2f} %", briefOf(methods[i]), 100.0 * shares[i]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string judgedAt(std::int64_t judged) {
  const bool at_wrist =
      static_cast<identification::ShownFirst::Judged>(judged) == identification::ShownFirst::Judged::at_wrist;
  return at_wrist ? "P_wrist" : "the reflectors";
}

/// Values: see RemarkId::shown_as_good_as_most.
std::string asGoodWords(const RemarkValues& values) {
  const std::string own = briefOf(values.count(1));
  return fmt::format(
      "{}, as good as {}, which compensates most of the deflection at {} on postures held out ({}): by {:.2f} % more, "
      "with a standard deviation of {:.2f} % over the subsets; of equals DPP goes before PP, and PP before CP",
      own, briefOf(values.count(2)), judgedAt(values.count(0)), sharesWords(values.counts(5), values.numbers(6)),
      100.0 * values.number(3), 100.0 * values.number(4));
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
      return "no readings under load in 'loading' or 'displacements': they are needed to identify";
    case RemarkId::no_wrench:
      return "no wrench in 'states' (fx_n to mz_nm): force and moment of each load step are needed to identify";
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
      return "P_wrist needs absolute readings of three reflectors of known radius, not on one line, in every posture: "
             "measure `loading` and the wrist sweep with three";
    case RemarkId::wrist_centre_not_measured:
      return "the wrist centre is not measured: " + words(values.remark(0));
    case RemarkId::wrist_sweep_wanted:
      return fmt::format("{}; measure a wrist sweep (axes {}-{} moving) and `loading` with three reflectors",
                         words(values.remark(0)), values.count(1), values.count(2));
    case RemarkId::wrist_sweep_wanted_too:
      return fmt::format("{}; and P_wrist needs a wrist sweep (axes {}-{} moving) with three reflectors",
                         words(values.remark(0)), values.count(1), values.count(2));
    case RemarkId::wrist_is_offset:
      return offsetWristWords(values.count(0), values.number(1));
    case RemarkId::wrist_axes_apart:
      return wristAxesApart(values);
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
    case RemarkId::back_at_zero:
      return fmt::format("back at zero in this load step: {:.3g} N of its largest {:.4g} N", values.number(0),
                         values.number(1));
    case RemarkId::under_three_reflectors:
      return "fewer than three reflectors read in both states";
    case RemarkId::no_wrist_point:
      return "no P_wrist from reflectors of known radius";
    case RemarkId::disagrees:
      return fmt::format("disagrees with the other postures by {} per coordinate, {:.1f} times theirs",
                         withMicro(lengthWords(values.number(0), 0)), values.number(1));
    case RemarkId::in_step:
      return fmt::format("{} (step {})", words(values.remark(0)), values.count(1));
    case RemarkId::geometry_missed:
      return fmt::format(
          "the unloaded reflectors stand {:.0f} mm rms from where sweeps and joint angles put them: units, angles or "
          "the tracker's place are wrong in one of the tables",
          values.number(0) / io::kMillimetre);
    case RemarkId::implausible_load:
      return implausibleWords({values.number(0), values.number(1)});
    case RemarkId::all_negative:
      return "every stiffness is negative: the wrench may be that of the robot on the load, not of the load on the "
             "robot";
    case RemarkId::residual_above_noise:
      return fmt::format(
          "the residual of {} per coordinate is {:.0f} times the {} of the tracker's noise: something "
          "other than joint springs is in the data, and the stated uncertainties hold it only as far as it scatters "
          "between postures",
          withMicro(lengthWords(values.number(0), 0)), values.number(0) / values.number(1),
          withMicro(lengthWords(values.number(1), 1)));
    case RemarkId::too_few_postures:
      return fmt::format("{} posture{} too few to state uncertainties from scatter", values.count(0),
                         values.count(0) == 1 ? " is" : "s are");
    case RemarkId::outlying_postures:
      return outlyingWords(values);
    case RemarkId::mostly_noise:
      return "the tracker's noise is more than half of the deflection: this load step hardly moves the arm";
    case RemarkId::sag_left_in:
      return "the arm's own sag is left in what the sweeps give, and is not in its uncertainties: they are of the "
             "readings alone";
    case RemarkId::sag_in_sweeps_weighed:
      return fmt::format(
          "axes and lengths stand on sweeps from which up to {} of the arm's own sag was taken off by the "
          "identified stiffnesses; what could hide in these is in the stated uncertainties",
          sagWords(values.number(0)));
    case RemarkId::sag_in_sweeps:
      return fmt::format(
          "axes and lengths stand on sweeps from which up to {} of the arm's own sag was taken off by the "
          "identified stiffnesses; what those get wrong of it is not in the stated uncertainties",
          sagWords(values.number(0)));
    case RemarkId::sweep_above_noise:
      return fmt::format(
          "the circles of axis {} leave {}, {:.0f} times the tracker's noise: the axis bent during its sweep or "
          "a reading is wrong, and its uncertainty is of scatter only",
          values.count(0), withMicro(lengthWords(values.number(1), 0)), values.number(2));
    case RemarkId::shown_compensates_most:
      return fmt::format("{}, which compensates most of the deflection at {} on postures held out ({})",
                         briefOf(values.count(1)), judgedAt(values.count(0)),
                         sharesWords(values.counts(2), values.numbers(3)));
    case RemarkId::shown_as_good_as_most:
      return asGoodWords(values);
    case RemarkId::shown_alone:
      return fmt::format("{}, the only method available", briefOf(values.count(0)));
    case RemarkId::shown_unjudged:
      return fmt::format("{}, the first available of DPP, PP and CP: the methods are not judged on postures held out",
                         briefOf(values.count(0)));
    case RemarkId::shown_as_in_the_paper:
      return fmt::format("{}, the paper's method", briefOf(values.count(0)));
    case RemarkId::shown_as_asked:
      return fmt::format("{}, as asked", briefOf(values.count(0)));
    case RemarkId::no_second_encoder:
      return "no second encoder: `states` has no angle of its motor side, or the reported one again";
    case RemarkId::no_loaded_state:
      return "no load state with a force and angles of the motor side: the wind-up of a gear needs a torque";
    case RemarkId::encoders_apart:
      return fmt::format(
          "m{0}_deg stands {1:.3g} deg from q{0}_deg: not the motor's angle over the gear ratio, in the joint's sense",
          values.count(0), values.number(1) / io::kDegree);
    case RemarkId::too_few_encoder_postures:
      return fmt::format("angles of the motor side in two load states or more of {} posture{}; {} are needed",
                         values.count(0), values.count(0) == 1 ? "" : "s", values.count(1));
    case RemarkId::loop_not_as_declared:
      return values.count(1) != 0
                 ? fmt::format(
                       "joint {}: double_encoder is declared active, but under load the link side moves and the "
                       "motor stands: taken as closed on the motor",
                       values.count(0))
                 : fmt::format(
                       "joint {}: double_encoder is declared inactive, but under load the motor moves and the "
                       "link side stands: taken as closed on the link side",
                       values.count(0));
    case RemarkId::known_stiffness_contradicted: {
      const double low = values.number(5) / 1e6, high = values.number(6) / 1e6;
      return fmt::format(
          "k{} is known from {} as {:.4f} +- {:.4f} (standard uncertainty), but this day says {:.4f}, with 95 % {}; "
          "all in 1e6 Nm/rad: one of the two is wrong, or the machine changed. The day's own is used",
          values.count(0), values.name(3), values.number(1) / 1e6, values.number(2) / 1e6, values.number(4) / 1e6,
          std::isfinite(low) && std::isfinite(high) ? fmt::format("from {:.4f} to {:.4f}", low, high)
                                                    : fmt::format("above {:.4f}", low));
    }
    case RemarkId::negative:
      return "negative";
    case RemarkId::imprecise:
      return "imprecise";
  }
  return {};
}

}  // namespace stiffscope::reports
