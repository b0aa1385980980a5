#include "metrology/trilateration.h"

#include <gtest/gtest.h>

#include "tests/metrology/reference.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace trilateration_test {

using Points = std::array<Eigen::Vector3d, 3>;
using Radii = std::array<double, 3>;

TEST(Trilaterate, ByHand) {
  // P10 at the origin, P11 on x, P12 on y: e_x, e_y, e_z are the axes. The point (1, 2, 3) of the sides 4
  // and 5.
  const Points points{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 0, 0), Eigen::Vector3d(0, 5, 0)};
  const auto both = metrology::trilaterate(points, {std::sqrt(14.0), std::sqrt(22.0), std::sqrt(19.0)});
  ASSERT_TRUE(both);
  EXPECT_LT((both->roots[0] - Eigen::Vector3d(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT((both->roots[1] - Eigen::Vector3d(1, 2, -3)).norm(), 1e-14);
  EXPECT_NEAR(both->height_squared, 9.0, 1e-13);
}

TEST(Trilaterate, FrameByHandWithObliqueThirdPoint) {
  // (18)-(20), (19) with i e_x: P12 - P10 = (3, 4, 0), e_x = x, i = 3, e_y = y, j = 4.
  const auto frame = metrology::trilaterationFrame({1, 1, 1}, {3, 1, 1}, {4, 5, 1});
  ASSERT_TRUE(frame);
  EXPECT_DOUBLE_EQ(frame->d, 2.0);
  EXPECT_DOUBLE_EQ(frame->i, 3.0);
  EXPECT_DOUBLE_EQ(frame->j, 4.0);
  EXPECT_LT((frame->ey - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((frame->ez - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(Trilaterate, TheSamePointWhicheverReflectorIsTheOrigin) {
  Noise noise(11);
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d wrist = 2.0 * noise.normal3();
    Points points;
    Radii radii;
    for (std::size_t i = 0; i < 3; ++i) {
      points[i] = wrist + 0.5 * noise.normal3();
      // Radii off by noise, so that the answer is not the wrist exactly: it must still be the same thrice.
      radii[i] = (points[i] - wrist).norm() * (1.0 + 1e-5 * noise.normal());
    }
    const auto first = metrology::trilaterate(points, radii);
    ASSERT_TRUE(first);
    if (first->height_squared < 1e-2) continue;  // near the reflectors' plane the root magnifies rounding
    for (std::size_t shift = 1; shift < 3; ++shift) {
      const auto turned = metrology::trilaterate({points[shift], points[(shift + 1) % 3], points[(shift + 2) % 3]},
                                                 {radii[shift], radii[(shift + 1) % 3], radii[(shift + 2) % 3]});
      ASSERT_TRUE(turned);
      // A cyclic permutation keeps the side of e_z, so the roots keep their order. Rounding, over sides of
      // decimetres.
      EXPECT_LT((turned->roots[0] - first->roots[0]).norm(), 1e-10);
      EXPECT_LT((turned->roots[1] - first->roots[1]).norm(), 1e-10);
    }
    const auto swapped = metrology::trilaterate({points[1], points[0], points[2]}, {radii[1], radii[0], radii[2]});
    ASSERT_TRUE(swapped);
    EXPECT_LT((swapped->roots[1] - first->roots[0]).norm(), 1e-10);  // an odd permutation swaps them
  }
}

TEST(Trilaterate, RootsLieOnAllThreeSpheres) {
  Noise noise(12);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d wrist = noise.normal3();
    Points points;
    Radii radii;
    for (std::size_t i = 0; i < 3; ++i) points[i] = wrist + noise.normal3(), radii[i] = (points[i] - wrist).norm();
    const auto both = metrology::trilaterate(points, radii);
    ASSERT_TRUE(both);
    for (const Eigen::Vector3d& root : both->roots) {
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR((points[i] - root).norm(), radii[i], 1e-8);
    }
  }
}

TEST(Trilaterate, SpheresThatDoNotMeet) {
  const auto both = metrology::trilaterate(
      {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}, {0.1, 0.1, 0.1});
  ASSERT_TRUE(both);
  EXPECT_LT(both->height_squared, 0.0);
  EXPECT_EQ(both->roots[0], both->roots[1]);
  EXPECT_LT((both->roots[0] - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 1e-15);
}

TEST(Trilaterate, RefusesReflectorsInOneLineOrPlace) {
  EXPECT_FALSE(metrology::trilaterate({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(3, 3, 0)},
                                      {1, 1, 1}));
  EXPECT_FALSE(metrology::trilaterate({Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(3, 3, 0)},
                                      {1, 1, 1}));
  EXPECT_FALSE(metrology::trilaterate({Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 2, 0), Eigen::Vector3d(1, 0, 0)},
                                      {1, 1, 1}));
}

TEST(NearerRoot, TakesTheOneAsked) {
  const metrology::Trilateration both{{Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1)}, 1.0};
  EXPECT_EQ(metrology::nearerRoot(both, {5, 5, 0.1}), both.roots[0]);
  EXPECT_EQ(metrology::nearerRoot(both, {5, 5, -0.1}), both.roots[1]);
}

TEST(Trilaterate, PublishedTwoRoots) {
  const auto file = reference("published-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  const auto& one = (*file)["trilateration_two_roots_7"];
  const Points points{vector(one["anchors"][0]), vector(one["anchors"][1]), vector(one["anchors"][2])};
  const auto both = metrology::trilaterate(points, {one["distances"][0], one["distances"][1], one["distances"][2]});
  ASSERT_TRUE(both);
  for (const auto& exact : one["exact_roots"]) {
    const Eigen::Vector3d root = vector(exact);
    EXPECT_LT((metrology::nearerRoot(*both, root) - root).norm(), 1e-14);
  }
}

TEST(Trilaterate, PublishedPlaneCaseFindsTheTruthNotTheMirrorMinimum) {
  // Two coordinates only: the point lies in the anchors' plane, so both roots fall together.
  const auto file = reference("published-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  const auto& one = (*file)["trilateration_local_minimum_34"];
  const Eigen::Vector3d truth = vector(one["truth"]);
  Points points;
  Radii radii;
  for (std::size_t i = 0; i < 3; ++i) points[i] = vector(one["anchors"][i]), radii[i] = (points[i] - truth).norm();
  const auto both = metrology::trilaterate(points, radii);
  ASSERT_TRUE(both);
  for (const Eigen::Vector3d& root : both->roots) EXPECT_LT((root - truth).norm(), 1e-6);  // root of rounding, 1e-13
}

}  // namespace trilateration_test
}  // namespace stiffscope
