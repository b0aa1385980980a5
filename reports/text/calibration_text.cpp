#include <fmt/format.h>
#include <cmath>
#include <iterator>

#include "core/calibration/calibrate.h"
#include "core/calibration/denavit_hartenberg.h"
#include "core/calibration/growth_from.h"
#include "core/io/units.h"
#include "reports/text/text.h"
#include "reports/words/calibration_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

void writeModels(const calibration::Calibration& calibration, const calibration::CalibrationOptions& options, Out out) {
  fmt::format_to(out,
                 "\nPosition error, 3-D, mm (rms over reflectors and postures)\n  {:<12}{:>12}{:>12}{:>12}{:>14}\n",
                 "model", "fitted", "held out", "largest", "parameters");
  for (const calibration::ModelResult& model : calibration.models) {
    const bool held_out = model.held_out.readings > 0;
    fmt::format_to(
        out, "  {:<12}{:>12.4f}{:>12}{:>12}{:>14}\n", nameOf(model.model), model.fitted.rms / io::kMillimetre,
        held_out ? fmt::format("{:.4f}", model.held_out.rms / io::kMillimetre) : "-",
        held_out ? fmt::format("{:.3f}", model.held_out.largest / io::kMillimetre) : "-", model.fit.parameters);
  }
  fmt::format_to(out, "  {}\n", foldWords(options));
  if (calibration.angles)
    fmt::format_to(out, "  {}\n", wrapped(angleWords(*calibration.angles, calibration.day.angles), 4));
}

void writeEffects(const calibration::Calibration& calibration, Out out) {
  const calibration::ArmFit& fit = calibration.best().fit;
  if (!fit.parts.empty())
    fmt::format_to(out, "\nEffects beside the geometry, in the order in which they were found (+- U, 95 %)\n");
  Eigen::Index k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    fmt::format_to(out, "  {}\n", partName(part));
    for (const calibration::EffectTerm& term : part.terms) {
      const double sd = fit.sd(static_cast<int>(fit.steps.size() + k));
      fmt::format_to(out, "    {:<32}{:>14.4g} +- {:.2g} {}\n", term.name, fit.sizes[k], expanded(sd), term.unit);
      ++k;
    }
  }
  for (const std::string& note : modelNotes(calibration)) fmt::format_to(out, "  {}\n", wrapped(note, 4));
}

void writeAxes(const calibration::Calibration& calibration, Out out) {
  const calibration::ArmFit& fit = calibration.geometry().fit;
  const robot::Robot arm = fit.arm(calibration.day.arm);
  fmt::format_to(out,
                 "\nAxes of the geometry against the URDF's, in base_link at zero (u, v across the axis; +- U, 95 %)\n"
                 "  {:<6}{:>38}{:>42}\n",
                 "axis", "moved, mm", "tilted, mdeg");
  constexpr double kMillidegree = 1e-3 * io::kDegree;
  for (int j = 0; j < arm.axes(); ++j) {
    fmt::format_to(out, "  {:<6}", j + 1);
    for (int k = 0; k < 4; ++k) {
      const int at = 4 * j + k;
      const double unit = k < 2 ? io::kMillimetre : kMillidegree;
      const double sd = fit.sd(at);
      fmt::format_to(
          out, "{:>20}",
          sd > 0.0 ? fmt::format("{:.3f} +- {:.3f}", fit.steps[at] / unit, expanded(sd) / unit) : std::string("-"));
    }
    fmt::format_to(out, "\n");
  }
  const calibration::DenavitHartenberg now = calibration::denavitHartenberg(arm, calibration.day.arm),
                                       before =
                                           calibration::denavitHartenberg(calibration.day.arm, calibration.day.arm);
  const PerJoint<calibration::LinkParameters> sds = calibration::linkUncertainties(fit, calibration.day.arm);
  fmt::format_to(out,
                 "\nDenavit and Hartenberg's parameters (Hayati's where axes are parallel) to the second digit of U, "
                 "URDF's in brackets; fixed ones to three places\n"
                 "  {:<6}{:>22}{:>24}{:>24}{:>20}\n",
                 "axes", "theta, deg", "d, mm (H: beta, deg)", "a, mm", "alpha, deg");
  for (std::size_t i = 0; i < now.links.size(); ++i) {
    const calibration::LinkParameters &link = now.links[i], &as_built = before.links[i], &sd = sds[i];
    const double second = link.hayati ? link.beta / io::kDegree : link.d / io::kMillimetre;
    const double second_built = as_built.hayati ? as_built.beta / io::kDegree : as_built.d / io::kMillimetre;
    const double second_sd = link.hayati ? sd.beta / io::kDegree : sd.d / io::kMillimetre;
    const auto both = [](double value, double uncertainty, double nominal) {
      constexpr int kOfUrdf = 3;
      const int places = placesOf(expanded(uncertainty), kOfUrdf);
      return fmt::format("{:.{}f} ({:.{}f})", unsignedZero(value, places), places, unsignedZero(nominal, kOfUrdf),
                         kOfUrdf);
    };
    fmt::format_to(out, "  {}-{}{}{:>24}{:>24}{:>24}{:>20}\n", i + 1, i + 2, link.hayati ? "H" : " ",
                   both(link.theta / io::kDegree, sd.theta / io::kDegree, as_built.theta / io::kDegree),
                   both(second, second_sd, second_built),
                   both(link.a / io::kMillimetre, sd.a / io::kMillimetre, as_built.a / io::kMillimetre),
                   both(link.alpha / io::kDegree, sd.alpha / io::kDegree, as_built.alpha / io::kDegree));
  }
  if (calibration.not_identifiable.empty()) return;
  fmt::format_to(out, "\nNot identifiable\n");
  for (const Remark& remark : calibration.not_identifiable) fmt::format_to(out, "  {}\n", words(remark));
}

}  // namespace

std::string calibrationText(const campaign::Campaign& campaign, const calibration::Calibration& calibration,
                            const calibration::CalibrationOptions& options) {
  std::string text;
  const Out out(text);
  fmt::format_to(out, "{}: calibration by {} unloaded postures\n", campaign.name, calibration.day.postures.size());
  if (!calibration.reason.empty()) {
    fmt::format_to(out, "\n{}\n", wrapped("not done: " + words(calibration.reason), 2));
    return text;
  }
  writeModels(calibration, options, out);
  writeEffects(calibration, out);
  writeAxes(calibration, out);
  if (const std::string caution = geometryCaution(calibration); !caution.empty())
    fmt::format_to(out, "\n{}\n", wrapped("Caution: " + caution + ".", 2));
  if (const std::string growth = growthFromWords(calibration::growthFrom(campaign, calibration)); !growth.empty())
    fmt::format_to(out, "\n{}\n", wrapped(growth + ".", 2));
  for (const Remark& note : calibration.notes) fmt::format_to(out, "\n{}\n", wrapped(words(note), 2));
  if (calibration.rejected.empty()) return text;
  fmt::format_to(out, "\nReadings left out by the fullest model: {}\n", calibration.rejected.size());
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, calibration.rejected.size()); ++i) {
    const preparation::RejectedReading& one = calibration.rejected[i];
    fmt::format_to(out, "  {}:{}: {}\n", one.file, one.line, words(one.reason));
  }
  if (calibration.rejected.size() > kShown) fmt::format_to(out, "  the JSON lists all of them\n");
  return text;
}

std::string calibrationCsv(const calibration::Calibration& calibration) {
  const calibration::ArmFit& fit = calibration.geometry().fit;
  const robot::Robot arm = fit.arm(calibration.day.arm);
  const calibration::DenavitHartenberg now = calibration::denavitHartenberg(arm, calibration.day.arm),
                                       before =
                                           calibration::denavitHartenberg(calibration.day.arm, calibration.day.arm);
  std::string text =
      "axis,point_x_m,point_y_m,point_z_m,direction_x,direction_y,direction_z,sd_shift_u_mm,sd_shift_v_mm,"
      "sd_tilt_u_deg,sd_tilt_v_deg,convention,theta_deg,d_mm,a_mm,alpha_deg,beta_deg,nominal_theta_deg,nominal_d_mm,"
      "nominal_a_mm,nominal_alpha_deg,nominal_beta_deg\n";
  const Out out(text);
  const auto link = [&](const calibration::LinkParameters& of) {
    fmt::format_to(out, ",{:.9f},{:.6f},{:.6f},{:.9f},{:.9f}", of.theta / io::kDegree, of.d / io::kMillimetre,
                   of.a / io::kMillimetre, of.alpha / io::kDegree, of.beta / io::kDegree);
  };
  for (std::size_t j = 0; j < arm.axes_in_base_at_zero.size(); ++j) {
    const metrology::Line& axis = arm.axes_in_base_at_zero[j];
    fmt::format_to(out, "{},{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.12f}", j + 1, axis.point.x(), axis.point.y(),
                   axis.point.z(), axis.direction.x(), axis.direction.y(), axis.direction.z());
    for (int k = 0; k < 4; ++k) {
      const double sd = fit.sd(static_cast<int>(4 * j) + k);
      fmt::format_to(out, ",{}", sd > 0.0 ? fmt::format("{:.6f}", sd / (k < 2 ? io::kMillimetre : io::kDegree)) : "");
    }
    if (j < now.links.size()) {
      fmt::format_to(out, ",{}", now.links[j].hayati ? "hayati" : "denavit_hartenberg");
      link(now.links[j]);
      link(before.links[j]);
      fmt::format_to(out, "\n");
    } else {
      fmt::format_to(out, ",,,,,,,,,,,\n");
    }
  }
  return text;
}

}  // namespace stiffscope::reports
