#include "core/extended_model/extend_model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include "core/compensation/compensate.h"
#include "core/diagnosis/gap_study.h"
#include "core/effects/all.h"
#include "core/extended_model/effect_deflection.h"
#include "core/extended_model/remarks.h"
#include "core/identification/estimate.h"
#include "core/io/input_error.h"
#include "core/preparation/prepare.h"
#include "core/simulation/equilibrium.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/extended_day.h"

// Machines of the simulator with one hidden effect, identified without and with it. STIFFSCOPE_WITH_DAYS=200 in the
// environment repeats the coverage test on as many days and prints it.

namespace stiffscope {
namespace extended_model_test {

struct Hidden {
  const char* name;
  const char* word;  ///< --with
  void (*hide)(simulation::SimulationSpec& spec);
  std::vector<double> truth;  ///< of the parameters in their order; empty: not stated
};

double truthOf(const simulation::SimulationSpec& spec, int joint) {
  return *spec.machine.joints[static_cast<std::size_t>(joint)].torsion;
}

/// Joints whose stated interval does not hold the truth, and the largest error over the standard uncertainty.
struct Missed {
  int joints = 0;
  double worst = 0.0;
};

Missed missedBy(const identification::MethodResult& method, const simulation::SimulationSpec& spec) {
  Missed missed;
  for (int joint = 0; joint < 6; ++joint) {
    const identification::StiffnessEstimate& estimate = method.estimate;
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
    const double truth = truthOf(spec, joint);
    missed.joints += identification::stiffnessInterval(estimate, joint).holds(truth) ? 0 : 1;
    missed.worst = std::max(missed.worst, std::abs(estimate.compliance[joint] - 1.0 / truth) /
                                              std::sqrt(estimate.covariance(joint, joint)));
  }
  return missed;
}

void tiltJoint3(simulation::SimulationSpec& spec) { spec.machine.joints[2].bearing = 4e6; }

/// P12 moves along the pull by 0.45 mm under 1.5 kN: as if the arm gave more.
void softNest(simulation::SimulationSpec& spec) {
  spec.targets[2].motion =
      simulation::TargetMotion{simulation::TargetMotion::Kind::compliant, Eigen::Vector3d::Zero(), 1.0, 3e-7};
}

class HiddenEffect : public testing::TestWithParam<Hidden> {};

TEST_P(HiddenEffect, TrueStiffnessesComeBackWithItAndNotWithoutIt) {
  const Hidden& hidden = GetParam();
  simulation::SimulationSpec spec = springsAlone(3);
  hidden.hide(spec);
  const extended_model::ExtendedModel model = extendedDay(spec, {hidden.word});
  ASSERT_EQ(model.effects.added.size(), 1u);
  EXPECT_TRUE(model.effects.added[0].plausible);
  for (std::size_t i = 0; i < hidden.truth.size(); ++i) {
    const extended_model::EffectParameter& found = model.effects.added[0].parameters[i];
    EXPECT_NEAR(found.value, hidden.truth[i], 4.0 * found.sd) << found.name;  // 1 of 16 000 by chance
  }
  for (const identification::Method which : identification::kMethods) {
    const identification::MethodResult &without = model.without.of(which), &with = model.with.of(which);
    ASSERT_TRUE(without.available && with.available) << reports::words(without.reason) << reports::words(with.reason);
    EXPECT_GE(missedBy(without, spec).joints, 1) << "the effect is hidden in no stiffness: nothing is tested";
    // Five joints with 10 to 20 effective degrees of freedom: 3.5 standard deviations are passed once in a hundred
    // days.
    EXPECT_LT(missedBy(with, spec).worst, 3.5);
    EXPECT_LT(with.estimate.rms_residual, without.estimate.rms_residual);
    EXPECT_GT(with.at_targets->subsets.held_out, without.at_targets->subsets.held_out);
    // The effect's own uncertainty is in what is stated.
    EXPECT_GT(with.estimate.parts.effects.diagonal().maxCoeff(), 0.0);
    EXPECT_TRUE(with.estimate.covariance.isApprox(with.estimate.parts.total()));
  }
  EXPECT_GT(model.effects.explained, 0.9);
}

INSTANTIATE_TEST_SUITE_P(OfDifferentKind, HiddenEffect,
                         testing::Values(Hidden{"MachineBearing", "bearing_tilt:3", &tiltJoint3, {1.0 / 4e6}},
                                         Hidden{"LoadPoint",
                                                "load_point_error",
                                                [](simulation::SimulationSpec& spec) {
                                                  spec.load_cell->place_error = {0.03, -0.02, 0.04};
                                                },
                                                {0.03, -0.02, 0.04}},
                                         Hidden{"CellTurned",
                                                "load_cell_misalignment",
                                                [](simulation::SimulationSpec& spec) {
                                                  spec.load_cell->misalignment = {0.05, -0.08, 0.03};
                                                },
                                                {0.05, -0.08, 0.03}},
                                         Hidden{"ReflectorMoves", "target_motion:P12", &softNest, {}}),
                         [](const testing::TestParamInfo<Hidden>& info) { return info.param.name; });

// Bearings that are rigid come out at zero or just above, which noise decides; either way the data know them no better,
// and what they could take of the springs is in the springs' uncertainty.
TEST(ExtendedModel, AParameterAtItsBoundStaysInTheCovariance) {
  int at_bound = 0;
  for (const std::uint64_t seed : {3, 4}) {
    simulation::SimulationSpec spec = springsAlone(seed);
    tiltJoint3(spec);
    const extended_model::ExtendedModel model = extendedDay(
        spec, {"bearing_tilt:2", "bearing_tilt:3", "bearing_tilt:4", "bearing_tilt:5", "bearing_tilt:6"}, 1);
    ASSERT_EQ(model.effects.added.size(), 1u);
    EXPECT_EQ(model.effects.free.size(), 5u);
    for (const extended_model::EffectParameter& one : model.effects.added[0].parameters) {
      at_bound += one.value == 0.0;
      EXPECT_GT(one.sd, 0.0) << one.name;
    }
    EXPECT_TRUE(model.effects.covariance.diagonal().minCoeff() > 0.0);
  }
  EXPECT_GT(at_bound, 0) << "nothing is tested";
}

TEST(ExtendedModel, StatedIntervalsHoldTheTruth) {
  const char* asked = std::getenv("STIFFSCOPE_WITH_DAYS");
  const int days = asked != nullptr ? std::atoi(asked) : 3;
  std::array<std::array<int, 6>, 3> held{}, stated{};
  int all_held = 0, all = 0;
  for (int day = 0; day < days; ++day) {
    simulation::SimulationSpec spec = springsAlone(100 + static_cast<std::uint64_t>(day));
    tiltJoint3(spec);
    const extended_model::ExtendedModel model = extendedDay(spec, {"bearing_tilt:3"}, 1);
    for (std::size_t m = 0; m < 3; ++m) {
      const identification::StiffnessEstimate& estimate = model.with.methods[m].estimate;
      for (std::size_t j = 1; j < 6; ++j, ++all) {
        const bool holds =
            identification::stiffnessInterval(estimate, static_cast<int>(j)).holds(truthOf(spec, static_cast<int>(j)));
        held[m][j] += holds, ++stated[m][j], all_held += holds;
      }
    }
  }
  for (std::size_t m = 0; asked != nullptr && m < 3; ++m) {
    for (std::size_t j = 1; j < 6; ++j)
      fmt::print("method {} k{}: {:.1f} % of {}\n", m, j + 1, 100.0 * held[m][j] / stated[m][j], stated[m][j]);
  }
  // The three methods share their errors: of three days 45 intervals count as 15; fewer than three of four would come
  // once in 5000 by chance at the stated 95 %. Two hundred days show a coverage to 2 %.
  EXPECT_GE(static_cast<double>(all_held) / all, asked != nullptr ? 0.90 : 0.75);
}

/// How far the machine's reflectors stand from where they are unloaded, mean over postures.
double meanLeft(const simulation::SimulationSpec& spec, int step,
                const std::vector<compensation::CompensatedPosture>& rows) {
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::AppliedLoad load = simulation::loadAtStep(*spec.loading, step, machine.gravity_in_base, {});
  double sum = 0.0;
  for (const compensation::CompensatedPosture& row : rows) {
    EXPECT_TRUE(row.solved) << reports::words(row.reason);
    const simulation::MachineState rest = simulation::equilibrium(machine, row.posture.q),
                                   there = simulation::equilibrium(machine, row.commands, load);
    for (std::size_t t = 0; t < rest.targets_in_base.size(); ++t)
      sum += (there.targets_in_base[t] - rest.targets_in_base[t]).norm() /
             static_cast<double>(rest.targets_in_base.size());
  }
  return sum / static_cast<double>(rows.size());
}

TEST(ExtendedModel, CommandsWithAnEffectOfTheMachineLeaveLessOfTheTrueDeflection) {
  simulation::SimulationSpec spec = springsAlone(3);
  tiltJoint3(spec);
  const extended_model::ExtendedModel model = extendedDay(spec, {"bearing_tilt:3"});
  ASSERT_TRUE(extended_model::deflectsByEffects(model.effects));
  constexpr identification::Method kMethod = identification::Method::partial_pose;
  const auto commands = [&](const identification::Identification& result, const effects::EffectDeflection* give) {
    const identification::MethodResult& method = result.of(kMethod);
    return compensation::compensate(model.campaign, method.geometry, method.estimate, result.frames.tcp_in_flange,
                                    compensation::campaignPostures(model.campaign, result.step), {}, give);
  };
  const effects::EffectDeflection give = extended_model::effectDeflection(model, kMethod);
  const auto plain_rows = commands(model.without, nullptr), rows = commands(model.with, &give);
  const double without = meanLeft(spec, model.with.step, plain_rows), with = meanLeft(spec, model.with.step, rows);
  EXPECT_LT(with, 0.3 * without);
  // Held out, with the effect fitted anew: no more is claimed than the machine then shows.
  const std::vector<double>& moved = model.with.target_displacement;
  const double whole = std::accumulate(moved.begin(), moved.end(), 0.0) / static_cast<double>(moved.size());
  EXPECT_GE(1.0 - with / whole, model.with.of(kMethod).at_targets->subsets.held_out);
  for (const compensation::CompensatedPosture& row : rows) {
    EXPECT_LT(row.remaining, 1e-9);  // the model's own, where Newton stops
    EXPECT_TRUE((row.tcp.sd.array() > 0.0).all());
  }
  // What the machine does stays in its displacements, and the effect's uncertainty is in the prediction's.
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_NEAR(moved[i], model.without.target_displacement[i], 1e-9);
  effects::EffectDeflection springs_only = extended_model::effectDeflection(model, kMethod);
  springs_only.varied.clear();
  EXPECT_GT(rows.front().tcp.sd.norm(), commands(model.with, &springs_only).front().tcp.sd.norm());
}

TEST(ExtendedModel, AFaultOfTheMeasurementIsNoPartOfADeflection) {
  simulation::SimulationSpec spec = springsAlone(3);
  softNest(spec);
  const extended_model::ExtendedModel model = extendedDay(spec, {"target_motion:P12"}, 2);
  EXPECT_FALSE(extended_model::deflectsByEffects(model.effects));
  // The displacements that shares are of: those of reflectors that sit still in their nests, read on the same day.
  spec.targets[2].motion.reset();
  const identification::Identification still = identification::identify(simulation::simulate(spec), fewSubsets(2));
  double added = 0.0;
  for (std::size_t i = 0; i < still.target_displacement.size(); ++i) {
    // The same noise; 4 um are 1 % of what one of three reflectors moved, mean 150 um, its parameters known to half of
    // that.
    EXPECT_NEAR(model.with.target_displacement[i], still.target_displacement[i], 4e-6);
    added += model.without.target_displacement[i] - still.target_displacement[i];
  }
  EXPECT_GT(added / static_cast<double>(still.target_displacement.size()), 50e-6);
}

TEST(ExtendedModel, WithoutEffectsNothingChanges) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(3));
  const extended_model::ExtendedModel model =
      extended_model::extendModel(campaign, extended_model::fitEffects(campaign, {}), fewSubsets(2));
  EXPECT_TRUE(model.effects.added.empty());
  EXPECT_EQ(model.with.of(identification::Method::partial_pose).estimate.compliance,
            model.without.of(identification::Method::partial_pose).estimate.compliance);
}

// A joint whose stiffness goes with its angle is no effect of the list. What the list has that fits is not added where
// it makes postures that chose nothing worse.
TEST(SupportedModel, AddsNothingThatPredictsWorseThanSprings) {
  int refused = 0;
  for (const std::uint64_t seed : {11, 12, 13}) {
    simulation::SimulationSpec spec = springsAlone(seed);
    spec.machine.joints[2].rate_wave = simulation::JointWave{0.35, 1.0 + static_cast<double>(seed % 3), 0.4};
    const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
    const extended_model::ExtendedModel model =
        extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2));
    if (!model.effects.free.empty()) {
      EXPECT_GT(model.effects.shrink.value, 0.0) << seed;
      continue;
    }
    for (const Remark& note : model.effects.notes)
      refused += note.is(extended_model::RemarkId::effects_do_not_help) ? 1 : 0;
    EXPECT_EQ(model.with.of(identification::Method::partial_pose).estimate.compliance,
              model.without.of(identification::Method::partial_pose).estimate.compliance);
    EXPECT_FALSE(model.with.of(identification::Method::partial_pose).estimate.stated.empty());  // what could hide is in
  }
  EXPECT_GT(refused, 0);
}

TEST(EffectFit, SaysWhatIsMissing) {
  simulation::SimulationSpec spec = springsAlone(3);
  spec.loading->return_to_zero = false;
  const campaign::Campaign campaign = simulation::simulate(spec);
  const auto messageOf = [&](const std::vector<std::string>& words) -> std::string {
    try {
      extended_model::fitEffects(campaign, extended_model::requestedEffects(words, campaign));
    } catch (const io::InputError& error) {
      return error.what();
    } catch (const extended_model::UnfitEffect& error) {
      return fmt::format("{}: {}", error.what(), reports::words(error.reason()));
    }
    return "";
  };
  EXPECT_EQ(
      messageOf({"hysteresis"}),
      "hysteresis: this campaign cannot show that effect: no return to zero: a last, unloaded step in each posture is "
      "needed");
  EXPECT_EQ(
      messageOf({"bearing_tlt"}).rfind("--with: 'bearing_tlt': expected auto or effects of: link_compliance, ", 0), 0u);
  EXPECT_NE(messageOf({"bearing_tlt"}).find("(did you mean 'bearing_tilt'?)"), std::string::npos);
  EXPECT_EQ(messageOf({"target_motion:P13"}), "--with: 'target_motion:P13': expected one of its parts: P10, P11, P12");
  EXPECT_EQ(messageOf({"frame_error:2"}), "--with: 'frame_error:2': frame_error has no parts to name");
}

// A station that wanders between two rounds of the nests is not where it was interpolated: its readings are weighed by
// that, as the study of the diagnosis does, and not by the tracker's noise alone.
TEST(EffectFit, KnowsThatTheStationWandersBetweenTheNests) {
  simulation::SimulationSpec spec = springsAlone(3);
  spec.timing.nest_interval_s = 1200.0;
  spec.station.walk.head<3>().setConstant(3e-6);  // m after a second: 0.1 mm between two rounds
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  const extended_model::EffectFit effects =
      extended_model::fitEffects(prepared, extended_model::requestedEffects({"bearing_tilt:3"}, prepared.campaign));
  const diagnosis::GapStudy study = diagnosis::studyGap(prepared);
  ASSERT_TRUE(study.input->wandering);
  ASSERT_FALSE(study.input->wandering->wander.isZero());
  ASSERT_TRUE(effects.input->wandering);
  EXPECT_EQ(effects.input->wandering->wander, study.input->wandering->wander);
  ASSERT_EQ(effects.fit.data->postures.size(), study.fit.data->postures.size());
  for (std::size_t p = 0; p < study.fit.data->postures.size(); ++p) {
    const Eigen::MatrixXd &own = effects.fit.data->postures[p].noise, &of_study = study.fit.data->postures[p].noise;
    EXPECT_NEAR(own.norm(), of_study.norm(), 1e-3 * of_study.norm()) << p;
  }
}

TEST(EffectFit, GeometryIsIdentificationsOwnTask) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(3));
  const extended_model::EffectFit fit =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"kinematic_error"}, campaign));
  EXPECT_TRUE(fit.added.empty());
  EXPECT_EQ(fit.geometry, std::vector<effects::Effect>{effects::Effect::kinematic_error});
}

TEST(RequestedEffects, DetailsOfOneEffectAddUp) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(3));
  const extended_model::RequestedEffects wanted = extended_model::requestedEffects(
      {"bearing_tilt:2", "joint_coupling:3-2", "bearing_tilt:3", "hysteresis"}, campaign);
  ASSERT_EQ(wanted.effects.size(), 3u);
  EXPECT_EQ(wanted.effects[0].parts, (std::vector<std::string>{"joint 2", "joint 3"}));
  EXPECT_EQ(wanted.effects[1].parts, std::vector<std::string>{"joints 2 and 3"});
  EXPECT_TRUE(wanted.effects[2].parts.empty());
}

TEST(RequestedEffects, OfADiagnosisTakesTheFirstOfAClassAndNeverTheUnknown) {
  diagnosis::Diagnosis diagnosis(6);
  diagnosis.usable = true;
  diagnosis.verdict.entries = {
      {{effects::Effect::bearing_tilt, effects::Effect::link_compliance}, "joint 2, joint 3 or joint 4"}, {{}, ""}};
  extended_model::RequestedEffects wanted = extended_model::namedBy(diagnosis);
  ASSERT_EQ(wanted.effects.size(), 1u);
  EXPECT_EQ(wanted.effects[0].effect, effects::Effect::bearing_tilt);
  EXPECT_EQ(wanted.effects[0].parts, (std::vector<std::string>{"joint 2", "joint 3"}));
  ASSERT_EQ(wanted.notes.size(), 2u);
  EXPECT_EQ(reports::words(wanted.notes[0]),
            "bearing tilt is added because it fits best; this data cannot tell it from link compliance");
  EXPECT_TRUE(wanted.notes[1].is(extended_model::RemarkId::diagnosis_finds_unknown));
  diagnosis.verdict.entries = {{{}, ""}};
  wanted = extended_model::namedBy(diagnosis);
  EXPECT_TRUE(wanted.effects.empty());
  ASSERT_EQ(wanted.notes.size(), 1u);
  EXPECT_TRUE(wanted.notes[0].is(extended_model::RemarkId::diagnosis_finds_only_unknown));
  diagnosis.verdict.entries.clear();
  wanted = extended_model::namedBy(diagnosis);
  EXPECT_TRUE(wanted.effects.empty());
  ASSERT_EQ(wanted.notes.size(), 1u);
  EXPECT_TRUE(wanted.notes[0].is(extended_model::RemarkId::diagnosis_names_none));
}

TEST(EffectNature, EveryEffectHasOneAndMeasurementsStayOutOfCompensation) {
  int entering = 0;
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    const auto effect = static_cast<effects::Effect>(e);
    EXPECT_EQ(effects::entersCompensation(effect), effects::natureOf(effect) == effects::EffectNature::machine ||
                                                       effects::natureOf(effect) == effects::EffectNature::load);
    entering += effects::entersCompensation(effect);
  }
  EXPECT_EQ(entering, 11);
  for (const effects::Effect effect :
       {effects::Effect::tracker_drift, effects::Effect::frame_error, effects::Effect::target_motion,
        effects::Effect::load_cell_bias, effects::Effect::load_cell_misalignment}) {
    EXPECT_FALSE(effects::entersCompensation(effect)) << effects::idOf(effect);
  }
}

}  // namespace extended_model_test
}  // namespace stiffscope
