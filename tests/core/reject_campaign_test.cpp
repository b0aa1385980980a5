#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/campaign/read_campaign.h"
#include "core/input/input_error.h"
#include "core/input/one_line.h"
#include "tests/core/small_campaign.h"

namespace stiffscope {
namespace {

/// One change to the small campaign, and what the error must say. `find` empty: the whole file is replaced.
struct Rejected {
  const char *file, *find, *replace, *message;
};

const std::string kManyColumns = std::string(1000, ',') + "\n1\n";
const std::string kDeep = [] {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "<a>";
  return text;
}();

const std::string kManyAttributes = [] {
  std::string text = "<campaign";
  for (int i = 0; i < 1001; ++i) text += " a" + std::to_string(i) + "='>'";
  return text + "/>";
}();

const Rejected kTables[] = {
    // Header lines.
    {"nests.csv", "x_mm", "x_m",
     "nests.csv:1: x_mm: expected this column; the header lacks it and has 'x_m'"},
    {"nests.csv", "x_mm", "x_mm\xC2\xA0",
     "nests.csv:1: x_mm: expected this column; the header lacks it and has 'x_mm' with a character that does not show"},
    {"nests.csv", "time_s", "# exported, as it says,\ntime_s",
     "nests.csv:1: time_s: expected this column; the header lacks it; it starts with '# exported'"},
    {"nests.csv", "time_s", "sep=\ntime_s", "nests.csv:1: time_s: expected this column; the header lacks it; it starts with 'sep='"},
    {"nests.csv", "z_mm", "", "nests.csv:1: z_mm: expected this column; the header lacks it"},
    {"loading.csv", "time_s,", "", "loading.csv:1: time_s: expected this column"},
    {"circle_sweeps.csv", "q3_deg", "q3_rad", "circle_sweeps.csv:1: q3_deg: expected this column"},
    {"nests.csv", "y_mm", "x_mm", "nests.csv:1: x_mm: expected this column once; the header has it twice"},
    {"nests.csv", "", "time_s;nest;x_mm;y_mm;z_mm\n0,0;N1;1,5;2;3\n",
     "nests.csv:1: 'time_s;nest;x_mm;y_mm;z_mm': expected columns separated by commas and numbers with a "
     "decimal "
     "point; this header has semicolons"},
    {"nests.csv", "", "time_s\tnest\tx_mm\ty_mm\tz_mm\n0\tN1\t1\t2\t3\n", "this header has tabs"},
    {"nests.csv", "", "time_s,nest,x_mm,y_mm,z_mm\n",
     "nests.csv: expected at least one row below the header"},
    {"nests.csv", "", "\n\n  \n", "nests.csv: expected a header line; there is none"},
    {"nests.csv", "", "0,N1,1,2,3\n1,N1,1,2,3\n", "nests.csv:1: time_s: expected this column"},
    // Numbers of cells.
    {"nests.csv", ",-1209.9495", "", "nests.csv:2: '4 cells': expected 5 cells, as the header has"},
    {"nests.csv", "0.0,N1", "0,0,N1",
     "nests.csv:2: '6 cells': expected 5 cells, as the header has; a decimal comma splits a number in two"},
    {"nests.csv", ",1315.5592,-1180.4804\n", ",1315.5",
     "nests.csv:3: '4 cells': expected 5 cells, as the header has; the file ends in the middle of this line"},
    {"nests.csv", "0.0,N1", "0.0,\"N1", "nests.csv:2: '\"': expected a closing quote on the same line"},
    {"nests.csv", "0.0,N1", "0.0,\"N1\"x",
     "nests.csv:2: 'x': expected a comma, or the end of the line, after a closing quote"},
    {"nests.csv", "-1209.9495", "-1209.9495,",
     "nests.csv:2: '6 cells': expected 5 cells, as the header has; a decimal comma"},
    {"nests.csv", "-1209.9495\n", "-1209.9495\n,,,,\n", "nests.csv:3: time_s: expected a number; there is nothing"},
    {"nests.csv", "", "time_s,nest,x_mm,y_mm,z_mm,,\n0,N1,1,5,2,3,\n",
     "nests.csv:2: column 6: '3': expected nothing in a column without a name; a decimal comma splits"},
    {"nests.csv", "", kManyColumns.c_str(), "nests.csv:1: '1001 columns': expected at most 1000 columns"},
    // Numbers.
    {"nests.csv", "3349.2176", "abc", "nests.csv:2: x_mm: 'abc': expected a number"},
    {"nests.csv", "3349.2176", "", "nests.csv:2: x_mm: expected a number; there is nothing"},
    {"nests.csv", "3349.2176", "3349.2176mm", "nests.csv:2: x_mm: '3349.2176mm': expected a number"},
    {"nests.csv", "3349.2176", "33 49", "nests.csv:2: x_mm: '33 49': expected a number"},
    {"nests.csv", "3349.2176", "\"3349,2\"",
     "nests.csv:2: x_mm: '3349,2': expected a number with a decimal point, not a decimal comma"},
    {"nests.csv", "3349.2176", "nan", "nests.csv:2: x_mm: 'nan': expected a finite number"},
    {"nests.csv", "3349.2176", "-inf", "nests.csv:2: x_mm: '-inf': expected a finite number"},
    {"nests.csv", "3349.2176", "1e999",
     "nests.csv:2: x_mm: '1e999': expected a number that double precision"},
    {"nests.csv", "3349.2176", "0x1p3", "nests.csv:2: x_mm: '0x1p3': expected a number"},
    {"nests.csv", "3349.2176", "+-1", "nests.csv:2: x_mm: '+-1': expected a number"},
    {"nests.csv", "3349.2176", "3.3492176D+03",
     "nests.csv:2: x_mm: '3.3492176D+03': expected a number; an exponent is written with e, not with d"},
    {"nests.csv", "3349.2176", "\xE2\x88\x92" "3349.2",
     "nests.csv:2: x_mm: '\xE2\x88\x92" "3349.2': expected a number; its minus sign is a typographic one"},
    {"nests.csv", "3349.2176", "3'349.2176",
     "nests.csv:2: x_mm: '3'349.2176': expected a number without blanks or marks between its digits"},
    {"nests.csv", "3349.2176", "\"3,349.2176\"", "nests.csv:2: x_mm: '3,349.2176': expected a number with a decimal"},
    {"nests.csv", "3349.2176", "3349.2176e", "nests.csv:2: x_mm: '3349.2176e': expected a number"},
    {"nests.csv", "3349.2176", "1e-999",
     "nests.csv:2: x_mm: '1e-999': expected a number that double precision can hold"},
    {"nests.csv", "3349.2176", "#N/A", "nests.csv:2: x_mm: '#N/A': expected a number"},
    {"nests.csv", "3349.2176", "=A1*2", "nests.csv:2: x_mm: '=A1*2': expected a number"},
    {"nests.csv", "0.0,N1", "soon,N1", "nests.csv:2: time_s: 'soon': expected a number"},
    {"wrist_sweep.csv", "952.1996,5.5", "952.1996,",
     "wrist_sweep.csv:2: time_s: expected a number; there is"},
    // Values that cannot be meant.
    {"nests.csv", "3349.2176", "200000.1",
     "nests.csv:2: x_mm: '200000.1': expected a coordinate in mm, within +-200 m"},
    {"wrist_sweep.csv", "-116.85697", "-720.1",
     "wrist_sweep.csv:2: q4_deg: '-720.1': expected an angle in degrees, within +-720"},
    {"states.csv", "A,1,1170.3,7.93121", "A,1,1170.3,-1538.428",
     "states.csv:3: q1_deg: '-1538.428': expected an angle in degrees"},
    {"states.csv", "-538.428", "2e6", "states.csv:3: fx_n: '2e6': expected a force in N, within +-1e6"},
    {"states.csv", "39.656", "-1e7", "states.csv:3: mx_nm: '-1e7': expected a moment in Nm, within +-1e6"},
    {"displacements.csv", "-0.686", "2136.9",
     "displacements.csv:2: dx_mm: '2136.9': expected a displacement from step 0 in mm, within +-1 m"},
    // Identifiers, axes and steps.
    {"loading.csv", "A,1,2,P10", "A,1,2,P12",
     "loading.csv:4: target: 'P12': expected a target that campaign.xml declares: P10, P11 (did you mean "
     "'P10'?)"},
    {"loading.csv", "A,1,2,P10", "A,1,2,", "loading.csv:4: target: expected a value; the cell is empty"},
    {"loading.csv", "A,1,2,P10", ",1,2,P10", "loading.csv:4: pose: expected a value; the cell is empty"},
    {"loading.csv", "A,1,2,P10", "A,1,,P10", "loading.csv:4: repeat: expected a value; the cell is empty"},
    {"loading.csv", "A,1,2,P10", "A,-1,2,P10",
     "loading.csv:4: step: '-1': expected a whole number, 0 or more"},
    {"loading.csv", "A,1,2,P10", "A,1.5,2,P10",
     "loading.csv:4: step: '1.5': expected a whole number, 0 or more"},
    {"loading.csv", "A,1,2,P10", "A,99999999999,2,P10",
     "loading.csv:4: step: '99999999999': expected a whole"},
    {"nests.csv", "2.0,N2", "2.0,", "nests.csv:3: nest: expected a value; the cell is empty"},
    {"circle_sweeps.csv", "6,1,P10", "7,1,P10", "circle_sweeps.csv:4: axis: '7': expected an axis, 1 to 6"},
    {"circle_sweeps.csv", "6,1,P10", "0,1,P10", "circle_sweeps.csv:4: axis: '0': expected an axis, 1 to 6"},
    {"circle_sweeps.csv", "6,1,P10", "A6,1,P10", "circle_sweeps.csv:4: axis: 'A6': expected an axis, 1 to 6"},
    // Keys that repeat.
    {"circle_sweeps.csv", "6,1,P10", "1,0,P11",
     "circle_sweeps.csv:4: axis, index, target: '1, 0, P11': expected a key that does not repeat; line 3 has "
     "it "
     "first"},
    {"wrist_sweep.csv", "952.1996,5.5\n", "952.1996,5.5\n0,P10,0,0,0,0,0,0,1,2,3,4\n",
     "wrist_sweep.csv:3: index, target: '0, P10': expected a key that does not repeat; line 2"},
    {"loading.csv", "A,1,2,P10", "A,01,1,P10",
     "loading.csv:4: pose, step, repeat, target: 'A, 01, 1, P10': expected a key that does not repeat; line "
     "3"},
    {"states.csv", "B,1,1170.4", "A,1,9.0",
     "states.csv:4: pose, step: 'A, 1': expected a key that does not repeat"},
    {"displacements.csv", "-0.025\n", "-0.025\nB,1,P10,0,0,0\n",
     "displacements.csv:3: pose, step, target: 'B, 1, P10': expected a key that does not repeat; line 2"},
    {"nests.csv", "2.0,N2", "-0,N1",
     "nests.csv:3: time_s, nest: '-0, N1': expected a key that does not repeat"},
    // One table against another.
    {"loading.csv", "A,1,2,P10", "A,2,2,P10",
     "loading.csv:4: pose, step: 'A, 2': expected a load state that states.csv has a row for"},
    {"displacements.csv", "B,1", "C,1",
     "displacements.csv:2: pose, step: 'C, 1': expected a load state that"},
    {"displacements.csv", "P10", "P11",
     "displacements.csv:2: target: 'P11': expected a target whose place on the flange campaign.xml gives"},
    // Files.
    {"nests.csv", "", "", "nests.csv: expected a file that is not empty"},
    {"nests.csv", "N1", "N\xE9", "nests.csv:2: expected text in UTF-8"},
    {"nests.csv", "", "\xFF\xFEt", "nests.csv: expected text in UTF-8; this file is UTF-16 by its byte-order mark"},
    {"nests.csv", "", "\xFE\xFFt", "nests.csv: expected text in UTF-8; this file is UTF-16 by its byte-order mark"},
    {"robot.urdf", "link_6\"/>", "link_7\"/>", "robot.urdf:"},
    {"robot.urdf", "0.1 0 0.5", "0,1 0 0.5",
     "robot.urdf:11: xyz: '0,1 0 0.5': expected a number with a decimal point, not a decimal comma (three"},
    {"robot.urdf", "", "solid part\n", "robot.urdf:1: expected well-formed XML"},
    {"robot.urdf", "<origin xyz=\"0.2", "<orgin xyz=\"0.2",
     "robot.urdf:12: orgin: expected a name that URDF has here (did you mean 'origin'?)"},
    {"robot.urdf", "xyz=\"0.2", "xzy=\"0.2", "robot.urdf:12: xzy: expected a name that URDF has here (did you mean 'xyz'?)"},
    {"robot.urdf", "<mass value=\"20\"", "<mass vlaue=\"20\"", "vlaue: expected a name that URDF has here (did you mean 'value'?)"},
    {"robot.urdf", "0.3 0 0.5\" rpy=\"0 0 0\"", "0.3 0 0.5\" rpy=\"180 -90 0\"",
     "robot.urdf:13: rpy: '180 -90 0': expected radians, within one turn"},
    {"robot.urdf", "\"0 2 0\"", "\"0 1e300 0\"", "robot.urdf:12: xyz: '0 1e300 0': expected an axis that is not zero, nor longer"},
    {"nests.csv", nullptr, nullptr,
     "campaign.xml:21: file: 'nests.csv': expected a file inside the campaign's folder; there is none of "
     "this name"},
    {"robot.urdf", nullptr, nullptr, "campaign.xml:8: urdf: 'robot.urdf': expected a file inside"},
};

const Rejected kXml[] = {
    {"campaign.xml", nullptr, nullptr, "expected a campaign folder; it holds no campaign.xml"},
    {"campaign.xml", "", "", "campaign.xml: expected a file that is not empty"},
    {"campaign.xml", "", "  \n", "campaign.xml: expected an XML element; there is none"},
    {"campaign.xml", "", "<?xml version=\"1.0\"?>", "campaign.xml: expected an XML element; there is none"},
    {"campaign.xml", "", "pose,step\n1,2\n", "campaign.xml:1: expected well-formed XML"},
    {"campaign.xml", "</targets>", "</target>",
     "campaign.xml:10: expected well-formed XML: an element is not closed"},
    {"campaign.xml", "mass_kg=\"45\"", "mass_kg=45",
     "campaign.xml:15: expected well-formed XML: an attribute"},
    {"campaign.xml", "mass_kg=\"45\"", "mass_kg=\"45\" mass_kg=\"5\"",
     "campaign.xml:15: expected well-formed XML: an attribute needs a value in quotes, and to be there once"},
    {"campaign.xml", "<campaign ", "<!DOCTYPE campaign [<!ENTITY x SYSTEM \"/etc/hostname\">]>\n<campaign ",
     "campaign.xml: 'DOCTYPE': expected XML without a document type or entities"},
    {"campaign.xml", "",
     "<?xml version=\"1.0\"?><!DOCTYPE lolz [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;\">]><campaign>&b;</campaign>",
     "campaign.xml: 'DOCTYPE': expected XML without a document type or entities"},
    {"campaign.xml", "", kManyAttributes.c_str(), "campaign.xml:1: expected an element of at most 1000 attributes"},
    {"campaign.xml", "", kDeep.c_str(), "campaign.xml:1: expected elements nested less deeply"},
    {"campaign.xml", "Force &amp; Motion", "Force & Motion",
     "campaign.xml:3: '&': expected &amp; for an ampersand; XML without a document type has no entities"},
    {"campaign.xml", "base_link=\"base\"", "base_link=\"&base;\"",
     "campaign.xml:8: '&base': expected &amp; for an ampersand"},
    {"campaign.xml", "<laboratory>", "<laboratory", "campaign.xml:3: expected well-formed XML"},
    {"campaign.xml", "</campaign>", "<!--", "campaign.xml:22: expected well-formed XML"},
    {"campaign.xml", "</campaign>\n", "</campaign>\n<campaign/>",
     "campaign.xml:23: campaign: expected the end of the file after the root element"},
    {"campaign.xml", "", "<robot name=\"r\"/>", "campaign.xml:1: robot: expected <campaign> as the root"},
    {"campaign.xml", "format=\"1\"", "format=\"2\"",
     "campaign.xml:2: format: '2': expected 1, the version of the format this program reads"},
    {"campaign.xml", "format=\"1\"", "fromat=\"1\"",
     "campaign.xml:2: format: expected this attribute of <campaign>; there is 'fromat' (did you mean "
     "'format'?)"},
    {"campaign.xml", "date=\"2026-01-02\"", "",
     "campaign.xml:2: date: expected this attribute of <campaign>"},
    {"campaign.xml", "<robot", "<robbot",
     "campaign.xml:2: robot: expected this element in <campaign>; there is 'robbot' (did you mean 'robot'?)"},
    {"campaign.xml", "<item>I</item>", "<item>I</item><item/>",
     "campaign.xml:6: item: expected this element once; the first is in line 6"},
    {"campaign.xml", "<nests file=\"nests.csv\"/>", "<nests file=\"nests.csv\"/>\n<nests file=\"n\"/>",
     "campaign.xml:22: nests: expected this element once; the first is in line 21"},
    {"campaign.xml", "base_link=\"base\"", "",
     "campaign.xml:8: base_link: expected this attribute of <robot>"},
    {"campaign.xml", "base_link=\"base\"", "base_link=\" \"",
     "campaign.xml:8: base_link: ' ': expected a name"},
    {"campaign.xml", "base_link=\"base\"", "base_link=\"bse\"",
     "robot.urdf:2: base_link: 'bse': expected a link of the robot (did you mean 'base'?)"},
    {"campaign.xml", "double_encoder=\"active\"", "double_encoder=\"actve\"",
     "campaign.xml:8: double_encoder: 'actve': expected active, inactive or unspecified (did you mean "
     "'active'?)"},
    {"campaign.xml", "double_encoder=\"active\"", "double_encoder=\"active\" gravity_m_s2=\"0 -9.8\"",
     "campaign.xml:8: gravity_m_s2: '0 -9.8': expected three numbers; found 2"},
    {"campaign.xml", "double_encoder=\"active\"", "double_encoder=\"active\" gravity_m_s2=\"0 0 -9806\"",
     "campaign.xml:8: gravity_m_s2: '0 0 -9806': expected m/s^2, at most 20"},
    {"campaign.xml", "range_fixed_um=\"4\"", "range_fixed_um=\"-4\"",
     "campaign.xml:9: range_fixed_um: '-4': expected 0 or more"},
    {"campaign.xml", "range_fixed_um=\"4\" range_per_m_um=\"0.6\"", "range_fixed_um=\"0\" range_per_m_um=\"0\"",
     "campaign.xml:9: range_fixed_um: '0': expected, together with what grows by the metre, 0.001 to 100000 um"},
    {"campaign.xml", "angle_fixed_um=\"6\"", "angle_fixed_um=\"6e9\"",
     "campaign.xml:9: angle_fixed_um: '6e9': expected, together with what grows by the metre"},
    {"campaign.xml", "force_sigma_n=\"1\"", "force_sigma_n=\"1e200\"", "campaign.xml:14: force_sigma_n: '1e200': expected 0 to 1000000"},
    {"campaign.xml", "mass_kg=\"45\"", "mass_kg=\"45000\"", "campaign.xml:15: mass_kg: '45000': expected 0 to 5000"},
    {"campaign.xml", "range_per_m_um=\"0.6\"", "",
     "campaign.xml:9: range_per_m_um: expected this attribute of <tracker>"},
    {"campaign.xml",
     "angle_per_m_um=", "angel_per_m_um=", "<tracker>; there is 'angel_per_m_um' (did you mean"},
    {"campaign.xml", "angle_fixed_um=\"6\"", "angle_fixed_um=\"6 um\"",
     "campaign.xml:9: angle_fixed_um: '6 um': expected a number"},
    {"campaign.xml", "angle_per_m_um=\"2.2\"", "angle_per_m_um=\"2,2\"",
     "campaign.xml:9: angle_per_m_um: '2,2': expected a number with a decimal point, not a decimal comma"},
    {"campaign.xml", "angle_per_m_um=\"2.2\"", "angle_per_m_um=\"2.2\" x_mm=\"3e5\"",
     "campaign.xml:9: x_mm: '3e5': expected a coordinate in mm, within +-200 m"},
    {"campaign.xml", "id=\"P11\"", "", "campaign.xml:12: id: expected this attribute of <target>"},
    {"campaign.xml", "id=\"P11\"", "id=\"\"", "campaign.xml:12: id: expected a name that is not empty"},
    {"campaign.xml", "id=\"P11\"", "id=\"P10\"",
     "campaign.xml:12: id: 'P10': expected an id that does not repeat; line 11 has it first"},
    {"campaign.xml", "y_mm=\"2\"", "",
     "campaign.xml:11: target: 'P10': expected all three of x_mm, y_mm and z_mm, or none"},
    {"campaign.xml", "parent=\"flange\"", "parent=\"flnage\"",
     "campaign.xml:14: parent: 'flnage': expected a link of the robot, on its chain or fixed to it (did you "
     "mean "
     "'flange'?)"},
    {"campaign.xml", "parent=\"flange\"", "parent=\"flange\" axes=\"bas\"",
     "campaign.xml:14: axes: 'bas': expected a link of the robot"},
    {"campaign.xml", "rpy_deg=\"0 0 90\"", "",
     "campaign.xml:14: rpy_deg: expected this attribute of <load_cell>"},
    {"campaign.xml", "rpy_deg=\"0 0 90\"", "rpy_deg=\"0 0 900\"",
     "campaign.xml:14: rpy_deg: '0 0 900': expected an angle in degrees"},
    {"campaign.xml", "xyz_mm=\"0 0 90\"", "xyz_mm=\"0 zero 90\"",
     "campaign.xml:14: xyz_mm: '0 zero 90': expected"},
    {"campaign.xml", "force_sigma_n=\"1\"", "force_sigma_n=\"-1\"",
     "campaign.xml:14: force_sigma_n: '-1': expected 0"},
    {"campaign.xml", "moment_sigma_nm=\"0.3\"", "",
     "campaign.xml:14: moment_sigma_nm: expected this attribute"},
    {"campaign.xml", "mass_kg=\"45\"", "mass_kg=\"-45\"",
     "campaign.xml:15: mass_kg: '-45': expected 0 or more"},
    {"campaign.xml", "com_mm=\"0 0 100\"", "com_mm=\"0 0 100 0\"",
     "campaign.xml:15: com_mm: '0 0 100 0': expected three numbers; found 4"},
    {"campaign.xml", "frame=\"base_link\"", "frame=\"flange\"",
     "campaign.xml:20: frame: 'flange': expected base_link, or tracker, or no such attribute"},
    {"campaign.xml", "file=\"nests.csv\"", "", "campaign.xml:21: file: expected this attribute of <nests>"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\"\"",
     "campaign.xml:21: file: expected a name that is not empty"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\"/etc/hostname\"",
     "campaign.xml:21: file: '/etc/hostname': expected a file inside the campaign's folder; this path is "
     "absolute"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\"a/../../nests.csv\"",
     "campaign.xml:21: file: 'a/../../nests.csv': expected a file inside the campaign's folder; this path "
     "leads out"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\"robot.urdf\"", "robot.urdf:1: time_s: expected this column"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\"..\"", "this path leads out of it"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\".\"", "expected a file; this is a directory"},
    {"campaign.xml", "file=\"nests.csv\"", "file=\"ne&#10;sts.csv\"",
     "campaign.xml:21: file: 'ne?sts.csv': expected"},
    {"campaign.xml", "urdf=\"robot.urdf\"", "urdf=\"../robot.urdf\"",
     "campaign.xml:8: urdf: '../robot.urdf': expected"},
};

void change(const SmallCampaign& files, const Rejected& test) {
  if (test.find == nullptr) {
    files.remove(test.file);
  } else if (*test.find == '\0') {
    files.write(test.file, test.replace);
  } else {
    files.alter(test.file, test.find, test.replace);
  }
}

/// A text of any length as it can stand in a table of Markdown.
std::string cell(const std::string& text) {
  std::string shown;
  for (const char c : oneLine(text, 100)) shown += c == '|' ? std::string("\\|") : std::string(1, c);
  return shown;
}

/// The change and the message as one row of bad_inputs.md.
std::string listed(const Rejected& test, const SmallCampaign& files, std::string message) {
  const std::string folder = files.folder().string();
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
    message.replace(at, folder.size(), "campaign");
  }
  const std::string what = test.find == nullptr  ? "no such file"
                           : *test.find == '\0' ? "all of it `" + cell(test.replace) + "`"
                                                : "`" + cell(test.find) + "` became `" + cell(test.replace) + "`";
  return "| " + std::string(test.file) + " | " + what + " | " + oneLine(message, 1000) + " |\n";
}

std::string expectRejected(const Rejected& test) {
  const SmallCampaign files;
  change(files, test);
  try {
    readCampaign(files.folder());
    ADD_FAILURE() << "read on instead of: " << test.message;
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(test.message), std::string::npos)
        << "expected: " << test.message << "\ngot: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_LT(text.size(), 500u) << text;
    return listed(test, files, text);
  }
  return "";
}

// The list is documentation, and this keeps it true: it is made from what the program says. Where it differs, the new one
// is written beside the test program, to be looked at and copied.
TEST(RejectCampaign, SaysWhatTheListOfBadInputsHas) {
  std::string list =
      "# What bad input is told\n\nOne change each to a small campaign that is right, and the message. Made and checked by "
      "tests/core/reject_campaign_test.cpp.\n\n| file | change | message |\n|---|---|---|\n";
  for (const Rejected& test : kTables) list += expectRejected(test);
  for (const Rejected& test : kXml) list += expectRejected(test);
  std::ostringstream kept;
  kept << std::ifstream(STIFFSCOPE_SOURCE_DIR "/tests/core/bad_inputs.md").rdbuf();
  if (kept.str() == list) return;
  const auto made = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bad_inputs.md";
  std::ofstream(made) << list;
  ADD_FAILURE() << "tests/core/bad_inputs.md is not what the program says now, which is in " << made;
}

TEST(RejectCampaign, NamesTheForcesThatStandWhereAnglesBelong) {
  const SmallCampaign files;
  // Columns swapped in the header: q1..q3 hold forces of more than a kilonewton.
  files.alter("states.csv", "q1_deg,q2_deg,q3_deg", "fx_n,fy_n,fz_n");
  files.alter("states.csv", "fx_n,fy_n,fz_n,mx_nm", "q1_deg,q2_deg,q3_deg,mx_nm");
  files.alter("states.csv", "-538.428", "-1342.240");
  EXPECT_THROW(
      {
        try {
          readCampaign(files.folder());
        } catch (const InputError& error) {
          EXPECT_EQ(error.place().line, 3u);
          EXPECT_EQ(error.place().column, "q1_deg");
          EXPECT_EQ(error.value(), "-1342.240");
          EXPECT_EQ(error.expectation(), "expected an angle in degrees, within +-720");
          throw;
        }
      },
      InputError);
}

TEST(RejectCampaign, FollowsNoLinkOutOfTheFolderButTakesOneWithin) {
  const SmallCampaign files;
  const TemporaryFolder elsewhere;
  std::filesystem::rename(files.folder() / "nests.csv", elsewhere.path() / "nests.csv");
  std::filesystem::create_symlink(elsewhere.path() / "nests.csv", files.folder() / "nests.csv");
  try {
    readCampaign(files.folder());
    ADD_FAILURE() << "read a file outside the folder";
  } catch (const InputError& error) {
    EXPECT_EQ(error.expectation(), "expected a file inside the campaign's folder; a link leads out of it");
  }
  std::filesystem::remove(files.folder() / "nests.csv");
  std::filesystem::copy_file(elsewhere.path() / "nests.csv", files.folder() / "real.csv");
  std::filesystem::create_symlink("real.csv", files.folder() / "nests.csv");
  EXPECT_EQ(readCampaign(files.folder().string() + "/").campaign.nests->rows.size(), 2u);
}

TEST(RejectCampaign, NamesAFolderThatIsNotThere) {
  const TemporaryFolder folder;
  try {
    readCampaign(folder.path() / "none");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), (folder.path() / "none").string() +
                                ": expected a campaign folder or its campaign.xml; there is none");
  }
}

// Whatever prefix of a table was transferred, it is either refused or warned about, unless it ends with a
// line.
TEST(RejectCampaign, NoticesATableCutShortAnywhere) {
  const SmallCampaign files;
  const std::string whole = files.read("states.csv");
  const std::size_t header_end = whole.find('\n');
  for (std::size_t size = 1; size < whole.size(); ++size) {
    if (size > header_end + 1 && whole[size - 1] == '\n') continue;
    files.write("states.csv", whole.substr(0, size));
    try {
      EXPECT_FALSE(readCampaign(files.folder()).warnings.empty()) << "first " << size << " bytes";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace stiffscope
