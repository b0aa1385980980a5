#include "core/interchange/day_template.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

#include "core/io/input_error.h"

namespace stiffscope::interchange {

namespace {

struct MakerLines {
  const char* joints;  ///< how the controller states them
  const char* log;
  const char* join;
};

MakerLines makerLines(Maker maker) {
  switch (maker) {
    case Maker::fanuc:
      return {
          "  <!-- FANUC states axis 3 against the horizontal: the joint's angle is J3 + J2 -->\n"
          "  <joint_reading joint=\"3\" plus=\"2\"/>\n",
          "  <!-- a KAREL log (Time [ms];...;J1;...;J6;), or the taught positions of a program (.ls, by=\"name\") -->\n"
          "  <log file=\"karel.csv\" format=\"fanuc_karel\"/>\n",
          "clock"};
    case Maker::kuka:
      return {
          "  <!-- URDFs of KUKA's arms are of two kinds: with <axis xyz=\"0 0 -1\"/> joint 1 turns as A1 does, with\n"
          "       0 0 1 the other way; axes 4 and 6 may as well, and the zero of axes 2 and 3 may be another. Compare\n"
          "       A1..A6 in one posture with the URDF, and state what differs, for example\n"
          "       <joint_reading joint=\"1\" sign=\"-1\"/> -->\n",
          "  <!-- taught axes of a .dat file, named P1, P2, ...: DECL E6AXIS XP1={A1 ...} -->\n"
          "  <log file=\"program.dat\" format=\"kuka_krl\" names=\"XP{pose}\"/>\n",
          "name"};
    case Maker::abb:
      return {"  <!-- IRBs with a parallelogram couple axis 3 to axis 2; others need no joint_reading -->\n",
              "  <!-- jointtargets of a RAPID module, named j1, j2, ... -->\n"
              "  <log file=\"module.mod\" format=\"rapid\" names=\"j{pose}\"/>\n",
              "name"};
    case Maker::ur:
      break;
  }
  return {"  <!-- UR's joints are the URDF's: no joint_reading -->\n",
          "  <!-- a recording of the real-time interface; without a column of time state its rate (rate_hz) -->\n"
          "  <log file=\"joints.txt\" format=\"ur\" rate_hz=\"125\"/>\n",
          "clock"};
}

}  // namespace

Maker makerNamed(const std::string& name, const std::string& option) {
  for (std::size_t i = 0; i < kMakerNames.size(); ++i) {
    if (name == kMakerNames[i]) return static_cast<Maker>(i);
  }
  const std::vector<std::string> known(kMakerNames.begin(), kMakerNames.end());
  throw io::InputError({option}, name,
                       fmt::format("expected {}{}", fmt::join(known, ", "), io::nearestNameHint(name, known)));
}

std::string dayTemplate(Maker maker) {
  const MakerLines lines = makerLines(maker);
  const bool clock = std::string(lines.join) == "clock";
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text +=
      "<!-- A day as tracker and robot wrote it. Fill in, put the files beside it, and run\n"
      "     stiffscope import campaign DAY.xml --out FOLDER\n"
      "     docs/import.md has every element. -->\n"
      "<day format=\"1\" name=\"Cell 4\" date=\"2026-01-31\">\n"
      "  <robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\" controller_model=\"nominal\"/>\n";
  text += lines.joints;
  text +=
      "  <!-- one-sigma noise of one reading, from the tracker's data sheet -->\n"
      "  <tracker model=\"absolute tracker\" range_fixed_um=\"4\" range_per_m_um=\"0.6\" angle_fixed_um=\"6\" "
      "angle_per_m_um=\"2.4\"/>\n"
      "  <targets>\n    <target id=\"P10\"/>\n    <target id=\"P11\"/>\n    <target id=\"P12\"/>\n  </targets>\n"
      "  <!-- <target_name from=\"1\" to=\"P10\"/> where the tracker's software names it otherwise -->\n";
  if (clock) {
    text +=
        "  <!-- readings belong to the standstill they fall into; names repeat once a pose -->\n"
        "  <points role=\"loading\" file=\"tracker.txt\"/>\n";
  } else {
    text +=
        "  <!-- names say reflector and pose -->\n"
        "  <points role=\"loading\" file=\"tracker.txt\" names=\"{target}_{pose}\"/>\n";
  }
  text +=
      "  <!-- <points role=\"nests\" file=\"tracker.txt\" only=\"N1 N2 N3\"/> reflectors on the floor -->\n"
      "  <!-- <points role=\"circle_sweeps\" file=\"sweep1.txt\" axis=\"1\"/> one file an axis -->\n";
  text += lines.log;
  text += fmt::format("  <join by=\"{}\"/>\n</day>\n", lines.join);
  return text;
}

std::string campaignTemplate(const std::string& base_link, const std::string& flange_link) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!-- One machine in one condition, measured once. docs/campaign-format.md has every element and the tables' "
      "columns; all\n"
      "     tables are optional. -->\n"
      "<campaign format=\"1\" name=\"Cell 4\" date=\"2026-01-31\">\n"
      "  <robot urdf=\"robot.urdf\" base_link=\"{}\" flange_link=\"{}\"/>\n"
      "  <!-- one-sigma noise of one reading, from the tracker's data sheet -->\n"
      "  <tracker model=\"absolute tracker\" range_fixed_um=\"4\" range_per_m_um=\"0.6\" angle_fixed_um=\"6\" "
      "angle_per_m_um=\"2.4\"/>\n"
      "  <targets>\n    <target id=\"P10\"/>\n    <target id=\"P11\"/>\n    <target id=\"P12\"/>\n  </targets>\n"
      "  <!-- <joint_reading joint=\"3\" plus=\"2\"/> where the controller states joints otherwise (FANUC) -->\n"
      "  <!-- <load_cell parent=\"{}\" xyz_mm=\"0 0 110\" rpy_deg=\"0 0 0\" force_sigma_n=\"1\" "
      "moment_sigma_nm=\"0.3\"/> -->\n"
      "  <!-- <tool mass_kg=\"60\" com_mm=\"0 0 90\"/> -->\n"
      "  <!-- <circle_sweeps file=\"circle_sweeps.csv\"/> -->\n"
      "  <!-- <wrist_sweep file=\"wrist_sweep.csv\"/> -->\n"
      "  <!-- <loading file=\"loading.csv\"/> -->\n"
      "  <!-- <states file=\"states.csv\"/> -->\n"
      "  <!-- <nests file=\"nests.csv\"/> -->\n"
      "</campaign>\n",
      base_link, flange_link, flange_link);
}

}  // namespace stiffscope::interchange
