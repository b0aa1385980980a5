#include "render/view_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace stiffscope {
namespace view_camera_test {

constexpr double kRounding = 1e-12;

render::ArmScene seenBy(const render::ViewCamera& camera) {
  render::ArmScene scene;
  camera.apply(scene);
  return scene;
}

TEST(ViewCamera, FitsUntilTheHandTakesIt) {
  render::ViewCamera camera;
  camera.look(render::View::front);
  camera.framedAs({{1, 2, 3}, 4});
  EXPECT_FALSE(seenBy(camera).framing);
  EXPECT_FALSE(seenBy(camera).view_direction);
  EXPECT_EQ(seenBy(camera).view, render::View::front);
  camera.zoom(2);
  ASSERT_TRUE(seenBy(camera).framing);
  EXPECT_DOUBLE_EQ(seenBy(camera).framing->metres_high, 2);
  EXPECT_EQ(seenBy(camera).framing->centre, Eigen::Vector3d(1, 2, 3));
  camera.look(render::View::side);
  EXPECT_FALSE(seenBy(camera).framing);
}

// From the front y is to the right and z up: pulled by a quarter of a room 4 m high, the centre goes the
// other way.
TEST(ViewCamera, ShiftingMovesTheCentreAgainstTheHand) {
  render::ViewCamera camera;
  camera.look(render::View::front);
  camera.framedAs({{0, 0, 0}, 4});
  camera.shift(0.25, -0.5);
  EXPECT_LT((seenBy(camera).framing->centre - Eigen::Vector3d(0, -1, 2)).norm(), kRounding);
}

// Pulled to the right by a quarter turn, what was in front is at the right: then the view is from the left
// side, along the turned y axis.
TEST(ViewCamera, TurnsTheSceneWithTheHand) {
  render::ViewCamera camera;
  camera.look(render::View::front);  // against x
  camera.turn(M_PI / 2, 0);
  // The axis that pointed at the viewer, x, now points to the right: right = direction x z.
  const Eigen::Vector3d direction = *seenBy(camera).view_direction;
  EXPECT_LT((direction.cross(Eigen::Vector3d::UnitZ()) - Eigen::Vector3d::UnitX()).norm(), kRounding);
}

TEST(ViewCamera, TippingEndsShortOfTheVertical) {
  render::ViewCamera camera;
  camera.look(render::View::top);
  for (int i = 0; i < 20; ++i) camera.turn(0.1, 0.5);
  const Eigen::Vector3d from_above = *seenBy(camera).view_direction;
  EXPECT_LT(from_above.z(), -0.99);
  EXPECT_GT(from_above.head<2>().norm(), 0.04);
  for (int i = 0; i < 20; ++i) camera.turn(0, -0.5);
  EXPECT_GT(seenBy(camera).view_direction->z(), 0.99);
  EXPECT_NEAR(seenBy(camera).view_direction->norm(), 1, kRounding);
}

// Straight down has y up; tipping back from there looks along y.
TEST(ViewCamera, FromTheTopTheHeadingIsThatOfY) {
  render::ViewCamera camera;
  camera.look(render::View::top);
  camera.turn(0, -M_PI / 2);
  EXPECT_GT(seenBy(camera).view_direction->y(), 0.99);
}

}  // namespace view_camera_test
}  // namespace stiffscope
