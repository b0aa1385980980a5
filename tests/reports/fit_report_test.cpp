#include <gtest/gtest.h>

#include <Eigen/Dense>
#include "reports/json/fit_json.h"
#include "reports/text/text.h"
#include "reports/words/remark_words.h"

namespace stiffscope {
namespace fit_report_test {

/// Points on a circle of radius 2 about the z axis, or on a cylinder 15 high, off by a fixed pattern of a hundredth.
metrology::MeasuredPoints pattern(bool in_plane) {
  metrology::MeasuredPoints points;
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.21 * i, radius = 2.0 + 0.01 * ((i * 7) % 5 - 2);
    points.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                               0.01 * ((i * 3) % 4 - 1.5) + (in_plane ? 0.0 : 3.0 * (i % 6)));
  }
  return points;
}

Eigen::MatrixXd matrixOf(const reports::Json& rows) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.at(0).size()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      matrix(i, j) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
    }
  }
  return matrix;
}

TEST(FitJson, CovarianceIsOfTheFullVectorsInTheOrderOfParameters) {
  const metrology::FittedCircle circle = metrology::fitCircle(pattern(true));
  ASSERT_TRUE(circle.determined) << reports::words(circle.reason);
  const reports::Json json = reports::fitJson({"circle", 24, circle, std::nullopt});
  const std::vector<std::string> order{"center_x", "center_y", "center_z", "normal_x",
                                       "normal_y", "normal_z", "radius"};
  EXPECT_EQ(json.at("parameters").get<std::vector<std::string>>(), order);
  const Eigen::MatrixXd covariance = matrixOf(json.at("covariance"));
  ASSERT_EQ(covariance.rows(), 7);
  ASSERT_EQ(covariance.cols(), 7);
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12 * covariance.norm());  // rounding
  // A direction has two degrees of freedom: nothing along it, one rank less.
  const Eigen::Vector3d normal = circle.circle.normal;
  const Eigen::Matrix3d of_normal = covariance.block(3, 3, 3, 3);
  EXPECT_LT((of_normal * normal).norm(), 1e-12 * of_normal.norm());
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues();
  EXPECT_LT(std::abs(values[0]), 1e-10 * values[6]);
  EXPECT_GT(values[1], 1e-6 * values[6]);
  EXPECT_NEAR(json.at("radius").get<double>(), 2.0, 0.01);
  EXPECT_NEAR(json.at("center").at(1).get<double>(), 0.0, 0.01);
  EXPECT_FALSE(json.contains("snooping"));
}

TEST(FitJson, EveryShapeHasItsKeys) {
  const metrology::MeasuredPoints tall = pattern(false), flat = pattern(true);
  const auto keysOf = [](const char* name, auto fit) { return reports::fitJson({name, 24, fit, std::nullopt}); };
  for (const auto& [json, keys] : std::vector<std::pair<reports::Json, std::vector<const char*>>>{
           {keysOf("line", metrology::fitLine(tall)), {"point", "axis"}},
           {keysOf("plane", metrology::fitPlane(flat)), {"point", "normal"}},
           {keysOf("circle", metrology::fitCircle(flat)), {"center", "normal", "radius"}},
           {keysOf("cylinder", metrology::fitCylinder(tall)), {"point", "axis", "radius"}}}) {
    ASSERT_TRUE(json.at("determined").get<bool>()) << json;
    for (const char* key : keys) EXPECT_TRUE(json.contains(key)) << key << json;
    EXPECT_EQ(json.at("covariance").size(), json.at("parameters").size());
    for (const char* key : {"rms", "residual_sd", "degrees_of_freedom", "method", "points"}) {
      EXPECT_TRUE(json.contains(key)) << key;
    }
  }
}

TEST(FitJson, AnExactFitSaysWhyItHasNoCovariance) {
  metrology::MeasuredPoints corner;
  corner.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const reports::ShapeFit fitted{"plane", 3, metrology::fitPlane(corner), std::nullopt};
  const reports::Json json = reports::fitJson(fitted);
  EXPECT_TRUE(json.at("determined").get<bool>());
  EXPECT_TRUE(json.at("covariance").is_null());
  EXPECT_TRUE(json.at("residual_sd").is_null());
  EXPECT_NE(json.at("covariance_reason").get<std::string>().find("exact"), std::string::npos);
  EXPECT_NE(reports::fitText(fitted).find("no degree of freedom"), std::string::npos);
}

TEST(FitJson, UndeterminedGivesTheReasonAndNoNumber) {
  metrology::MeasuredPoints straight;
  for (int i = 0; i < 5; ++i) straight.points.emplace_back(i, 0, 0);
  const reports::ShapeFit fitted{"circle", 5, metrology::fitCircle(straight), std::nullopt};
  const reports::Json json = reports::fitJson(fitted);
  EXPECT_FALSE(json.at("determined").get<bool>());
  EXPECT_FALSE(json.at("reason").get<std::string>().empty());
  for (const char* key : {"center", "radius", "covariance", "rms"}) EXPECT_FALSE(json.contains(key)) << key;
  EXPECT_NE(reports::fitText(fitted).find("undetermined: " + json.at("reason").get<std::string>()), std::string::npos);
}

TEST(FitText, NamesEachParameterWithItsStandardUncertainty) {
  const metrology::FittedSphere sphere =
      metrology::fitSphere({{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1.2}}, {}});
  const std::string text = reports::fitText({"sphere", 6, sphere, std::nullopt});
  EXPECT_EQ(text.find("sphere through 6 points"), 0u);
  for (const char* name : {"center_x", "center_y", "center_z", "radius", "standard unc.", "2 degrees of freedom"}) {
    EXPECT_NE(text.find(name), std::string::npos) << name << text;
  }
}

TEST(FitText, PointsLeftOutAreCountedFromOne) {
  const reports::Snooping snooping{0.01, 3.4, {{0, 6, 12.5, 3.5}}};
  const reports::ShapeFit fitted{"circle", 23, metrology::fitCircle(pattern(true)), snooping};
  EXPECT_NE(reports::fitText(fitted).find("point 7: w 12.5, above 3.5"), std::string::npos) << reports::fitText(fitted);
  const reports::Json json = reports::fitJson(fitted);
  EXPECT_EQ(json.at("snooping").at("rejected").at(0).at("point"), 7);
  EXPECT_DOUBLE_EQ(json.at("snooping").at("critical_w").get<double>(), 3.4);
}

}  // namespace fit_report_test
}  // namespace stiffscope
