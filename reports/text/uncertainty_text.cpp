#include "reports/text/uncertainty_text.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/identification/stiffness_interval.h"
#include "core/input/units.h"
#include "reports/method_names.h"

namespace stiffscope {

namespace {

constexpr double kMega = 1e6;

std::string bounds(const CoverageInterval& interval) {
  if (std::isfinite(interval.low) && std::isfinite(interval.high)) {
    return fmt::format("{:.4f} to {:.4f}", interval.low / kMega, interval.high / kMega);
  }
  if (std::isfinite(interval.low)) return fmt::format("above {:.4f}", interval.low / kMega);
  if (std::isfinite(interval.high)) return fmt::format("below {:.4f}", interval.high / kMega);
  return "unbounded";
}

template <class Write>
void forEachSeen(const Identification& result, const std::vector<Method>& methods, const Write& write) {
  for (const Method which : methods) {
    const MethodResult& method = result.of(which);
    for (int joint = 0; method.available && joint < 6; ++joint) {
      if (method.estimate.identifiable[static_cast<std::size_t>(joint)]) write(which, method, joint);
    }
  }
}

}  // namespace

std::string wideIntervals(const Identification& result, const std::vector<Method>& methods) {
  std::string text;
  constexpr double kWide = 0.2;  // relative half width: beyond it the two sides differ by a tenth of a standard deviation
  forEachSeen(result, methods, [&](Method which, const MethodResult& method, int joint) {
    const CoverageInterval compliance = complianceInterval(method.estimate, joint);
    if (!std::isfinite(compliance.low)) return;
    const double c = method.estimate.compliance[joint];
    if (compliance.high - c < kWide * std::abs(c)) return;
    const bool open = compliance.low <= 0.0 && compliance.high >= 0.0;
    text += fmt::format("  {} k{}: 95 % interval {}{}\n", namesOf(which).brief, joint + 1, bounds(stiffnessInterval(compliance)),
                        open ? " (its compliance may be zero: this data only bounds it from below)" : "");
  });
  return text;
}

std::string bootstrapText(const Identification& result, const std::vector<Method>& methods) {
  std::string rows;
  std::size_t draws = 0;
  forEachSeen(result, methods, [&](Method which, const MethodResult& method, int joint) {
    if (method.bootstrap.compliances.empty()) return;
    draws = method.bootstrap.compliances.size();
    rows += fmt::format("  {:<5}k{} {:>26}{:>26}\n", namesOf(which).brief, joint + 1,
                        bounds(stiffnessInterval(method.estimate, joint)), bounds(method.bootstrap.stiffness(joint)));
  });
  if (rows.empty()) return {};
  return fmt::format("\n95 % intervals, 1e6 Nm/rad: stated, and percentiles of {} draws of the postures\n  {:<5}   {:>26}{:>26}\n{}",
                     draws, "", "stated", "bootstrap", rows);
}

std::string stepsText(const StepStudy& study, const Identification& result, const std::vector<Method>& methods) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Method which : methods) {
    const StepsOfMethod& own = study.methods[static_cast<std::size_t>(which)];
    if (own.steps.empty()) continue;
    const JointMask& seen = result.of(which).estimate.identifiable;
    const auto row = [&](const std::string& name, const auto& cell) {
      fmt::format_to(out, "  {:<14}", name);
      for (int j = 0; j < 6; ++j) {
        fmt::format_to(out, " {:>17}", seen[static_cast<std::size_t>(j)] ? cell(j) : "-");
      }
      fmt::format_to(out, "\n");
    };
    fmt::format_to(out, "\n{} by load step, 1e6 Nm/rad +- standard uncertainty\n", namesOf(which).full);
    for (const StepEstimate& one : own.steps) {
      row(fmt::format("{} ({:.0f} N)", one.step, one.mean_force), [&](int j) {
        return fmt::format("{:.4f} +-{:.4f}", one.estimate.stiffness(j) / kMega, one.estimate.stiffnessSd(j) / kMega);
      });
    }
    row("change of 1/k", [&](int j) {
      const LoadDependence& joint = own.joints[static_cast<std::size_t>(j)];
      return fmt::format("{:+.2f} +-{:.2f} %", 100.0 * joint.change, 100.0 * joint.change_sd);
    });
    row("p, linear", [&](int j) { return fmt::format("{:.3g}", own.joints[static_cast<std::size_t>(j)].p_linear); });
  }
  if (!text.empty()) {
    text += "  p: how often steps of equal stiffness would differ as much by chance; below 0.05 / 6 the stiffness depends on "
            "the load\n";
  }
  return text;
}

std::string posturesText(const Campaign& campaign, const Identification& result, Method method) {
  const PostureStiffnesses postures(campaign, result, method);
  const std::vector<GeometricStiffnessCost> costs = geometricStiffnessCosts(result, method);
  if (postures.size() == 0) return {};
  std::string text = fmt::format("\nPostures at P_TCP by {}: softest and stiffest direction, what neglecting K_c costs\n"
                                 "  kappa: condition number of the posture's Jacobian by P_TCP, 1 at best\n"
                                 "  {:<12}{:>8}{:>16}{:>16}{:>12}\n",
                                 namesOf(method).full, "pose", "kappa", "softest (N/um)", "stiffest", "K_c (um)");
  for (std::size_t i = 0; i < postures.size(); ++i) {
    const PostureStiffness posture = postures.at(i);
    const auto& principal = posture.with_kc.principal;
    text += fmt::format("  {:<12}{:>8.2f}{:>16.3f}{:>16.3f}{:>12.2f}\n", posture.pose, posture.conditioning.kappa,
                        principal[0].stiffness * kMicrometre, principal[2].stiffness * kMicrometre,
                        costs[i].at_targets / kMicrometre);
  }
  return text;
}

}  // namespace stiffscope
