#include "core/toolpath/tool_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/io/input_error.h"
#include "core/toolpath/remarks.h"
#include "tests/app/command.h"

namespace stiffscope {
namespace tool_path_test {

namespace fs = std::filesystem;
using Eigen::Vector3d;

toolpath::ToolPath read(const std::string& text) {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "path.csv";
  std::ofstream(file) << text;
  std::vector<std::string> warnings;
  return toolpath::readToolPath(file, warnings);
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "";
}

const std::string kPoint = "pose,x_mm,y_mm,z_mm";

TEST(ToolPath, WithoutADirectionTheToolPointsDown) {
  const toolpath::ToolPath path = read(kPoint + "\na,1,2,3\nb,4,5,6\n");
  ASSERT_EQ(path.poses.size(), 2u);
  EXPECT_TRUE(path.turn_free);
  EXPECT_FALSE(path.has_wrenches);
  EXPECT_EQ(path.poses[1].id, "b");
  EXPECT_TRUE(path.poses[1].workpiece_from_tool.translation().isApprox(Vector3d(4e-3, 5e-3, 6e-3), 1e-12));
  EXPECT_TRUE(path.poses[1].workpiece_from_tool.linear().col(2).isApprox(Vector3d(0, 0, -1), 1e-12));
}

// CAM's axis leads from the tip to the spindle, the tool's z the other way.
TEST(ToolPath, AxesOfCamAndQuaternionsAreTheSameTool) {
  const toolpath::ToolPath axes = read(kPoint + ",i,j,k\na,0,0,0,0.6,0,0.8\nb,1,0,0,0,0.6,0.8\n");
  EXPECT_TRUE(axes.turn_free);
  EXPECT_TRUE(axes.poses[0].workpiece_from_tool.linear().col(2).isApprox(Vector3d(-0.6, 0, -0.8), 1e-12));
  // A turn of pi about y.
  const toolpath::ToolPath turned = read(kPoint + ",qw,qx,qy,qz\na,0,0,0,0,0,1,0\n");
  EXPECT_FALSE(turned.turn_free);
  EXPECT_TRUE(turned.poses[0].workpiece_from_tool.linear().isApprox(
      Eigen::DiagonalMatrix<double, 3>(-1, 1, -1).toDenseMatrix(), 1e-12));
  // From one pose to the next no turn about the axis itself.
  const Eigen::Matrix3d step =
      axes.poses[1].workpiece_from_tool.linear() * axes.poses[0].workpiece_from_tool.linear().transpose();
  const Eigen::AngleAxisd turn(step);
  EXPECT_NEAR(turn.axis().dot(axes.poses[0].workpiece_from_tool.linear().col(2)), 0.0, 1e-9);
}

TEST(ToolPath, RefusesWhatIsNoPath) {
  EXPECT_NE(refusal(kPoint + ",i,j,k\na,0,0,0,0,0,0.9\n").find(":2: i, j, k: '0.9': expected a length of one"),
            std::string::npos)
      << refusal(kPoint + ",i,j,k\na,0,0,0,0,0,0.9\n");
  EXPECT_NE(refusal(kPoint + ",i,j\na,0,0,0,0,1\n").find(": k: expected this column"), std::string::npos)
      << refusal(kPoint + ",i,j\na,0,0,0,0,1\n");
  EXPECT_NE(refusal(kPoint + ",i,j,k,qw,qx,qy,qz\na,0,0,0,0,0,1,1,0,0,0\n").find("not both"), std::string::npos);
  EXPECT_NE(refusal(kPoint + ",i,j,k\na,0,0,0,0,0,25.4\n").find("within +-1"), std::string::npos);
  EXPECT_NE(refusal(kPoint + "\na,0,0,0\na,1,0,0\n").find("does not repeat"), std::string::npos);
  EXPECT_NE(refusal(kPoint + ",load_share\na,0,0,0,-0.5\n").find("0 to 1"), std::string::npos);
  EXPECT_NE(refusal(kPoint + "\n").find("expected"), std::string::npos);
}

/// Along x, then along y, at the height of zero; the tool's axis up.
const std::string kCorner = kPoint + ",load_share\na,0,0,0,1\nb,10,0,0,1\nc,20,0,0,0.5\nd,20,10,0,0\ne,20,20,0,1\n";

TEST(ToolWrenches, FollowTheFeed) {
  const toolpath::ToolPath path = read(kCorner);
  toolpath::ProcessLoad load;
  load.axes = toolpath::WrenchAxes::feed;
  load.constant << 10, 20, -30, 1, 2, 3;
  const auto wrenches = toolpath::toolWrenches(path, Eigen::Isometry3d::Identity(), load);
  EXPECT_TRUE(wrenches[0].force.isApprox(Vector3d(10, 20, -30), 1e-9));
  EXPECT_TRUE(wrenches[0].moment.isApprox(Vector3d(1, 2, 3), 1e-9));
  // At the corner the feed is half way between, and half of the load acts.
  const double half = std::sqrt(0.5);
  EXPECT_TRUE(wrenches[2].force.isApprox(0.5 * Vector3d(half * (10 - 20), half * (10 + 20), -30), 1e-9));
  EXPECT_TRUE(wrenches[3].force.isZero());
  EXPECT_TRUE(wrenches[4].force.isApprox(Vector3d(-20, 10, -30), 1e-9));
}

TEST(ToolWrenches, AxesOfToolAndBase) {
  const toolpath::ToolPath path = read(kCorner);
  Eigen::Isometry3d base_from_workpiece = Eigen::Isometry3d::Identity();
  base_from_workpiece.linear() = Eigen::AngleAxisd(0.5 * EIGEN_PI, Vector3d::UnitZ()).toRotationMatrix();
  toolpath::ProcessLoad load;
  load.constant << 10, 0, -30, 0, 0, 0;
  load.axes = toolpath::WrenchAxes::base_link;
  EXPECT_TRUE(toolpath::toolWrenches(path, base_from_workpiece, load)[0].force.isApprox(Vector3d(0, -10, -30), 1e-9));
  load.axes = toolpath::WrenchAxes::tool;  // whose z leads down
  EXPECT_NEAR(toolpath::toolWrenches(path, base_from_workpiece, load)[0].force.z(), 30.0, 1e-9);
}

TEST(ToolWrenches, CuttingActsAtHalfTheDepth) {
  const toolpath::ToolPath path = read(kCorner);
  toolpath::ProcessLoad load;
  load.cutting = toolpath::Cutting{0.4e-3, 3e-3, 12e-3, 20e-3, 800e6, 0.3, 0.1, false};
  const auto wrenches = toolpath::toolWrenches(path, Eigen::Isometry3d::Identity(), load);
  const toolpath::CuttingForce cut = toolpath::meanCuttingForce(*load.cutting);
  EXPECT_TRUE(wrenches[0].force.isApprox(cut.force, 1e-9));
  EXPECT_TRUE(wrenches[0].point_in_tool.isApprox(Vector3d(0, 0, -1.5e-3), 1e-12));
  EXPECT_NEAR(wrenches[0].moment.z(), cut.torque, 1e-12);
  // Plunging has no direction of feed.
  const toolpath::ToolPath down = read(kPoint + "\na,0,0,10\nb,0,0,5\n");
  EXPECT_TRUE(toolpath::toolWrenches(down, Eigen::Isometry3d::Identity(), load)[0].reason.is(
      toolpath::RemarkId::no_feed_direction));
  // Nor has it after a way to the side; the poses beside it still move that way.
  const toolpath::ToolPath pocket = read(kPoint + "\na,0,0,10\nb,10,0,10\nc,10,0,5\nd,10,0,0\ne,20,0,0\n");
  const auto in_pocket = toolpath::toolWrenches(pocket, Eigen::Isometry3d::Identity(), load);
  EXPECT_TRUE(in_pocket[1].force.isApprox(cut.force, 1e-9));
  EXPECT_TRUE(in_pocket[2].reason.is(toolpath::RemarkId::no_feed_direction));
  EXPECT_TRUE(in_pocket[3].force.isApprox(cut.force, 1e-9));
}

}  // namespace tool_path_test
}  // namespace stiffscope
