#include "core/identification/geometric_stiffness_cost.h"
#include "core/identification/identify.h"
#include "core/identification/load_dependence.h"
#include "core/identification/posture_stiffness.h"
#include "core/identification/remarks.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/identification/estimate.h"
#include "core/identification/posture_stiffness.h"
#include "core/io/units.h"
#include "reports/words/listed.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

std::string bounds(const identification::CoverageInterval& interval, const StiffnessUnit& unit) {
  const double low = interval.low / unit.size, high = interval.high / unit.size;
  if (std::isfinite(low) && std::isfinite(high)) return fmt::format("{:.4f} to {:.4f}", low, high);
  if (std::isfinite(low)) return fmt::format("above {:.4f}", low);
  if (std::isfinite(high)) return fmt::format("below {:.4f}", high);
  return "unbounded";
}

/// U, or "?" where it is open.
std::string expandedCell(double expanded, int decimals) {
  return std::isfinite(expanded) ? fmt::format("{:.{}f}", expanded, decimals) : "?";
}

template <class Write>
void forEachSeen(const identification::Identification& result, const std::vector<identification::Method>& methods,
                 const Write& write) {
  for (const identification::Method which : methods) {
    const identification::MethodResult& method = result.of(which);
    for (int joint = 0; method.available && joint < method.estimate.joints(); ++joint) {
      if (method.estimate.identifiable[static_cast<std::size_t>(joint)]) write(which, method, joint);
    }
  }
}

}  // namespace

std::string wideIntervals(const identification::Identification& result,
                          const std::vector<identification::Method>& methods) {
  std::string text;
  const StiffnessUnit unit = stiffnessUnit(result);
  forEachSeen(
      result, methods, [&](identification::Method which, const identification::MethodResult& method, int joint) {
        if (!farFromSymmetric(method.estimate, joint)) return;
        const identification::CoverageInterval compliance = identification::complianceInterval(method.estimate, joint);
        const bool open = compliance.low <= 0.0 && compliance.high >= 0.0;
        text += fmt::format("  {} k{}: 95 % interval {}{}\n", namesOf(which).brief, joint + 1,
                            bounds(identification::stiffnessInterval(compliance), unit),
                            open ? " (its compliance may be zero: this data only bounds it from below)" : "");
      });
  return text;
}

std::string bootstrapText(const identification::Identification& result,
                          const std::vector<identification::Method>& methods) {
  std::string rows;
  std::size_t draws = 0;
  const StiffnessUnit unit = stiffnessUnit(result);
  forEachSeen(result, methods,
              [&](identification::Method which, const identification::MethodResult& method, int joint) {
                if (method.bootstrap.compliances.empty()) return;
                draws = method.bootstrap.compliances.size();
                rows += fmt::format("  {:<5}k{} {:>26}{:>26}\n", namesOf(which).brief, joint + 1,
                                    bounds(identification::stiffnessInterval(method.estimate, joint), unit),
                                    bounds(method.bootstrap.stiffness(joint), unit));
              });
  if (rows.empty()) return {};
  return fmt::format(
      "\n95 % intervals, {}: stated, and percentiles of {} draws of the postures\n  {:<5}   {:>26}{:>26}\n{}",
      unit.text, draws, "", "stated", "bootstrap", rows);
}

std::string stepsText(const identification::StepStudy& study, const identification::Identification& result,
                      const std::vector<identification::Method>& methods) {
  std::string text;
  const auto out = std::back_inserter(text);
  const StiffnessUnit unit = stiffnessUnit(result);
  for (const identification::Method which : methods) {
    const identification::StepsOfMethod& own = study.methods[static_cast<std::size_t>(which)];
    if (own.steps.empty()) continue;
    const robot::JointMask& seen = result.of(which).estimate.identifiable;
    const auto row = [&](const std::string& name, const auto& cell) {
      fmt::format_to(out, "  {:<14}", name);
      for (int j = 0; j < static_cast<int>(seen.size()); ++j) {
        fmt::format_to(out, " {:>17}", seen[static_cast<std::size_t>(j)] ? cell(j) : "-");
      }
      fmt::format_to(out, "\n");
    };
    fmt::format_to(out, "\n{} by load step, {} +- U\n", namesOf(which).full, unit.text);
    for (const identification::StepEstimate& one : own.steps) {
      row(fmt::format("{} ({:.0f} N)", one.step, one.mean_force), [&](int j) {
        return fmt::format("{:.4f} +-{}", one.estimate.stiffness(j) / unit.size,
                           expandedCell(identification::expandedUncertainty(one.estimate, j) / unit.size, 4));
      });
    }
    row("change of 1/k", [&](int j) {
      const identification::LoadDependence& joint = own.joints[static_cast<std::size_t>(j)];
      const double factor = identification::studentFactor(joint.dof, identification::kStatedCoverage);
      return fmt::format("{:+.2f} +-{} %", 100.0 * joint.change, expandedCell(100.0 * factor * joint.change_sd, 2));
    });
    row("p, linear", [&](int j) { return fmt::format("{:.3g}", own.joints[static_cast<std::size_t>(j)].p_linear); });
  }
  if (!text.empty()) {
    text += fmt::format(
        "  p: how often steps of equal stiffness would differ as much by chance; below 0.05 / {} the stiffness depends "
        "on the load\n",
        result.identifiability.joints.size());
  }
  return text;
}

std::string posturesText(const campaign::Campaign& campaign, const identification::Identification& result,
                         identification::Method method) {
  const identification::PostureStiffnesses postures(campaign, result, method);
  const std::vector<identification::GeometricStiffnessCost> costs =
      identification::geometricStiffnessCosts(result, method);
  if (postures.size() == 0) return {};
  std::string text = fmt::format(
      "\nPostures at P_TCP by {}: softest and stiffest direction, what neglecting K_c costs\n"
      "  kappa: condition number of the posture's Jacobian by P_TCP, 1 at best\n"
      "  {:<12}{:>8}{:>16}{:>16}{:>12}\n",
      namesOf(method).full, "pose", "kappa", "softest (N/µm)", "stiffest", "K_c (µm)");
  for (std::size_t i = 0; i < postures.size(); ++i) {
    const identification::PostureStiffness posture = postures.at(i);
    const auto& principal = posture.with_kc.principal;
    text += fmt::format("  {:<12}{:>8.2f}{:>16.3f}{:>16.3f}{:>12.2f}\n", posture.pose, posture.conditioning.kappa,
                        principal[0].stiffness * io::kMicrometre, principal[2].stiffness * io::kMicrometre,
                        costs[i].at_targets / io::kMicrometre);
  }
  return text;
}

namespace {

using Out = std::back_insert_iterator<std::string>;

std::string markedStiffnessCell(const identification::StiffnessEstimate& estimate, int joint,
                                const StiffnessUnit& unit) {
  if (!estimate.identifiable[static_cast<std::size_t>(joint)]) return "-";
  const char* mark =
      estimate.mark(joint).empty() ? "" : (estimate.mark(joint).is(identification::RemarkId::negative) ? "!" : "?");
  const double expanded = identification::expandedUncertainty(estimate, joint) / unit.size;
  return fmt::format("{:.4f} +-{}{}", estimate.stiffness(joint) / unit.size, expandedCell(expanded, 4), mark);
}

void writeStiffness(const identification::Identification& result, const std::vector<identification::Method>& methods,
                    Out out) {
  const StiffnessUnit unit = stiffnessUnit(result);
  const bool weighed = std::any_of(result.methods.begin(), result.methods.end(),
                                   [](const auto& method) { return !method.estimate.stated.empty(); });
  fmt::format_to(out, "\nStiffness, {}, with its expanded uncertainty U (coverage 95 %, {})\n  {:<5}", unit.text,
                 weighed ? "effects that could hide in it" : "Student's t", "");
  const int joints = static_cast<int>(result.identifiability.joints.size());
  for (int joint = 1; joint <= joints; ++joint) fmt::format_to(out, " {:>17}", fmt::format("k{}", joint));
  fmt::format_to(out, "\n");
  bool negative = false, imprecise = false;
  for (const identification::Method which : methods) {
    const identification::MethodResult& method = result.of(which);
    if (!method.available) continue;
    fmt::format_to(out, "  {:<5}", namesOf(which).brief);
    for (int joint = 0; joint < joints; ++joint) {
      fmt::format_to(out, " {:>17}", markedStiffnessCell(method.estimate, joint, unit));
      if (!method.estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      negative |= method.estimate.mark(joint).is(identification::RemarkId::negative);
      imprecise |= method.estimate.mark(joint).is(identification::RemarkId::imprecise);
    }
    fmt::format_to(out, "\n");
  }
  fmt::format_to(out, "{}", wideIntervals(result, methods));
  if (negative) fmt::format_to(out, "  ! negative: no spring has that, something else is in the data\n");
  if (imprecise) fmt::format_to(out, "  ? imprecise: the uncertainty U exceeds twice the value\n");
  for (std::size_t j = 0; j < result.identifiability.joints.size(); ++j) {
    const identification::JointIdentifiability& joint = result.identifiability.joints[j];
    if (joint.identifiable || joint.reason.empty()) continue;
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("k{} is not identifiable: {}", j + 1, words(joint.reason)), 4));
  }
  for (const identification::Method which : methods) {
    const identification::MethodResult& method = result.of(which);
    if (method.available) continue;
    fmt::format_to(out, "  {}\n",
                   wrapped(fmt::format("{} is unavailable: {}", namesOf(which).full, words(method.reason)), 4));
  }
}

void writeResiduals(const identification::Identification& result, const std::vector<identification::Method>& methods,
                    Out out) {
  fmt::format_to(out, "\n  {:<5}{:>12}{:>20}{:>24}\n", "", "condition", "rms residual (µm)", "over dof, sigma (µm)");
  for (const identification::Method which : methods) {
    const identification::MethodResult& method = result.of(which);
    if (!method.available) continue;
    fmt::format_to(out, "  {:<5}{:>12.2f}{:>20.1f}{:>24.1f}\n", namesOf(which).brief, method.estimate.condition,
                   method.estimate.rms_residual / io::kMicrometre, method.estimate.sigma / io::kMicrometre);
  }
  fmt::format_to(out, "  condition: condition number of the method's equations, columns of unit length; 1 at best\n");
}

constexpr const char* kShareColumns = "    used  held out (sd)     all  all identify";

/// At one kind of point, as in kShareColumns.
std::string shareCells(const std::optional<identification::Compensation>& share, bool subsets) {
  const auto cell = [&](double value, bool known) { return known ? fmt::format("{:.2f}", 100.0 * value) : "-"; };
  if (!share) return fmt::format("{:>8}{:>15}{:>8}{:>14}", "-", "-", "-", "-");
  const std::string held_out = subsets ? fmt::format("{:.2f} ({})", 100.0 * share->subsets.held_out,
                                                     cell(share->held_out_sd, std::isfinite(share->held_out_sd)))
                                       : "-";
  return fmt::format("{:>8}{:>15}{:>8}{:>14.2f}", cell(share->subsets.used, subsets), held_out,
                     cell(share->subsets.all, subsets), 100.0 * share->all_postures);
}

/// Complete Pose against the characteristic length: what it would compensate with another.
void writeLengths(const identification::Identification& result, Out out) {
  const identification::MethodResult& own = result.of(identification::Method::complete_pose);
  if (!own.available || result.length_sensitivity.empty() || own.subsets.compliances.empty()) return;
  fmt::format_to(out,
                 "\nComplete Pose against the characteristic length L: share compensated on postures held out (sd), %\n"
                 "  {:<12}{:>12}{:>18}{:>20}\n",
                 "L (m)", "condition", "at P_wrist", "at the reflectors");
  const auto share = [](const std::optional<identification::Compensation>& at) {
    return at ? fmt::format("{:.2f} ({:.2f})", 100.0 * at->subsets.held_out, 100.0 * at->held_out_sd) : "-";
  };
  const auto row = [&](double length, double condition, const std::optional<identification::Compensation>& at_wrist,
                       const std::optional<identification::Compensation>& at_targets, const char* mark) {
    fmt::format_to(out, "  {:<12.3f}{:>12.2f}{:>18}{:>20}{}\n", length, condition, share(at_wrist), share(at_targets),
                   mark);
  };
  for (const identification::LengthSensitivity& one : result.length_sensitivity)
    row(one.length, one.condition, one.at_wrist, one.at_targets, "");
  row(result.characteristic_length.length, result.characteristic_length.condition, own.at_wrist, own.at_targets,
      "  least condition number: CP above");
  if (const auto& one = result.residual_length)
    row(one->length, one->condition, one->at_wrist, one->at_targets, "  of the residual variances");
  fmt::format_to(out, "  over {} subsets at each length, over all at that of the least condition number\n",
                 result.length_sensitivity.front().subsets);
}

void writeCompensation(const identification::Identification& result, const std::vector<identification::Method>& methods,
                       Out out) {
  const bool any = std::any_of(methods.begin(), methods.end(),
                               [&](identification::Method which) { return result.of(which).available; });
  if (!any) return;
  const int arm = robot::armJointsOf(static_cast<int>(result.identifiability.joints.size()));
  fmt::format_to(out, "\nShare of the deflection compensated, %\n  {:<5} |{:^44} |{:^44}\n  {:<5} |{} |{}\n", "",
                 fmt::format("at P_wrist, which sees joints 1-{}", arm), "at the reflectors, which see all joints", "",
                 kShareColumns, kShareColumns);
  for (const identification::Method which : methods) {
    const identification::MethodResult& method = result.of(which);
    if (!method.available) continue;
    const bool subsets = !method.subsets.compliances.empty();
    fmt::format_to(out, "  {:<5} |{} |{}\n", namesOf(which).brief, shareCells(method.at_wrist, subsets),
                   shareCells(method.at_targets, subsets));
  }
  for (const identification::Method which : methods) {
    const identification::SubsetStudy& study = result.of(which).subsets;
    if (study.compliances.empty()) continue;
    fmt::format_to(out,
                   "  means over {} of the {} out of {} postures that identify; sd: standard deviation over them\n",
                   study.every_subset ? fmt::format("all {} subsets", study.compliances.size())
                                      : fmt::format("{} random subsets", study.compliances.size()),
                   study.size, study.of);
    break;
  }
  if (result.noise && result.noise->at_wrist) {
    fmt::format_to(out, "  the tracker's noise alone forbids about {:.2f} % at P_wrist, {:.2f} % at the reflectors\n",
                   100.0 * std::min(1.0, *result.noise->at_wrist), 100.0 * std::min(1.0, result.noise->at_targets));
  } else if (result.noise) {
    fmt::format_to(out, "  the tracker's noise alone forbids about {:.2f} % at the reflectors\n",
                   100.0 * std::min(1.0, result.noise->at_targets));
  }
}

}  // namespace

std::string identificationText(const campaign::Campaign& campaign, const identification::Identification& result,
                               const std::vector<identification::Method>& methods) {
  std::string text;
  Out out(text);
  fmt::format_to(out, "{}: joint stiffness from load step{} {}, {} postures\n", campaign.name,
                 result.steps.size() > 1 ? "s" : "", fmt::join(result.steps, ", "),
                 identification::postureCount(result));
  const auto leftOut = [](const identification::LeftOutPosture& one) { return "left out: " + leftOutWords(one); };
  for (const std::string& entry : listed(result.left_out, leftOut, kListedInJson)) fmt::format_to(out, "  {}\n", entry);
  if (const auto first = identification::shownFirstOf(result, methods))
    fmt::format_to(out, "{}\n", wrapped(shownFirstWords(result, *first), 2));
  writeStiffness(result, methods, out);
  writeResiduals(result, methods, out);
  writeCompensation(result, methods, out);
  if (std::find(methods.begin(), methods.end(), identification::Method::complete_pose) != methods.end())
    writeLengths(result, out);
  fmt::format_to(out, "{}", bootstrapText(result, methods));
  if (result.transmission) fmt::format_to(out, "{}", transmissionText(result, methods));
  fmt::format_to(out, "\n");
  for (const std::string& caution : words(result.cautions)) {
    fmt::format_to(out, "{}\n", wrapped("Caution: " + caution + ".", 2));
  }
  if (result.calibration.done) {
    fmt::format_to(out, "{}\n",
                   wrapped(fmt::format("Partial Pose's geometry: unloaded positions missed by {:.3f} mm rms "
                                       "before and {:.3f} mm after calibration of {} parameters.",
                                       result.calibration.rms_before / io::kMillimetre,
                                       result.calibration.rms_after / io::kMillimetre, result.calibration.parameters),
                           0));
    if (const std::string kept = geometryKeptWords(result.calibration); !kept.empty())
      fmt::format_to(out, "{}\n", wrapped(kept, 0));
  }
  fmt::format_to(out, "{}\n", wrapped(fmt::format("Own weight: {}.", words(result.frames.sag_note)), 0));
  fmt::format_to(out, "{}\n",
                 wrapped(fmt::format("K_c is {}; it changes the joint torques by {:.2f} %.",
                                     result.finite_deflection ? "included" : "neglected",
                                     100.0 * result.geometric_stiffness_share),
                         0));
  if (result.servo_change > 0.0) {
    fmt::format_to(out, "{}\n",
                   wrapped(fmt::format("The reported joint angles change under load by up to {:.4f} deg: "
                                       "servo, not subtracted.",
                                       result.servo_change / io::kDegree),
                           0));
  }
  return text;
}

}  // namespace stiffscope::reports
