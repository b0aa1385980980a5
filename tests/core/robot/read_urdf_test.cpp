#include "core/robot/read_urdf.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>
#include <vector>
#include "core/io/input_error.h"
#include "core/robot/kinematics.h"

namespace stiffscope {
namespace read_urdf_test {

constexpr double kRounding = 1e-12;

// Six joints, the third turned by its rpy, a chain with an intermediate fixed joint, and all the clutter that
// exported URDFs have.
const char* const kRobot = R"(<?xml version="1.0"?>
<robot name="odd" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="unused" value="${pi}"/>
  <material name="grey"/>
  <link name="world"/>
  <link name="base"><visual><geometry><mesh filename="package://x.stl"/></geometry></visual></link>
  <link name="l1"><inertial><mass value="100"/><origin xyz="0.1 0 0" rpy="1 2 3"/></inertial></link>
  <link name="l2"><inertial><mass value="0"/></inertial></link>
  <link name="l3"/>
  <link name="motor"><inertial><origin xyz="0 0 0.5"/><mass value="20"/></inertial></link>
  <link name="forearm"><inertial><mass value="60"/></inertial></link>
  <link name="l4"/><link name="l5"/><link name="l6"/>
  <link name="tool0"/>
  <link name="finger"/><link name="wheel"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 -1"/></joint>
  <joint name="j1" type="continuous"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.5"/>
    <axis xyz="0 0 2"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.3 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="0" velocity="0"/></joint>
  <joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><limit lower="-1" upper="1"/></joint>
  <joint name="mount" type="fixed"><parent link="l3"/><child link="forearm"/><origin xyz="1 0 0"/></joint>
  <joint name="bolt" type="fixed"><parent link="l3"/><child link="motor"/><origin xyz="0 0 0"/></joint>
  <joint name="j4" type="revolute"><parent link="forearm"/><child link="l4"/><axis xyz="1 0 0"/>
    <limit lower="-3" upper="3"/></joint>
  <joint name="j5" type="revolute"><parent link="l4"/><child link="l5"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2"/></joint>
  <joint name="j6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.2 0 0"/>
    <axis xyz="1 0 0"/><limit/></joint>
  <joint name="face" type="fixed"><parent link="l6"/><child link="tool0"/></joint>
  <joint name="grip" type="prismatic"><parent link="tool0"/><child link="finger"/><axis xyz="${a} 0 0"/></joint>
  <joint name="belt" type="revolute"><parent link="l4"/><child link="wheel"/><mimic joint="j4"/></joint>
  <transmission name="t"><joint name="j1"/></transmission>
  <gazebo reference="l1"><plugin/></gazebo>
</robot>
)";

robot::Robot odd() { return robot::parseUrdf(kRobot, "odd.urdf", "base", "tool0"); }

const robot::LinkFrame& link(const robot::Robot& robot, const std::string& name) {
  for (const robot::LinkFrame& frame : robot.links) {
    if (frame.name == name) return frame;
  }
  throw std::out_of_range(name);
}

TEST(ReadUrdf, PlacesAxesInTheBaseAtZero) {
  const robot::Robot robot = odd();
  EXPECT_EQ(robot.name, "odd");
  EXPECT_EQ(robot.joint_names[3], "j4");
  const auto expectAxis = [&](std::size_t i, const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
    EXPECT_NEAR((robot.axes_in_base_at_zero[i].point - point).norm(), 0.0, kRounding) << i;
    EXPECT_NEAR((robot.axes_in_base_at_zero[i].direction - direction).norm(), 0.0, kRounding) << i;
  };
  expectAxis(0, {0, 0, 0.5}, {0, 0, 1});
  expectAxis(1, {0.3, 0, 0.5}, {0, 1, 0});
  expectAxis(2, {0.3, 0, 1.5}, {0, 1, 0});  // the default axis x, turned by 90 deg about z
  expectAxis(3, {0.3, 1, 1.5}, {0, 1, 0});
  expectAxis(4, {0.3, 1, 1.5}, {-1, 0, 0});
  expectAxis(5, {0.3, 1.2, 1.5}, {0, 1, 0});
  EXPECT_NEAR((robot.base_from_flange_at_zero.translation() - Eigen::Vector3d(0.3, 1.2, 1.5)).norm(), 0, kRounding);
}

TEST(ReadUrdf, ReadsLimits) {
  const robot::Robot robot = odd();
  EXPECT_EQ(robot.limits[0].lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(robot.limits[0].upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(robot.limits[1].lower, -1.0);
  EXPECT_EQ(robot.limits[1].upper, 2.0);
  EXPECT_EQ(robot.limits[5].upper, 0.0);
}

TEST(ReadUrdf, ListsTheLinksThatMoveWithTheChain) {
  const robot::Robot robot = odd();
  EXPECT_EQ(robot.links.size(), 11u);  // all but finger and wheel
  EXPECT_EQ(link(robot, "world").body, 0);
  EXPECT_NEAR(link(robot, "world").base_from_link_at_zero.translation().z(), 1.0, kRounding);
  EXPECT_EQ(link(robot, "motor").body, 3);
  EXPECT_EQ(link(robot, "forearm").body, 3);
  EXPECT_EQ(link(robot, "tool0").body, 6);
  EXPECT_THROW(link(robot, "finger"), std::out_of_range);
}

TEST(ReadUrdf, LumpsTheMassesThatAreFixedTogether) {
  const robot::Robot robot = odd();
  EXPECT_EQ(robot.bodies[1].mass_kg, 100.0);
  EXPECT_NEAR((robot.bodies[1].com_in_base_at_zero - Eigen::Vector3d(0.1, 0, 0.5)).norm(), 0, kRounding);
  EXPECT_EQ(robot.bodies[2].mass_kg, 0.0);
  // Forearm 60 kg at (0.3, 1, 1.5) and motor 20 kg at (0.3, 0, 2).
  EXPECT_EQ(robot.bodies[3].mass_kg, 80.0);
  EXPECT_NEAR((robot.bodies[3].com_in_base_at_zero - Eigen::Vector3d(0.3, 0.75, 1.625)).norm(), 0, kRounding);
}

/// The text with the joints of these names of another type.
std::string withTypes(std::string text, const std::vector<std::string>& joints, const std::string& type) {
  for (const std::string& joint : joints) {
    const std::string name = "name=\"" + joint + "\" type=\"";
    const std::size_t at = text.find(name) + name.size();
    text.replace(at, text.find('"', at) - at, type);
  }
  return text;
}

/// So many joints, one above the other, 0.1 m apart.
std::string stack(int joints) {
  std::string text = "<robot name=\"stack\"><link name=\"l0\"/>";
  for (int j = 1; j <= joints; ++j) {
    const std::string number = std::to_string(j), before = std::to_string(j - 1);
    text += "<link name=\"l" + number + "\"><inertial><mass value=\"" + number +
            "\"/></inertial></link><joint name=\"j" + number + "\" type=\"continuous\"><parent link=\"l" + before +
            "\"/><child link=\"l" + number + "\"/><origin xyz=\"0 0 0.1\"/><axis xyz=\"" +
            (j % 2 == 1 ? "0 0 1" : "0 1 0") + "\"/></joint>";
  }
  return text + "</robot>";
}

TEST(ReadUrdf, HasAsManyJointsAsTheChain) {
  const robot::Robot five = robot::parseUrdf(withTypes(kRobot, {"j2"}, "fixed"), "odd.urdf", "base", "tool0");
  EXPECT_EQ(five.joints(), 5);
  EXPECT_EQ(five.joint_names, (PerJoint<std::string>{"j1", "j3", "j4", "j5", "j6"}));
  EXPECT_EQ(five.limits.size(), 5u);
  EXPECT_EQ(five.limits[1].upper, 1.0);
  EXPECT_NEAR((five.axes_in_base_at_zero[1].point - Eigen::Vector3d(0.3, 0, 1.5)).norm(), 0, kRounding);
  ASSERT_EQ(five.bodies.size(), 6u);
  EXPECT_EQ(five.bodies[1].mass_kg, 100.0);  // l1 and l2 are one body
  EXPECT_EQ(five.bodies[2].mass_kg, 80.0);
  EXPECT_EQ(link(five, "motor").body, 2);
  EXPECT_EQ(link(five, "tool0").body, 5);

  const robot::Robot seven = robot::parseUrdf(withTypes(kRobot, {"face"}, "continuous"), "odd.urdf", "base", "tool0");
  EXPECT_EQ(seven.joints(), 7);
  EXPECT_EQ(seven.joint_names.back(), "face");
  EXPECT_EQ(seven.limits.back().upper, std::numeric_limits<double>::infinity());
  EXPECT_NEAR((seven.axes_in_base_at_zero.back().direction - Eigen::Vector3d(0, 1, 0)).norm(), 0, kRounding);
  EXPECT_EQ(seven.bodies.size(), 8u);
  EXPECT_EQ(link(seven, "l6").body, 6);
  EXPECT_EQ(link(seven, "tool0").body, 7);
}

TEST(ReadUrdf, TakesFourToEightJoints) {
  for (int joints = kFewestJoints; joints <= kMostJoints; ++joints) {
    const robot::Robot robot = robot::parseUrdf(stack(joints), "stack.urdf", "l0", "l" + std::to_string(joints));
    EXPECT_EQ(robot.joints(), joints);
    EXPECT_EQ(robot.bodies.back().mass_kg, joints);
    EXPECT_NEAR(robot.base_from_flange_at_zero.translation().z(), 0.1 * joints, kRounding);
  }
  const auto why = [](int joints) -> std::string {
    try {
      robot::parseUrdf(stack(joints), "stack.urdf", "l0", "l" + std::to_string(joints));
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why(3),
            "stack.urdf:1: joint: expected 4 to 8 revolute joints between 'l0' and 'l3'; there are 3: j1, j2, j3");
  EXPECT_EQ(why(9),
            "stack.urdf:1: joint: expected 4 to 8 revolute joints between 'l0' and 'l9'; there are 9: j1, j2, j3, j4, "
            "j5, j6, j7, j8, j9");
}

TEST(ReadUrdf, RefusesParallelFirstAxes) {
  std::string text = stack(5);
  text.replace(text.find("0 1 0"), 5, "0 0.01 1");  // half a degree off
  try {
    robot::parseUrdf(text, "stack.urdf", "l0", "l5");
    ADD_FAILURE() << "read on";
  } catch (const io::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'j2': expected an axis that is not parallel to that of joint 'j1'"),
              std::string::npos)
        << error.what();
  }
}

// A linear axis, turned in its own frame, between a fixed column and the arm.
TEST(ReadUrdf, APrismaticJointBeforeAllOthersIsARail) {
  std::string text = kRobot;
  const std::string before = "<joint name=\"j1\" type=\"continuous\"><parent link=\"base\"/>";
  text.replace(text.find(before), before.size(),
               "<link name=\"carriage\"/><joint name=\"track\" type=\"prismatic\"><parent link=\"base\"/>"
               "<child link=\"carriage\"/><origin xyz=\"0 0 0.2\" rpy=\"0 0 1.5707963267948966\"/>"
               "<axis xyz=\"2 0 0\"/><limit lower=\"-0.5\" upper=\"4\"/></joint>"
               "<joint name=\"j1\" type=\"continuous\"><parent link=\"carriage\"/>");
  const robot::Robot arm = robot::parseUrdf(text, "odd.urdf", "base", "tool0");
  EXPECT_EQ(arm.joints(), 6);
  ASSERT_TRUE(arm.rail);
  EXPECT_EQ(arm.rail->joint_name, "track");
  EXPECT_LT((arm.rail->direction_in_base - Eigen::Vector3d::UnitY()).norm(), kRounding);
  EXPECT_EQ(arm.rail->lower, -0.5);
  EXPECT_EQ(arm.rail->upper, 4.0);
  // The arm stands 0.2 m higher than without it, and is turned with it.
  EXPECT_NEAR(arm.axes_in_base_at_zero[0].point.z(), odd().axes_in_base_at_zero[0].point.z() + 0.2, kRounding);
  EXPECT_EQ(link(arm, "carriage").body, 0);
  EXPECT_FALSE(odd().rail);
}

struct RejectedUrdf {
  const char *find, *replace, *message;
};

const RejectedUrdf kRejected[] = {
    {"<robot name", "<sdf name", "odd.urdf"},
    {"name=\"j2\" type=\"revolute\"", "name=\"j2\" type=\"prismatic\"",
     "type: 'prismatic': expected revolute joints between 'base' and 'tool0'; joint 'j2' is not"},
    {"name=\"j2\" type=\"revolute\"", "name=\"j2\" type=\"floating\"", "type: 'floating': expected revolute joints"},
    {"name=\"j2\" type=\"revolute\"", "name=\"j2\" type=\"planar\"", "type: 'planar': expected revolute joints"},
    {"<axis xyz=\"0 0 2\"/>", "<mimic joint=\"belt\"/>",
     "joint: 'belt': expected a joint between base and flange that has an angle of its own: j2, j3, j4, j5, j6"},
    {"<axis xyz=\"0 0 2\"/>", "<mimic joint=\"j2\" multiplier=\"0\"/>",
     "multiplier: '0': expected a multiplier within +-1000 that is not 0"},
    {"<axis xyz=\"0 0 2\"/>", "<axis xyz=\"0 0 0\"/>", "xyz: '0 0 0': expected an axis that is not zero"},
    {"<axis xyz=\"0 0 2\"/>", "<axis xyz=\"0 ${s} 1\"/>", "xyz: '0 ${s} 1': expected a number; expand xacro first"},
    {"<origin xyz=\"0.3 0 0\"/>", "<origin xyz=\"${length} 0 0\"/>", "expand xacro first"},
    {"<origin xyz=\"0.3 0 0\"/>", "<origin xyz=\"300 0 0\"/>", "xyz: '300 0 0': expected metres, within +-200 m"},
    {"<origin xyz=\"0.3 0 0\"/>", "<origin xyz=\"0.3 0\"/>", "xyz: '0.3 0': expected three numbers; found 2"},
    {"<limit lower=\"-1\" upper=\"2\" effort=\"0\" velocity=\"0\"/>", "", "limit: expected this element in <joint>"},
    {"lower=\"-1\" upper=\"2\"", "lower=\"3\" upper=\"2\"",
     "lower: '3': expected at most the upper limit of joint 'j2', 2"},
    {"<mass value=\"100\"/>", "<mass value=\"-100\"/>", "value: '-100': expected a mass of 0 or more"},
    {"<mass value=\"100\"/>", "<mass value=\"heavy\"/>", "value: 'heavy': expected a number"},
    {"<mass value=\"100\"/>", "", "mass: expected this element in <inertial>"},
    {"<link name=\"l3\"/>", "", "'l3': expected a link of the robot"},
    {"<link name=\"l3\"/>", "<link name=\"l3\"/><link name=\"l2\"/>", "link: 'l2': expected a name of its own"},
    {"<link name=\"l3\"/>", "<link/>", "name: expected this attribute of <link>"},
    {"<link name=\"motor\">", "<link name=\"motr\">", "child: 'motor': expected a link of the robot (did you mean"},
    {"<child link=\"finger\"/>", "<child link=\"l2\"/>",
     "child: 'l2': expected a link with one parent; joints 'j2' and 'grip' both carry it"},
    {"<parent link=\"base\"/><child link=\"l1\"/>", "<parent link=\"l6\"/><child link=\"l1\"/>",
     "expected a chain without a loop; this joint is part of one"},
    {"<parent link=\"l1\"/><child link=\"l2\"/>", "<parent link=\"finger\"/><child link=\"l2\"/>", "without a loop"},
    {"<parent link=\"base\"/><child link=\"l1\"/>", "<parent link=\"pillar\"/><child link=\"l1\"/>",
     "parent: 'pillar': expected a link of the robot"},
    {"<parent link=\"l1\"/><child link=\"l2\"/>", "<child link=\"l2\"/>", "parent: expected this element in <joint>"},
    {"<joint name=\"j1\" type=\"continuous\"><parent link=\"base\"/>",
     "<joint name=\"j1\" type=\"continuous\"><parent link=\"wheel2\"/>", "expected a link of the robot"},
    {"<joint name=\"j3\"", "<joint name=\"j2\"", "joint: 'j2': expected a name of its own; another joint has it"},
    {"<link name=\"world\"/>", "<link name=\"world\"/><!--", "expected well-formed XML"},
};

TEST(ReadUrdf, RefusesWhatIsNoChainOfRevoluteJoints) {
  for (const RejectedUrdf& test : kRejected) {
    std::string text = kRobot;
    const std::size_t at = text.find(test.find);
    ASSERT_NE(at, std::string::npos) << test.find;
    text.replace(at, std::string(test.find).size(), test.replace);
    try {
      robot::parseUrdf(text, "odd.urdf", "base", "tool0");
      ADD_FAILURE() << "read on instead of: " << test.message;
    } catch (const io::InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(test.message), std::string::npos) << "expected: " << test.message << "\ngot: " << what;
      EXPECT_TRUE(what.starts_with("odd.urdf:") && what.find('\n') == std::string::npos) << what;
    }
  }
}

TEST(ReadUrdf, RefusesLinksThatAreNotOnOneChain) {
  const auto why = [](const char* base, const char* flange) -> std::string {
    try {
      robot::parseUrdf(kRobot, "odd.urdf", base, flange);
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      why("base", "tol0"),
      "odd.urdf:2: flange_link: 'tol0': expected a link of the robot (did you mean 'tool0'?); the name is that of "
      "attribute flange_link of `robot` in campaign.xml or the specification, or of an option");
  EXPECT_EQ(why("tool0", "base"),
            "odd.urdf:2: flange_link: 'base': expected a link beyond 'tool0'; the way back from it ends at "
            "'world'");
  EXPECT_EQ(why("base", "base"),
            "odd.urdf:2: joint: expected 4 to 8 revolute joints between 'base' and 'base'; there are 0");
  EXPECT_EQ(why("world", "tool0"), "");
}

TEST(RollPitchYaw, TurnsAboutFixedAxesInThatOrder) {
  const double quarter = std::numbers::pi / 2;
  // Roll takes y to z, then yaw leaves z: by hand from R = Rz Ry Rx.
  const Eigen::Matrix3d r = robot::rotationFromRpy({quarter, 0, quarter});
  EXPECT_NEAR((r * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 0, kRounding);
  EXPECT_NEAR((r * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0, kRounding);
  for (const Eigen::Vector3d& rpy :
       {Eigen::Vector3d(0.1, -0.2, 3), Eigen::Vector3d(3, quarter, -1), Eigen::Vector3d(1, -quarter, 2)}) {
    const Eigen::Matrix3d once = robot::rotationFromRpy(rpy);
    // At +-90 deg the cosine of the pitch keeps 1e-16, which the square root of rounding makes 1e-8 at worst.
    EXPECT_NEAR((robot::rotationFromRpy(robot::rpyFromRotation(once)) - once).norm(), 0, 1e-8);
  }
}

}  // namespace read_urdf_test
}  // namespace stiffscope
