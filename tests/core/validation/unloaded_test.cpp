#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include "core/io/read_file.h"
#include "core/numerics/random.h"
#include "core/simulation/measure.h"
#include "core/validation/case.h"
#include "core/validation/effect_size.h"
#include "core/validation/run_blind.h"

namespace stiffscope {

namespace fs = std::filesystem;
using Eigen::Vector3d;

namespace unloaded_test {

struct UnloadedLab {
  simulation::SimulationSpec spec;
  explicit UnloadedLab(std::uint64_t seed)
      : spec(validation::drawUnloadedMachine(
                 seed, "case",
                 fs::temp_directory_path() / "stiffscope_blind_unloaded" / std::to_string(seed) / "robot.urdf")
                 .spec) {}
};

TEST(BlindUnloadedMachines, areRigidAndSpreadOverTheWorkspace) {
  int with_nests = 0, alone = 0, with_temperature = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const simulation::SimulationSpec spec = UnloadedLab(seed).spec;
    EXPECT_FALSE(spec.loading || spec.load_cell || spec.wrist_sweep || !spec.circle_sweeps.empty());
    EXPECT_EQ(spec.machine.tool.mass_kg, 0.0);
    EXPECT_GE(spec.postures.size(), 60u);
    EXPECT_LE(spec.postures.size(), 200u);
    for (const auto& joint : spec.machine.joints) EXPECT_FALSE(joint.torsion || joint.bearing);
    EXPECT_GE(spec.machine.geometry.position_sigma, 1.2e-4);
    with_nests += spec.nests.empty() ? 0 : 1;
    alone += spec.targets.size() == 1 ? 1 : 0;
    with_temperature += spec.temperature ? 1 : 0;
    JointVector low = spec.postures.front().q, high = low;
    for (const auto& posture : spec.postures) {
      low = low.cwiseMin(posture.q);
      high = high.cwiseMax(posture.q);
    }
    EXPECT_GT((high - low).minCoeff(), 1.2);  // rad
  }
  EXPECT_NEAR(with_nests, 32, 8);
  EXPECT_NEAR(alone, 6, 6);
  EXPECT_NEAR(with_temperature, 20, 10);
}

// Another axis, another zero, another place of a reflector: a calibration takes them in, to second order.
TEST(BlindUnloadedSize, geometryIsNoEffect) {
  const UnloadedLab lab(3);
  const validation::GeometrySizer sizer(lab.spec);
  EXPECT_LT(sizer.background(), 1e-6);
  EXPECT_EQ(sizer.measure(lab.spec).positions, 0.0);
  simulation::SimulationSpec other = lab.spec;
  PerJoint<simulation::AxisError> errors = simulation::drawAxisErrors(lab.spec);
  errors[1].zero += 1e-5;
  errors[2].offset += Vector3d(2e-5, 1e-5, 3e-5);
  errors[4].tilt += Vector3d(1e-5, 2e-5, 0);
  for (std::size_t i = 0; i < 6; ++i) other.machine.geometry.listed[i] = errors[i];
  other.targets[0].position_in_flange += Vector3d(1e-4, 0, -1e-4);
  const validation::EffectSize size = sizer.measure(other);
  EXPECT_LT(size.positions, 1e-3);
  EXPECT_GT(size.geometry, 0.02);
}

// One of three reflectors sits s elsewhere in the second half of the day. Its place takes the mean, which leaves s/2 in
// every posture with either sign: rms s/2 / sqrt(3) a coordinate of that reflector, s/6 of all. Robot and axes take a
// little of it: no more than their 30 numbers of the day's hundreds.
TEST(BlindUnloadedSize, ofAReflectorThatSitsElsewhereByHand) {
  const UnloadedLab lab(5);
  ASSERT_EQ(lab.spec.targets.size(), 3u);
  simulation::SimulationSpec moved = lab.spec;
  simulation::TargetMotion motion;
  motion.kind = simulation::TargetMotion::Kind::reseated;
  motion.shift = Vector3d(0, 1e-4, 0);
  // Readings of the middle posture: nests come between, so the time is taken from the day itself.
  const campaign::Campaign day = simulation::measureWithoutNoise(simulation::buildMachine(lab.spec), lab.spec);
  motion.from_s = day.states->rows[day.states->rows.size() / 2].time_s;
  moved.targets[1].motion = motion;
  double variance = 0.0;
  const campaign::Tracker& tracker = lab.spec.tracker.declared;
  for (const campaign::LoadingReading& one : day.loading->rows) {
    const double d = one.point.norm();
    variance += (std::pow(tracker.range_fixed + tracker.range_per_m * d, 2) +
                 2.0 * std::pow(tracker.angle_fixed + tracker.angle_per_m * d, 2)) /
                3.0 / lab.spec.unloaded_repeats;
  }
  const double noise = std::sqrt(variance / static_cast<double>(day.loading->rows.size()));
  const double by_hand = 1e-4 / 6.0 / noise;
  const double size = validation::GeometrySizer(lab.spec).measure(moved).positions;
  const double numbers = 9.0 * static_cast<double>(lab.spec.postures.size());
  // Noises differ with the distance by a half: the whitened fit is not the least of the plain rms.
  EXPECT_LT(size, 1.02 * by_hand);
  EXPECT_GT(size, by_hand * std::sqrt(1.0 - 39.0 / numbers) * 0.97);
}

TEST(BlindUnloadedSize, theStrengthForASizeIsFound) {
  numerics::RandomStream random(2, "test");
  const validation::DayKind& days = validation::unloadedDays();
  const auto reaches = [&](const validation::EffectDraw& draw, const UnloadedLab& lab,
                           const validation::Sizing& sizing) {
    validation::EffectSize sizes;
    const double strength = validation::strengthFor(draw, lab.spec, sizing, 3.0, sizes);
    simulation::SimulationSpec spec = lab.spec;
    draw.apply(strength, spec);
    EXPECT_EQ(validation::sizeOf(sizing.measure(spec), draw.shows), validation::sizeOf(sizes, draw.shows));
    return strength <= draw.most && std::abs(std::log(validation::sizeOf(sizes, draw.shows) / 3.0)) < 0.1;
  };
  int missed = 0;
  for (const std::uint64_t seed : {11, 12}) {
    const UnloadedLab lab(seed);
    const validation::Sizing sizing = days.sizing(lab.spec);
    for (const std::string& id : days.vocabulary.effects) {
      const validation::EffectDraw draw = days.effect(id, lab.spec, random);
      EXPECT_EQ(draw.effect, id);
      const bool reached = reaches(draw, lab, sizing);
      missed += reached ? 0 : 1;
      if (!reached) std::printf("%s (%s) does not reach 3 noises\n", id.c_str(), draw.detail.c_str());
    }
    for (const std::string& kind : days.vocabulary.outside) {
      const validation::EffectDraw draw = days.outside(kind, lab.spec, random);
      EXPECT_EQ(draw.effect, "");
      EXPECT_EQ(draw.detail, kind);
      missed += reaches(draw, lab, sizing) ? 0 : 1;
    }
  }
  EXPECT_LE(missed, 3);  // torques that never cross their friction; a ratio of joint 1, which is nearly a turned base
  EXPECT_THROW(days.effect("gremlins", UnloadedLab(1).spec, random), std::invalid_argument);
  EXPECT_THROW(days.outside("gremlins", UnloadedLab(1).spec, random), std::invalid_argument);
}

// Known and taken out, nothing of the effect is left; with noise 1 - sqrt(1 / (1 + 25)) or so: plain rms is not the
// whitened one, and both have the fit's own scatter.
TEST(BlindUnloadedSize, shrinkWithAndWithoutNoise) {
  const UnloadedLab lab(7);
  numerics::RandomStream random(4, "test");
  const validation::DayKind& days = validation::unloadedDays();
  const validation::EffectDraw draw = days.effect("transmission_error", lab.spec, random);
  validation::EffectSize sizes;
  validation::strengthFor(draw, lab.spec, days.sizing(lab.spec), 5.0, sizes);
  EXPECT_NEAR(sizes.shrink, 1.0, 1e-3);
  EXPECT_NEAR(sizes.shrink_seen, 0.8, 0.06);
}

// Two effects that both soften joint 2 soften it twice.
TEST(BlindUnloadedEffects, aJointGivesByTheSumOfItsCompliances) {
  simulation::SimulationSpec spec = UnloadedLab(2).spec;
  numerics::RandomStream random(6, "test");
  const auto& days = validation::unloadedDays();
  validation::EffectDraw weight;
  while (weight.detail != "joint 2") weight = days.effect("joint_compliance", spec, random);
  const validation::EffectDraw spring = days.effect("gravity_compensator", spec, random);
  simulation::SimulationSpec one = spec, other = spec, both = spec;
  weight.apply(0.5, one);
  spring.apply(2.0, other);
  weight.apply(0.5, both);
  spring.apply(2.0, both);
  EXPECT_DOUBLE_EQ(1.0 / *both.machine.joints[1].torsion,
                   1.0 / *one.machine.joints[1].torsion + 1.0 / *other.machine.joints[1].torsion);
}

TEST(BlindUnloadedPlan, sharesAndBalance) {
  std::map<validation::CaseKind, int> kinds;
  std::map<std::string, int> singles, outside;
  for (const auto& plan : validation::planCases(400, 3, 0.125, validation::unloadedDays())) {
    ++kinds[plan.kind];
    if (plan.kind == validation::CaseKind::single) ++singles[plan.effects.front()];
    if (plan.kind == validation::CaseKind::outside) ++outside[plan.outside];
  }
  EXPECT_EQ(kinds[validation::CaseKind::none], 80);
  EXPECT_EQ(kinds[validation::CaseKind::pair], 50);
  EXPECT_EQ(kinds[validation::CaseKind::outside], 50);
  EXPECT_EQ(kinds[validation::CaseKind::as_is], 0);
  EXPECT_EQ(singles.size(), 15u);
  for (const auto& [id, count] : singles) EXPECT_NEAR(count, 220 / 15.0, 1.0) << id;
  EXPECT_EQ(outside.size(), validation::unloadedDays().vocabulary.outside.size());
}

TEST(BlindUnloadedRun, sealsFirstAndScoresByItsOwnVocabulary) {
  const fs::path folder = fs::temp_directory_path() / "stiffscope_blind_unloaded_run";
  fs::remove_all(folder);
  const auto run = [&](int threads, const char* name) {
    validation::BlindOptions options;
    options.cases = 8;
    options.seed = 7;
    options.out = folder / name;
    options.threads = threads;
    options.unloaded = true;
    bool sealed = false;
    validation::BlindEvents events;
    events.sealed = [&](const std::string& seal) {
      sealed = true;
      EXPECT_EQ(seal, io::sha256Hex(io::readTextFile(options.out / "labels.csv")));
    };
    return validation::runBlind(
        options,
        [&](const campaign::Campaign& campaign) {
          EXPECT_TRUE(sealed);
          EXPECT_FALSE(campaign.load_cell);
          validation::Answer answer;
          answer.entries = {{{"read_back_error"}, ""}};
          return answer;
        },
        events);
  };
  const validation::BlindResult one = run(1, "one"), two = run(2, "two");
  EXPECT_EQ(one.seal, two.seal);
  EXPECT_EQ(one.answers_hash, two.answers_hash);
  EXPECT_EQ(one.score.effects.size(), 15u);
  EXPECT_EQ(one.score.rate("false_alarms").hits, one.score.rate("false_alarms").trials);
  EXPECT_EQ(one.score.rate("failed").hits, 0);
  EXPECT_TRUE(one.score.as_is.empty());
  fs::remove_all(folder);
}

validation::Label labelled(const std::string& effect) {
  validation::Label label;
  label.name = "1";
  label.kind = validation::CaseKind::single;
  label.effects = {{effect, "joint 2", "positions", 4.0, 0.0, 4.0}};
  return label;
}

bool isRight(const std::string& effect, const std::vector<std::vector<std::string>>& said) {
  validation::Answer answer;
  answer.name = "1";
  for (const auto& effects : said) answer.entries.push_back({effects, "joint 2"});
  return validation::score({labelled(effect)}, {answer}, {}, validation::unloadedDays().vocabulary).cases[0].right;
}

TEST(BlindUnloadedScore, whatAnEffectBringsAlongIsNoFault) {
  EXPECT_TRUE(isRight("gravity_compensator", {{"gravity_compensator"}}));
  EXPECT_TRUE(isRight("gravity_compensator", {{"joint_compliance"}, {"gravity_compensator"}}));
  EXPECT_FALSE(isRight("gravity_compensator", {{"joint_compliance"}}));
  EXPECT_FALSE(isRight("gravity_compensator", {{"gravity_compensator"}, {"backlash"}}));
  EXPECT_FALSE(isRight("joint_compliance", {{"joint_compliance"}, {"gravity_compensator"}}));
  EXPECT_TRUE(isRight("transmission_error", {{"ratio_error", "transmission_error"}}));
}

TEST(BlindUnloadedScore, aURDFThatMissesIsAKinematicError) {
  accuracy::AccuracyDiagnosis diagnosis;
  diagnosis.verdict = {{{accuracy::UnloadedEffect::backlash}, "joint 3, both + sides"}, {{}, ""}};
  EXPECT_EQ(validation::answerOf(diagnosis).entries.size(), 2u);
  diagnosis.geometry_off_nominal = true;
  const validation::Answer answer = validation::answerOf(diagnosis);
  ASSERT_EQ(answer.entries.size(), 3u);
  EXPECT_EQ(answer.entries[0].effects, std::vector<std::string>{"backlash"});
  EXPECT_EQ(answer.entries[0].detail, "joint 3  both   sides");
  EXPECT_TRUE(answer.entries[1].effects.empty());
  EXPECT_EQ(answer.entries[2].effects, std::vector<std::string>{"kinematic_error"});
}

}  // namespace unloaded_test

}  // namespace stiffscope
