#include "reports/words/day_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "reports/words/audit_plain.h"
#include "reports/words/names.h"

namespace stiffscope::reports {

namespace {

const char* topicOf(const ReportCampaign& one) {
  switch (kindOf(one)) {
    case DayKind::unloaded:
      return "absolute accuracy";
    case DayKind::sweeps:
      return one.campaign.circle_sweeps ? "geometry by circle sweeps" : "wrist centre by its sweep";
    case DayKind::loaded:
      break;
  }
  return "joint stiffness";
}

/// What the readings of such a day are for.
const char* purposeOf(DayKind kind) {
  switch (kind) {
    case DayKind::unloaded:
      return "calibrate from";
    case DayKind::sweeps:
      return "find axes from";
    case DayKind::loaded:
      break;
  }
  return "identify stiffnesses from";
}

}  // namespace

std::string reportTitle(const std::vector<ReportCampaign>& campaigns) {
  std::vector<std::string> topics;
  for (const DayKind kind : {DayKind::unloaded, DayKind::loaded, DayKind::sweeps}) {
    for (const ReportCampaign& one : ofKind(campaigns, kind)) {
      if (std::find(topics.begin(), topics.end(), topicOf(one)) == topics.end()) topics.emplace_back(topicOf(one));
    }
  }
  if (topics.empty()) topics.emplace_back("joint stiffness");
  std::string title = topics.front();
  for (std::size_t i = 1; i < topics.size(); ++i) title += (i + 1 == topics.size() ? " and " : ", ") + topics[i];
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

std::string methodWords(DayKind kind, int joints) {
  switch (kind) {
    case DayKind::unloaded:
      return "Positions of the reflectors in unloaded postures, read by a laser tracker, are held against what the "
             "arm's geometry makes of the joint angles that the controller reports. Nominal: the URDF's arm, its base "
             "and the reflectors fitted. Geometry: axes, base and reflectors calibrated (zero-reference model, least "
             "squares, outliers by the fullest model). With effects: also the own weight and what else the machine or "
             "the measurement does, where it predicts postures that took no part. Errors are 3-D distances; held "
             "out: each fold of postures by what the other folds fit, selection of effects included.";
    case DayKind::sweeps:
      return "Each joint is turned by itself while a laser tracker reads the reflectors: their circles give its axis "
             "(circle-point method), neighbouring axes the distances and angles between them. No load and no load "
             "cell take part.";
    case DayKind::loaded:
      break;
  }
  const int arm = robot::armJointsOf(joints);
  return fmt::format(
      "Displacements of the reflectors under a known load, read by a laser tracker, give the "
      "compliance of each joint by least squares. Complete Pose (CP) uses position and rotation of "
      "P_{{TCP}}; Partial Pose (PP) the reflectors' positions on a calibrated geometry; Decoupled "
      "Partial Pose (DPP) first joints {0} from P_{{wrist}}, which joints {1} do not move, "
      "then joints {1} from what is left. Stiffness is that of the closed loop, at the joint "
      "angles which the controller reports.",
      countsFromTo(1, arm), countsFromTo(arm + 1, joints));
}

namespace {

/// The checks of a verdict, each once.
std::vector<std::string> checksThat(const audit::AuditReport& audit, preparation::AuditVerdict verdict) {
  std::vector<std::string> ids;
  for (const preparation::AuditCheck& check : audit.checks) {
    if (check.verdict == verdict && std::find(ids.begin(), ids.end(), check.id) == ids.end()) ids.push_back(check.id);
  }
  return ids;
}

/// ": reflectors do not come back when the load is taken off", where they are few; else " by 5 checks".
std::string failureWords(const std::vector<std::string>& ids) {
  constexpr std::size_t kFew = 3;
  if (ids.empty()) return {};
  if (ids.size() > kFew) return fmt::format(" by {} checks", ids.size());
  std::vector<std::string> amiss;
  for (const std::string& id : ids) amiss.push_back(amissWords(id));
  return fmt::format(": {}", fmt::join(amiss, "; "));
}

}  // namespace

std::string auditMeaning(const audit::AuditReport& audit, DayKind kind, bool refers) {
  const std::vector<std::string> warned = checksThat(audit, preparation::AuditVerdict::warn);
  switch (audit.verdict) {
    case preparation::AuditVerdict::pass:
      return fmt::format("The audit passes: the readings are fit to {}.", purposeOf(kind));
    case preparation::AuditVerdict::warn:
      return fmt::format("The readings are good enough to {}; the audit warns of {}{}.", purposeOf(kind),
                         warned.size() == 1 ? "one thing" : fmt::format("{} things", warned.size()),
                         refers ? " (see @{Audit})" : "");
    case preparation::AuditVerdict::not_testable:
      // A day that is not meant for loads does not fail by what only a load would tell.
      if (kind == DayKind::sweeps) return "No check of the audit fails; some need what such a day does not measure.";
      return "The audit cannot tell: too little was measured to say whether the readings are fit to " +
             std::string(purposeOf(kind)) + ".";
    case preparation::AuditVerdict::fail:
      break;
  }
  return fmt::format("The audit fails{}. As they were read, the readings are not fit to {}.",
                     failureWords(checksThat(audit, preparation::AuditVerdict::fail)), purposeOf(kind));
}

std::string doubtedNumbersWords() {
  return "What the readings give as they stand; it is no result until what fails is mended or explained:";
}

std::string untestedWords(const audit::AuditReport& audit, DayKind kind) {
  if (audit.verdict != preparation::AuditVerdict::not_testable || kind == DayKind::sweeps) return {};
  return fmt::format("The audit could make {} of {} checks, too few to say that the readings are fit to {}.",
                     audit.made, audit.of, purposeOf(kind));
}

bool hiddenIsHeld(const identification::Identification& identification) {
  return std::any_of(identification.methods.begin(), identification.methods.end(),
                     [](const auto& method) { return !method.estimate.stated.empty(); });
}

std::vector<std::string> scopeWords(DayKind kind, bool limits, bool hidden) {
  const std::string rule =
      limits ? "What counts: " : "Decision rule: no statement of conformity to a specification is made. ";
  switch (kind) {
    case DayKind::unloaded:
      return {
          "Uncertainty: U of a parameter, about 95\u00a0%, is 1.96 times its standard uncertainty by least squares, "
          "from the tracker's noise, which is that of the repeats where there are enough of them and else the declared "
          "one, and what the model leaves beyond it, readings of one posture erring together. The tracker's own "
          "scale, of which no reading tells, is not in it.",
          rule +
              "An effect is in the model where it predicts postures that took no part better than the model without "
              "it; errors that are named held out are of postures by which nothing was fitted or chosen. The errors "
              "are of these postures and reflectors: elsewhere in the workspace they can be larger."};
    case DayKind::sweeps:
      return {
          "Uncertainty: that of an axis is from the scatter of its reflectors about their circles, and where they "
          "leave them by more than the declared noise widened by that. The tracker's own scale, of which no reading "
          "tells, is not in it.",
          limits ? std::string("What counts: the limits of the first page.") : rule};
    case DayKind::loaded:
      break;
  }
  const std::string shared =
      "the scatter between postures (sandwich estimate, CR2) and what they all share and the campaign tells of: "
      "frames, wrist radii, geometry";
  return {
      hidden
          ? "Uncertainty: U of a stiffness, about 95\u00a0%, is the farther end of the interval that holds " + shared +
                ", and the scales of load cell, tracker and masses where it declares them; and what effects in the "
                "model or beside it could still do to each joint. The budget has each part."
          : "Uncertainty: the standard uncertainty u of a compliance holds " + shared +
                "; that of a stiffness is u(c)/c², to first order. U = k u with Student's t for about 95\u00a0%. The "
                "scales of load cell and tracker, of which no reading tells, are not in it. What effects beside joint "
                "springs do is in it as far as it scatters between postures.",
      rule +
          "A joint counts as seen where the load "
          "turns it by more than three times what wrench, frame and angle uncertainty alone would. A stiffness is "
          "imprecise where U exceeds twice the value, and negative ones are shown as found" +
          (limits ? "." : "; uncertainty is not used to move a limit.")};
}

}  // namespace stiffscope::reports
