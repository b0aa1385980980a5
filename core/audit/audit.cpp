#include "core/audit/audit.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "core/audit/checks.h"
#include "core/audit/redundancies.h"
#include "core/audit/remarks.h"
#include "core/campaign/state_points.h"
#include "core/numerics/parallel.h"

namespace stiffscope::audit {

namespace {

/// A function of the audit and the checks that it gives, by their ids; at most three.
struct Check {
  Findings (*of)(const AuditInput&);
  std::array<const char*, 3> ids;
};

/// In the order in which the day goes, which is that of the report.
constexpr std::array<Check, 21> kAllChecks{{
    {checkTimeOrder, {"time_order"}},
    {checkCompleteness, {"completeness"}},
    {checkRepeatability, {"repeatability_along", "repeatability_across"}},
    {checkDeclaredNoise, {"noise_declared"}},
    {checkRigidTool, {"rigid_tool"}},
    {checkNests, {"station_drift", "nest_moved"}},
    {checkCircleSweeps, {"circle_arc", "circle_count"}},
    {checkSweepAngles, {"sweep_angles"}},
    {checkCircleResidual, {"circle_residual"}},
    {checkSweptReflectors, {"axis_agreement", "reflector_on_axis"}},
    {checkLinkLengths, {"link_lengths"}},
    {checkWrist, {"wrist_sphere", "wrist_axes_meet"}},
    {checkRail, {"rail_straight", "rail_scale", "rail_direction"}},
    {checkUnloadedPositions, {"frame_moved", "unloaded_positions", "joint_read_back"}},
    {checkServo, {"servo_change"}},
    {checkReturnToZero, {"return_to_zero"}},
    {checkLoadCell, {"tare", "gravity_direction", "moment_lever"}},
    {checkLoadSize, {"load_size"}},
    {checkPostureSet, {"posture_set"}},
    {checkModel, {"arm_model", "load_model"}},
    {checkControllerPoses, {"controller_poses"}},
}};

/// Whether the functions give the very checks among which the chance of a false finding is shared.
constexpr bool givesAllChecks() {
  std::size_t next = preparation::kScreeningChecks;
  for (const Check& check : kAllChecks) {
    for (const char* const id : check.ids) {
      if (id == nullptr) continue;
      if (next == preparation::kAuditCheckIds.size() || preparation::kAuditCheckIds[next].id != id) return false;
      ++next;
    }
  }
  return next == preparation::kAuditCheckIds.size();
}
static_assert(givesAllChecks(), "preparation::kAuditCheckIds and kAllChecks name different checks");

/// What a pass needs to know, and the checks of which each alone would tell; at most five.
struct Question {
  RemarkId unanswered;
  std::array<const char*, 5> ids;
};

constexpr std::array kToIdentify{
    Question{RemarkId::unknown_if_it_identifies, {"posture_set"}},
    Question{RemarkId::unknown_size, {"load_size"}},
    Question{RemarkId::unknown_worth_of_readings,
             {"repeatability_along", "repeatability_across", "rigid_tool", "unloaded_positions", "return_to_zero"}},
    Question{RemarkId::unknown_load_cell, {"tare", "gravity_direction", "moment_lever"}},
};

constexpr std::array kToCalibrate{
    Question{RemarkId::unknown_arm, {"arm_model"}},
    Question{RemarkId::unknown_worth_unloaded,
             {"repeatability_along", "repeatability_across", "rigid_tool", "return_to_zero"}},
};

/// Ids of the checks that could be made, of one of several places at least.
std::set<std::string> madeChecks(const std::vector<preparation::AuditCheck>& checks) {
  std::set<std::string> made;
  for (const preparation::AuditCheck& check : checks) {
    if (check.verdict != preparation::AuditVerdict::not_testable) made.insert(check.id);
  }
  return made;
}

std::vector<Remark> unansweredBy(const std::set<std::string>& made, std::span<const Question> questions) {
  std::vector<Remark> unanswered;
  for (const Question& question : questions) {
    const bool told = std::any_of(question.ids.begin(), question.ids.end(),
                                  [&](const char* id) { return id != nullptr && made.contains(id); });
    if (!told) unanswered.push_back(Remark(question.unanswered));
  }
  return unanswered;
}

/// Of days without a load: base, reflectors and axes, less what is a choice of frame, of what was read.
std::optional<Remark> tooFewToCalibrate(const AuditInput& input) {
  constexpr double kSamePosture = 1e-3;  // rad: nearer ones say the same of the geometry, however often they are read
  struct Posture {
    JointVector q;
    std::set<int> targets;
  };
  std::map<std::pair<int, int>, JointVector> angles;
  if (input.campaign.states)
    for (const campaign::State& row : input.campaign.states->rows) angles.emplace(std::pair(row.pose, row.step), row.q);
  const std::size_t parameters =
      4 * input.campaign.robot.axes_in_base_at_zero.size() + 3 * input.campaign.targets.size();
  std::vector<Posture> different;
  std::size_t coordinates = 0;
  for (const campaign::StatePoints& state : input.states) {
    const auto row = angles.find({state.pose, state.step});
    if (state.source != campaign::StatePoints::Source::loading || row == angles.end()) continue;
    auto own = std::find_if(different.begin(), different.end(), [&](const Posture& one) {
      return (one.q - row->second).cwiseAbs().maxCoeff() < kSamePosture;
    });
    if (own == different.end()) own = different.insert(different.end(), {row->second, {}});
    for (const campaign::ReflectorMean& reflector : state.reflectors)
      coordinates += own->targets.insert(reflector.target).second ? 3 : 0;
    if (coordinates > parameters) return std::nullopt;
  }
  return Remark(RemarkId::too_few_to_calibrate, coordinates, parameters);
}

preparation::AuditVerdict verdictOf(const AuditReport& report) {
  const auto any = [&](preparation::AuditVerdict verdict) {
    return std::any_of(report.checks.begin(), report.checks.end(),
                       [&](const preparation::AuditCheck& check) { return check.verdict == verdict; });
  };
  if (any(preparation::AuditVerdict::fail)) return preparation::AuditVerdict::fail;
  if (!report.unanswered.empty()) return preparation::AuditVerdict::not_testable;
  return any(preparation::AuditVerdict::warn) ? preparation::AuditVerdict::warn : preparation::AuditVerdict::pass;
}

}  // namespace

AuditReport audit(campaign::Campaign campaign) { return audit(preparation::prepareCampaign(std::move(campaign))); }

AuditReport audit(const preparation::PreparedCampaign& prepared) {
  AuditReport report;
  report.checks = prepared.screening;
  report.rejected = prepared.preparation.rejected;
  const AuditInput input = auditInput(prepared);
  std::vector<Findings> findings(kAllChecks.size());
  numerics::onAllCores(findings.size(), [&](std::size_t i) { findings[i] = kAllChecks[i].of(input); });
  for (Findings& of_check : findings) std::move(of_check.begin(), of_check.end(), std::back_inserter(report.checks));
  const std::set<std::string> made = madeChecks(report.checks);
  report.made = static_cast<int>(made.size());
  report.of = preparation::checksOf(prepared.campaign.robot.rail.has_value()) + (input.stations ? 1 : 0);
  if (campaign::isUnloadedDay(prepared.campaign)) report.purpose = Purpose::calibrate;
  if (report.purpose == Purpose::calibrate) {
    report.unanswered = unansweredBy(made, kToCalibrate);
    if (auto few = tooFewToCalibrate(input)) report.unanswered.push_back(std::move(*few));
  } else {
    report.unanswered = unansweredBy(made, kToIdentify);
  }
  const std::vector<mistakes::Suspected> zero = suspectedZero(input), noise = suspectedNoise(input);
  for (const auto* found : {&input.model.arm, &input.model.loads, &zero})
    report.suspected.insert(report.suspected.end(), found->begin(), found->end());
  // What the readings name already is named once.
  for (const mistakes::Suspected& one : input.controller.cures) {
    if (std::none_of(input.model.arm.begin(), input.model.arm.end(),
                     [&](const mistakes::Suspected& other) { return other.remedy == one.remedy; }))
      report.suspected.push_back(one);
  }
  // Another noise makes a day pass whatever is wrong with it: last.
  report.suspected.insert(report.suspected.end(), noise.begin(), noise.end());
  report.verdict = verdictOf(report);
  return report;
}

bool findsTheImpossible(const AuditReport& report) {
  return std::any_of(report.checks.begin(), report.checks.end(),
                     [](const preparation::AuditCheck& one) { return one.impossible; });
}

}  // namespace stiffscope::audit
