#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "render/colours.h"

namespace stiffscope {
namespace {

Eigen::Vector3d linear(Colour colour) {
  const auto one = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return {one(colour.red / 255.0), one(colour.green / 255.0), one(colour.blue / 255.0)};
}

/// CIE L*a*b* of linear sRGB, D65.
Eigen::Vector3d lab(const Eigen::Vector3d& rgb) {
  Eigen::Matrix3d to_xyz;
  to_xyz << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
  const Eigen::Vector3d xyz = (to_xyz * rgb).cwiseQuotient(Eigen::Vector3d(0.95047, 1.0, 1.08883));
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const Eigen::Vector3d g(f(xyz.x()), f(xyz.y()), f(xyz.z()));
  return {116 * g.y() - 16, 500 * (g.x() - g.y()), 200 * (g.y() - g.z())};
}

/// What red-, green- and blue-blind eyes see: Machado, Oliveira and Fernandes (2009), severity 1.
std::array<Eigen::Matrix3d, 3> blindnesses() {
  Eigen::Matrix3d red, green, blue;
  red << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  green << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  blue << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return {red, green, blue};
}

// A difference of 20 in L*a*b* is about ten times what is just seen side by side, 14 in L* tells two greys of
// a print.
TEST(SceneColours, VectorsStayApartInGreyAndToTheColourBlind) {
  for (const Palette& palette : {kLightPalette, kDarkPalette}) {
    const std::array<Colour, 3> vectors{palette.measured, palette.predicted, palette.residual};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        if (a == b) continue;
        SCOPED_TRACE(testing::Message() << a << " and " << b);
        EXPECT_GE(std::abs(lab(linear(vectors[a]))[0] - lab(linear(vectors[b]))[0]), 14);
        for (const Eigen::Matrix3d& eye : blindnesses()) {
          const auto seen = [&](Colour colour) {
            return lab((eye * linear(colour)).cwiseMax(0).cwiseMin(1));
          };
          EXPECT_GE((seen(vectors[a]) - seen(vectors[b])).norm(), 20);
          EXPECT_GE((seen(vectors[a]) - seen(palette.paper)).norm(), 40);
        }
      }
    }
  }
}

}  // namespace
}  // namespace stiffscope
