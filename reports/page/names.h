#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/page/report_campaign.h"

// What things are called on the page and in its pictures; rich texts (`x_{abc}` is a subscript).

namespace stiffscope::page {

std::string longName(Method method);                  ///< "Decoupled Partial Pose (DPP)"
std::string shortName(Method method);                 ///< "DPP"
std::string jointName(int joint);                     ///< 0-based: "k_{1}"
std::string pointName(const std::string& target_id);  ///< "P10" as "P_{10}"; other names to the letter
std::string auditName(const std::string& check_id);   ///< "station drift"
std::string auditWord(AuditVerdict verdict);          ///< "warns"
std::string encoderState(DoubleEncoder state);        ///< "active", "inactive", "not declared"
std::string encoderWords(DoubleEncoder state);        ///< "double encoders active"; empty where not declared

/// Where deflections of a campaign are judged: P_wrist where it is measured, else the reflectors (mean over
/// them).
struct JudgedPoint {
  bool at_wrist = false;
  std::string name;  ///< "P_{wrist}", "the reflector TIP", "the reflectors (mean of 3)"
};
JudgedPoint judgedPoint(const ReportCampaign& one);

/// The name of the posture of a load case, to the letter.
std::string postureName(const ReportCampaign& one, std::size_t load_case);

const std::vector<double>& displacementAt(const Identification& identification,
                                          bool at_wrist);                          ///< m, per case
const std::vector<double>& residualAt(const MethodResult& method, bool at_wrist);  ///< m, per case

/// What is left in each posture by stiffnesses identified on others, mean over the subsets that leave it out; without
/// subsets, by those from all postures. m, per case; at the reflectors the mean over them.
std::vector<double> heldOutResidualAt(const ReportCampaign& one, Method method, bool at_wrist);
const std::optional<Compensation>& compensationAt(const MethodResult& method, bool at_wrist);

/// Compensated on the postures held out, mean over the subsets; empty where there are no subsets.
std::optional<double> heldOut(const MethodResult& method, bool at_wrist);

/// The method to show first: of those available the paper's order of trust, DPP, PP, CP.
std::optional<Method> shownMethod(const Identification& identification);

std::string capitalised(std::string text);  ///< its first letter, where that is of the alphabet

double meanForce(const Identification& identification);  ///< N, over the load cases; 0 without one
double mean(const std::vector<double>& values);          ///< 0 of none

/// "all 92 378 subsets of 10 of 19 postures"; empty where there are none.
std::string subsetWords(const SubsetStudy& study);

}  // namespace stiffscope::page
