#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "core/io/units.h"
#include "core/mistakes/remarks.h"
#include "core/mistakes/spring_fit.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

double degrees(double angle) { return angle / io::kDegree; }
double millimetresOf(double length) { return length / io::kMillimetre; }

/// Right angles without decimals, others with one.
std::string roundedDegrees(double angle) {
  const double value = degrees(angle), whole = std::round(value);
  return std::abs(value - whole) < 0.05 ? fmt::format("{:.0f}", whole == 0.0 ? 0.0 : whole)
                                        : fmt::format("{:.1f}", value);
}

std::string files(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::string coordinates(const std::vector<double>& place) {
  return fmt::format("{:.0f} {:.0f} {:.0f}", millimetresOf(place.at(0)), millimetresOf(place.at(1)),
                     millimetresOf(place.at(2)));
}

std::string turnSigns(const RemarkValues& values) {
  const auto& joints = values.counts(0);
  std::string columns;
  for (const std::int64_t joint : joints) columns += fmt::format("{}q{}_deg", columns.empty() ? "" : ", ", joint);
  const std::string which = joints.size() == 1 ? fmt::format("sign of joint {}", joints.front())
                                               : fmt::format("signs of joints {}", fmt::join(joints, ", "));
  return fmt::format(
      "turn the {} ({}){}", which, columns,
      values.count(1) != 0 ? ", or the axis of that joint in the URDF where it is the URDF that is wrong" : "");
}

std::string addJoint(const RemarkValues& values) {
  const std::int64_t joint = values.count(0), other = values.count(1);
  const bool plus = values.count(2) > 0;
  return fmt::format(
      "the readings give joint {0} without joint {1}, as some controllers show it: write q{0}_deg {2} q{1}_deg for "
      "q{0}_deg",
      joint, other, plus ? "+" : "-");
}

std::string shiftZero(const RemarkValues& values) {
  return fmt::format("shift the zero of joint {0} by {1} deg (add it to q{0}_deg){2}", values.count(0),
                     roundedDegrees(values.number(1)),
                     values.count(2) != 0 ? ", or turn that joint's origin in the URDF" : "");
}

/// "angles stand in rows of other poses, in the reverse order: those of pose 1 in the row of pose 16, ..."
std::string renumbered(bool whole_rows, const RemarkValues& values) {
  const std::vector<std::string>& pairs = values.names(0);
  constexpr std::size_t kShown = 16;  // eight pairs
  std::string text = fmt::format("{} stand in the rows of other poses", whole_rows ? "angles and wrenches" : "angles");
  if (!values.remark(1).empty()) text += ", " + words(values.remark(1));
  for (std::size_t i = 0; i + 1 < std::min(kShown, pairs.size()); i += 2)
    text += fmt::format("{}those of pose {} in that of pose {}", i == 0 ? ": " : ", ", pairs[i], pairs[i + 1]);
  if (pairs.size() > kShown) text += fmt::format(" and {} more", (pairs.size() - kShown) / 2);
  return text + (whole_rows ? ": number the rows, or the readings, as the others are"
                            : ": put the angles of each pose into its own row");
}

/// Whole millimetres where the shift is of a centimetre or more.
std::string originOff(const RemarkValues& values) {
  const std::vector<double>& shift = values.numbers(1);
  const double largest = std::max({std::abs(shift.at(0)), std::abs(shift.at(1)), std::abs(shift.at(2))});
  constexpr double kCentimetre = 1e-2;
  const int decimals = largest < kCentimetre ? 2 : 0;
  const std::vector<double>& unseen = values.numbers(2);
  const auto triple = [](const std::vector<double>& all, std::size_t first, double unit, int places) {
    std::string text;
    for (std::size_t i = first; i < first + 3; ++i)
      text += fmt::format("{}{:.{}f}", i == first ? "" : ", ", unsignedZero(all.at(i) / unit, places), places);
    return "(" + text + ")";
  };
  std::string directions;
  for (std::size_t i = 0; i + 2 < unseen.size(); i += 3)
    directions += (directions.empty() ? "" : " and ") + triple(unseen, i, 1.0, 2);
  return fmt::format(
      "shift the origin of joint {} by {} mm in base_link's axes, all joints at zero{}; or the URDF is another "
      "machine's",
      values.count(0), triple(shift, 0, io::kMillimetre, decimals),
      directions.empty() ? "" : ", and as far as it may be along " + directions + ", which the readings do not show");
}

std::string exchangedNames(const std::vector<std::string>& pairs) {
  std::string text;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    text += fmt::format("{}{} is {}", text.empty() ? "" : ", ", pairs[i], pairs[i + 1]);
  return text;
}

std::string exchangedLabels(const std::vector<std::int64_t>& pairs) {
  std::string turns;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    turns +=
        fmt::format("{}under axis {} it is joint {} that turns", turns.empty() ? "" : ", ", pairs[i], pairs[i + 1]);
  std::vector<std::int64_t> labels;
  for (std::size_t i = 0; i < pairs.size(); i += 2) labels.push_back(pairs[i]);
  return fmt::format("mend the labels of the sweeps of axes {}: {}", fmt::join(labels, " and "), turns);
}

std::string turnCell(const RemarkValues& values) {
  const std::vector<double>&axis = values.numbers(0), &rpy = values.numbers(2);
  std::string about;
  for (std::size_t k = 0; k < 3; ++k) {
    if (axis.at(k) > 0.99) about = std::string(1, "xyz"[k]);
  }
  const auto small = [](double a) {
    const double third = a / 0.57735026918963, half = a / 0.70710678118655;
    if (std::abs(third - std::round(third)) < 1e-3) return fmt::format("{:.0f}", std::round(third));
    if (std::abs(half - std::round(half)) < 1e-3) return fmt::format("{:.0f}", std::round(half));
    return fmt::format("{:.2f}", a);
  };
  if (about.empty()) about = fmt::format("({}, {}, {})", small(axis.at(0)), small(axis.at(1)), small(axis.at(2)));
  return fmt::format(
      "turn the load cell about {} by {} deg, which is rpy_deg=\"{} {} {}\"; or the flange's frame in the URDF, or "
      "the zero of joint {}, is turned by as much",
      values.count(3) != 0 ? fmt::format("{} of its parent", about) : fmt::format("its {}", about),
      std::round(degrees(values.number(1))), roundedDegrees(rpy.at(0)), roundedDegrees(rpy.at(1)),
      roundedDegrees(rpy.at(2)), values.count(4));
}

std::string wrenchIn(const RemarkValues& values) {
  if (values.name(1).find(" and ") != std::string::npos) {
    const std::size_t at = values.name(1).find(" and ");
    return fmt::format("the readings are forces in {} and moments in {}: write N and Nm", values.name(1).substr(0, at),
                       values.name(1).substr(at + 5));
  }
  if (values.name(0) == "wrenches") {
    return fmt::format(
        "the readings are wrenches in {0}, forces as well as moments: write N and Nm; or the URDF's masses are off by "
        "as much",
        values.name(1));
  }
  return fmt::format("the readings are {} in {}: write {}", values.name(0), values.name(1),
                     values.name(0) == "forces" ? "N" : "Nm");
}

std::string wrenchOfRow(mistakes::WrenchRow row) {
  switch (row) {
    case mistakes::WrenchRow::previous_posture:
      return "each wrench stands a posture early: that of a posture is in the row of the posture before";
    case mistakes::WrenchRow::next_posture:
      return "each wrench stands a posture late: that of a posture is in the row of the next posture";
    case mistakes::WrenchRow::previous_step:
      return "each wrench stands a step early: that of a step is in the row of the step before";
    case mistakes::WrenchRow::next_step:
      return "each wrench stands a step late: that of a step is in the row of the next step";
    case mistakes::WrenchRow::own:
      break;
  }
  return {};
}

}  // namespace

std::string mistakesWords(mistakes::RemarkId id, const RemarkValues& values) {
  using mistakes::RemarkId;
  switch (id) {
    case RemarkId::in_columns:
      return fmt::format("columns {} of {}", values.name(0), files(values.names(1)));
    case RemarkId::in_files:
      return files(values.names(0));
    case RemarkId::at_pose_in:
      return fmt::format("pose {}, {} from {} on", values.name(0), values.name(1), values.name(2));
    case RemarkId::at_sweep_of:
      return fmt::format("sweep{}, {} from {} on",
                         values.count(0) > 0 ? fmt::format(" of axis {}", values.count(0)) : " of the wrist",
                         values.name(1), values.name(2));
    case RemarkId::in_urdf:
      return "URDF";
    case RemarkId::in_cell:
      return fmt::format("attribute {} of load_cell in campaign.xml", values.name(0));
    case RemarkId::in_attribute:
      return fmt::format("attribute {} in campaign.xml of the tables {}", values.name(0), files(values.names(1)));
    case RemarkId::in_robot:
      return fmt::format("attribute {} of robot in campaign.xml", values.name(0));
    case RemarkId::at_poses_in:
      return fmt::format("poses {} to {}, {} of {}", values.name(0), values.name(1), values.name(2), values.name(3));
    case RemarkId::both:
      return fmt::format("{}; and in the {}: {}", words(values.remarks(0).at(0)), words(values.remarks(0).at(2)),
                         words(values.remarks(0).at(1)));
    case RemarkId::turn_signs:
      return turnSigns(values);
    case RemarkId::order_of_joints:
      return fmt::format("q1_deg to q6_deg hold the joints in the order {}", fmt::join(values.counts(0), ", "));
    case RemarkId::add_joint:
      return addJoint(values);
    case RemarkId::shift_zero:
      return shiftZero(values);
    case RemarkId::angles_in:
      return fmt::format("the readings are angles in {}: write degrees", values.name(0));
    case RemarkId::angles_of_row:
      return values.count(0) != 0 ? "angles lag behind the readings: those of a reading stand in the row after it"
                                  : "angles run ahead of the readings: those of a reading stand in the row before it";
    case RemarkId::angles_of_posture:
      return values.count(0) != 0 ? "angles of a posture stand in the row of the next posture"
                                  : "angles of a posture stand in the row of the posture before";
    case RemarkId::angles_exchanged:
      return fmt::format("exchange the angles of poses {} and {}", values.name(0), values.name(1));
    case RemarkId::readings_exchanged:
      return fmt::format("exchange the readings of poses {} and {}", values.name(0), values.name(1));
    case RemarkId::angles_repeated:
      return fmt::format("pose {0} has the angles of pose {1}, and not its readings: write those of pose {0}",
                         values.name(0), values.name(1));
    case RemarkId::angles_renumbered:
    case RemarkId::rows_renumbered:
      return renumbered(id == RemarkId::rows_renumbered, values);
    case RemarkId::order_reversed:
      return "in the reverse order";
    case RemarkId::order_moved_on:
      return fmt::format("{} row{} {}", std::abs(values.count(0)), std::abs(values.count(0)) == 1 ? "" : "s",
                         values.count(0) > 0 ? "further on, those at the end at the beginning"
                                             : "further up, those at the beginning at the end");
    case RemarkId::order_as_texts:
      return "in the order of their names as texts, which has 10 before 2";
    case RemarkId::rows_lost:
      return fmt::format("from pose {} on each posture has the angles of the {}: a row of the log is {}",
                         values.name(0), values.count(1) != 0 ? "next" : "one before",
                         values.count(1) != 0 ? "lost" : "too many");
    case RemarkId::angles_backwards:
      return fmt::format("the angles of the sweep of axis {} run backwards: its last row has those of the first",
                         values.count(0));
    case RemarkId::sweeps_exchanged:
      return fmt::format("exchange the readings of the sweeps of axes {} and {}", values.count(0), values.count(1));
    case RemarkId::labels_exchanged:
      return exchangedLabels(values.counts(0));
    case RemarkId::origin_off:
      return originOff(values);
    case RemarkId::origin_turned:
      return fmt::format("turn the origin of joint {} by {} deg about {} of base_link, all joints at zero",
                         values.count(0), roundedDegrees(values.number(2)),
                         std::string(1, "xyz"[static_cast<std::size_t>(values.count(1))]));
    case RemarkId::scale_off: {
      const double percent = 100.0 * values.number(0);
      return fmt::format(
          "the points are {:.1f} % too {} for the URDF's arm: the tracker's scale (air, unit, a "
          "reflector's offset) is off, or the URDF's lengths are {:.1f} % too {}",
          std::abs(percent), percent > 0.0 ? "large" : "small", std::abs(percent), percent > 0.0 ? "short" : "long");
    }
    case RemarkId::left_handed:
      return "the points' axes are left-handed: turn the sign of one of x_mm, y_mm, z_mm, or exchange two of them, in "
             "all tables";
    case RemarkId::axes_of_points:
      return fmt::format("write ({}) for (x, y, z)", fmt::join(values.names(0), ", "));
    case RemarkId::points_in:
      return fmt::format("the readings are points in {}: write mm{}", values.name(0),
                         values.name(0) == "m" ? ", or the URDF's lengths are in mm" : "");
    case RemarkId::robot_in:
      return fmt::format("its lengths are in {}: write m", values.name(0));
    case RemarkId::masses_in:
      return fmt::format("the arm's masses are in {}, {:.3g} in all: write kg", values.name(0), values.number(1));
    case RemarkId::table_scale_off: {
      const double percent = 100.0 * values.number(0);
      return fmt::format("the points of this table are {:.1f} % too {} against the others", std::abs(percent),
                         percent > 0.0 ? "large" : "small");
    }
    case RemarkId::step_scale_off:
      return fmt::format(
          "the wrenches of load step {} are {:.3g} times what the other steps' springs say: mend their "
          "unit or their rows",
          values.count(0), values.number(1));
    case RemarkId::weight_not_tared:
      return fmt::format(
          "tare the load cell: unloaded it shows a weight of {:.3g} kg that turns with the postures "
          "({:.4g} N, of which that leaves {:.2g} N); take it off all rows",
          values.number(0), values.number(1), values.number(2));
    case RemarkId::other_station:
      return fmt::format(
          "read from another station, or after the tracker or the robot moved, by {:.0f} mm and {} deg: "
          "refer the points to the station of the other tables",
          millimetresOf(values.number(0)), roundedDegrees(values.number(1)));
    case RemarkId::elsewhere:
      return fmt::format(
          "its readings stand {:.0f} mm and {} deg away as a whole: the tracker or the robot moved, or these are the "
          "angles of another posture",
          millimetresOf(values.number(0)), roundedDegrees(values.number(1)));
    case RemarkId::not_in_base:
      return fmt::format(
          "the points are not in the base, but in a frame {:.0f} mm and {} deg away: take "
          "frame=\"base_link\" off",
          millimetresOf(values.number(0)), roundedDegrees(values.number(1)));
    case RemarkId::reflectors_renamed:
      return fmt::format("mend the names: {}", exchangedNames(values.names(0)));
    case RemarkId::reflector_twice:
      return fmt::format("{} and {} are one reflector there, read twice ({:.2f} mm apart at most)", values.name(0),
                         values.name(1), millimetresOf(values.number(2)));
    case RemarkId::reflectors_on_line:
      return fmt::format(
          "the reflectors stand on one line but for {:.1f} mm of {:.0f} mm: the turn about it is not "
          "seen; mount one of them aside",
          millimetresOf(values.number(0)), millimetresOf(values.number(1)));
    case RemarkId::turn_wrench_signs:
      return fmt::format("turn the sign of {}", fmt::join(values.names(0), ", "));
    case RemarkId::order_of_wrench:
      return fmt::format("mend the order of {}: write ({}) for (x, y, z)", values.name(0),
                         fmt::join(values.names(1), ", "));
    case RemarkId::moments_first:
      return "moments stand where the forces should, and forces where the moments should: exchange the columns";
    case RemarkId::cell_left_handed:
      return fmt::format("the load cell's axes are left-handed: write ({}) for (x, y, z) in forces and moments",
                         fmt::join(values.names(0), ", "));
    case RemarkId::turn_cell:
      return turnCell(values);
    case RemarkId::cell_along_link:
      return fmt::format("the wrench is parallel to {0}: declare axes=\"{0}\"", values.name(0));
    case RemarkId::cell_not_along_link:
      return fmt::format("the wrench is not parallel to {}: take axes off and give rpy_deg", values.name(0));
    case RemarkId::cell_turned_back:
      return "rpy_deg is that of the parent in the cell: declare the inverse";
    case RemarkId::cell_angles_in:
      return fmt::format("rpy_deg is in {}: write degrees", values.name(0));
    case RemarkId::cell_not_turned:
      return "the cell is not turned: take rpy_deg off";
    case RemarkId::move_cell:
      return fmt::format("the point of the load cell is not at {} mm: xyz_mm=\"{}\" explains the loads",
                         coordinates(values.numbers(0)), coordinates(values.numbers(1)));
    case RemarkId::wrench_in:
      return wrenchIn(values);
    case RemarkId::wrench_of_row:
      return wrenchOfRow(static_cast<mistakes::WrenchRow>(values.count(0)));
    case RemarkId::wrenches_exchanged:
      return fmt::format("exchange the wrenches of poses {} and {}", values.name(0), values.name(1));
    case RemarkId::wrenches_repeated:
      return fmt::format("pose {0} has the wrenches of pose {1}, digit by digit: write those of pose {0}",
                         values.name(0), values.name(1));
    case RemarkId::steps_repeated: {
      const std::vector<std::string>& poses = values.names(0);
      return fmt::format("pose{} {}: step {} has the wrench of step {}, digit by digit: write its own",
                         poses.size() == 1 ? "" : "s", fmt::join(poses, ", "), values.count(1), values.count(2));
    }
    case RemarkId::steps_exchanged:
      return fmt::format("exchange the {} of steps {} and {}", values.count(2) != 0 ? "readings" : "wrenches",
                         values.count(0), values.count(1));
    case RemarkId::gravity_reversed:
      return fmt::format("gravity points the other way: the own weight bends the arm by {:.2f} of what its masses say",
                         values.number(0));
    case RemarkId::misses_arm:
      return fmt::format("the readings then miss the URDF's arm by {:.2f} mm rms instead of {:.4g} mm",
                         millimetresOf(values.number(1)), millimetresOf(values.number(0)));
    case RemarkId::group_misses_arm:
      return fmt::format("its readings then miss the URDF's arm by {:.2f} mm rms instead of {:.4g} mm",
                         millimetresOf(values.number(1)), millimetresOf(values.number(0)));
    case RemarkId::stated_pose_misses:
      return fmt::format(
          "the poses that the controller states then miss the URDF's by {:.3f} mm rms instead of {:.4g} mm",
          millimetresOf(values.number(1)), millimetresOf(values.number(0)));
    case RemarkId::loads_left:
      return fmt::format("joint springs then leave {:.1f} % of the displacements instead of {:.1f} %",
                         100.0 * values.number(1), 100.0 * values.number(0));
    case RemarkId::off_gravity:
      return fmt::format("the forces then pull down within {} deg instead of {} deg", roundedDegrees(values.number(1)),
                         roundedDegrees(values.number(0)));
    case RemarkId::sag_against_load:
      return fmt::format("the own weight's sag and the loads' then differ by a factor of {:.2f} instead of {:.2f}",
                         values.number(1), values.number(0));
    case RemarkId::day_scatters:
      return fmt::format("readings over the day then scatter by {:.2f} of it instead of {:.2f}", values.number(1),
                         values.number(0));
  }
  return {};
}

}  // namespace stiffscope::reports
