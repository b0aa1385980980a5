#include "reports/words/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>

#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"

namespace stiffscope::reports {

const char* sourceOf(const frames::Frames& frames, std::initializer_list<std::size_t> axes) {
  const auto measured = static_cast<std::size_t>(
      std::count_if(axes.begin(), axes.end(), [&](std::size_t axis) { return frames.axes[axis].measured; }));
  if (measured == axes.size()) return "sweeps";
  return measured == 0 ? "nominal" : "partly nominal";
}

AxisSd sdAcross(const frames::MeasuredAxis& axis) {
  const auto& covariance = axis.at_zero.covariance;
  return {std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2.0),
          std::sqrt(covariance.bottomRightCorner<2, 2>().trace() / 2.0)};
}

std::string sourceMark(const frames::Frames& frames, std::initializer_list<std::size_t> axes) {
  const std::string source = sourceOf(frames, axes);
  return source == "sweeps" ? std::string() : " (" + source + ")";
}

const MethodNames& namesOf(identification::Method method) {
  static constexpr std::array<MethodNames, 3> kNames{
      {{"cp", "CP", "Complete Pose"}, {"pp", "PP", "Partial Pose"}, {"dpp", "DPP", "Decoupled Partial Pose"}}};
  return kNames[static_cast<std::size_t>(method)];
}

const char* nameOfDirection(identification::LoadDirection direction) {
  static constexpr std::array<const char*, identification::kLoadDirections> kNames{"down", "up", "outward", "inward",
                                                                                   "sideways"};
  return kNames[static_cast<std::size_t>(direction)];
}

namespace {

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) {
    digits.insert(static_cast<std::size_t>(at), "\u00a0");
  }
  return digits;
}

}  // namespace

std::string longName(identification::Method method) {
  return fmt::format("{} ({})", namesOf(method).full, namesOf(method).brief);
}

std::string shortName(identification::Method method) { return namesOf(method).brief; }

std::string jointName(int joint) { return fmt::format("k_{{{}}}", joint + 1); }

std::string countsFromTo(int first, int last) {
  return fmt::format("{} {} {}", first, last == first + 1 ? "and" : "to", last);
}

const char* countWord(int joints) {
  static constexpr std::array<const char*, kMostJoints - kFewestJoints + 1> kWords{"four", "five", "six", "seven",
                                                                                   "eight"};
  return kWords.at(static_cast<std::size_t>(joints - kFewestJoints));
}

std::string pointName(const std::string& target_id) {
  const bool numbered =
      target_id.size() > 1 && std::isalpha(static_cast<unsigned char>(target_id[0])) != 0 &&
      std::all_of(target_id.begin() + 1, target_id.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return numbered ? fmt::format("{}_{{{}}}", target_id[0], target_id.substr(1)) : asIs(target_id);
}

std::string auditName(const std::string& check_id) {
  std::string name = check_id;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string auditWord(preparation::AuditVerdict verdict) {
  switch (verdict) {
    case preparation::AuditVerdict::pass:
      return "passes";
    case preparation::AuditVerdict::warn:
      return "warns";
    case preparation::AuditVerdict::fail:
      return "fails";
    case preparation::AuditVerdict::not_testable:
      break;
  }
  return "not testable";
}

std::string encoderState(campaign::DoubleEncoder state) {
  if (state == campaign::DoubleEncoder::unspecified) return "not declared";
  return state == campaign::DoubleEncoder::active ? "active" : "inactive";
}

std::string encoderWordsOf(const campaign::Campaign& campaign) {
  const std::string state = encoderState(campaign.double_encoder);
  const std::vector<int>& joints = campaign.double_encoder_joints;
  if (joints.empty()) return state;
  std::vector<std::string> numbers;
  for (const int joint : joints) numbers.push_back(std::to_string(joint + 1));
  const bool in_a_row = joints.size() > 1 && joints.back() - joints.front() + 1 == static_cast<int>(joints.size());
  return fmt::format(
      "{}, on joint{} {}", state, joints.size() > 1 ? "s" : "",
      in_a_row ? countsFromTo(joints.front() + 1, joints.back() + 1) : fmt::format("{}", fmt::join(numbers, ", ")));
}

std::string encoderWords(campaign::DoubleEncoder state) {
  return state == campaign::DoubleEncoder::unspecified ? std::string()
                                                       : fmt::format("double encoders {}", encoderState(state));
}

JudgedPoint judgedPoint(const ReportCampaign& one) {
  if (!one.identification.wrist_displacement.empty()) return {true, "P_{wrist}"};
  const std::size_t count = one.campaign.targets.size();
  if (count == 1) return {false, fmt::format("the reflector {}", pointName(one.campaign.targets.front().id))};
  return {false, fmt::format("the reflectors (mean of {})", count)};
}

std::string offsetWristWords(std::int64_t first, double apart) {
  return fmt::format("axes {} and {} meet {:.1f} mm from where {} and {} do: this wrist has no centre", first,
                     first + 1, apart / io::kMillimetre, first + 1, first + 2);
}

std::string geometryKeptWords(const frames::GeometryCalibration& calibration) {
  if (calibration.fixed.empty()) return {};
  return fmt::format("PP's geometry, kept at its start because the positions do not see it: {}.",
                     fmt::join(words(calibration.fixed), ", "));
}

std::string leftOutWords(const identification::LeftOutPosture& posture) {
  return fmt::format("pose {}: {}", posture.pose, words(posture.reason));
}

std::string unseenWords(const identification::JointIdentifiability& joint) {
  using identification::RemarkId;
  if (joint.reason.is(RemarkId::load_hangs)) return "not seen: the load only hangs";
  if (joint.reason.is(RemarkId::load_turns_too_little)) return "not seen: hardly loaded";
  if (joint.reason.is(RemarkId::points_on_axis)) return "not seen: points stand on its axis";
  if (joint.reason.is(RemarkId::two_joints_combined) || joint.reason.is(RemarkId::joints_combined))
    return "not seen apart from others";
  return "not seen";
}

std::string postureName(const ReportCampaign& one, std::size_t load_case) {
  return asIs(one.campaign.pose_ids[static_cast<std::size_t>(one.identification.cases[load_case].pose)]);
}

const std::vector<double>& displacementAt(const identification::Identification& identification, bool at_wrist) {
  return at_wrist ? identification.wrist_displacement : identification.target_displacement;
}

const std::vector<double>& residualAt(const identification::MethodResult& method, bool at_wrist) {
  return at_wrist ? method.wrist_residual : method.target_residual;
}

std::vector<double> heldOutResidualAt(const ReportCampaign& one, identification::Method method, bool at_wrist) {
  const identification::MethodResult& result = one.identification.of(method);
  std::vector<double> left = at_wrist ? result.subsets.at_wrist.left_held_out : result.subsets.at_targets.left_held_out;
  if (left.empty()) return residualAt(result, at_wrist);
  for (std::size_t i = 0; !at_wrist && i < left.size(); ++i) {
    left[i] /= static_cast<double>(one.identification.cases[i].targets.size());
  }
  return left;
}

const std::optional<identification::Compensation>& compensationAt(const identification::MethodResult& method,
                                                                  bool at_wrist) {
  return at_wrist ? method.at_wrist : method.at_targets;
}

std::optional<double> heldOut(const identification::MethodResult& method, bool at_wrist) {
  const auto& compensation = compensationAt(method, at_wrist);
  if (!compensation || method.subsets.compliances.empty()) return std::nullopt;
  return compensation->subsets.held_out;
}

std::optional<identification::Method> shownMethod(const identification::Identification& identification) {
  return identification::bestMethodOf(identification, identification::kMethods);
}

std::string shownFirstWords(const identification::Identification& result, const identification::ShownFirst& first) {
  using Judged = identification::ShownFirst::Judged;
  std::vector<std::string> shares;
  for (const bool at_wrist : {false, true}) {
    if (first.judged == (at_wrist ? Judged::at_wrist : Judged::at_reflectors)) continue;  // the reason says it
    if (const auto share = heldOut(result.of(first.method), at_wrist))
      shares.push_back(fmt::format("{:.2f} % at {}", 100.0 * *share, at_wrist ? "P_wrist" : "the reflectors"));
  }
  std::string text = fmt::format("Shown first: {}.", words(first.reason));
  if (!shares.empty()) text += fmt::format(" Held out, it compensates {}.", fmt::join(shares, " and "));
  return text;
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

double meanForce(const identification::Identification& identification) {
  std::vector<double> forces;
  for (const identification::LoadCase& load_case : identification.cases)
    forces.push_back(load_case.wrench.force.norm());
  return mean(forces);
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::string subsetWords(const identification::SubsetStudy& study) {
  if (study.compliances.empty()) return {};
  return fmt::format("{} {} subsets of {} of {} postures", study.every_subset ? "all" : "a sample of",
                     grouped(study.compliances.size()), study.size, study.of);
}

}  // namespace stiffscope::reports
