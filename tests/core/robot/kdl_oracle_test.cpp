#include <gtest/gtest.h>

#ifndef STIFFSCOPE_TEST_KDL

TEST(RobotByKdl, IsNotBuilt) { GTEST_SKIP() << "urdfdom or KDL is not here"; }

#else

#include <urdf_parser/urdf_parser.h>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <random>

#include "core/robot/gravity_load.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"
#include "core/robot/read_urdf.h"

// URDFs as urdfdom reads them and KDL moves and weighs them (R. Smits, Orocos project), against our own reading,
// kinematics and statics.

namespace stiffscope {
namespace kdl_oracle_test {

namespace fs = std::filesystem;

KDL::Frame frameOf(const urdf::Pose& pose) {
  const auto& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

/// Mass and centre of a link alone; KDL wants a rotational inertia too, which statics does not use.
KDL::RigidBodyInertia inertiaOf(const urdf::Link& link) {
  if (!link.inertial) return KDL::RigidBodyInertia::Zero();
  return KDL::RigidBodyInertia(link.inertial->mass, frameOf(link.inertial->origin).p, KDL::RotationalInertia::Zero());
}

/// With all that is rigidly fixed to the link and is not the chain's next link.
KDL::RigidBodyInertia inertiaWithAttached(const urdf::Link& link, const urdf::Link* next) {
  KDL::RigidBodyInertia sum = inertiaOf(link);
  for (const auto& joint : link.child_joints) {
    if (joint->type != urdf::Joint::FIXED) continue;
    for (const auto& child : link.child_links) {
      if (child->parent_joint != joint || child.get() == next) continue;
      sum = sum + frameOf(joint->parent_to_joint_origin_transform) * inertiaWithAttached(*child, next);
    }
  }
  return sum;
}

KDL::Chain chainOf(const urdf::ModelInterface& model, const std::string& base, const std::string& flange) {
  std::vector<urdf::LinkConstSharedPtr> links;  // from the flange down
  for (auto link = model.getLink(flange); link && link->name != base; link = link->getParent()) links.push_back(link);
  KDL::Chain chain;
  for (std::size_t i = links.size(); i-- > 0;) {
    const urdf::Joint& joint = *links[i]->parent_joint;
    const KDL::Frame origin = frameOf(joint.parent_to_joint_origin_transform);
    const KDL::Vector axis(joint.axis.x, joint.axis.y, joint.axis.z);
    const KDL::Joint moves = joint.type == urdf::Joint::FIXED
                                 ? KDL::Joint(joint.name, KDL::Joint::None)
                                 : KDL::Joint(joint.name, origin.p, origin.M * axis, KDL::Joint::RotAxis);
    chain.addSegment(KDL::Segment(links[i]->name, moves, origin,
                                  inertiaWithAttached(*links[i], i > 0 ? links[i - 1].get() : nullptr)));
  }
  return chain;
}

Eigen::Vector3d vectorOf(const KDL::Vector& v) { return {v.x(), v.y(), v.z()}; }

KDL::JntArray jointsOf(const JointVector& q) {
  KDL::JntArray joints(static_cast<unsigned>(q.size()));
  joints.data = q;
  return joints;
}

/// Mass and centre of each moving body, joints at zero: segments up to the next joint that moves are one.
PerBody<robot::BodyMass> bodiesOf(const KDL::Chain& chain) {
  PerBody<robot::BodyMass> bodies(chain.getNrOfJoints() + 1);
  KDL::Frame at = KDL::Frame::Identity();
  std::size_t body = 0;
  for (unsigned i = 0; i < chain.getNrOfSegments(); ++i) {
    const KDL::Segment& segment = chain.getSegment(i);
    at = at * segment.pose(0.0);
    if (segment.getJoint().getType() != KDL::Joint::None) ++body;
    const double mass = segment.getInertia().getMass();
    if (mass == 0.0) continue;
    robot::BodyMass& sum = bodies[body];
    sum.com_in_base_at_zero =
        (sum.mass_kg * sum.com_in_base_at_zero + mass * vectorOf(at * segment.getInertia().getCOG())) /
        (sum.mass_kg + mass);
    sum.mass_kg += mass;
  }
  return bodies;
}

// Positions of a few metres, torques of some 1e4 Nm: rounding of a dozen products in double precision. URDFs write
// angles with some ten digits and urdfdom keeps them as quaternions, which costs no more.
constexpr double kMetres = 1e-11, kTorque = 1e-8;

void expectTheSame(const fs::path& file) {
  SCOPED_TRACE(file.string());
  const auto model = urdf::parseURDFFile(file.string());
  ASSERT_TRUE(model);
  const KDL::Chain chain = chainOf(*model, "base_link", "tool0");
  ASSERT_EQ(chain.getNrOfJoints(), 6u);
  const robot::Robot ours = robot::readUrdf(file, "base_link", "tool0");

  const auto bodies = bodiesOf(chain);
  robot::GravityLoad weight;
  weight.gravity_in_base = {0.3, -0.5, -9.79};
  weight.bodies = ours.bodies;
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    EXPECT_NEAR(ours.bodies[b].mass_kg, bodies[b].mass_kg, 1e-10) << b;
    EXPECT_LT((ours.bodies[b].com_in_base_at_zero - bodies[b].com_in_base_at_zero).norm(), kMetres) << b;
  }

  KDL::ChainFkSolverPos_recursive place(chain);
  KDL::ChainJntToJacSolver jacobian(chain);
  const Eigen::Vector3d& g = weight.gravity_in_base;
  KDL::ChainDynParam statics(chain, KDL::Vector(g.x(), g.y(), g.z()));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  constexpr int kPostures = 100;
  for (int k = 0; k < kPostures; ++k) {
    const JointVector q = JointVector::NullaryExpr(ours.joints(), [&] { return angle(random); });
    const KDL::JntArray joints = jointsOf(q);
    const robot::ArmPosture posture = robot::postureAt(ours, q);

    KDL::Frame flange;
    ASSERT_GE(place.JntToCart(joints, flange), 0);
    const Eigen::Isometry3d base_from_flange = robot::flangeAt(ours, posture);
    EXPECT_LT((base_from_flange.translation() - vectorOf(flange.p)).norm(), kMetres);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(base_from_flange.linear()(row, column), flange.M(row, column), kMetres);
    }

    KDL::Jacobian columns(6);
    ASSERT_GE(jacobian.JntToJac(joints, columns), 0);
    EXPECT_LT((robot::jacobianAt(ours, posture, base_from_flange.translation()) - columns.data).cwiseAbs().maxCoeff(),
              kMetres);

    // KDL states the torque that holds the arm, which is opposite to what its weight makes.
    KDL::JntArray holding(6);
    ASSERT_GE(statics.JntToGravity(joints, holding), 0);
    EXPECT_LT((robot::weightTorque(ours, posture, weight) + JointVector(holding.data)).cwiseAbs().maxCoeff(), kTorque);
  }
}

TEST(RobotByKdl, TheSample) { expectTheSame(STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf"); }
TEST(RobotByKdl, RotatedOriginsFixedJointsAndSideBranches) {
  expectTheSame(STIFFSCOPE_SOURCE_DIR "/tests/data/rotated_arm.urdf");
}
TEST(RobotByKdl, DefaultsOfUrdf) { expectTheSame(STIFFSCOPE_SOURCE_DIR "/tests/data/plain_arm.urdf"); }

// Joint angles that the inverse kinematics finds, put into KDL's forward kinematics of the URDF as urdfdom reads it.
TEST(RobotByKdl, InverseKinematicsHoldThePose) {
  int reached = 0;
  double worst = 0.0;
  for (const char* name : {"/samples/m900ib700.urdf", "/tests/data/rotated_arm.urdf", "/tests/data/plain_arm.urdf"}) {
    const std::string file = std::string(STIFFSCOPE_SOURCE_DIR) + name;
    const auto model = urdf::parseURDFFile(file);
    ASSERT_TRUE(model);
    const KDL::Chain chain = chainOf(*model, "base_link", "tool0");
    KDL::ChainFkSolverPos_recursive place(chain);
    const robot::Robot ours = robot::readUrdf(file, "base_link", "tool0");
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> angle(-2.5, 2.5), off(-0.25, 0.25);
    constexpr int kPoses = 1000;
    for (int k = 0; k < kPoses; ++k) {
      const JointVector q = JointVector::NullaryExpr(ours.joints(), [&] { return angle(random); });
      KDL::Frame wanted, held;
      ASSERT_GE(place.JntToCart(jointsOf(q), wanted), 0);
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = vectorOf(wanted.p);
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) pose.linear()(row, column) = wanted.M(row, column);
      }
      // From a quarter of a radian off in every joint.
      const JointVector start = q + JointVector::NullaryExpr(q.size(), [&] { return off(random); });
      const robot::InverseKinematics found = robot::inverseKinematics(ours, pose, Eigen::Isometry3d::Identity(), start);
      if (!found.reached) continue;
      ++reached;
      ASSERT_GE(place.JntToCart(jointsOf(found.q), held), 0);
      worst = std::max({worst, (vectorOf(held.p) - pose.translation()).norm(), KDL::diff(wanted.M, held.M).Norm()});
    }
  }
  std::printf("%d of 3000 poses reached, missed by %.1e m or rad at most\n", reached, worst);
  EXPECT_LT(worst, 1e-9);  // Newton's end at 1e-10 of six numbers, and the rounding of both kinematics
  // Near a singularity a start so far off may lead to a minimum that is none of the pose.
  EXPECT_GE(reached, 2850);
}

TEST(RobotByKdl, RealAndPracticeCampaigns) {
  std::size_t files = 0;
  for (const char* set : {"real", "practice"}) {
    const fs::path folder = fs::path(STIFFSCOPE_SHARED_DIR) / set;
    if (!fs::is_directory(folder)) continue;
    for (const auto& campaign : fs::directory_iterator(folder)) {
      if (!fs::exists(campaign.path() / "robot.urdf")) continue;
      expectTheSame(campaign.path() / "robot.urdf");
      ++files;
    }
  }
  if (files == 0) GTEST_SKIP() << "the real and practice campaigns are not here";
}

}  // namespace kdl_oracle_test
}  // namespace stiffscope

#endif
