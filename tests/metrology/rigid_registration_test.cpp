#include "metrology/registration.h"

#include <gtest/gtest.h>

#include "metrology/remarks.h"
#include "metrology/rigid_motion.h"
#include "reports/words/remark_words.h"
#include "tests/metrology/reference.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace rigid_registration_test {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Isometry3d someMotion(Noise& noise) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(3.1 * noise.uniform(), noise.direction()).toRotationMatrix();
  motion.translation() = 3.0 * noise.normal3();
  return motion;
}

Points moved(const Eigen::Isometry3d& motion, const Points& points) {
  Points result;
  for (const auto& point : points) result.push_back(motion * point);
  return result;
}

TEST(RegisterRigid, AQuarterTurnByHand) {
  const metrology::RigidRegistration found =
      metrology::registerRigid({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {{5, 1, 2}, {4, 0, 2}, {5, -1, 2}});
  ASSERT_TRUE(found.determined);
  EXPECT_LT((found.to_from_source * Eigen::Vector3d(2, 0, 3) - Eigen::Vector3d(5, 2, 5)).norm(), 1e-14);
  EXPECT_LT(found.rms, 1e-15);
}

TEST(RegisterRigid, RandomMotionsComeBack) {
  Noise noise(1);
  for (int k = 0; k < 200; ++k) {
    Points points;
    for (int i = 0; i < 3 + k % 5; ++i) points.push_back(noise.normal3());
    const Eigen::Isometry3d motion = someMotion(noise);
    const metrology::RigidRegistration found = metrology::registerRigid(points, moved(motion, points));
    ASSERT_TRUE(found.determined);
    // Rounding of points of 10 m; a random triangle may be narrow by 100.
    EXPECT_LT((found.to_from_source.matrix() - motion.matrix()).norm(), 1e-11);
    EXPECT_NEAR(found.to_from_source.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(RegisterRigid, LeastSquaresCannotBeImprovedOn) {
  // With noise: no small turn or shift of the answer fits better.
  Noise noise(2);
  Points source, to;
  for (int i = 0; i < 6; ++i) source.push_back(noise.normal3());
  to = moved(someMotion(noise), source);
  for (auto& point : to) point += 0.05 * noise.normal3();
  const metrology::RigidRegistration found = metrology::registerRigid(source, to);
  ASSERT_TRUE(found.determined);
  const auto misfit = [&](const Eigen::Isometry3d& motion) {
    double sum = 0.0;
    for (std::size_t i = 0; i < to.size(); ++i) sum += (motion * source[i] - to[i]).squaredNorm();
    return sum;
  };
  EXPECT_NEAR(found.rms, std::sqrt(misfit(found.to_from_source) / 18.0), 1e-15);
  for (int k = 0; k < 100; ++k) {
    Eigen::Isometry3d near = found.to_from_source;
    near.prerotate(Eigen::AngleAxisd(1e-3, noise.direction()));
    near.pretranslate(1e-3 * noise.normal3());
    EXPECT_GT(misfit(near), misfit(found.to_from_source));
  }
}

TEST(RegisterRigid, NeverAReflection) {
  // A mirror image of a solid: the best proper motion leaves a misfit.
  Noise noise(3);
  Points solid, mirrored;
  for (int i = 0; i < 5; ++i)
    solid.push_back(noise.normal3()), mirrored.push_back(solid.back().cwiseProduct(Eigen::Vector3d(1, 1, -1)));
  const metrology::RigidRegistration found = metrology::registerRigid(solid, mirrored);
  ASSERT_TRUE(found.determined);
  EXPECT_NEAR(found.to_from_source.linear().determinant(), 1.0, 1e-12);
  EXPECT_GT(found.rms, 0.05);
}

TEST(RegisterRigid, UmeyamasReflectionCase) {
  // Umeyama's example is plane and asks for a similarity; its rotation is also that of the rigid motion, for
  // scale does not turn. His scale and shift do not apply here. In space a triangle may be turned over
  // instead, so two more points above and below the centroids keep the motion in the plane, as it is in his.
  const auto file = reference("published-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  const auto& one = (*file)["similarity_umeyama_1991"];
  Points source, to;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero(), to_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    source.push_back({one["A"][0][i], one["A"][1][i], 0});
    to.push_back({one["B"][0][i], one["B"][1][i], 0});
    source_mean += source.back() / 3.0;
    to_mean += to.back() / 3.0;
  }
  for (const double side : {10.0, -10.0}) {
    source.push_back(source_mean + side * Eigen::Vector3d::UnitZ());
    to.push_back(to_mean + side * Eigen::Vector3d::UnitZ());
  }
  const metrology::RigidRegistration found = metrology::registerRigid(source, to);
  ASSERT_TRUE(found.determined);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      EXPECT_NEAR(found.to_from_source.linear()(row, column),
                  one["R"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>(),
                  1e-6);  // as printed
    }
  }
  EXPECT_NEAR(found.to_from_source.linear()(2, 2), 1.0, 1e-12);
  // The triangle alone, free to be turned over in space, is matched exactly.
  source.resize(3), to.resize(3);
  EXPECT_LT(metrology::registerRigid(source, to).rms, 1e-14);
}

TEST(RegisterRigid, OfThreePointsIsThatOfTheSingularVectors) {
  // Three points go by the closed form in their planes, four by singular vectors: each point twice is the same problem.
  Noise noise(11);
  for (int n = 0; n < 50; ++n) {
    Points source;
    for (int i = 0; i < 3; ++i) source.push_back(0.3 * noise.normal3());
    Points to = moved(someMotion(noise), source);
    for (auto& point : to) point += 0.02 * noise.normal3();
    Points twice = source, twice_to = to;
    twice.insert(twice.end(), source.begin(), source.end());
    twice_to.insert(twice_to.end(), to.begin(), to.end());
    const metrology::RigidRegistration three = metrology::registerRigid(source, to),
                                       six = metrology::registerRigid(twice, twice_to);
    ASSERT_TRUE(three.determined && six.determined);
    // Rounding over the least singular value that counts, a hundredth of the largest at worst here.
    EXPECT_TRUE(three.to_from_source.isApprox(six.to_from_source, 1e-11)) << n;
    EXPECT_NEAR(three.rms, six.rms, 1e-13) << n;
    EXPECT_NEAR(three.to_from_source.linear().determinant(), 1.0, 1e-12) << n;
  }
}

TEST(NearestRotation, KeepsHandsByTheLeastSingularDirection) {
  // Along z the map mirrors: turning nothing keeps 3 + 2 - 1 of the trace, more than any half turn (3 - 2 + 1 at most).
  const metrology::NearestRotation found = metrology::nearestRotation(Eigen::Vector3d(3.0, 2.0, -1.0).asDiagonal());
  EXPECT_TRUE(found.rotation.isApprox(Eigen::Matrix3d::Identity(), 1e-15));
  EXPECT_TRUE(found.singular_values.isApprox(Eigen::Vector3d(3.0, 2.0, 1.0), 1e-15));
}

TEST(NearestRotation, NoSmallTurnComesNearer) {
  Noise noise(12);
  for (int n = 0; n < 50; ++n) {
    Eigen::Matrix3d map;
    for (int column = 0; column < 3; ++column) map.col(column) = noise.normal3();
    const Eigen::Matrix3d rotation = metrology::nearestRotation(map).rotation;
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12) << n;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double angle : {-1e-3, 1e-3}) {
        const Eigen::Matrix3d turned = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)) * rotation;
        // Sums of squares of a few ones have lost 1e-14 at most; a worse turn costs the square of the angle, 1e-6.
        EXPECT_LE((rotation - map).squaredNorm(), (turned - map).squaredNorm() + 1e-13) << n;
      }
    }
  }
}

TEST(NearlyOnOneLine, IsWhatLeavesItsLineByLessThanAHundredth) {
  // Of three at -1, 0 and 1 the middle one off by h: squares 2 along, 2/3 h^2 across.
  const auto bent = [](double h) {
    return metrology::nearlyOnOneLine({{-1.0, 0.0, 0.0}, {0.0, h, 0.0}, {1.0, 0.0, 0.0}});
  };
  EXPECT_TRUE(bent(0.0));
  EXPECT_TRUE(bent(0.99 * std::sqrt(3e-4)));
  EXPECT_FALSE(bent(1.01 * std::sqrt(3e-4)));
  EXPECT_TRUE(metrology::nearlyOnOneLine({{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}));
}

TEST(NearlyOnOneLine, JudgesThreePointsAsTheSamePointsTwice) {
  // Three have a formula of their own; each taken twice, they spread in the same ratio and go by the decomposition.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  int lines = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d along(normal(random), normal(random), normal(random));
    Points points;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d across(normal(random), normal(random), normal(random));
      points.push_back(Eigen::Vector3d(4.0, -2.0, 1.0) + normal(random) * along + 0.01 * across);
    }
    Points twice = points;
    twice.insert(twice.end(), points.begin(), points.end());
    EXPECT_EQ(metrology::nearlyOnOneLine(points), metrology::nearlyOnOneLine(twice));
    lines += metrology::nearlyOnOneLine(points);
  }
  EXPECT_GT(lines, 50);
  EXPECT_LT(lines, 350);
}

TEST(RegisterRigid, RefusesTooFewAndCollinear) {
  EXPECT_FALSE(metrology::registerRigid({}, {}).determined);
  EXPECT_FALSE(metrology::registerRigid({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}).determined);
  const Points line{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {5, 5, 0}};
  const metrology::RigidRegistration found = metrology::registerRigid(line, line);
  EXPECT_FALSE(found.determined);
  EXPECT_TRUE(found.reason.is(metrology::RemarkId::points_on_one_line));
  const Points place(4, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(metrology::registerRigid(place, place).determined);
}

TEST(RegisterRigid, RefusesALineThatRoundingHasBent) {
  // Points on an oblique line, as read from a file with four decimals of a millimetre: not a frame.
  Points line;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d point = Eigen::Vector3d(0.1, 0.2, 0.3) + i * Eigen::Vector3d(1, 2, -3) / 30.0;
    line.push_back(1e-7 * (1e7 * point).array().round().matrix());
  }
  EXPECT_FALSE(metrology::registerRigid(line, line).determined);
}

TEST(RegisterRigid, WeightedRegionHoldsTheTruth) {
  // 95 % ellipsoids of 2000 draws: 0.5 % standard error; the factor chi2/dof, applied only above 1, adds
  // about 1 %.
  Noise noise(21);
  const Eigen::Isometry3d truth =
      Eigen::Translation3d(101.0, -2.0, 0.5) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 2) / 3.0);
  int inside = 0;
  for (int k = 0; k < 2000; ++k) {
    Points source, to;
    std::vector<Eigen::Matrix3d> covariances;
    for (int i = 0; i < 30; ++i) {
      source.push_back(noise.normal3());
      const Eigen::Vector3d there = truth * source.back();
      covariances.push_back(seenFromOrigin(there - Eigen::Vector3d(99, 0, 0), 6e-6, 2.5e-5));
      to.push_back(there + noise.draw(covariances.back()));
    }
    const metrology::WeightedRegistration found = metrology::registerRigid(source, to, covariances);
    ASSERT_TRUE(found.determined) << reports::words(found.reason);
    EXPECT_EQ(found.degrees_of_freedom, 84);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(truth.linear() * found.to_from_source.linear().transpose()));
    const Eigen::Vector3d rotation = turn.angle() * turn.axis();
    const Eigen::Vector3d shift = truth * (found.to_from_source.inverse() * found.pivot) - found.pivot;
    Eigen::Matrix<double, 6, 1> error;
    error << rotation, shift;
    inside += error.dot(found.covariance.ldlt().solve(error)) < 12.5916;
  }
  EXPECT_GT(inside, 1860);
  EXPECT_LT(inside, 1940);
}

TEST(RegisterRigid, WeightsPullTowardsThePrecisePairs) {
  const Points source{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  Points to = source;
  to[4] += Eigen::Vector3d(0, 0, 1e-3);
  std::vector<Eigen::Matrix3d> covariances(5, 1e-10 * Eigen::Matrix3d::Identity());
  const auto offOf = [&] {
    return (metrology::registerRigid(source, to, covariances).to_from_source * source[0] - source[0]).norm();
  };
  EXPECT_GT(offOf(), 1e-5);
  covariances[4] *= 1e10;
  EXPECT_LT(offOf(), 1e-12);  // 1 mm by a weight of 1e-10
  covariances.pop_back();
  EXPECT_FALSE(metrology::registerRigid(source, to, covariances).determined);
}

}  // namespace rigid_registration_test
}  // namespace stiffscope
