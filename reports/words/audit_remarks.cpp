#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "core/audit/remarks.h"
#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

constexpr double kMinute = 60.0;  // s

std::string joined(const RemarkValues& values, std::size_t place, const char* between) {
  return fmt::format("{}", fmt::join(words(values.remarks(place)), between));
}

/// Remarks that go on with the sentence; each brings its own mark.
std::string more(const RemarkValues& values, std::size_t place) { return joined(values, place, ""); }

std::string state(const RemarkValues& values) {
  return fmt::format("pose {}, step {}", values.name(0), values.count(1));
}

/// The first of them, and how many there are besides: of a list that grows with the day.
std::string few(const std::vector<Remark>& all, const char* between, std::size_t most = 8) {
  const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(most, all.size()));
  std::string text = fmt::format("{}", fmt::join(words(std::vector<Remark>(all.begin(), end)), between));
  if (all.size() > most) text += fmt::format("{}and {} more", *between != 0 ? between : "; ", all.size() - most);
  return text;
}

/// "at loading.csv:2 (pose 1, step 0)", "from ... on", "from ... to ..."
std::string whereExchanged(const RemarkValues& values) {
  const std::string first = fmt::format("{} ({})", values.name(0), values.name(1));
  if (values.count(3) == 1) return "at " + first;
  return "from " + first + (values.count(5) != 0 ? std::string(" on") : fmt::format(" to {}", values.name(4)));
}

/// "P10 is P11, P11 is P10"
std::string exchange(const std::vector<std::string>& pairs) {
  std::string text;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    text += fmt::format("{}{} is {}", text.empty() ? "" : ", ", pairs[i], pairs[i + 1]);
  return text;
}

/// Coordinates in m as mm.
std::string millimetres(const std::vector<double>& place, int decimals) {
  std::string text;
  for (const double coordinate : place)
    text += fmt::format("{}{:.{}f}", text.empty() ? "" : ", ", 1e3 * coordinate, decimals);
  return text;
}

std::string wristAxesMiss(const RemarkValues& values) {
  const std::vector<double>& miss = values.numbers(0);  // each with its standard uncertainty
  std::string text;
  std::int64_t axis = values.count(2);
  for (std::size_t k = 0; k + 1 < miss.size(); k += 2, ++axis) {
    text += fmt::format("{}axes {} and {}{} by {:.3f} +- {:.3f} mm", k > 0 ? ", " : "", axis, axis + 1,
                        k > 0 ? "" : " miss", 1e3 * miss[k], 1e3 * expanded(miss[k + 1]));
  }
  return text + " (U, 95 %)" + more(values, 1);
}

std::string mending(std::int64_t cures, const std::string& check) {
  if (cures == 0 && !check.empty()) {
    return fmt::format("the readings contradict the model; what {} finds explains it",
                       check == "rigid_tool" ? "rigid tool" : "time order");
  }
  if (cures == 0) return "the readings contradict the model, and none of the usual mistakes explains it";
  return cures == 1 ? "one of the usual mistakes explains it (suspected)"
                    : fmt::format("{} mistakes would each explain it (suspected), or are several", cures);
}

std::string unloadedReading(const RemarkValues& values) {
  const std::vector<double>& mean = values.numbers(0);
  return fmt::format(
      "unloaded, the load cell shows ({:.2f}, {:.2f}, {:.2f}) N and ({:.2f}, {:.2f}, {:.2f}) Nm on average{}",
      mean.at(0), mean.at(1), mean.at(2), mean.at(3), mean.at(4), mean.at(5), more(values, 1));
}

}  // namespace

std::string auditWords(audit::RemarkId id, const RemarkValues& values) {
  switch (id) {
    case audit::RemarkId::at_axis:
      return fmt::format("axis {}", values.count(0));
    case audit::RemarkId::at_axis_row:
      return fmt::format("axis {}, {}", values.count(0), values.name(1));
    case audit::RemarkId::at_axes:
      return fmt::format("axes {} and {}", values.count(0), values.count(1));
    case audit::RemarkId::at_axis_and_pair:
      return fmt::format("axis {}, {} and {}", values.count(0), values.name(1), values.name(2));
    case audit::RemarkId::at_reflector:
      return fmt::format("{}, axis {}", values.name(0), values.count(1));
    case audit::RemarkId::at_reflectors:
      return joined(values, 0, "; ");
    case audit::RemarkId::at_moved_reflector:
      return fmt::format("{}, {}", values.name(0), values.name(1));
    case audit::RemarkId::at_pose:
      return fmt::format("pose {}", values.name(0));
    case audit::RemarkId::at_state:
      return state(values);
    case audit::RemarkId::at_time:
      return fmt::format("{:.0f} s", values.number(0));
    case audit::RemarkId::at_loading:
      return "loading";
    case audit::RemarkId::at_tracker:
      return "tracker";
    case audit::RemarkId::at_load_cell:
      return "load cell";
    case audit::RemarkId::unknown_if_it_identifies:
      return "whether postures and loads identify any joint (posture set): measure `states` with a load cell, and "
             "`loading` or `displacements`, unloaded and under load";
    case audit::RemarkId::unknown_size:
      return "whether displacements are of the size that forces make (load size): measure `loading` or "
             "`displacements` under a known force";
    case audit::RemarkId::unknown_worth_of_readings:
      return "what a reading under load is worth (one of repeatability, rigid tool, unloaded positions, return to "
             "zero): read each state of `loading` twice or more, or several reflectors in each, and add a last step "
             "without load, which `displacements` may have, too";
    case audit::RemarkId::unknown_load_cell:
      return "whether the load cell shows the load (one of tare, gravity direction, moment lever): state "
             "force_sigma_n and moment_sigma_nm, and write what the cell shows unloaded and its moments as they were "
             "read; or let the load hang";
    case audit::RemarkId::unknown_arm:
      return "whether the readings are those of the URDF's arm (arm model): read one reflector or more in postures in "
             "which every joint stands at several angles";
    case audit::RemarkId::unknown_worth_unloaded:
      return "what a reading is worth (one of repeatability, rigid tool, return to zero): read postures twice or more, "
             "or three reflectors in each";
    case audit::RemarkId::too_few_to_calibrate:
      return fmt::format(
          "whether the geometry is right: {} coordinates were read in different postures, and it has {} numbers",
          values.count(0), values.count(1));
    case audit::RemarkId::steps_follow:
      return "steps follow each other in time in every posture";
    case audit::RemarkId::steps_out_of_order:
      return "steps out of order: " + few(values.remarks(0), "; ");
    case audit::RemarkId::step_too_early:
      return fmt::format("{} (pose {}: step {} before step {} ends)", values.name(0), values.name(1), values.count(2),
                         values.count(3));
    case audit::RemarkId::state_during:
      return fmt::format("{} (pose {}: the state of step {} was taken during step {})", values.name(0), values.name(1),
                         values.count(2), values.count(3));
    case audit::RemarkId::clocks_apart:
      return fmt::format("the clock of {} is {:.0f} s {} that of {}: with that {} its times all {} rows are in order",
                         values.name(0), std::abs(values.number(2)), values.number(2) > 0.0 ? "ahead of" : "behind",
                         values.name(1), values.number(2) > 0.0 ? "taken off" : "added to", values.count(3));
    case audit::RemarkId::rows_of_other_postures:
      return fmt::format(
          "{} of {} postures have rows in {} that were taken while another posture was read, pose {} while {} was{}",
          values.count(1), values.count(2), values.name(0), values.name(3), values.name(4),
          values.count(5) != 0 ? ": the table was sorted as text (1, 10, 11, 2) and numbered afresh" : "");
    case audit::RemarkId::all_there:
      return fmt::format("every one of {} postures has all steps, reflectors and repeats", values.count(0));
    case audit::RemarkId::missing:
      return "missing: " + few(values.remarks(0), "; ");
    case audit::RemarkId::step_not_read:
      return state(values) + ": no readings";
    case audit::RemarkId::no_row_in_states:
      return state(values) + ": no row in states";
    case audit::RemarkId::too_few_readings:
      return fmt::format("{}: {} of {} readings of {}", state(values), values.count(2), values.count(3),
                         values.name(4));
    case audit::RemarkId::posture_not_read:
      return fmt::format("pose {}: no readings", values.name(0));
    case audit::RemarkId::repeats_scatter:
      return fmt::format(
          "repeats scatter {} the beam by {} (one sigma), {:.2f} of what is declared{}",
          values.count(0) != 0 ? "along" : "across", lengthWords(values.number(1), 1), values.number(2),
          values.count(3) != 0
              ? ": every stated uncertainty is too small by as much; the other checks take the noise as the "
                "repeats show it"
              : "");
    case audit::RemarkId::distances_keep_too_well:
      return fmt::format(
          "the reflectors' distances keep to {:.2g} of the declared noise: these readings are not independent of one "
          "another (made from a measured pose, or copied), or the declared noise is not theirs; checks and "
          "uncertainties take "
          "them as independent",
          values.number(0));
    case audit::RemarkId::repeats_scatter_little:
      return "repeats scatter by less than half of what is declared: one sigma of a reading is asked for, not "
             "the maximum permissible error of a data sheet (ISO 10360-10); checks and uncertainties are as lax "
             "as the declaration";
    case audit::RemarkId::repeats_rounded:
      return fmt::format(
          "coordinates are written to {}, and that rounding counts as noise beside what is declared: write more digits",
          lengthWords(values.number(0), 0));
    case audit::RemarkId::noise_borne_out:
      return fmt::format("readings bear the declared noise out within a factor of {:.2f}: of it show {}",
                         values.number(0), joined(values, 1, ", "));
    case audit::RemarkId::noise_too_large:
      return fmt::format(
          "declared about {:.1f} times too large: of the declared noise show {}; one sigma of a reading is asked for, "
          "not a maximum permissible error; checks and stated uncertainties are as lax as the declaration",
          values.number(0), joined(values, 1, ", "));
    case audit::RemarkId::noise_too_small:
      return fmt::format(
          "declared about {:.1f} times too small: of the declared noise show {}; every uncertainty stated from it is "
          "too small by as much",
          values.number(0), joined(values, 1, ", "));
    case audit::RemarkId::noise_explained:
      return fmt::format(
          "readings scatter {:.1f} times otherwise than declared, because of the mistake that is suspected: of the "
          "declared noise show {}",
          values.number(0), joined(values, 1, ", "));
    case audit::RemarkId::repeats_along_show:
      return fmt::format("repeats along the beam {:.2f}", values.number(0));
    case audit::RemarkId::repeats_across_show:
      return fmt::format("repeats across it {:.2f}", values.number(0));
    case audit::RemarkId::nests_show:
      return fmt::format("floor nests {:.2f}", values.number(0));
    case audit::RemarkId::sweep_shows:
      return fmt::format("sweep of axis {} {:.2f}", values.count(0), values.number(1));
    case audit::RemarkId::short_sweeps_show:
      return fmt::format("short sweeps together {:.2f}", values.number(0));
    case audit::RemarkId::returns_show:
      return fmt::format("returns to zero {:.2f}", values.number(0));
    case audit::RemarkId::unloaded_cell_shows:
      return fmt::format("unloaded readings {:.2f}", values.number(0));
    case audit::RemarkId::lever_shows:
      return fmt::format("moments against one lever {:.2f}", values.number(0));
    case audit::RemarkId::declare_tracker_noise:
      return fmt::format(
          "multiply range_fixed_um and range_per_m_um by {:.2g}, angle_fixed_um and angle_per_m_um by {:.2g}",
          values.numbers(0).at(0), values.numbers(0).at(1));
    case audit::RemarkId::declare_load_cell_noise:
      return fmt::format("multiply force_sigma_n and moment_sigma_nm by {:.2g}", values.numbers(0).at(0));
    case audit::RemarkId::take_step_0_off:
      return fmt::format(
          "unloaded, the load cell drifts by {:.3g} N and {:.2g} Nm in {:.1f} h: take what it shows in step 0 of each "
          "posture off all rows of that posture",
          values.number(0), values.number(1), values.number(2));
    case audit::RemarkId::unloaded_scatter:
      return fmt::format("unloaded readings then scatter by {:.2f} of the declared noise instead of {:.2f}",
                         values.number(1), values.number(0));
    case audit::RemarkId::distance_changes:
      return fmt::format("largest change of a distance: {} to {} by {} at {}{}", values.name(0), values.name(1),
                         lengthWords(values.number(2), 0), values.name(3), few(values.remarks(4), ""));
    case audit::RemarkId::distances_scatter:
      return fmt::format("; over all states distances scatter {:.2f} times as far as noise alone", values.number(0));
    case audit::RemarkId::reflectors_exchanged:
      return fmt::format("; reflectors exchanged {}: {}", whereExchanged(values), exchange(values.names(2)));
    case audit::RemarkId::no_one_reflector:
      return "; no one reflector explains it: two move, the tool itself bends, or the tracker's noise is larger "
             "than declared";
    case audit::RemarkId::reflector_moves:
      return fmt::format(
          "; reflector {} moves: the distances between the others hold, its own change by {} rms "
          "under load and {} without",
          values.name(0), lengthWords(values.number(1), 0), lengthWords(values.number(2), 0));
    case audit::RemarkId::station_moved:
      return fmt::format("at the arm the station moved by {} and turned by {:.1f} urad at most, at {:.0f} s{}",
                         lengthWords(values.number(0), 0), 1e6 * values.number(1), values.number(2), more(values, 3));
    case audit::RemarkId::station_drifts:
      return fmt::format("; a drift of {:.2f} um/min on average",
                         1e6 * values.number(0) / (values.number(1) / kMinute));
    case audit::RemarkId::station_jumps:
      return fmt::format("; it jumped at about {:.0f} s: the tracker was moved", fmt::join(values.numbers(0), " s, "));
    case audit::RemarkId::motion_taken_off:
      return "; readings with a time are referred to the first round, here and in identification";
    case audit::RemarkId::motion_not_taken_off:
      return "; not taken off the readings: " + words(values.remark(0));
    case audit::RemarkId::nests_left:
      return fmt::format("what no motion of the station explains is {:.2f} of the noise{}", values.number(0),
                         more(values, 1));
    case audit::RemarkId::nest_moved:
      return fmt::format("; nest {} moved by up to {} against the others and is left out of the station's motion",
                         values.name(0), lengthWords(values.number(1), 0));
    case audit::RemarkId::nests_not_mended:
      return "; leaving out any one nest does not mend it: more than one moved, or the readings are wrong";
    case audit::RemarkId::nests_too_near:
      return fmt::format(
          "nests {} and {} stand {} apart, closer than two reflectors can: the coordinates are in another unit "
          "than mm, or two names are of one nest; nothing of the station's motion is to be believed",
          values.name(0), values.name(1), lengthWords(values.number(2), 1));
    case audit::RemarkId::of_station:
      return values.name(0) + ": " + words(values.remark(1));
    case audit::RemarkId::stations_left:
      return fmt::format("what the stations' nests leave of each other is {:.2f} of the noise{}", values.number(0),
                         more(values, 1));
    case audit::RemarkId::station_at_arm:
      return fmt::format(
          "{}, by {} nests in common: where the arm was read its frame is known to {} and {:.1f} urad (one sigma, the "
          "largest of all directions), common to all that was read from it",
          values.name(0), values.count(1), lengthWords(values.number(2), 1), 1e6 * values.number(3));
    case audit::RemarkId::nest_read_apart:
      return fmt::format(
          "; nest {} as {} read it stands {} from where the others put it, and is left out: it moved between the "
          "stations",
          values.name(0), values.name(1), lengthWords(values.number(2), 0));
    case audit::RemarkId::reading_read_apart:
      return fmt::format("; the reading of nest {} from {} in line {} is {} off the others, and is left out",
                         values.name(1), values.name(2), values.count(0), lengthWords(values.number(3), 0));
    case audit::RemarkId::stations_not_mended:
      return "; leaving out single nests does not mend it: several moved between the stations, or a station drifted "
             "while its nests were read";
    case audit::RemarkId::arc_known:
      return fmt::format(
          "axis {}: arc of {:.1f} deg; known to {:.1f} urad in direction and {} in place (one sigma), "
          "{} at the reach of {:.2f} m{}",
          values.count(0), values.number(1) / io::kDegree, 1e6 * values.number(2), lengthWords(values.number(3), 1),
          lengthWords(values.number(4), 0), values.number(5), more(values, 6));
    case audit::RemarkId::wide_not_enough:
      return "; does not suffice for identification, wide as it is: take more readings, or reflectors farther "
             "from the axis and along it";
    case audit::RemarkId::short_arc:
      return fmt::format(", {:.1f} times what as many readings over {:.0f} deg would give; {} for identification",
                         values.number(0), values.number(1) / io::kDegree,
                         values.count(2) != 0 ? "still suffices" : "does not suffice");
    case audit::RemarkId::smallest_circle:
      return fmt::format("the smallest circle has {} readings", values.count(0));
    case audit::RemarkId::angle_stays:
      return fmt::format("axis {} reports one and the same angle while its reflectors turn by {:.4g} deg",
                         values.count(0), values.number(1) / io::kDegree);
    case audit::RemarkId::angle_and_turn:
      return fmt::format(
          "while axis {} reports a turn of {:.4g} deg its reflectors turn by {:.4g} deg{}", values.count(0),
          values.number(1) / io::kDegree, values.number(2) / io::kDegree,
          values.count(3) != 0 ? ": angles in another unit (radians for degrees), or those of another joint" : "");
    case audit::RemarkId::on_circles:
      return "readings lie on their circles within the noise";
    case audit::RemarkId::off_circles:
      return fmt::format(
          "readings leave their circles by more than noise: {}; the stated uncertainties of the axes are "
          "widened by it{}",
          joined(values, 0, ", "), more(values, 1));
    case audit::RemarkId::axis_off_circles:
      return fmt::format("axis {} by {} rms, {:.2f} of the noise", values.count(0), lengthWords(values.number(1), 1),
                         values.number(2));
    case audit::RemarkId::one_reading_off:
      return fmt::format("; most of that of axis {} is the one reading {}", values.count(0), values.name(1));
    case audit::RemarkId::runs_along_sweep:
      return fmt::format(
          "; that of ax{} {} runs along the sweep, no one reading makes it: the axis moves as it turns, most "
          "often because the own weight bends bearings or links, which joint springs do not describe, or because the "
          "springs by which its sag is taken off are wrong, as by a load cell that is off by a factor; "
          "identification goes on",
          values.counts(0).size() == 1 ? "is" : "es", fmt::join(values.counts(0), ", "));
    case audit::RemarkId::reflectors_agree:
      return fmt::format("reflectors that turn about one axis agree on it within {:.2f} of the difference's sd",
                         values.number(0));
    case audit::RemarkId::reflectors_disagree:
      return fmt::format(
          "reflectors that turn about one axis place it apart by {:.2f} of the difference's sd: the own "
          "weight bends more than the joints (bearings, links) or is not what the URDF's masses make it, or "
          "a reflector moved (rigid tool then shows it too)",
          values.number(0));
    case audit::RemarkId::well_off_axes:
      return "every reflector stands well off the axes";
    case audit::RemarkId::on_axis:
      return "says next to nothing about the axis it stands on, nor about that joint's stiffness: " +
             joined(values, 0, "; ");
    case audit::RemarkId::reflector_near_axis:
      return fmt::format("{} at {:.2f} mm", words(values.remark(0)), 1e3 * values.number(1));
    case audit::RemarkId::axes_apart:
      return fmt::format("axes {} and {} stand {:.3f} mm apart, {:.3f} mm in the URDF{}", values.count(0),
                         values.count(1), values.number(2) / io::kMillimetre, values.number(3) / io::kMillimetre,
                         values.count(4) != 0
                             ? ": points or angles of the sweeps are in another unit, or the URDF is another machine's"
                             : "");
    case audit::RemarkId::wrist_residuals:
      return fmt::format(
          "radial residuals of {} rms, of which the axes' missing each other leaves {}, {:.2f} "
          "of the noise{}",
          lengthWords(values.number(0), 1), lengthWords(values.number(1), 1), values.number(2), more(values, 3));
    case audit::RemarkId::wrist_reading_off:
      return fmt::format(
          "; farthest {}: a wrong reading, or the own weight bends more than the joints (bearings, links)",
          values.name(0));
    case audit::RemarkId::wrist_axes_miss:
      return wristAxesMiss(values);
    case audit::RemarkId::wrist_meets_apart:
      return "; " + offsetWristWords(values.count(0), values.number(1));
    case audit::RemarkId::wrist_leak:
      return fmt::format(": joints {}-{} put {:.2f} % into P_wrist's displacement", values.count(1), values.count(2),
                         100.0 * values.number(0));
    case audit::RemarkId::decoupling_needs_one_point:
      return "; Decoupled Partial Pose takes them to meet in one point";
    case audit::RemarkId::rail_leaves:
      return fmt::format(
          "from {:.1f} to {:.1f} mm the carriage leaves a straight line by {} rms across it, and what is "
          "reported by {} along it; at most {}",
          values.number(2) / io::kMillimetre, values.number(3) / io::kMillimetre, lengthWords(values.number(1), 1),
          lengthWords(values.number(0), 1), lengthWords(values.number(4), 1));
    case audit::RemarkId::rail_travels:
      return fmt::format("a reported metre is {:.6f} +- {:.6f} m of travel (U, 95 %), and is taken as that",
                         values.number(0), expanded(values.number(1)));
    case audit::RemarkId::rail_runs:
      return fmt::format("the carriage goes {:.3f} deg off the axis of the URDF's prismatic joint",
                         values.number(0) / io::kDegree);
    case audit::RemarkId::rail_reversed:
      return fmt::format(
          "the carriage goes against the axis of the URDF's prismatic joint ({:.3f} deg from it): turn the axis round "
          "in the URDF, or the sign of `rail_mm`",
          values.number(0) / io::kDegree);
    case audit::RemarkId::loading_shifted:
      return fmt::format(
          "loading against sweeps: shift of ({}) mm in R0 at the arm and turn of {:.0f} urad, which explains "
          "{:.0f} % of the misfit of the unloaded positions{}",
          millimetres(values.numbers(0), 3), 1e6 * values.number(1), 100.0 * values.number(2), more(values, 3));
    case audit::RemarkId::tracker_or_robot_moved:
      return ": tracker or robot moved between sweeps and loading";
    case audit::RemarkId::moved_meanwhile:
      return joined(values, 0, "; ") +
             "; displacements within a posture hardly feel it: stiffnesses by springs alone stand, geometry, accuracy "
             "and "
             "what a diagnosis makes of positions do not";
    case audit::RemarkId::station_moved_meanwhile:
      return fmt::format(
          "from posture {} on readings stand ({}) mm in R0 from those before, and turned by {:.0f} urad, which "
          "explains "
          "{:.0f} % of the misfit of the unloaded positions: tracker or robot moved during the loading",
          values.name(0), millimetres(values.numbers(1), 3), 1e6 * values.number(2), 100.0 * values.number(3));
    case audit::RemarkId::station_drifts_meanwhile:
      return fmt::format(
          "readings drift by ({}) mm in R0 from the first posture of the loading to the last, and turn by {:.0f} urad, "
          "which explains {:.0f} % of the misfit of the unloaded positions: the tracker, its stand or the air drifted, "
          "or the "
          "robot grew warm",
          millimetres(values.numbers(0), 3), 1e6 * values.number(1), 100.0 * values.number(2));
    case audit::RemarkId::tool_moved_meanwhile:
      return fmt::format(
          "from posture {} on all reflectors stand {:.3f} mm from where the flange carried them before, and turned by "
          "{:.0f} urad, which explains {:.0f} % of the misfit of the unloaded positions: the tool slipped on the "
          "flange",
          values.name(0), 1e3 * values.number(1), 1e6 * values.number(2), 100.0 * values.number(3));
    case audit::RemarkId::positions_miss:
      return fmt::format(
          "{} unloaded positions miss forward kinematics with sag by {:.3f} mm rms per coordinate, {:.3f} mm "
          "once shift, reflectors, axes and sag are fitted within their uncertainties ({:.2f} of what these "
          "leave open){}",
          values.count(0), 1e3 * values.number(1), 1e3 * values.number(2), values.number(3), more(values, 4));
    case audit::RemarkId::positions_impossible:
      return "; far more than own weight leaves once it is taken off: units, angles or the tracker's place are "
             "wrong in one of the tables";
    case audit::RemarkId::geometry_does_not_carry:
      return "; the swept geometry does not carry over to the postures: joint zeros, gear errors, or the own "
             "weight bends more than the joints (bearings, links)";
    case audit::RemarkId::zero_since_sweeps:
      return fmt::format(
          "; {:.0f} % of this goes where joint {} stands {:+.4f} deg from its reported angle in all of loading, as it "
          "did not in the sweeps: was its zero set again between them, or does one of the tables have another?",
          100.0 * values.number(2), values.count(0), values.number(1) / io::kDegree);
    case audit::RemarkId::angles_agree:
      return "reported joint angles agree with what the reflectors say, posture by posture";
    case audit::RemarkId::angles_stale:
      return "reported before the arm settled, or stale: " + few(values.remarks(0), "; ");
    case audit::RemarkId::joint_off:
      return fmt::format("{} (pose {}: joint {} stands {:.4f} deg from what is reported)", values.name(0),
                         values.name(1), values.count(2), values.number(3) / io::kDegree);
    case audit::RemarkId::angle_changes:
      return fmt::format("joint {}'s reported angle changes most, at pose {}, step {}{}", values.count(0),
                         values.name(1), values.count(2),
                         values.count(3) != 0
                             ? ": the servo gives way, and identification counts that as stiffness of the closed loop"
                             : "");
    case audit::RemarkId::no_angle_changes:
      return "no reported angle changes under load";
    case audit::RemarkId::comes_back:
      return fmt::format(
          "unloaded again, reflectors stand {:.2f} times as far from step 0 as noise alone; farthest {}"
          " at pose {}, step {}{}",
          values.number(0), lengthWords(values.number(1), 0), values.name(2), values.count(3), more(values, 4));
    case audit::RemarkId::do_not_come_back:
      return fmt::format(
          "; {} of {} postures do not come back{}{}; friction, backlash, a slipping part, or drift that "
          "nests do not show",
          values.remarks(0).size(), values.count(1), values.remarks(0).empty() ? "" : ": ",
          few(values.remarks(0), ", "));
    case audit::RemarkId::posture_off:
      return fmt::format("{} by {}", values.name(0), lengthWords(values.number(1), 0));
    case audit::RemarkId::unloaded_reading:
      return unloadedReading(values);
    case audit::RemarkId::not_tared:
      return ": not tared, or tared with something on it";
    case audit::RemarkId::zero_drifts:
      return fmt::format(": its zero drifts, by {:.3g} N and {:.2g} Nm in {:.1f} h", values.number(0), values.number(1),
                         values.number(2));
    case audit::RemarkId::one_pose_off:
      return fmt::format("; pose {} is {:.1f} sigma off", values.name(0), values.number(1));
    case audit::RemarkId::force_off_gravity:
      return fmt::format(
          "a hanging load's force lies {:.2f} mrad rms off gravity, {:.2f} mrad on average, farthest {:.2f} "
          "mrad at pose {}{}",
          1e3 * values.number(0), 1e3 * values.number(1), 1e3 * values.number(2), values.name(3), more(values, 4));
    case audit::RemarkId::cell_rope_or_base:
      return ": load cell turned against its declared axes, a rope that drags, or base_link not level";
    case audit::RemarkId::moments_of_force:
      return fmt::format("moments are those of the force at ({}) mm from the cell's point, but for {:.2f} Nm rms{}",
                         millimetres(values.numbers(0), 1), values.number(1), more(values, 2));
    case audit::RemarkId::lever_too_long:
      return ": no tool is that long, forces (kN for N) or moments (N mm for Nm) are in another unit";
    case audit::RemarkId::worst_state:
      return fmt::format("; worst at {} (pose {}, step {})", values.name(0), values.name(1), values.count(2));
    case audit::RemarkId::signs_mend:
      return fmt::format("; with {} of {} turned round they agree", fmt::join(values.names(0), ", "),
                         values.count(1) != 0 ? "all states" : "that state");
    case audit::RemarkId::load_moves:
      return fmt::format("{:.4g} N rms move the reflectors by {:.3g} mm rms", values.number(0),
                         values.number(1) / io::kMillimetre);
    case audit::RemarkId::joint_identifiable:
      return fmt::format("joint {}: identifiable: the load turns it by {:.4g} Nm rms, known to {:.2g} Nm",
                         values.count(0), values.number(1), values.number(2));
    case audit::RemarkId::joint_not_identifiable:
      return fmt::format("joint {}: not identifiable: {}", values.count(0), words(values.remark(1)));
    case audit::RemarkId::joint_missing:
      return fmt::format("; joint {}: {}", values.count(0), words(values.remark(1)));
    case audit::RemarkId::no_joint_identified:
      return "no joint can be identified" + more(values, 0);
    case audit::RemarkId::joints_identified:
      return fmt::format(
          "{} postures at load step {} identify joints {} with a condition number of {:.3g} of their equations{}",
          values.count(0), values.count(1), fmt::join(values.counts(2), ", "), values.number(3), more(values, 4));
    case audit::RemarkId::effects_apart:
      return fmt::format("effects that could be told apart: {}", fmt::join(values.names(0), ", "));
    case audit::RemarkId::effects_alike:
      return fmt::format("effects that could not always be told apart: {}", fmt::join(values.names(0), " or "));
    case audit::RemarkId::readings_agree:
      return fmt::format("postures and sweeps miss the URDF's arm, sag taken off, by {:.3g} mm (median)",
                         values.number(0) / io::kMillimetre);
    case audit::RemarkId::readings_contradict:
      return fmt::format("postures and sweeps miss the URDF's arm, sag taken off, by {:.4g} mm (median): {}",
                         values.number(0) / io::kMillimetre, mending(values.count(1), values.name(2)));
    case audit::RemarkId::springs_agree:
      return fmt::format("joint springs on the URDF's arm leave {:.1f} % of the displacements",
                         100.0 * values.number(0));
    case audit::RemarkId::springs_contradict:
      return fmt::format("joint springs on the URDF's arm leave {:.1f} % of the displacements: {}",
                         100.0 * values.number(0), mending(values.count(1), values.name(2)));
    case audit::RemarkId::effects_not_testable:
      return fmt::format("effects that cannot be tested here (diagnose says what is missing): {}",
                         fmt::join(values.names(0), ", "));
  }
  return {};
}

}  // namespace stiffscope::reports
