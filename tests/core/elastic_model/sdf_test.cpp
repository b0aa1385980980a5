#include "core/elastic_model/simulator_models.h"

#include <gtest/gtest.h>

#ifndef STIFFSCOPE_TEST_SDFORMAT
TEST(Sdf, IsNotReadByLibsdformat) { GTEST_SKIP() << "libsdformat is not here"; }
#else

#include <map>
#include <sdf/sdf.hh>

#include "core/effects/all.h"
#include "core/elastic_model/elastic_model.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace sdf_test {

constexpr double kRounding = 1e-12;

Eigen::Vector3d eigen(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

/// The chain with all four effects that springs are.
elastic_model::ElasticModel fullModel(const KnownArm& arm) {
  using enum effects::Effect;
  using Models = std::vector<effects::EffectModel>;
  std::vector<Models> models;
  for (const effects::Effect effect : {bearing_tilt, link_compliance, base_compliance, tool_compliance})
    models.push_back(effects::modelsOf(effects::recordOf(effect)));
  elastic_model::ElasticSource source{arm.campaign, arm.geometry, arm.estimate};
  for (const Models& of_effect : models) {
    const auto count = static_cast<Eigen::Index>(of_effect[0].parameters());
    source.effects.push_back({&of_effect[0], Eigen::VectorXd::LinSpaced(count, 1e-8, 5e-8)});
  }
  source.inertias.resize(7);
  for (Eigen::Matrix3d& inertia : source.inertias) inertia << 3, 0.1, 0.2, 0.1, 2.5, -0.3, 0.2, -0.3, 2;
  return elastic_model::elasticModel(source);
}

struct Read {
  sdf::Root root;
  const sdf::World* world = nullptr;
  const sdf::Model* model = nullptr;

  explicit Read(const std::string& text) {
    for (const sdf::Error& error : root.LoadSdfString(text)) ADD_FAILURE() << error.Message();
    world = root.WorldByIndex(0);
    if (world) model = world->ModelByIndex(0);
  }
  ignition::math::Pose3d pose(const sdf::SemanticPose& semantic) const {
    ignition::math::Pose3d found;
    for (const sdf::Error& error : semantic.Resolve(found, "__model__")) ADD_FAILURE() << error.Message();
    return found;
  }
};

TEST(Sdf, LibsdformatFindsEveryJointWhereTheChainHasIt) {
  const KnownArm arm;
  const elastic_model::ElasticModel written = fullModel(arm);
  const Read read(elastic_model::sdf(written.chain, {"a -- comment"}));
  ASSERT_NE(read.model, nullptr);
  EXPECT_LT((eigen(read.world->Gravity()) - written.chain.gravity).norm(), kRounding);
  std::uint64_t joints = 1;  // the base's
  std::string parent = written.chain.base;
  using Kind = elastic_model::ChainJoint::Kind;
  for (const elastic_model::ChainBody& body : written.chain.bodies) {
    for (const elastic_model::ChainJoint& joint : body.joints) {
      SCOPED_TRACE(joint.name);
      ++joints;
      const sdf::Joint* found = read.model->JointByName(joint.name);
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(found->Type(), joint.kind == Kind::shift_spring ? sdf::JointType::PRISMATIC : sdf::JointType::REVOLUTE);
      EXPECT_EQ(found->ParentLinkName(), parent);
      parent = found->ChildLinkName();
      ignition::math::Vector3d axis;
      EXPECT_TRUE(found->Axis()->ResolveXyz(axis, "__model__").empty());
      EXPECT_LT((eigen(axis) - joint.direction).norm(), kRounding);
      if (joint.kind != Kind::shift_spring) {
        EXPECT_LT((eigen(read.pose(found->SemanticPose()).Pos()) - joint.point).norm(), kRounding);
      }
      EXPECT_EQ(found->Axis()->SpringStiffness(), joint.stiffness);
      EXPECT_EQ(found->Axis()->SpringReference(), 0.0);
      if (joint.kind == Kind::drive) {
        EXPECT_EQ(found->Axis()->Lower(), joint.lower);
        EXPECT_EQ(found->Axis()->Upper(), joint.upper);
      }
    }
    EXPECT_EQ(parent, body.name);
  }
  EXPECT_EQ(read.model->JointCount(), joints);
}

TEST(Sdf, LibsdformatFindsMassesAndFrames) {
  const KnownArm arm;
  const elastic_model::ElasticModel written = fullModel(arm);
  const Read read(elastic_model::sdf(written.chain, {}));
  ASSERT_NE(read.model, nullptr);
  for (const elastic_model::ChainBody& body : written.chain.bodies) {
    SCOPED_TRACE(body.name);
    const sdf::Link* link = read.model->LinkByName(body.name);
    ASSERT_NE(link, nullptr);
    const ignition::math::Inertiald& inertial = link->Inertial();
    if (body.mass.mass_kg <= 0.0) {
      EXPECT_FALSE(link->Element()->Get<bool>("gravity"));
      EXPECT_EQ(inertial.MassMatrix().Mass(), elastic_model::kStandInMass);
      continue;
    }
    EXPECT_TRUE(link->Element()->Get<bool>("gravity"));
    EXPECT_EQ(inertial.MassMatrix().Mass(), body.mass.mass_kg);
    const ignition::math::Pose3d centre = read.pose(link->SemanticPose()) * inertial.Pose();
    EXPECT_LT((eigen(centre.Pos()) - body.mass.centre).norm(), kRounding);
    const ignition::math::Matrix3d moments = inertial.Moi();
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(moments(i, k), body.mass.inertia(i, k), kRounding);
    }
  }
  for (const elastic_model::ChainSite& site : written.chain.sites) {
    const sdf::Frame* frame = read.model->FrameByName(site.name);
    ASSERT_NE(frame, nullptr) << site.name;
    const ignition::math::Pose3d pose = read.pose(frame->SemanticPose());
    EXPECT_LT((eigen(pose.Pos()) - site.base_from_site.translation()).norm(), kRounding);
    const Eigen::Quaterniond turn(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z());
    EXPECT_LT((turn.toRotationMatrix() - site.base_from_site.linear()).norm(), kRounding);
  }
}

}  // namespace sdf_test
}  // namespace stiffscope
#endif
