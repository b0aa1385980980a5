#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/frames/frames.h"
#include "core/identification/held_out_loads.h"
#include "core/identification/identify.h"
#include "reports/report_content.h"

// What things are called on the page and in its pictures; rich texts (`x_{abc}` is a subscript).

namespace stiffscope::reports {

/// Where a length, angle or place that hangs on these axes (0-based) comes from: "sweeps" where all of them
/// were measured, "nominal" where none was and the value is the URDF's, else "partly nominal".
const char* sourceOf(const frames::Frames& frames, std::initializer_list<std::size_t> axes);

/// The same as a mark behind a value for people: empty for "sweeps", else " (nominal)".
std::string sourceMark(const frames::Frames& frames, std::initializer_list<std::size_t> axes);

/// Standard uncertainty of a measured axis across itself, one number a kind: the root of the mean of the two variances,
/// at the fit's own point, all joints at zero.
struct AxisSd {
  double point = 0.0;      ///< m
  double direction = 0.0;  ///< rad
};
AxisSd sdAcross(const frames::MeasuredAxis& axis);

/// A method's names: `dpp` as a key, `DPP` in tables, `Decoupled Partial Pose` in words.
struct MethodNames {
  const char* key;
  const char* brief;
  const char* full;
};

const MethodNames& namesOf(identification::Method method);

const char* nameOfDirection(identification::LoadDirection direction);  ///< "down", "sideways"

std::string longName(identification::Method method);       ///< "Decoupled Partial Pose (DPP)"
std::string shortName(identification::Method method);      ///< "DPP"
std::string jointName(int joint);                          ///< 0-based: "k_{1}"
std::string countsFromTo(int first, int last);             ///< "1 to 3", "4 and 5"
const char* countWord(int joints);                         ///< "six"; of four to eight
std::string pointName(const std::string& target_id);       ///< "P10" as "P_{10}"; other names to the letter
std::string auditName(const std::string& check_id);        ///< "station drift"
std::string auditWord(preparation::AuditVerdict verdict);  ///< "warns"
std::string encoderState(campaign::DoubleEncoder state);   ///< "active", "inactive", "not declared"
std::string encoderWordsOf(
    const campaign::Campaign& campaign);  ///< "active, on joints 1 to 3"; the state where no joint is stated
std::string encoderWords(campaign::DoubleEncoder state);  ///< "double encoders active"; empty where not declared

/// Where deflections of a campaign are judged: P_wrist where it is measured, else the reflectors (mean over
/// them).
struct JudgedPoint {
  bool at_wrist = false;
  std::string name;  ///< "P_{wrist}", "the reflector TIP", "the reflectors (mean of 3)"
};
JudgedPoint judgedPoint(const ReportCampaign& one);

/// "pose 3: no state of this load step"; a plain text.
std::string leftOutWords(const identification::LeftOutPosture& posture);
/// "axes 4 and 5 meet 115.8 mm from where 5 and 6 do: this wrist has no centre", of an offset wrist
/// (frames::WristCentre::offset); `first`: the first of its axes, from 1.
std::string offsetWristWords(std::int64_t first, double apart);
/// Parameters of PP's geometry that the positions do not show, as a sentence; empty where they show all.
std::string geometryKeptWords(const frames::GeometryCalibration& calibration);

/// "not seen: the load only hangs"; short enough for a cell of a table.
std::string unseenWords(const identification::JointIdentifiability& joint);

/// The name of the posture of a load case, to the letter.
std::string postureName(const ReportCampaign& one, std::size_t load_case);

const std::vector<double>& displacementAt(const identification::Identification& identification,
                                          bool at_wrist);                                          ///< m, per case
const std::vector<double>& residualAt(const identification::MethodResult& method, bool at_wrist);  ///< m, per case

/// What is left in each posture by stiffnesses identified on others, mean over the subsets that leave it out; without
/// subsets, by those from all postures. m, per case; at the reflectors the mean over them.
std::vector<double> heldOutResidualAt(const ReportCampaign& one, identification::Method method, bool at_wrist);
const std::optional<identification::Compensation>& compensationAt(const identification::MethodResult& method,
                                                                  bool at_wrist);

/// Compensated on the postures held out, mean over the subsets; empty where there are no subsets.
std::optional<double> heldOut(const identification::MethodResult& method, bool at_wrist);

/// The method to show first (core/identification/shown_first.h); empty where none is available.
std::optional<identification::Method> shownMethod(const identification::Identification& identification);

/// "Shown first: PP, which .... Held out, it compensates 83.75 % at P_wrist."; a plain text.
std::string shownFirstWords(const identification::Identification& result, const identification::ShownFirst& first);

std::string capitalised(std::string text);  ///< its first letter, where that is of the alphabet

double meanForce(const identification::Identification& identification);  ///< N, over the load cases; 0 without one
double mean(const std::vector<double>& values);                          ///< 0 of none

/// "all 92 378 subsets of 10 of 19 postures"; empty where there are none.
std::string subsetWords(const identification::SubsetStudy& study);

}  // namespace stiffscope::reports
