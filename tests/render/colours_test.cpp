#include "render/colours.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace stiffscope {
namespace colours_test {

Eigen::Vector3d linear(render::Colour colour) {
  const auto channel = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return {channel(colour.red / 255.0), channel(colour.green / 255.0), channel(colour.blue / 255.0)};
}

/// CIE L*a*b* (D65) of linear sRGB.
Eigen::Vector3d lab(const Eigen::Vector3d& rgb) {
  Eigen::Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d xyz = (xyz_from_rgb * rgb).cwiseQuotient(Eigen::Vector3d(0.9505, 1.0, 1.089));
  const Eigen::Vector3d f =
      xyz.unaryExpr([](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; });
  return {116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z())};
}

/// Machado, Oliveira and Fernandes 2009, severity 1: protanopia, deuteranopia, tritanopia.
std::vector<Eigen::Matrix3d> visions() {
  Eigen::Matrix3d protan, deutan, tritan;
  protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  tritan << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return {Eigen::Matrix3d::Identity(), protan, deutan, tritan};
}

void expectApart(const std::vector<render::Colour>& set) {
  for (const Eigen::Matrix3d& vision : visions()) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Eigen::Vector3d a = lab((vision * linear(set[i])).cwiseMax(0.0).cwiseMin(1.0));
        const Eigen::Vector3d b = lab((vision * linear(set[k])).cwiseMax(0.0).cwiseMin(1.0));
        EXPECT_GT((a - b).norm(), 18.0) << i << " and " << k;  // 2.3 is just noticeable side by side
      }
    }
  }
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      // In a grey print: a tenth of the scale between black and white.
      EXPECT_GT(std::abs(lab(linear(set[i])).x() - lab(linear(set[k])).x()), 10.0) << i << " and " << k;
    }
  }
}

TEST(Colours, OfSeriesSurviveColourBlindnessAndGreyPrint) {
  expectApart({render::colours::kSeries.begin(), render::colours::kSeries.end()});
}

// A difference of 20 in L*a*b* is about ten times what is just seen side by side, 14 in L* tells two greys of
// a print; vectors also stand off the paper.
TEST(Colours, OfASceneStayApartOnLightAndDark) {
  for (const render::Palette& palette : {render::kLightPalette, render::kDarkPalette}) {
    const std::vector<render::Colour> vectors{palette.measured, palette.predicted, palette.residual};
    for (std::size_t a = 0; a < vectors.size(); ++a) {
      for (std::size_t b = 0; b < vectors.size(); ++b) {
        if (a == b) continue;
        SCOPED_TRACE(testing::Message() << a << " and " << b);
        EXPECT_GE(std::abs(lab(linear(vectors[a])).x() - lab(linear(vectors[b])).x()), 14.0);
        for (const Eigen::Matrix3d& vision : visions()) {
          const auto seen = [&](render::Colour colour) {
            return lab((vision * linear(colour)).cwiseMax(0.0).cwiseMin(1.0));
          };
          EXPECT_GE((seen(vectors[a]) - seen(vectors[b])).norm(), 20.0);
          EXPECT_GE((seen(vectors[a]) - seen(palette.paper)).norm(), 40.0);
        }
      }
    }
  }
}

TEST(Colours, OfTheMethodsToo) {
  expectApart({render::colours::kNone, render::colours::kCp, render::colours::kPp, render::colours::kDpp});
}

}  // namespace colours_test
}  // namespace stiffscope
