#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <vector>
#include "metrology/axis_fit.h"
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/lines.h"
#include "metrology/plane_fit.h"
#include "metrology/sphere_fit.h"
#include "reports/words/remark_words.h"
#include "tests/metrology/reference.h"

// Certified least-squares answers of NIST's Algorithm Testing System (default test of ASME B89.4.10). They are printed
// with twenty digits, so the printing is no coarser than the tolerance. Lengths are judged against the extent of the
// data about their mean, directions against 1.

namespace stiffscope {
namespace nist_test {

constexpr double kTolerance = 1e-11;

struct Pair {
  std::string name;
  metrology::MeasuredPoints points;
  std::vector<double> certified;
  double scale = 0.0;  ///< extent of the data about its mean

  Eigen::Vector3d vectorAt(std::size_t k) const { return {certified[k], certified[k + 1], certified[k + 2]}; }
};

std::vector<double> numbersIn(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istream_iterator<double>(stream), {}};
}

std::vector<Pair> pairsOf(const std::string& shape) {
  std::vector<Pair> pairs;
  const auto folder = referenceFolder() / "nist" / shape;
  if (!std::filesystem::exists(folder)) return pairs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".ds") continue;
    Pair pair{
        entry.path().stem().string(), {}, numbersIn(std::filesystem::path(entry.path()).replace_extension(".fit"))};
    const std::vector<double> data = numbersIn(entry.path());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k + 2 < data.size(); k += 3)
      pair.points.points.push_back({data[k], data[k + 1], data[k + 2]});
    EXPECT_EQ(static_cast<double>(pair.points.points.size()), data[0]) << pair.name;
    for (const auto& point : pair.points.points) mean += point / data[0];
    for (const auto& point : pair.points.points) pair.scale = std::max(pair.scale, (point - mean).norm());
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// Largest deviations over the pairs of a shape, relative to the scale of each.
class Worst {
 public:
  explicit Worst(std::string shape) : shape_(std::move(shape)) {}
  ~Worst() {
    std::printf("NIST %s, %d pairs, worst:", shape_.c_str(), pairs_);
    for (const auto& [what, value] : worst_) std::printf(" %s %.1e", what.c_str(), value);
    std::printf("\n");
  }
  void pair() { ++pairs_; }
  void see(const Pair& pair, const std::string& what, double relative) {
    EXPECT_LT(relative, kTolerance) << pair.name << " " << what;
    worst_[what] = std::max(worst_[what], relative);
  }

 private:
  std::string shape_;
  int pairs_ = 0;
  std::map<std::string, double> worst_;
};

double apart(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.normalized().cross(b.normalized()).norm();  // printed directions are of unit length to their last digit only
}

TEST(Nist, Planes) {
  const auto pairs = pairsOf("Plane");
  if (pairs.empty()) GTEST_SKIP() << "reference data are not beside the checkout";
  Worst worst("plane");
  for (const Pair& pair : pairs) {
    const metrology::FittedPlane fit = metrology::fitPlane(pair.points);
    ASSERT_TRUE(fit.determined) << pair.name << ": " << reports::words(fit.reason);
    worst.pair();
    worst.see(pair, "point", std::abs(fit.plane.normal.dot(pair.vectorAt(0) - fit.plane.point)) / pair.scale);
    worst.see(pair, "normal", apart(fit.plane.normal, pair.vectorAt(3)));
  }
}

TEST(Nist, Spheres) {
  const auto pairs = pairsOf("Sphere");
  if (pairs.empty()) GTEST_SKIP() << "reference data are not beside the checkout";
  Worst worst("sphere");
  for (const Pair& pair : pairs) {
    const metrology::FittedSphere fit = metrology::fitSphere(pair.points);
    ASSERT_TRUE(fit.determined) << pair.name << ": " << reports::words(fit.reason);
    worst.pair();
    worst.see(pair, "centre", (fit.sphere.centre - pair.vectorAt(0)).norm() / pair.scale);
    worst.see(pair, "radius", std::abs(fit.sphere.radius - pair.certified[3] / 2.0) / pair.scale);
  }
}

TEST(Nist, Cylinders) {
  const auto pairs = pairsOf("Cylinder");
  if (pairs.empty()) GTEST_SKIP() << "reference data are not beside the checkout";
  Worst worst("cylinder");
  for (const Pair& pair : pairs) {
    const metrology::FittedCylinder fit = metrology::fitCylinder(pair.points);
    EXPECT_TRUE(fit.determined) << pair.name << ": " << reports::words(fit.reason);
    worst.pair();
    const Eigen::Vector3d certified = pair.vectorAt(0);
    worst.see(pair, "point", (metrology::nearestPoint(fit.cylinder.axis, certified) - certified).norm() / pair.scale);
    worst.see(pair, "axis", apart(fit.cylinder.axis.direction, pair.vectorAt(3)));
    worst.see(pair, "radius", std::abs(fit.cylinder.radius - pair.certified[6] / 2.0) / pair.scale);
  }
}

void compareCircles(const std::string& shape, metrology::CircleStrategy strategy) {
  Worst worst(shape);
  for (const Pair& pair : pairsOf(shape)) {
    const metrology::FittedCircle fit = metrology::fitCircle(pair.points, strategy);
    ASSERT_TRUE(fit.determined) << pair.name << ": " << reports::words(fit.reason);
    worst.pair();
    worst.see(pair, "centre", (fit.circle.centre - pair.vectorAt(0)).norm() / pair.scale);
    worst.see(pair, "normal", apart(fit.circle.normal, pair.vectorAt(3)));
    worst.see(pair, "radius", std::abs(fit.circle.radius - pair.certified[6] / 2.0) / pair.scale);
  }
}

TEST(Nist, CirclesInSpacePlaneFirst) {
  if (pairsOf("Circle3d").empty()) GTEST_SKIP() << "reference data are not beside the checkout";
  compareCircles("Circle3d", metrology::CircleStrategy::plane_first);  // as NIST's own answers are made
}

TEST(Nist, CirclesInAPlane) {
  if (pairsOf("Circle2d").empty()) GTEST_SKIP() << "reference data are not beside the checkout";
  compareCircles("Circle2d", metrology::CircleStrategy::full);  // flat data: both strategies are one
  compareCircles("Circle2d", metrology::CircleStrategy::plane_first);
}

}  // namespace nist_test
}  // namespace stiffscope
