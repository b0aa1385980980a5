#include "core/robot/body_inertia.h"

#include <gtest/gtest.h>

#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/robot/read_urdf.h"

namespace stiffscope {
namespace body_inertia_test {

const std::string kFile = STIFFSCOPE_SOURCE_DIR "/tests/data/plain_arm.urdf";

std::string plainArm() { return io::readTextFile(kFile, io::kLargestXml); }

std::string with(std::string text, const std::string& what, const std::string& instead) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("no " + what);
  return text.replace(at, what.size(), instead);
}

// A quarter turn about z of the inertial's own frame exchanges its x and y.
TEST(BodyInertia, StandsInAxesOfTheBase) {
  const std::string turned =
      with(plainArm(),
           R"(<inertial><mass value="50"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)",
           R"(<inertial><origin rpy="0 0 1.5707963267948966"/><mass value="50"/>)"
           R"(<inertia ixx="2" iyy="3" izz="4" ixy="0.5" ixz="0" iyz="0"/></inertial>)");
  const auto inertias = robot::bodyInertias(turned, kFile, "base_link", "tool0");
  Eigen::Matrix3d expected;
  expected << 3, -0.5, 0, -0.5, 2, 0, 0, 0, 4;
  EXPECT_LT((inertias[1] - expected).norm(), 1e-12) << inertias[1];
  EXPECT_TRUE(inertias[3].isZero(0.0));  // a link without a mass
}

// Two masses of 3 kg, 0.2 m apart along x of the base: 2 * 3 kg * (0.1 m)^2 about y and z besides their own.
TEST(BodyInertia, CarriesLinksToTheirCommonCentre) {
  std::string joined = with(plainArm(), "</robot>",
                            R"(<link name="box"><inertial><mass value="3"/></inertial></link>
    <joint name="f" type="fixed"><parent link="tool0"/><child link="box"/><origin xyz="-0.1 0 0"/></joint></robot>)");
  const robot::Robot arm = robot::parseUrdf(joined, kFile, "base_link", "tool0");
  ASSERT_DOUBLE_EQ(arm.bodies[6].mass_kg, 6.0);
  const auto inertias = robot::bodyInertias(joined, kFile, "base_link", "tool0");
  const Eigen::Vector3d along = arm.base_from_flange_at_zero.linear().col(0);
  EXPECT_NEAR(along.dot(inertias[6] * along), 1.0, 1e-12);
  const Eigen::Vector3d across = arm.base_from_flange_at_zero.linear().col(1);
  EXPECT_NEAR(across.dot(inertias[6] * across), 1.0 + 2 * 3.0 * 0.1 * 0.1, 1e-12);
}

TEST(BodyInertia, RefusesWhatIsNoNumber) {
  const std::string spoilt = with(plainArm(), "ixx=\"1\"", "ixx=\"${i}\"");
  try {
    robot::bodyInertias(spoilt, kFile, "base_link", "tool0");
    FAIL() << "an expression was read";
  } catch (const io::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ixx: '${i}'"), std::string::npos) << error.what();
  }
}

}  // namespace body_inertia_test
}  // namespace stiffscope
