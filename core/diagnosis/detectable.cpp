#include "core/diagnosis/detectable.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/geometry_error.h"

namespace stiffscope {

double sizeOfDrop(const GapFit& fit, double drop) {
  return std::sqrt(std::max(0.0, drop) / fit.rules.loading_rows) * fit.data.state_noise;
}

std::vector<DetectableSize> detectableSizes(const GapInput& input, const GapFit& fit,
                                            const std::vector<bool>& allowed) {
  const double drop = std::max(fit.rules.least_drop, fit.rules.detect);
  std::vector<DetectableSize> detectable;
  for (std::size_t e = 0; e < kEffectCount; ++e) {
    const auto effect = static_cast<Effect>(e);
    std::vector<double> sizes;
    for (std::size_t m = 0; m < input.models.size(); ++m) {
      if (input.models[m].effect != effect || !allowed[m]) continue;
      Eigen::Index at = fit.data.layout.model_at[m] - fit.data.layout.effects;
      for (const EffectPart& part : input.models[m].parts) {
        double kept = 0.0;
        for (std::size_t k = 0; k < part.most.size(); ++k, ++at) {
          if (fit.projection.before[at] > 0.0)
            kept = std::max(kept, fit.projection.matrix(at, at) / fit.projection.before[at]);
        }
        if (kept > fit.rules.kept_share) sizes.push_back(sizeOfDrop(fit, drop / kept));
      }
    }
    DetectableSize size{effect, std::nullopt};
    if (!sizes.empty()) {
      std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2),
                       sizes.end());
      size.size = sizes[sizes.size() / 2];
    }
    if (effect == Effect::kinematic_error && input.absolute) size.size = kGeometryTolerance;
    detectable.push_back(size);
  }
  return detectable;
}

}  // namespace stiffscope
