#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include "core/effects/all.h"
#include "core/io/input_error.h"
#include "core/simulation/postures.h"
#include "core/validation/case.h"
#include "core/validation/effect_draw.h"

namespace stiffscope {

using Eigen::Vector3d;

namespace effect_size_test {

struct Lab {
  simulation::SimulationSpec spec;
  explicit Lab(std::uint64_t seed)
      : spec(validation::drawMachine(
                 seed, "case",
                 std::filesystem::temp_directory_path() / "stiffscope_blind_size" / std::to_string(seed) / "robot.urdf")
                 .spec) {}
};

validation::Sizing sizing(const validation::EffectSizer& sizer) {
  return {[&](const simulation::SimulationSpec& with) { return sizer.measure(with); }, sizer.background()};
}

TEST(BlindArms, standAsTheirDimensionsSay) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const simulation::SimulationSpec spec = Lab(seed).spec;
    const robot::Robot& robot = spec.nominal;
    // Spherical wrist: axes 4, 5 and 6 meet.
    const metrology::Line &four = robot.axes_in_base_at_zero[3], &five = robot.axes_in_base_at_zero[4];
    EXPECT_LT((five.point - four.point).cross(four.direction).norm(), 1e-12);
    EXPECT_NEAR(std::abs(five.direction.y()), 1.0, 1e-12);
    EXPECT_NEAR(robot.base_from_flange_at_zero.linear()(0, 2), 1.0, 1e-12);  // z forward
    EXPECT_EQ(simulation::loadingPostures(spec).size(), 24u);
    for (const auto& posture : spec.postures) {
      for (int i = 0; i < 6; ++i) {
        EXPECT_GE(posture.q[i], robot.limits[static_cast<std::size_t>(i)].lower);
        EXPECT_LE(posture.q[i], robot.limits[static_cast<std::size_t>(i)].upper);
      }
    }
  }
}

// What is only another stiffness is refitted away: nothing is left of it but finite turns.
TEST(BlindSize, anotherStiffnessIsNoEffect) {
  const Lab lab(3);
  const validation::EffectSizer sizer(lab.spec);
  simulation::SimulationSpec softer = lab.spec;
  for (const std::size_t joint : {1u, 4u}) *softer.machine.joints[joint].torsion *= 0.95;
  // 5 % of a deflection of some hundred noises; a thousandth of it is what the arm's finite give leaves.
  EXPECT_LT(sizer.measure(softer).deflection, 0.05);
  EXPECT_LT(sizer.background(), 0.6);
  EXPECT_NEAR(sizer.measure(lab.spec).deflection, 0.0, 1e-9);
  EXPECT_NEAR(sizer.measure(lab.spec).positions, 0.0, 1e-9);
}

// One of three reflectors shifts by 30 um in every loaded state, 3 of 4 later steps: before the projection
// that is 30 um / sqrt(3) a coordinate, times sqrt(1/3 * 3/4), over the noise of a displacement, sqrt(2/3) of
// a reading's 4 to 20 um. A fixed direction on a flange that turns is hardly a stiffness.
TEST(BlindSize, ofAReflectorThatMovesByHand) {
  const Lab lab(5);
  simulation::SimulationSpec moved = lab.spec;
  moved.targets[1].motion =
      simulation::TargetMotion{simulation::TargetMotion::Kind::slip, Vector3d(3e-5, 0, 0), 1.0, 0.0};
  const campaign::Tracker& tracker = lab.spec.tracker.declared;
  const double far = 6.0, near = 1.5;  // m, of the tool from the station, at most and at least
  const double across = std::sqrt(2.0 / 3) * (tracker.angle_fixed + tracker.angle_per_m * far);
  const double along = std::sqrt(2.0 / 3) * (tracker.range_fixed + tracker.range_per_m * near);
  const validation::EffectSize size = validation::EffectSizer(lab.spec).measure(moved);
  // Seated again at the next posture, but not at the return to zero: all four later steps.
  EXPECT_GT(size.deflection, 0.8 * 3e-5 / 3.0 / across);
  EXPECT_LT(size.deflection, 3e-5 / 3.0 / along);
  EXPECT_EQ(size.positions, 0.0);
}

TEST(BlindSize, growsInProportion) {
  const Lab lab(3);
  const validation::EffectSizer sizer(lab.spec);
  numerics::RandomStream random(1, "test");
  for (const effects::Effect effect :
       {effects::Effect::bearing_tilt, effects::Effect::load_cell_misalignment, effects::Effect::load_cell_bias,
        effects::Effect::kinematic_error, effects::Effect::frame_error, effects::Effect::tracker_drift}) {
    const validation::EffectDraw draw = validation::drawEffect(effect, lab.spec, random);
    const auto sized = [&](double strength) {
      simulation::SimulationSpec spec = lab.spec;
      draw.apply(strength, spec);
      return validation::sizeOf(sizer.measure(spec), draw.shows);
    };
    const double once = sized(0.002 * draw.most), twice = sized(0.004 * draw.most);
    EXPECT_GT(once, 0.0) << effects::idOf(effect);
    EXPECT_NEAR(twice / once, 2.0, 0.06) << effects::idOf(effect);  // of second order in a strength of 0.4 %
  }
}

TEST(BlindSize, theStrengthForASizeIsFound) {
  numerics::RandomStream random(2, "test");
  int reached = 0, effects = 0;
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    if (!effects::concerns(static_cast<effects::Effect>(e), false)) continue;  // these arms stand on no rail
    const Lab lab(10 + e % 3);
    const validation::EffectSizer sizer(lab.spec);
    const validation::EffectDraw draw = validation::drawEffect(static_cast<effects::Effect>(e), lab.spec, random);
    validation::EffectSize sizes;
    const double strength = validation::strengthFor(draw, lab.spec, sizing(sizer), 3.0, sizes);
    simulation::SimulationSpec spec = lab.spec;
    draw.apply(strength, spec);
    EXPECT_EQ(validation::sizeOf(sizer.measure(spec), draw.shows), validation::sizeOf(sizes, draw.shows))
        << effects::kEffectIds[e];
    EXPECT_LE(strength, draw.most);
    ++effects;
    reached += std::abs(std::log(validation::sizeOf(sizes, draw.shows) / 3.0)) < 0.1 ? 1 : 0;
  }
  EXPECT_GE(reached,
            effects - 2);  // a gap that no torque crosses, a reflector that cannot: those stay as they are
}

// Known and taken out, an effect of ten noises leaves the background: a shrink near one without noise, and
// with noise 1 - sqrt(1 / (1 + 100)) or so (plain rms is not the whitened one).
TEST(BlindSize, shrinkWithAndWithoutNoise) {
  const Lab lab(3);
  const validation::EffectSizer sizer(lab.spec);
  simulation::SimulationSpec tilted = lab.spec;
  numerics::RandomStream random(4, "test");
  const validation::EffectDraw draw = validation::drawEffect(effects::Effect::base_compliance, lab.spec, random);
  validation::EffectSize sizes;
  validation::strengthFor(draw, lab.spec, sizing(sizer), 10.0, sizes);
  EXPECT_GT(sizes.shrink, 0.9);
  EXPECT_NEAR(sizes.shrink_seen, 0.9, 0.06);
  EXPECT_LT(sizes.shrink_seen, sizes.shrink);
}

TEST(BlindEffects, everyKindOutsideTheVocabularyShows) {
  numerics::RandomStream random(5, "test");
  const Lab lab(12);
  const validation::EffectSizer sizer(lab.spec);
  for (const std::string& kind : validation::outsideKinds()) {
    validation::EffectSize sizes;
    const validation::EffectDraw draw = validation::drawOutside(kind, lab.spec, random);
    EXPECT_EQ(draw.effect, "");
    validation::strengthFor(draw, lab.spec, sizing(sizer), 2.0, sizes);
    EXPECT_NEAR(std::log(validation::sizeOf(sizes, draw.shows) / 2.0), 0.0, 0.1) << kind;
  }
  EXPECT_THROW(validation::drawOutside("gremlins", lab.spec, random), std::invalid_argument);
}

// Two effects, each of which the machine bears and which together bring it down, are drawn again; where they never
// stand together it is said.
TEST(BlindDouble, IsDrawnAgainWhereBothTogetherDoNotStand) {
  const auto draw = [](int refusals) {
    validation::DayKind days = validation::loadedDays();
    int both = 0;
    days.sizing = [&](const simulation::SimulationSpec&) -> validation::Sizing {
      return {[&](const simulation::SimulationSpec& with) {
                const bool together = with.machine.base_rotation && !with.load_cell->misalignment.isZero();
                if (together && both++ < refusals) throw io::InputError({"day", 0, ""}, "", "expected less");
                validation::EffectSize size;
                size.deflection = size.positions = size.nests = 3.0;
                return size;
              },
              0.0};
    };
    const validation::CasePlan plan{validation::CaseKind::pair, {"base_compliance", "load_cell_misalignment"}, "", 3.0};
    const auto folder = std::filesystem::temp_directory_path() / "stiffscope_blind_size" / "pair";
    const validation::BlindCase one = validation::drawCase(plan, 5, "case", folder / "robot.urdf", days);
    EXPECT_EQ(one.effects.size(), 2U);
    EXPECT_TRUE(one.spec.machine.base_rotation && !one.spec.load_cell->misalignment.isZero());
    return both;
  };
  EXPECT_EQ(draw(0), 1);
  EXPECT_EQ(draw(2), 3);
  EXPECT_THROW(draw(1000), io::InputError);
}

// Half of what an arm of this kind usually has: across its axis a joint 16 to 36 times as stiff as about it, links 8 to
// 20, the base 20 to 50 times joint 2, friction 0.5 to 1 % of the torque of the full load.
TEST(BlindAsIs, hasEveryEffectAtHalfItsUsualSize) {
  const validation::CasePlan plan{
      validation::CaseKind::as_is, {"bearing_tilt", "link_compliance", "base_compliance", "hysteresis"}, ""};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Lab clean(seed);
    const validation::BlindCase one = validation::drawCase(
        plan, seed, "case",
        std::filesystem::temp_directory_path() / "stiffscope_blind_size" / std::to_string(seed) / "robot.urdf");
    const auto within = [](double value, double low, double high) { return low <= value && value <= high; };
    const auto& machine = one.spec.machine;
    for (int i = 0; i < 6; ++i) {
      const simulation::JointStiffness& joint = machine.joints[static_cast<std::size_t>(i)];
      EXPECT_EQ(*joint.torsion, *clean.spec.machine.joints[static_cast<std::size_t>(i)].torsion);
      EXPECT_TRUE(within(*joint.bearing / *joint.torsion, 16.0, 36.0)) << *joint.bearing / *joint.torsion;
      const double share = joint.friction->torque / validation::usualTorque(one.spec, i);
      EXPECT_TRUE(within(share, 0.005, 0.01)) << share;
    }
    ASSERT_EQ(machine.links.size(), 2u);
    for (const simulation::LinkBeam& link : machine.links) {
      const auto& axes = one.spec.nominal.axes_in_base_at_zero;
      const auto at = static_cast<std::size_t>(link.joint);
      const double rate = *link.bending / (axes[at + 1].point - axes[at].point).norm();
      EXPECT_TRUE(within(rate / *machine.joints[std::min<std::size_t>(at, 2)].torsion, 8.0, 20.0)) << rate;
    }
    EXPECT_TRUE(within(machine.base_rotation->x() / *machine.joints[1].torsion, 20.0, 50.0));
    EXPECT_EQ(one.effects.size(), 4u);
    EXPECT_GT(one.together.deflection, 0.0);
  }
  EXPECT_THROW(
      {
        numerics::RandomStream random(1, "any");
        validation::drawAsIs(effects::Effect::backlash, Lab(1).spec, random);
      },
      std::invalid_argument);
}

}  // namespace effect_size_test

}  // namespace stiffscope
