#include "reports/json/fit_json.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <cmath>
#include <vector>

#include "reports/words/listed.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

std::vector<double> valuesOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
}

std::vector<double> with(std::vector<double> values, double last) {
  values.push_back(last);
  return values;
}

std::vector<double> valuesOf(const metrology::FittedLine& fit) { return valuesOf(fit.line.point, fit.line.direction); }
std::vector<double> valuesOf(const metrology::FittedPlane& fit) { return valuesOf(fit.plane.point, fit.plane.normal); }
std::vector<double> valuesOf(const metrology::FittedCircle& fit) {
  return with(valuesOf(fit.circle.centre, fit.circle.normal), fit.circle.radius);
}
std::vector<double> valuesOf(const metrology::FittedSphere& fit) {
  const Eigen::Vector3d& centre = fit.sphere.centre;
  return {centre.x(), centre.y(), centre.z(), fit.sphere.radius};
}
std::vector<double> valuesOf(const metrology::FittedCylinder& fit) {
  return with(valuesOf(fit.cylinder.axis.point, fit.cylinder.axis.direction), fit.cylinder.radius);
}

template <class Fit>
std::string parametersText(const Fit& fit) {
  const std::vector<double> values = valuesOf(fit);
  std::string text = fmt::format("  {:<10}{:>22}{:>14}\n", "", "value", "standard unc.");
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const std::string sd =
        fit.covariance ? fmt::format("{:.2g}", std::sqrt(std::max(0.0, (*fit.covariance)(i, i)))) : "-";
    text += fmt::format("  {:<10}{:>22.12g}{:>14}\n", fit.kParameters[k], values[k], sd);
  }
  return text;
}

std::string snoopingText(const Snooping& snooping) {
  std::string text =
      fmt::format("  left out by the w-test: {} (critical w {:.3g}, level {:g} for all readings together)\n",
                  snooping.rejected.size(), snooping.critical_w, snooping.family_level);
  const auto words = [](const metrology::RejectedReading& one) {
    return fmt::format("point {}: w {:.3g}, above {:.3g}", one.index + 1, one.w, one.critical_w);
  };
  for (const std::string& entry : listed(snooping.rejected, words, kListedInJson))
    text += fmt::format("    {}\n", entry);
  return text;
}

}  // namespace

std::string fitText(const ShapeFit& fitted) {
  const metrology::FitQuality& quality = fitted.quality();
  std::string text = fmt::format("{} through {} points, in the file's length unit\n", fitted.shape, fitted.points);
  if (fitted.snooping) text += snoopingText(*fitted.snooping);
  if (!quality.determined) return text + fmt::format("  undetermined: {}\n", words(quality.reason));
  text += std::visit([](const auto& one) { return parametersText(one); }, fitted.fit);
  text += fmt::format("  rms distance of a point {:.4g}", quality.rms);
  text += quality.degrees_of_freedom > 0
              ? fmt::format(", residual standard deviation {:.4g} over {} degrees of freedom\n", quality.residual_sd,
                            quality.degrees_of_freedom)
              : "; no degree of freedom is left to tell an uncertainty by\n";
  return text + fmt::format("  method: {}\n", words(quality.method));
}

}  // namespace stiffscope::reports
