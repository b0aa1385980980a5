#include <gtest/gtest.h>
#include "core/diagnosis/geometry_error.h"
#include "core/diagnosis/linear_system.h"
#include "core/effects/all.h"
#include "core/effects/gravity_equilibrium.h"
#include "tests/fixtures/simulated_lab.h"

// The derivatives of absolute positions by the geometry's steps, against differences of positions computed afresh.

namespace stiffscope {
namespace position_by_geometry_test {

frames::LoadingGeometry placedArm(const ChainArm& chain) {
  frames::LoadingGeometry geometry;
  geometry.arm = chain.robot();
  geometry.compliance = chain.noAngles();
  geometry.r0_from_loading = Eigen::Isometry3d(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()));
  geometry.r0_from_loading->translation() = Eigen::Vector3d(0.5, -1.0, 0.3);
  const Eigen::Isometry3d& flange = geometry.arm.base_from_flange_at_zero;
  for (const Eigen::Vector3d& own : {Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(-0.2, 0.1, 0.3)})
    geometry.targets_at_zero.push_back(flange * own);
  return geometry;
}

/// Modelled less measured: `reading` is what the station saw.
Eigen::VectorXd modelledLessMeasured(const frames::LoadingGeometry& geometry, const JointVector& q,
                                     const std::vector<Eigen::Vector3d>& readings,
                                     const effects::LinearizationPoint& at) {
  const effects::ArmState state = effects::gravityEquilibrium(geometry, at, q);
  Eigen::VectorXd rows(3 * static_cast<Eigen::Index>(readings.size()));
  for (std::size_t t = 0; t < readings.size(); ++t) {
    rows.segment<3>(3 * static_cast<Eigen::Index>(t)) =
        state.posture.motion[6] * *geometry.targets_at_zero[t] - *geometry.r0_from_loading * readings[t];
  }
  return rows;
}

Eigen::MatrixXd byDifferences(const frames::LoadingGeometry& geometry, const JointVector& q,
                              const std::vector<Eigen::Vector3d>& readings, const Eigen::Vector3d& centre,
                              const effects::LinearizationPoint& at = effects::LinearizationPoint(6)) {
  constexpr double kStep = 1e-6;
  const Eigen::Index count = frames::ArmParameters(geometry.arm.joints()).count(readings.size());
  Eigen::MatrixXd columns(3 * static_cast<Eigen::Index>(readings.size()), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(count, k);
    columns.col(k) = (modelledLessMeasured(frames::moved(geometry, step, centre), q, readings, at) -
                      modelledLessMeasured(frames::moved(geometry, -step, centre), q, readings, at)) /
                     (2.0 * kStep);
  }
  return columns;
}

/// Readings are centimetres from the model, as those of an arm with a strong effect are.
const Eigen::Vector3d kOff{0.03, -0.02, 0.05};

struct Case {
  frames::LoadingGeometry geometry;
  JointVector q = JointVector::Zero(6);
  std::vector<Eigen::Vector3d> readings;
  Eigen::Vector3d centre{0.7, 0.2, 1.1};

  explicit Case(const frames::LoadingGeometry& placed) : geometry(placed) {
    q << 0.3, -0.5, 0.7, 1.1, -0.9, 0.4;
    const effects::ArmState state = effects::gravityEquilibrium(geometry, effects::LinearizationPoint(6), q);
    for (const auto& own : geometry.targets_at_zero)
      readings.push_back(geometry.r0_from_loading->inverse() * (state.posture.motion[6] * *own) + kOff);
  }

  Eigen::MatrixXd computed(const effects::LinearizationPoint& at = effects::LinearizationPoint(6)) const {
    effects::ArmState state = effects::gravityEquilibrium(geometry, at, q);
    for (std::size_t t = 0; t < readings.size(); ++t) {
      state.targets.push_back(static_cast<int>(t));
      state.points.push_back(*geometry.r0_from_loading * readings[t]);
    }
    return diagnosis::PositionByGeometry(geometry, at, centre).of(state);
  }
};

TEST(PositionByGeometry, OfARigidArmIsTheDifferences) {
  const Case one(placedArm(exampleChain()));
  const Eigen::MatrixXd expected = byDifferences(one.geometry, one.q, one.readings, one.centre);
  // Rounding of a metre over a step of 1e-6, and the step's own square.
  EXPECT_LT((one.computed() - expected).cwiseAbs().maxCoeff(), 2e-9) << one.computed() - expected;
}

/// A soft arm of heavy links, whose joints the own weight turns by some thousandths.
frames::LoadingGeometry heavyArm() {
  frames::LoadingGeometry geometry = placedArm(exampleChain());
  geometry.weight.links_known = true;
  geometry.weight.gravity_in_base = {0.5, -1.0, -9.7};
  geometry.weight.bodies.resize(7);
  for (std::size_t b = 1; b <= 6; ++b) {
    const double along = 0.15 * static_cast<double>(b);
    geometry.weight.bodies[b] = {60.0 - 8.0 * static_cast<double>(b), {along, 0.1, 1.5 - along}};
  }
  geometry.compliance << 2e-6, 3e-6, 3e-6, 5e-6, 5e-6, 5e-6;
  return geometry;
}

TEST(PositionByGeometry, OfASaggingArmIsTheDifferences) {
  frames::LoadingGeometry geometry = heavyArm();
  const Case one(geometry);
  ASSERT_GT((geometry.sagged(one.q) - one.q).cwiseAbs().maxCoeff(), 1e-3);
  const Eigen::MatrixXd expected = byDifferences(one.geometry, one.q, one.readings, one.centre);
  // The sag's fixed point stops at 1e-9 rad; a hundredth of what the sag does to the columns, see below.
  EXPECT_LT((one.computed() - expected).cwiseAbs().maxCoeff(), 1e-6) << one.computed() - expected;
  geometry.compliance.setZero();
  EXPECT_GT((Case(geometry).computed() - expected).cwiseAbs().maxCoeff(), 1e-4);
}

// Its torque changes with where the axes stand as the weight's does: by its lever, its length and its direction.
TEST(PositionByGeometry, OfAnArmOnBalancersIsTheDifferences) {
  frames::LoadingGeometry geometry = heavyArm();
  const auto sagOf = [](const Case& one) { return one.computed(); };
  const Eigen::MatrixXd without = sagOf(Case(geometry));
  const robot::GasLaw pulls{150e5, 1.7e-3, 6e-3, 0.8, 1.2, false};
  geometry.weight.balancers = {
      {pulls, {1, {-0.3, 0.05, 0.6}}, {2, {0.2, 0.1, 1.0}}, {}, {}},
      {robot::SpringLaw{2e3, 400.0, 2.2}, {4, {0.9, -0.1, 1.2}}, {0, {0.1, 0.2, 0.4}}, {}, {}}};
  const Case one(geometry);
  const Eigen::MatrixXd expected = byDifferences(one.geometry, one.q, one.readings, one.centre);
  // As of the sag without: the fixed point stops at 1e-9 rad, over a step of 1e-6, and is followed to the first order.
  EXPECT_LT((one.computed() - expected).cwiseAbs().maxCoeff(), 3e-6) << one.computed() - expected;
  EXPECT_GT((without - expected).cwiseAbs().maxCoeff(), 1e-3);
}

// Play of joint 5 passes from side to side where the own weight hardly turns it, so that a small change of its torque
// turns it by much.
TEST(PositionByGeometry, WithPlayInTheModelIsTheDifferences) {
  const frames::LoadingGeometry geometry = heavyArm();
  const Case one(geometry);
  const effects::EffectModel model = effects::modelsOf(effects::backlash()).front();
  effects::LinearizationPoint at(6);
  at.largest_torque.setConstant(2000.0);
  Eigen::VectorXd play = Eigen::VectorXd::Zero(7);
  play[4] = 2e-3;
  at.play = play.head<6>();
  at.present.push_back({&model, play});
  const Eigen::MatrixXd expected = byDifferences(one.geometry, one.q, one.readings, one.centre, at);
  const double by_play =
      (expected - byDifferences(one.geometry, one.q, one.readings, one.centre)).cwiseAbs().maxCoeff();
  ASSERT_GT(by_play, 5e-4);
  // The sag of gravityEquilibrium is that before the play turns the arm: a hundredth of what it changes.
  EXPECT_LT((one.computed(at) - expected).cwiseAbs().maxCoeff(), 0.02 * by_play);
}

// A foot that rocks by some thousandths under the own weight carries all axes with it.
TEST(PositionByGeometry, WithAFootThatRocksIsTheDifferences) {
  const frames::LoadingGeometry geometry = heavyArm();
  const Case one(geometry);
  const effects::EffectModel model = effects::modelsOf(effects::baseCompliance()).front();
  effects::LinearizationPoint at(6);
  at.present.push_back({&model, 1e-6 * Eigen::VectorXd::Unit(5, 1)});
  const Eigen::MatrixXd expected = byDifferences(one.geometry, one.q, one.readings, one.centre, at);
  ASSERT_GT((expected - one.computed()).cwiseAbs().maxCoeff(), 1e-3);
  // One round of the equilibrium: a hundredth of what the rocking changes.
  EXPECT_LT((one.computed(at) - expected).cwiseAbs().maxCoeff(), 1e-4);
}

// A reflector that was declared and never read stands nowhere, and is no point that the nominal arm misses.
TEST(GeometryError, IsThatOfTheReflectorsThatWereRead) {
  SimulatedLab lab;
  Noise noise(6);
  lab.actual = lab.nominal.disturbed(noise, 1e-3, 1e-3);
  const campaign::Campaign campaign = fullDay(lab, hangingForce);
  diagnosis::SystemState state(6);
  state.geometry.arm = lab.actual.robot();
  for (const Eigen::Vector3d& target : lab.targets_in_flange)
    state.geometry.targets_at_zero.push_back(state.geometry.arm.base_from_flange_at_zero * target);
  const auto errorWith = [&](const campaign::Campaign& day) {
    return diagnosis::geometryError({day, {}, 0.0, 0.0, {}, true, true, {}}, state);
  };
  const diagnosis::GeometryError error = errorWith(campaign);
  ASSERT_TRUE(error.tested);
  ASSERT_GT(error.rms, 50e-6);
  campaign::Campaign another = campaign;
  another.targets.push_back({"P13", {}});
  state.geometry.targets_at_zero.push_back(std::nullopt);
  EXPECT_NEAR(errorWith(another).rms, error.rms, 1e-9 * error.rms);
}

}  // namespace position_by_geometry_test
}  // namespace stiffscope
