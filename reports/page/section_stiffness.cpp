#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/identification/stiffness_interval.h"
#include "core/input/units.h"
#include "reports/page/coverage.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

constexpr double kMega = 1e6;

std::string unavailable(const Identification& result, Method method) {
  return fmt::format("{} is not available: {}.", longName(method), result.of(method).reason);
}

std::string markNote(const std::string& mark) {
  return mark == "negative" ? "Negative: the data fits this joint with a stiffness that no spring has; "
                              "printed as found, not clamped."
                            : "Imprecise: the standard uncertainty exceeds the value.";
}

Cell stiffnessCell(const Identification& result, Method method, int joint, Notes& notes) {
  const MethodResult& one = result.of(method);
  if (!one.available) return {"not available", notes.mark(unavailable(result, method))};
  if (!one.estimate.identifiable[static_cast<std::size_t>(joint)]) {
    const std::string& reason = result.identifiability.joints[static_cast<std::size_t>(joint)].reason;
    return {"not identifiable",
            notes.mark(fmt::format("{} is not identifiable: {}.", jointName(joint), reason))};
  }
  const double expanded = coverageOf(one.estimate, joint).factor * one.estimate.stiffnessSd(joint);
  const std::string value = withUncertainty(one.estimate.stiffness(joint) / kMega, expanded / kMega);
  const std::string mark = one.estimate.mark(joint);
  return mark.empty() ? Cell(value) : Cell(value, fmt::format("{} {}", mark, notes.mark(markNote(mark))));
}

Table stiffnessTable(const Identification& result, Notes& notes) {
  Table table{"Joint stiffness k ± U, 10⁶\u00a0Nm/rad, from all postures", {"Joint"}, {{}}};
  table.id = "stiffness";
  for (const Method method : kMethods) table.columns.push_back(longName(method));
  for (int joint = 0; joint < 6; ++joint) {
    Row row{jointName(joint)};
    for (const Method method : kMethods) row.push_back(stiffnessCell(result, method, joint, notes));
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

/// Compliances are what the methods solve for: their uncertainty is symmetric where a stiffness's is not.
Table complianceTable(const Identification& result) {
  Table table{"Joint compliance c ± u (standard uncertainty), 10⁻⁹\u00a0rad/Nm", {"Joint"}, {{}}};
  table.id = "compliance";
  for (const Method method : kMethods) {
    if (result.of(method).available) table.columns.push_back(longName(method));
  }
  for (int joint = 0; joint < 6 && table.columns.size() > 1; ++joint) {
    if (!result.identifiability.joints[static_cast<std::size_t>(joint)].identifiable) continue;
    Row row{fmt::format("1/{}", jointName(joint))};
    for (const Method method : kMethods) {
      const StiffnessEstimate& estimate = result.of(method).estimate;
      if (!result.of(method).available) continue;
      row.emplace_back(withUncertainty(1e9 * estimate.compliance[joint],
                                       1e9 * std::sqrt(estimate.covariance(joint, joint))));
    }
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

Table fitTable(const Identification& result) {
  Table table{
      "The fits", {"Method", "Condition number", "rms residual (mm)", "Over degrees of freedom (mm)"}, {{}}};
  table.id = "fits";
  for (const Method method : kMethods) {
    if (!result.of(method).available) continue;
    const StiffnessEstimate& estimate = result.of(method).estimate;
    table.groups.front().rows.push_back({longName(method), significant(estimate.condition, 3),
                                         significant(estimate.rms_residual / kMillimetre, 3),
                                         significant(estimate.sigma / kMillimetre, 3)});
  }
  return table;
}

/// CP's result against the characteristic length, which is not unique.
Table lengthTable(const Identification& result) {
  Table table{"Complete Pose against the characteristic length L: stiffness in 10⁶\u00a0Nm/rad",
              {"L (m)", "Condition"},
              {{}}};
  table.id = "characteristic-length";
  const auto& seen = result.of(Method::complete_pose).estimate.identifiable;
  for (int joint = 0; joint < 6; ++joint) {
    if (seen[static_cast<std::size_t>(joint)]) table.columns.push_back(jointName(joint));
  }
  constexpr std::size_t kEvery = 2;  // a dozen rows would say no more
  for (std::size_t i = 0; i < result.length_sensitivity.size(); i += kEvery) {
    const LengthSensitivity& at = result.length_sensitivity[i];
    Row row{significant(at.length, 3), significant(at.condition, 3)};
    for (int joint = 0; joint < 6; ++joint) {
      if (seen[static_cast<std::size_t>(joint)])
        row.emplace_back(significant(1e-6 / at.compliance[joint], 3));
    }
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

std::string range(const std::string& low, const std::string& high) {
  return low == high ? low : fmt::format("{} to {}", low, high);
}

/// One decimal where it matters to Student's t.
std::string degrees(double of_freedom) { return of_freedom < 100.0 ? fixed(of_freedom, 1) : significant(of_freedom, 3); }

std::string uncertaintyWords(const Identification& result) {
  std::vector<std::string> factors;
  for (const Method method : kMethods) {
    const StiffnessEstimate& estimate = result.of(method).estimate;
    Coverage least{std::numeric_limits<double>::infinity(), 0.0}, most;
    for (int joint = 0; joint < 6 && result.of(method).available; ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      const Coverage own = coverageOf(estimate, joint);
      if (own.factor < least.factor) least = own;
      if (own.factor > most.factor) most = own;
    }
    if (most.factor == 0.0) continue;
    const std::string freedom = range(degrees(most.degrees_of_freedom), degrees(least.degrees_of_freedom));
    factors.push_back(fmt::format("{} for {} ({} degree{} of freedom)", range(fixed(least.factor, 2), fixed(most.factor, 2)),
                                  shortName(method), freedom, freedom == "1.0" ? "" : "s"));
  }
  if (factors.empty()) return "Too few postures for an uncertainty.";
  return fmt::format(
      "± is the expanded uncertainty U = k u, coverage about 95\u00a0%, with the coverage factor k from Student's t, joint by "
      "joint: {}. The standard uncertainty u is from the scatter between postures and from what they all share: frames, "
      "wrist radii, calibrated geometry.",
      fmt::join(factors, ", "));
}

/// Where the interval of the stiffness is far from symmetric, or open.
std::string wideIntervals(const Identification& result) {
  std::vector<std::string> wide;
  for (const Method method : kMethods) {
    const StiffnessEstimate& estimate = result.of(method).estimate;
    for (int joint = 0; joint < 6 && result.of(method).available; ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      const CoverageInterval compliance = complianceInterval(estimate, joint);
      const double c = estimate.compliance[joint];
      constexpr double kWide = 0.2;
      if (!std::isfinite(compliance.low) || compliance.high - c < kWide * std::abs(c)) continue;
      const CoverageInterval own = stiffnessInterval(compliance);
      wide.push_back(std::isfinite(own.high)
                         ? fmt::format("{} by {} is between {} and {}", jointName(joint), shortName(method),
                                       significant(own.low / kMega, 3), significant(own.high / kMega, 3))
                         : fmt::format("{} by {} is only known to be above {}", jointName(joint), shortName(method),
                                       significant(own.low / kMega, 3)));
    }
  }
  if (wide.empty()) return {};
  return fmt::format("Wide 95\u00a0% intervals, 10⁶\u00a0Nm/rad: {}.", fmt::join(wide, "; "));
}

}  // namespace

void writeStiffness(Html& html, const ReportContent& content) {
  writeForEach(html, content, "stiffness", "Joint stiffness", [&](const ReportCampaign& one) {
    Notes notes;
    writeTable(html, stiffnessTable(one.identification, notes));
    html.paragraph(uncertaintyWords(one.identification), "faint");
    if (const std::string wide = wideIntervals(one.identification); !wide.empty()) html.paragraph(wide);
    notes.write(html);
    writeTable(html, complianceTable(one.identification));
    writeTable(html, fitTable(one.identification));
    if (shownMethod(one.identification)) {
      html.paragraph(
          "Residuals per coordinate, of the positions that the method fits: P_{TCP} for CP, the reflectors "
          "for PP and DPP.",
          "faint");
    }
    writeTable(html, lengthTable(one.identification));
  });
}

}  // namespace stiffscope::page
