#include <fmt/format.h>

#include "core/audit/remarks.h"
#include "core/io/units.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

/// "4, 5 and 6"
std::string axesFromTo(std::int64_t first, std::int64_t last) {
  std::string text = fmt::format("{}", first);
  for (std::int64_t axis = first + 1; axis <= last; ++axis)
    text += fmt::format("{}{}", axis == last ? " and " : ", ", axis);
  return text;
}

}  // namespace

std::string auditLimitWords(audit::LimitId id, const RemarkValues& values) {
  switch (id) {
    case audit::LimitId::chi_square:
      return fmt::format("chi-square of {} degrees of freedom", values.count(0));
    case audit::LimitId::chi_square_and_states:
      return fmt::format("chi-square of {} degrees of freedom, and of each state", values.count(0));
    case audit::LimitId::chi_square_and_postures:
      return fmt::format("chi-square of {} degrees of freedom, and of each posture", values.count(0));
    case audit::LimitId::chi_square_held_axes:
      return fmt::format("chi-square of {} degrees of freedom, axes {}-{} held by their own sweeps", values.count(0),
                         values.count(1), values.count(2));
    case audit::LimitId::chi_square_of_axes:
      return "chi-square of each axis's residuals";
    case audit::LimitId::chi_square_of_pairs:
      return fmt::format("chi-square of place and direction, {} pairs of reflectors", values.count(0));
    case audit::LimitId::chi_square_of_tare:
      return "chi-square of the mean unloaded reading, six components, and of each reading";
    case audit::LimitId::chi_square_of_displacement:
      return "chi-square of the displacement where the arm stands, by the nests' declared noise";
    case audit::LimitId::chi_square_of_motion:
      return "chi-square of a rigid motion, six degrees of freedom, over that of the rest; chance makes one at any of "
             "the "
             "postures in fewer than one day in a hundred thousand";
    case audit::LimitId::chi_square_of_shift:
      return "chi-square of a rigid shift, six degrees of freedom, over that of the rest";
    case audit::LimitId::factor_of_two:
      return fmt::format(
          "a factor of two either way, by kinds of readings with {} degrees of freedom or more: an "
          "interval of 95 % then covers 68 %, or is twice as wide as it need be",
          values.count(0));
    case audit::LimitId::normal_deviates:
      return fmt::format("largest of {} normal deviates", values.count(0));
    case audit::LimitId::student_between_postures:
      return "Student's t by the median absolute deviation between postures";
    case audit::LimitId::places_or_chance:
      return "how far identification trusts places (0.2 mm); or, where that is larger, " + words(values.remark(0));
    case audit::LimitId::third_of_places_or_chance:
      return "a third of the 0.2 mm to which identification trusts places; or, where that is larger, " +
             words(values.remark(0));
    case audit::LimitId::order_of_format:
      return "later steps follow in time (campaign format)";
    case audit::LimitId::what_most_have:
      return "what most postures and states of this campaign have";
    case audit::LimitId::arc_practice:
      return fmt::format(
          "circle-point practice: warn below {:.0f} deg, fail below {:.0f} deg, unless the axis is still "
          "known at the arm's reach to {}, a third of the {:.1f} mm to which identification trusts "
          "places",
          values.number(0) / io::kDegree, values.number(1) / io::kDegree, lengthWords(values.number(2), 0),
          1e3 * values.number(3));
    case audit::LimitId::circle_redundancy:
      return "three readings make a circle, twice as many leave as many again to check it by";
    case audit::LimitId::turns_as_reported:
      return "a joint turns by what it reports, to a thousandth; radians under degrees are 57 times off";
    case audit::LimitId::reflector_radius:
      return "radius of a 1.5 inch reflector: nearer, the axis passes through the reflector itself";
    case audit::LimitId::built_to_drawing:
      return "20 mm, where machines are built to a few; or, where that is larger, five standard uncertainties";
    case audit::LimitId::centre_of_wrist:
      return "ten times what a wrist whose axes meet is made to";
    case audit::LimitId::leak_that_decoupling_bears:
      return fmt::format(
          "the miss at which joints {}-{} would put 2 % into P_wrist's displacement: what decoupling bears",
          values.count(0), values.count(1));
    case audit::LimitId::places_or_sweeps:
      return "how far identification trusts places (0.2 mm), or what the sweeps' uncertainty would show";
    case audit::LimitId::trusted_places:
      return "how far identification trusts places (0.2 mm)";
    case audit::LimitId::travels_as_reported:
      return "racks and scales are right to a tenth of a millimetre a metre; what they are off is taken off";
    case audit::LimitId::rails_are_laid:
      return "rails are laid along an axis of the robot's foot to a fraction of a degree";
    case audit::LimitId::turn_at_lever:
      return fmt::format("turn that carries a reflector at the longest lever, {:.2f} m, by twice its reading noise",
                         values.number(0));
    case audit::LimitId::load_cell_axes:
      return "how far identification trusts the load cell's axes (2 mrad, one sigma) and its noise; chi-square "
             "of two directions";
    case audit::LimitId::arms_stiffness:
      return fmt::format(
          "force over displacement of six-axis arms: at least {:.0f} N/mm, half of what light collaborative "
          "arms give, and at most {:.0f} N/mm, which is that of machine tools",
          values.number(0) * io::kMillimetre, values.number(1) * io::kMillimetre);
    case audit::LimitId::condition_practice:
      return "calibration practice: condition number, columns of unit length, below 100";
    case audit::LimitId::machines_off_drawing:
      return "no machine is built that far off its drawing";
    case audit::LimitId::machines_leave:
      return fmt::format("half of the displacements; simulated machines with every effect leave {:.0f} % at most",
                         100.0 * values.number(0));
    case audit::LimitId::controllers_compute:
      return "a controller computes its poses from the joints beside them; 0.2 mm, to which identification trusts "
             "places";
  }
  return {};
}

std::string auditMissingWords(audit::MissingId id, const RemarkValues& values) {
  switch (id) {
    case audit::MissingId::no_sweeps:
      return "no circle sweeps: turn each axis by itself (`circle_sweeps`)";
    case audit::MissingId::tracker_not_declared:
      return "the tracker's noise is not declared: state `tracker`";
    case audit::MissingId::no_loads:
      return "no loads: measure `loading`, `states` and `load_cell`";
    case audit::MissingId::loading_not_in_r0:
      return "the loading's readings cannot be brought into R0: sweep axes 1 and 2";
    case audit::MissingId::no_step_with_force:
      return "no load step has a force";
    case audit::MissingId::no_posture_to_identify_from:
      return "no posture has readings at the heaviest load step and, of absolute points, unloaded ones (step "
             "0): nothing to identify from";
    case audit::MissingId::load_cell_noise_not_stated:
      return "the load cell's noise is not stated: force_sigma_n and moment_sigma_nm in campaign.xml";
    case audit::MissingId::no_unloaded_states:
      return "no unloaded states (step 0)";
    case audit::MissingId::no_compared_postures:
      return "no postures with readings unloaded and loaded";
    case audit::MissingId::load_does_not_hang:
      return "the load does not hang: it is pulled to the side";
    case audit::MissingId::no_load_cell_readings:
      return "no load cell readings: `load_cell` and `states`";
    case audit::MissingId::no_displacement_under_force:
      return "no displacement under a force that can be brought into the robot's frame";
    case audit::MissingId::few_loaded_states:
      return "fewer than four loaded states";
    case audit::MissingId::one_kind_scatters:
      return "one kind of readings alone scatters by more than is declared: its own fault and a noise declared too "
             "small cannot be told apart; read each state of `loading` three times";
    case audit::MissingId::too_few_to_judge_tracker:
      return fmt::format(
          "no repeats, nests, sweeps or returns to zero with {} degrees of freedom: read each state of "
          "`loading` three times",
          values.count(0));
    case audit::MissingId::too_few_to_judge_load_cell:
      return "too few unloaded readings of the load cell as it shows them (not set to zero), or loaded states with "
             "moments: write both for six postures or more";
    case audit::MissingId::no_moments:
      return "no moments were measured";
    case audit::MissingId::forces_on_one_line:
      return "the forces lie along one line in the tool: turn the flange between postures";
    case audit::MissingId::few_nests_or_rounds:
      return "too few nests or rounds to tell a moving nest from the station: measure four";
    case audit::MissingId::no_nest_to_spare:
      return "no more nests in common than the stations' poses take: measure four, better five";
    case audit::MissingId::no_load_states:
      return "no load states: measure `states` with `loading`";
    case audit::MissingId::no_states_nor_loading:
      return "no `states` and no `loading`";
    case audit::MissingId::no_readings_of_states:
      return "no readings of load states: measure `states` with `loading` or `displacements`";
    case audit::MissingId::no_unloading:
      return "no posture was unloaded again: add a last step without load";
    case audit::MissingId::no_compared_postures_in_geometry:
      return "no postures with readings unloaded and loaded in a known geometry";
    case audit::MissingId::sag_not_known:
      return "the arm's own sag is not known: state masses in the URDF, and load steps that identify stiffnesses";
    case audit::MissingId::few_unloaded_postures:
      return fmt::format("{} unloaded postures: {} or more are needed", values.count(0), values.count(1));
    case audit::MissingId::few_postures_to_compare:
      return fmt::format("fewer than {} postures to compare", values.count(0));
    case audit::MissingId::axis_not_measured:
      return fmt::format("axis {}: {}", values.count(0), words(values.remark(1)));
    case audit::MissingId::no_neighbouring_axes:
      return "no two neighbouring axes with circle sweeps";
    case audit::MissingId::no_sweep_below_whole_turn:
      return "no axis with a sweep of less than a whole turn";
    case audit::MissingId::no_two_reflectors_off_axis:
      return "no axis was swept with two reflectors well off it";
    case audit::MissingId::no_two_reflectors_in_states:
      return "no two reflectors were read in the same states: read two or more in each";
    case audit::MissingId::few_wrist_readings:
      return "too few readings: more than centre and radii take";
    case audit::MissingId::no_rail_sweep:
      return "no sweep of the rail: read the reflectors at several positions of the carriage, joints at rest "
             "(`rail_sweep`)";
    case audit::MissingId::wrist_axes_not_swept:
      return fmt::format("axes {} are not all measured: sweep each", axesFromTo(values.count(0), values.count(1)));
    case audit::MissingId::no_readings_of_arm:
      return "too few readings of the unloaded arm in several postures to hold it against the URDF";
    case audit::MissingId::few_loads_of_model:
      return "fewer than six loaded states with a wrench and readings of reflectors in postures that fit the URDF";
    case audit::MissingId::no_controller_poses:
      return "`states` has no poses of the controller's tool (px_mm to pr_deg)";
    case audit::MissingId::few_controller_poses:
      return fmt::format("{} postures have a pose of the controller's tool; {} are needed, with twelve coordinates",
                         values.count(0), values.count(1));
  }
  return {};
}

}  // namespace stiffscope::reports
