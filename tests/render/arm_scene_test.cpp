#include "render/arm_scene.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "tests/render/picture.h"

namespace stiffscope {
namespace arm_scene_test {

using Eigen::Vector3d;

// An arm in the x-z plane, its wrist centre well away from all else that is drawn. No names: no legend.
render::ArmScene scene(render::View view) {
  render::ArmScene scene;
  scene.view = view;
  scene.measured_name.clear();
  scene.predicted_name.clear();
  render::ArmPose pose;
  pose.joint_points = {{0, 0, 0}, {0.4, 0, 0.9}, {0.4, 0, 2.0}, {0.6, 0, 2.1}, {2, 0, 2.1}, {2, 0, 2.1}, {2.3, 0, 2.1}};
  pose.axis_directions = {Vector3d::UnitZ(), Vector3d::UnitY(), Vector3d::UnitY(),
                          Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitX()};
  pose.wrist = render::ScenePoint{"P_{wrist}", {2, 0, 2.1}, {}, {}};
  scene.poses = {pose};
  scene.magnification = 100;
  return scene;
}

enum class Hue { red, blue, green, amber };

// Solids are shaded, so a vector is told by its hue.
cv::Mat hueMask(const cv::Mat& picture, Hue hue) {
  std::vector<cv::Mat> bgr;
  cv::split(picture, bgr);
  cv::Mat blue, green, red;
  bgr[0].convertTo(blue, CV_32S);
  bgr[1].convertTo(green, CV_32S);
  bgr[2].convertTo(red, CV_32S);
  if (hue == Hue::red) return (red - green > 70) & (red - blue > 70) & (green - blue < 40);
  if (hue == Hue::blue) return (blue - red > 50) & (blue - green > 40);
  if (hue == Hue::green) return (green - red > 60) & (green - blue > 20);
  return (red - blue > 100) & (green - blue > 60);
}

cv::Rect extentOfHue(const cv::Mat& picture, Hue hue) { return cv::boundingRect(hueMask(picture, hue)); }

cv::Point middle(const cv::Rect& r) { return (r.tl() + r.br()) / 2; }

struct Case {
  render::View view;
  Vector3d vector;
  cv::Point towards;  // on the picture, y downwards
};

TEST(ArmPicture, VectorsPointTheRightWayInEveryView) {
  const std::vector<Case> cases = {
      {render::View::side, {0.004, 0, 0}, {1, 0}},   {render::View::side, {0, 0, -0.004}, {0, 1}},
      {render::View::side, {-0.004, 0, 0}, {-1, 0}}, {render::View::front, {0, 0.004, 0}, {1, 0}},
      {render::View::front, {0, 0, 0.004}, {0, -1}}, {render::View::top, {0.004, 0, 0}, {1, 0}},
      {render::View::top, {0, 0.004, 0}, {0, -1}},   {render::View::oblique, {0, 0, -0.004}, {0, 1}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::Message() << static_cast<int>(c.view) << ": " << c.vector.transpose());
    for (const bool measured : {true, false}) {
      render::ArmScene drawn = scene(c.view);
      (measured ? drawn.poses[0].wrist->measured : drawn.poses[0].wrist->predicted) = c.vector;
      const cv::Mat picture = decoded(render::render(drawn));
      const cv::Point from = middle(extentOfHue(picture, Hue::amber));
      const cv::Rect arrow = extentOfHue(picture, measured ? Hue::red : Hue::blue);
      ASSERT_GT(arrow.area(), 100);
      const cv::Point way = middle(arrow) - from;
      const cv::Point across(-c.towards.y, c.towards.x);
      EXPECT_GT(way.dot(c.towards), 15);
      EXPECT_LT(std::abs(way.dot(across)), 4);
      expectNothingClipped(picture);
    }
  }
}

TEST(ArmPicture, LengthIsMagnificationTimesVector) {
  // The magnification does not move the picture here: arrows stay inside of what the arm covers anyway.
  const auto lengthOf = [](double metres, double magnification) {
    render::ArmScene drawn = scene(render::View::side);
    drawn.magnification = magnification;
    drawn.poses[0].wrist->measured = Vector3d(0, 0, -metres);
    const cv::Mat picture = decoded(render::render(drawn));
    return extentOfHue(picture, Hue::red).br().y - middle(extentOfHue(picture, Hue::amber)).y;
  };
  const int once = lengthOf(0.004, 100);
  EXPECT_GT(once, 50);
  EXPECT_NEAR(lengthOf(0.008, 100), 2 * once, 3);
  EXPECT_NEAR(lengthOf(0.004, 200), 2 * once, 3);
}

TEST(ArmPicture, ReferenceArrowIsToTheSameScale) {
  render::ArmScene drawn = scene(render::View::side);
  drawn.poses[0].wrist->measured = Vector3d(0, 0, -0.005);
  const cv::Mat picture = decoded(render::render(drawn));
  const double five_mm = extentOfHue(picture, Hue::red).br().y - middle(extentOfHue(picture, Hue::amber)).y;
  // The arrow stands lowest at the left; its text begins ten pixels right of its tip.
  const cv::Rect strip(0, picture.rows - 40, picture.cols, 40);
  const auto pieces = piecesOf(maskOf(picture(strip), render::colours::kInk), 100);
  ASSERT_FALSE(pieces.empty());
  const double ratio = pieces[0].width / (five_mm / 5);
  // It stands for 1, 2, 5 or 10 mm.
  double nearest = 1e9;
  for (const double mm : {1.0, 2.0, 5.0, 10.0}) nearest = std::min(nearest, std::abs(ratio / mm - 1));
  EXPECT_LT(nearest, 0.03) << ratio;
}

TEST(ArmPicture, ResidualVectorsHaveTheirOwnFactorAndReferenceArrow) {
  const auto drawnWith = [](double factor) {
    render::ArmScene drawn = scene(render::View::side);
    drawn.poses[0].wrist->residual = Vector3d(0, 0, -0.001);
    drawn.poses[0].wrist->measured = Vector3d(0.004, 0, 0);
    drawn.residual_factor = factor;
    return decoded(render::render(drawn));
  };
  // Above the strip of the scale.
  const auto lengthIn = [](const cv::Mat& picture) {
    const cv::Mat above = picture.rowRange(0, picture.rows - 60);
    return extentOfHue(above, Hue::green).br().y - middle(extentOfHue(above, Hue::amber)).y;
  };
  const cv::Mat once = drawnWith(2), twice = drawnWith(4);
  EXPECT_GT(lengthIn(once), 20);
  EXPECT_NEAR(lengthIn(twice), 2 * lengthIn(once), 3);  // pixels: edges of both
  // The reference arrow of the residual stands in the strip, in its colour, where the factor is not 1.
  const auto inStrip = [](const cv::Mat& picture) {
    return cv::countNonZero(hueMask(picture.rowRange(picture.rows - 40, picture.rows), Hue::green));
  };
  EXPECT_GT(inStrip(once), 100);
  EXPECT_EQ(inStrip(drawnWith(1)), 0);
}

TEST(ArmPicture, ResidualFactorIsTheLargestThatStaysBelowTheOthers) {
  render::ArmScene drawn = scene(render::View::side);
  render::ScenePoint& wrist = *drawn.poses[0].wrist;
  wrist.measured = Vector3d(0, 0, -0.002);
  wrist.residual = Vector3d(0.0003, 0, 0);  // 6.7 times: 5
  EXPECT_DOUBLE_EQ(render::automaticResidualFactor(drawn), 5);
  wrist.residual = Vector3d(0.0015, 0, 0);
  EXPECT_DOUBLE_EQ(render::automaticResidualFactor(drawn), 1);
  wrist.residual = Vector3d(1e-9, 0, 0);
  EXPECT_DOUBLE_EQ(render::automaticResidualFactor(drawn), 100);
  wrist.measured.reset();
  EXPECT_DOUBLE_EQ(render::automaticResidualFactor(drawn), 1);
}

TEST(ArmPicture, FramingFixesScaleAndMiddle) {
  render::ArmScene drawn = scene(render::View::side);
  const Vector3d wrist = drawn.poses[0].wrist->position;
  const auto amberAt = [&](const Vector3d& centre, double metres_high) {
    drawn.framing = render::SceneFraming{centre, metres_high};
    return middle(extentOfHue(decoded(render::render(drawn)), Hue::amber));
  };
  const cv::Point centred = amberAt(wrist, 3);
  const cv::Point aside = amberAt(wrist + Vector3d(0.5, 0, 0), 3);
  const cv::Point nearer = amberAt(wrist + Vector3d(0.5, 0, 0), 1.5);
  EXPECT_LT(aside.x, centred.x - 50);
  EXPECT_NEAR(nearer.x - centred.x, 2 * (aside.x - centred.x), 2);  // pixels: middles of balls
  EXPECT_NEAR(aside.y, centred.y, 1);
  EXPECT_NEAR(centred.x, 600, 2);
}

TEST(ArmPicture, WhatIsZoomedInStaysInItsRoom) {
  render::ArmScene drawn = scene(render::View::side);
  drawn.title = "Deflection";
  drawn.panels = {{"Keys", {{{"q", "quit"}, std::nullopt}}, false}};
  drawn.framing = render::SceneFraming{{0.4, 0, 1.4}, 0.3};  // nothing but the upper arm
  const cv::Mat picture = decoded(render::render(drawn));
  expectNothingClipped(picture);
  const cv::Mat right = picture.colRange(1100, 1200).rowRange(200, 780);  // below the one line of the panel
  EXPECT_EQ(cv::countNonZero(inkOf(right)), 0);
}

TEST(ArmPicture, TracesAndPanelsAndDarkPaper) {
  render::ArmScene drawn = scene(render::View::side);
  drawn.traces = {{"P_{10}", {{1, 0, 1}, {1.2, 0, 1.1}, {1.4, 0, 1.3}}, false}};
  drawn.dark = true;
  drawn.panels = {{"P_{10}", {{{"measured", "1.000"}, render::colours::kPredicted}}, true}};
  const cv::Mat picture = decoded(render::render(drawn));
  EXPECT_EQ(piecesOf(hueMask(picture, Hue::red), 15).size(), 3u);
  EXPECT_EQ(piecesOf(maskOf(picture, render::colours::kPredicted), 50).size(), 1u);
  const render::Colour paper = render::kDarkPalette.paper;
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(paper.blue, paper.green, paper.red));
}

TEST(ArmPicture, TargetsAreLabelled) {
  render::ArmScene drawn = scene(render::View::side);
  drawn.poses[0].targets = {{"P_{10}", {2.4, 0, 2.5}, {}, {}}};
  const cv::Mat with = decoded(render::render(drawn));
  drawn.poses[0].targets[0].label.clear();
  const cv::Mat without = decoded(render::render(drawn));
  cv::Mat difference;
  cv::absdiff(with, without, difference);
  cv::cvtColor(difference, difference, cv::COLOR_BGR2GRAY);
  const cv::Rect label = cv::boundingRect(difference > 60);
  EXPECT_GT(label.area(), 200);
  EXPECT_LT(label.width, 80);
  // It stands beside its target, the one nearly black ball: labels are projected as the solids are.
  cv::Mat dark;
  cv::inRange(without, cv::Scalar(0, 0, 0), cv::Scalar(50, 50, 50), dark);
  cv::erode(dark, dark, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  const cv::Rect ball = cv::boundingRect(dark.rowRange(0, dark.rows / 2));
  ASSERT_GT(ball.area(), 20);
  EXPECT_LT(cv::norm(middle(ball) - middle(label)), 90);
}

TEST(ArmPicture, GhostsAndTargetsAreNotClipped) {
  for (const render::View view : {render::View::oblique, render::View::front, render::View::side, render::View::top}) {
    render::ArmScene drawn = scene(view);
    drawn.title = "Deflection";
    drawn.poses[0].targets = {{"P_{10}", {2.4, 0.2, 2.3}, Vector3d(0.001, 0, -0.003), Vector3d(0.001, 0, -0.002)}};
    drawn.poses.push_back(drawn.poses[0]);
    drawn.poses[1].ghost = true;
    for (Vector3d& point : drawn.poses[1].joint_points) point = {-point.y(), point.x(), point.z()};
    for (const render::Size size : {render::Size{1200, 800}, render::Size{480, 320}})
      expectNothingClipped(decoded(render::render(drawn, size)));
    EXPECT_LT(render::encodePng(render::render(drawn)).size(), 300'000u);
  }
}

TEST(ArmPicture, LoadIsAnArrowInItsDirectionWhateverTheForce) {
  const auto changedBy = [](const Vector3d& force, bool ghost = false) {
    render::ArmScene drawn = scene(render::View::side);
    drawn.framing = render::SceneFraming{{1.2, 0, 1.2}, 3};
    drawn.poses[0].ghost = ghost;
    drawn.poses[0].wrist->label.clear();  // it makes room for the arrow
    const cv::Mat without = decoded(render::render(drawn));
    drawn.poses[0].load = render::SceneLoad{{2.3, 0, 2.1}, force, ""};
    cv::Mat difference;
    cv::absdiff(without, decoded(render::render(drawn)), difference);
    cv::cvtColor(difference, difference, cv::COLOR_BGR2GRAY);
    return cv::boundingRect(difference > 60);
  };
  const cv::Rect down = changedBy({0, 0, -1500});
  EXPECT_GT(down.height, 60);
  EXPECT_GT(down.height, 2 * down.width);
  EXPECT_EQ(changedBy({0, 0, -15}), down);
  const cv::Rect up = changedBy({0, 0, 1500}), right = changedBy({1500, 0, 0});
  EXPECT_NEAR(up.br().y, down.y, 12);  // pixels: half the width of the shaft and its rim about the same place
  EXPECT_NEAR(up.height, down.height, 12);
  EXPECT_GT(right.width, 2 * right.height);
  EXPECT_NEAR(right.width, down.height, 12);
  EXPECT_EQ(changedBy({0, 1500, 0}).area(), 0);  // end on
  EXPECT_EQ(changedBy({0, 0, 0}).area(), 0);
  EXPECT_EQ(changedBy({0, 0, -1500}, true).area(), 0);
  render::ArmScene drawn = scene(render::View::side);
  drawn.poses[0].load = render::SceneLoad{{2.3, 0, 2.1}, {0, 0, -1500}, "load"};
  expectNothingClipped(decoded(render::render(drawn)));
  drawn.poses[0].load->force.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(render::render(drawn), std::invalid_argument);
}

TEST(ArmPicture, MagnificationMakesTheLongestAFifth) {
  render::ArmScene drawn = scene(render::View::side);
  // The box of all points is 2.3 m long; a fifth of it is 0.46 m = 230 x 2 mm; 1-2-5 below: 200.
  drawn.poses[0].wrist->measured = Vector3d(0, 0, -0.002);
  drawn.poses[0].wrist->predicted = Vector3d(0, 0, 0.001);
  EXPECT_DOUBLE_EQ(render::automaticMagnification(drawn), 200);
  drawn.poses[0].wrist->measured = drawn.poses[0].wrist->predicted = std::nullopt;
  EXPECT_DOUBLE_EQ(render::automaticMagnification(drawn), 1);
}

TEST(ArmPicture, RefusesWhatCannotBeDrawn) {
  render::ArmScene drawn = scene(render::View::side);
  drawn.poses[0].axis_directions.pop_back();
  try {
    render::render(drawn);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("7 joint points and 5 axes"), std::string::npos) << error.what();
  }
  drawn = scene(render::View::side);
  drawn.poses[0].wrist->measured = Vector3d(0, 0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(render::render(drawn), std::invalid_argument);
  drawn = scene(render::View::side);
  drawn.magnification = 0;
  EXPECT_THROW(render::render(drawn), std::invalid_argument);
  drawn = scene(render::View::side);
  drawn.residual_factor = -1;
  EXPECT_THROW(render::render(drawn), std::invalid_argument);
  drawn = scene(render::View::side);
  drawn.framing = render::SceneFraming{{0, 0, 0}, 0};
  EXPECT_THROW(render::render(drawn), std::invalid_argument);
  EXPECT_THROW(render::render(render::ArmScene{}), std::invalid_argument);
}

}  // namespace arm_scene_test
}  // namespace stiffscope
