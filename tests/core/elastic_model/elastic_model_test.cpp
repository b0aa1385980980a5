#include "core/elastic_model/elastic_model.h"

#include <gtest/gtest.h>

#include <set>

#include "core/effects/all.h"
#include "core/elastic_model/simulator_models.h"
#include "core/elastic_model/written.h"
#include "core/io/xml.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace elastic_model_test {

using elastic_model::ChainBody;
using elastic_model::ChainJoint;

/// An effect with sizes of one's own.
struct Sized {
  std::vector<effects::EffectModel> models;
  Eigen::VectorXd sizes;

  Sized(effects::Effect effect, std::size_t shape = 0) : models(effects::modelsOf(effects::recordOf(effect))) {
    models = {models[shape]};
    sizes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(models[0].parameters()));
  }
  effects::PresentEffect present() const { return {&models[0], sizes}; }
};

struct Arm : KnownArm {
  elastic_model::ElasticModel model(std::vector<effects::PresentEffect> effects = {}) const {
    elastic_model::ElasticSource source{campaign, geometry, estimate, Eigen::Vector3d::Zero()};
    source.effects = std::move(effects);
    source.inertias.assign(7, Eigen::Matrix3d(2.0 * Eigen::Matrix3d::Identity()));
    return elastic_model::elasticModel(source);
  }
};

const ChainBody* bodyNamed(const elastic_model::ElasticModel& model, const std::string& name) {
  for (const ChainBody& body : model.chain.bodies) {
    if (body.name == name) return &body;
  }
  return nullptr;
}

std::vector<ChainJoint> jointsOf(const elastic_model::ElasticModel& model, ChainJoint::Kind kind) {
  std::vector<ChainJoint> found;
  for (const ChainBody& body : model.chain.bodies) {
    for (const ChainJoint& joint : body.joints) {
      if (joint.kind == kind) found.push_back(joint);
    }
  }
  return found;
}

TEST(ElasticModel, EachJointIsADriveAndASpringOnItsAxis) {
  const Arm arm;
  const elastic_model::ElasticModel model = arm.model();
  const auto drives = jointsOf(model, ChainJoint::Kind::drive);
  const auto springs = jointsOf(model, ChainJoint::Kind::turn_spring);
  ASSERT_EQ(drives.size(), 6u);
  ASSERT_EQ(springs.size(), 6u);
  for (std::size_t j = 0; j < 6; ++j) {
    const metrology::Line& axis = arm.geometry.arm.axes_in_base_at_zero[j];
    EXPECT_EQ(drives[j].name, arm.campaign.robot.joint_names[j]);
    EXPECT_LT((drives[j].direction - axis.direction).norm(), 1e-15);
    EXPECT_LT((springs[j].direction - axis.direction).norm(), 1e-15);
    EXPECT_LT((springs[j].point - axis.point).norm(), 1e-15);
    EXPECT_DOUBLE_EQ(springs[j].stiffness * arm.estimate.compliance[static_cast<Eigen::Index>(j)], 1.0);
  }
  EXPECT_TRUE(jointsOf(model, ChainJoint::Kind::shift_spring).empty());
}

TEST(ElasticModel, AJointOfUnusableStiffnessIsRigidAndNamed) {
  Arm arm;
  arm.estimate.identifiable[0] = false;
  arm.estimate.compliance[3] = -2e-6;
  const elastic_model::ElasticModel model = arm.model();
  EXPECT_EQ(jointsOf(model, ChainJoint::Kind::drive).size(), 6u);
  EXPECT_EQ(jointsOf(model, ChainJoint::Kind::turn_spring).size(), 4u);
  ASSERT_EQ(model.remarks.size(), 2u);
  EXPECT_EQ(reports::words(model.remarks[0]), "joint 1 has no spring: the day does not tell k1");
  EXPECT_EQ(reports::words(model.remarks[1]),
            "joint 4 has no spring: k4 came out as -5e+05 Nm/rad, and no spring is negative");
}

TEST(ElasticModel, ABearingTiltsAboutTwoDirectionsAcrossTheAxis) {
  const Arm arm;
  Sized tilt(effects::Effect::bearing_tilt);
  tilt.sizes[2] = 4e-7;
  const elastic_model::ElasticModel model = arm.model({tilt.present()});
  const metrology::Line& axis = arm.geometry.arm.axes_in_base_at_zero[2];
  std::vector<ChainJoint> across;
  for (const ChainJoint& spring : jointsOf(model, ChainJoint::Kind::turn_spring)) {
    if (spring.name.find("tilt") != std::string::npos) across.push_back(spring);
  }
  ASSERT_EQ(across.size(), 2u);
  for (const ChainJoint& spring : across) {
    EXPECT_DOUBLE_EQ(spring.stiffness, 1.0 / 4e-7);
    EXPECT_NEAR(spring.direction.dot(axis.direction), 0.0, 1e-15);
    EXPECT_LT((spring.point - axis.point).norm(), 1e-15);
  }
  EXPECT_NEAR(across[0].direction.dot(across[1].direction), 0.0, 1e-15);
}

/// Turn and displacement at `tip` by a force and a moment there, of springs in series.
Vector6d moveOf(const ChainBody& body, const Eigen::Vector3d& tip, const Eigen::Vector3d& force,
                const Eigen::Vector3d& moment) {
  Vector6d move = Vector6d::Zero();
  for (const ChainJoint& spring : body.joints) {
    const Eigen::Vector3d& axis = spring.direction;
    if (spring.kind == ChainJoint::Kind::shift_spring) {
      move.tail<3>() += axis * axis.dot(force) / spring.stiffness;
      continue;
    }
    const Eigen::Vector3d lever = tip - spring.point;
    const double angle = axis.dot(moment + lever.cross(force)) / spring.stiffness;
    move.head<3>() += angle * axis;
    move.tail<3>() += angle * axis.cross(lever);
  }
  return move;
}

// A cantilever by the handbook: F L^3/3EI and F L^2/2EI, M L^2/2EI and M L/EI, T L/GJ.
TEST(ElasticModel, SpringsAtTheMiddleOfABeamAreTheCantilever) {
  const Arm arm;
  Sized beams(effects::Effect::link_compliance);
  const double bending = 3e-8, torsion = 5e-8;  // 1/(N m^2), of link 2
  beams.sizes[2] = bending, beams.sizes[3] = torsion;
  const elastic_model::ElasticModel model = arm.model({beams.present()});
  const Eigen::Vector3d from = arm.geometry.arm.axes_in_base_at_zero[1].point,
                        tip = arm.geometry.arm.axes_in_base_at_zero[2].point;
  const double length = (tip - from).norm();
  const Eigen::Vector3d along = (tip - from) / length, across = along.unitOrthogonal(), third = along.cross(across);
  const ChainBody* flexure = nullptr;
  for (const ChainBody& body : model.chain.bodies) {
    if (body.name.find("_flexure") != std::string::npos) flexure = &body;
  }
  ASSERT_NE(flexure, nullptr);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const double force = 1000.0, moment = 700.0;
  const Vector6d by_force = moveOf(*flexure, tip, force * across, none);
  EXPECT_NEAR(by_force.tail<3>().dot(across), force * std::pow(length, 3) / 3.0 * bending, 1e-15);
  EXPECT_NEAR(by_force.head<3>().dot(third), force * length * length / 2.0 * bending, 1e-15);
  const Vector6d by_moment = moveOf(*flexure, tip, none, moment * third);
  EXPECT_NEAR(by_moment.tail<3>().dot(across), moment * length * length / 2.0 * bending, 1e-15);
  EXPECT_NEAR(by_moment.head<3>().dot(third), moment * length * bending, 1e-15);
  const Vector6d by_torque = moveOf(*flexure, tip, none, moment * along);
  EXPECT_NEAR(by_torque.head<3>().dot(along), moment * length * torsion, 1e-15);
  EXPECT_LT(moveOf(*flexure, tip, force * along, none).norm(), 1e-15);
}

TEST(ElasticModel, ABaseRocksAboutItsOriginAndShifts) {
  const Arm arm;
  Sized base(effects::Effect::base_compliance);
  base.sizes << 2e-8, 0.0, 1e-8, 3e-8, 0.0;
  const elastic_model::ElasticModel model = arm.model({base.present()});
  const ChainBody& flexure = model.chain.bodies.front();
  ASSERT_EQ(flexure.joints.size(), 3u);
  for (const ChainJoint& spring : flexure.joints) {
    if (spring.kind != ChainJoint::Kind::turn_spring) continue;
    EXPECT_EQ(spring.direction, Eigen::Vector3d::UnitX());
    EXPECT_TRUE(spring.point.isZero(0.0));
    EXPECT_DOUBLE_EQ(spring.stiffness, 5e7);
  }
}

// By the load alone, what the flange weighs stays inside the plate; else it hangs on it.
TEST(ElasticModel, APlateCarriesWhatItsEquationSays) {
  const Arm arm;
  for (const std::size_t shape : {0u, 1u}) {
    Sized plate(effects::Effect::tool_compliance, shape);
    plate.sizes[1] = 1e-6, plate.sizes[3] = 1e-8;
    const elastic_model::ElasticModel model = arm.model({plate.present()});
    const ChainBody& beyond = model.chain.bodies.back();
    EXPECT_EQ(beyond.name, "tool_flexure");
    EXPECT_EQ(beyond.joints.size(), 2u);
    EXPECT_EQ(beyond.mass.mass_kg > 0.0, shape == 0u) << plate.models[0].shape;
    double all = 0.0, weighs = 0.0;
    for (const ChainBody& body : model.chain.bodies) all += body.mass.mass_kg;
    for (std::size_t b = 1; b < 7; ++b) weighs += arm.geometry.weight.bodies[b].mass_kg;
    EXPECT_DOUBLE_EQ(all, weighs);
    for (const elastic_model::ChainSite& site : model.chain.sites)
      EXPECT_EQ(site.body, site.name == "R0" ? -1 : static_cast<int>(model.chain.bodies.size()) - 1) << site.name;
  }
}

TEST(ElasticModel, EffectsThatAreNoSpringsAreNamed) {
  const Arm arm;
  elastic_model::ElasticSource source{arm.campaign, arm.geometry, arm.estimate};
  using enum effects::Effect;
  source.added = {bearing_tilt, joint_hardening, load_cell_bias, load_point_error, kinematic_error};
  std::set<std::string> said;
  for (const Remark& remark : elastic_model::elasticModel(source).remarks) said.insert(reports::words(remark));
  EXPECT_TRUE(said.contains("joint hardening is not in the file: no linear springs in series do that"));
  EXPECT_TRUE(
      said.contains("load cell bias is not in the file: a fault of the measurement, the machine does not do it"));
  EXPECT_TRUE(said.contains("load point error: load_point stands where the load acts as corrected"));
  for (const std::string& one : said) {
    EXPECT_EQ(one.find("bearing tilt"), std::string::npos);
    EXPECT_EQ(one.find("kinematic error"), std::string::npos);
  }
}

TEST(ElasticModel, WithoutMassesNothingWeighs) {
  Arm arm;
  arm.geometry.weight.links_known = false;
  const elastic_model::ElasticModel model = arm.model();
  for (const ChainBody& body : model.chain.bodies) EXPECT_EQ(body.mass.mass_kg, 0.0);
  ASSERT_EQ(model.remarks.size(), 1u);
  EXPECT_TRUE(model.remarks[0].is(elastic_model::RemarkId::no_masses));
}

TEST(ElasticModel, SaysThatABalancerIsNotInIt) {
  Arm arm;
  arm.geometry.weight.balancers.resize(2);
  const elastic_model::ElasticModel model = arm.model();
  ASSERT_EQ(model.remarks.size(), 1u);
  EXPECT_EQ(reports::words(model.remarks[0]),
            "no balancer is in the file (2 stated): the arm in it sags as it would without");
}

TEST(ElasticModel, AnInertiaThatNoBodyHasIsReplacedAndNamed) {
  const Arm arm;
  elastic_model::ElasticSource source{arm.campaign, arm.geometry, arm.estimate};
  source.inertias.assign(7, Eigen::Matrix3d(Eigen::Vector3d(1.0, 1.0, 2.5).asDiagonal()));
  const elastic_model::ElasticModel model = elastic_model::elasticModel(source);
  std::size_t named = 0;
  for (const Remark& remark : model.remarks) named += remark.is(elastic_model::RemarkId::no_inertia);
  EXPECT_EQ(named, 1u);
  for (const ChainBody& body : model.chain.bodies) {
    if (body.mass.mass_kg <= 0.0) continue;
    EXPECT_EQ(body.mass.inertia(2, 2), elastic_model::kStandInInertia) << body.name;
  }
}

// A thin plate is a body; that simulators compute its moments again shall not make it none.
TEST(ElasticModel, AThinPlateKeepsItsInertia) {
  const Arm arm;
  elastic_model::ElasticSource source{arm.campaign, arm.geometry, arm.estimate};
  source.inertias.assign(7, Eigen::Matrix3d(Eigen::Vector3d(1.0, 1.5, 2.5).asDiagonal()));
  const elastic_model::ElasticModel model = elastic_model::elasticModel(source);
  EXPECT_TRUE(model.remarks.empty());
  for (const ChainBody& body : model.chain.bodies) {
    if (body.mass.mass_kg <= 0.0) continue;
    const Eigen::Vector3d moments = body.mass.inertia.diagonal();
    EXPECT_NEAR(moments[2], 2.5, 1e-7) << body.name;
    EXPECT_GT(moments[0] + moments[1], moments[2] * (1.0 + 1e-10)) << body.name;
  }
}

// SDFormat keeps links, joints and frames in one list; URDF has a list each.
TEST(ElasticModel, NamesAreUnique) {
  Arm arm;
  arm.campaign.targets[0].id = arm.campaign.robot.joint_names[2];
  arm.campaign.targets[1].id = "tcp";
  arm.campaign.targets[2].id = "a::b";
  std::set<std::string> names;
  std::size_t count = 0;
  const elastic_model::ElasticModel model = arm.model();
  const auto add = [&](const std::string& name) {
    names.insert(name), ++count;
    EXPECT_EQ(name.find("::"), std::string::npos);
  };
  for (const ChainBody& body : model.chain.bodies) {
    add(body.name);
    for (const ChainJoint& joint : body.joints) add(joint.name);
  }
  for (const elastic_model::ChainSite& site : model.chain.sites) add(site.name);
  EXPECT_EQ(names.size(), count);
  EXPECT_TRUE(names.contains(arm.campaign.robot.joint_names[2]));
}

TEST(ElasticModel, CommentsStayComments) {
  const Arm arm;
  const elastic_model::ElasticModel model = arm.model();
  for (const char* comment : {"a -- b", "--> <x/>", "ends in -", "---"}) {
    for (const std::string& text :
         {elastic_model::mjcf(model.chain, {comment}), elastic_model::sdf(model.chain, {comment})}) {
      const std::size_t from = text.find("<!--") + 4, to = text.find("-->", from);
      EXPECT_EQ(text.substr(from, to - from).find("--"), std::string::npos) << comment;
      EXPECT_NO_THROW(io::XmlFile("file", text)) << comment;
    }
  }
}

}  // namespace elastic_model_test
}  // namespace stiffscope
