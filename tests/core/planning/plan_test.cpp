#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include "core/campaign/joint_reading.h"
#include "core/identification/posture_stiffness.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/planning/design.h"
#include "core/planning/plan.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace plan_test {

JointMatrix randomInformation(Noise& noise) {
  Eigen::Matrix<double, 3, 6> rows;
  for (int j = 0; j < 6; ++j) rows.col(j) = noise.normal3();
  return rows.transpose() * rows;
}

TEST(ExchangeDesign, FindsWhatTryingAllFinds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Noise noise(seed);
    planning::DesignProblem problem(6);
    problem.unknown = {true, true, true, true, true, false};
    problem.known = randomInformation(noise);
    for (int k = 0; k < 12; ++k) problem.information.push_back(randomInformation(noise));
    double best = -1e300;
    for (unsigned bits = 0; bits < 4096; ++bits) {
      std::vector<std::size_t> chosen;
      for (unsigned k = 0; k < 12; ++k) {
        if ((bits >> k & 1U) != 0) chosen.push_back(k);
      }
      if (chosen.size() == 4)
        best = std::max(best, planning::logDeterminant(planning::informationOf(problem, chosen), problem.unknown));
    }
    planning::ExchangeOptions options;
    options.starts = 20;
    const planning::Design found = planning::exchangeDesign(problem, 4, options);
    EXPECT_EQ(found.chosen.size(), 4u);
    EXPECT_NEAR(found.log_determinant, best, 1e-9) << seed;  // rounding of a sum of logarithms
  }
}

TEST(ExchangeDesign, AddsWhatIsMissingAndKeepsApart) {
  // Joints 1 and 2 alone. What is known sees joint 1; candidates 0 to 2 see joint 1 better than 3 and 4 see
  // joint 2.
  planning::DesignProblem problem(6);
  problem.unknown = {true, true, false, false, false, false};
  problem.known(0, 0) = 100.0, problem.known(1, 1) = 1.0;
  for (int k = 0; k < 5; ++k) {
    JointMatrix one = JointMatrix::Zero(6, 6);
    one(k < 3 ? 0 : 1, k < 3 ? 0 : 1) = k < 3 ? 10.0 : 5.0;
    problem.information.push_back(one);
  }
  EXPECT_GE(planning::exchangeDesign(problem, 1).chosen.front(), 3u);
  problem.excludes.assign(5, std::vector<char>(5, 0));
  problem.excludes[3][4] = problem.excludes[4][3] = 1;
  const planning::Design two = planning::exchangeDesign(problem, 2);
  ASSERT_EQ(two.chosen.size(), 2u);
  EXPECT_GE(two.chosen[0], 3u);
  EXPECT_LT(two.chosen[1], 3u);
  EXPECT_NEAR(two.log_determinant, std::log(110.0 * 6.0), 1e-9);
  problem.barred = {1, 1, 1, 0, 0};
  EXPECT_EQ(planning::exchangeDesign(problem, 2).chosen.size(), 1u);  // no more keep apart
  const JointVector sd = planning::standardDeviations(planning::informationOf(problem, {3}), problem.unknown);
  EXPECT_NEAR(sd[1], 1.0 / std::sqrt(6.0), 1e-12);
  EXPECT_TRUE(std::isnan(sd[2]));
}

/// Before the day: robot, reflectors, load cell, tracker as a sample's laboratory declares them.
campaign::Campaign dayBefore(const simulation::SimulationSpec& spec) {
  campaign::Campaign campaign;
  campaign.name = "before the day";
  campaign.robot = spec.nominal;
  campaign.base_link = spec.base_link;
  campaign.flange_link = spec.flange_link;
  campaign.tracker = spec.tracker.declared;
  campaign.load_cell = spec.load_cell->declared;
  for (const auto& target : spec.targets) campaign.targets.push_back({target.id, target.position_in_flange});
  return campaign;
}

planning::PlanOptions optionsFor(const simulation::SimulationSpec& spec, int postures) {
  planning::PlanOptions options;
  options.postures = postures;
  options.candidates = 1500;
  options.random_sets = 60;
  options.inputs.load = 1500.0;
  options.inputs.hook_in_flange = spec.loading->hook_in_flange;
  options.inputs.tracker_in_base = spec.tracker.base_from_tracker.translation();
  return options;
}

simulation::SimulationSpec sample() {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/inactive.xml");
  spec.wrist_sweep->readings = 200;
  return spec;
}

TEST(Plan, KeepsLimitsRulesAndDistance) {
  simulation::SimulationSpec spec = sample();
  campaign::Campaign campaign = dayBefore(spec);
  campaign.robot.limits[1] = {-0.5, 0.6};
  campaign.robot.limits[4] = {0.2, 1.9};
  const planning::PlanOptions options = optionsFor(spec, 8);
  const planning::Plan plan = planning::planCampaign(campaign, nullptr, options);
  ASSERT_EQ(plan.postures.size(), 8u);
  EXPECT_EQ(plan.unknown,
            (robot::JointMask{false, true, true, true, true, true}));  // a hanging load never turns axis 1
  const double margin = options.rules.limit_margin;
  for (const planning::PlannedPosture& one : plan.postures) {
    const JointVector& q = one.candidate.q;
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_GE(q[static_cast<Eigen::Index>(j)], campaign.robot.limits[j].lower + margin - 1e-12) << one.id;
      EXPECT_LE(q[static_cast<Eigen::Index>(j)], campaign.robot.limits[j].upper - margin + 1e-12) << one.id;
    }
    // Judged on the URDF's arm itself, not on the plan's copy in R0.
    const robot::ArmPosture posture = robot::postureAt(campaign.robot, q);
    const Eigen::Isometry3d flange = robot::flangeAt(campaign.robot, posture);
    const Jacobian jacobian = robot::jacobianAt(campaign.robot, posture, flange.translation());
    EXPECT_GE(identification::postureConditioning(jacobian, 1.0).dexterity, options.rules.least_dexterity - 1e-9)
        << one.id;
    const Eigen::Vector3d hook = flange * spec.loading->hook_in_flange;
    EXPECT_GE(hook.z(), options.rules.least_hook_height - 1e-9) << one.id;
    EXPECT_LE(flange.linear()(2, 2), std::sin(options.rules.most_outward_up) + 1e-9) << one.id;
    ASSERT_TRUE(one.tracker_distance.has_value());
    EXPECT_NEAR(*one.tracker_distance, (flange.translation() - *options.inputs.tracker_in_base).norm(), 1e-9);
    // The reading expected is a force down of 1500 N at the hook.
    const Eigen::Vector3d force = flange.linear() * one.reading.head<3>();
    EXPECT_LT((force - Eigen::Vector3d(0, 0, -1500)).norm(), 1e-9) << one.id;
    const Eigen::Vector3d arm = hook - flange * Eigen::Vector3d(0, 0, 0.11);
    EXPECT_LT((flange.linear() * one.reading.tail<3>() - arm.cross(force)).norm(), 1e-9) << one.id;
    for (const planning::PlannedPosture& other : plan.postures) {
      const bool same = &other == &one;
      EXPECT_EQ(planning::alike(plan.arm, one.candidate, other.candidate, options.least_separation), same);
    }
  }
  for (std::size_t k = 2; k < plan.postures.size(); ++k) {  // each next one adds no more than the one before it
    EXPECT_LE(plan.postures[k].log_det_gain, plan.postures[k - 1].log_det_gain + 1e-9);
  }
  EXPECT_EQ(planning::planCampaign(campaign, nullptr, options).postures.back().candidate.q,
            plan.postures.back().candidate.q);
}

// Joint 1 counted the other way round and from elsewhere, joint 3 against the horizontal.
TEST(Plan, LimitsAreOfWhatTheControllerStates) {
  const simulation::SimulationSpec spec = sample();
  campaign::Campaign campaign = dayBefore(spec);
  campaign.joint_readings = {{0, -1.0, 30.0 * io::kDegree, -1}, {2, 1.0, 0.0, 1}};
  planning::PlanOptions options = optionsFor(spec, 6);
  options.candidates = 300;
  options.random_sets = 5;
  options.rules.low.head(6) = io::kDegree * (Eigen::VectorXd(6) << -60, -40, -60, -100, -90, -90).finished();
  options.rules.high.head(6) = io::kDegree * (Eigen::VectorXd(6) << 60, 40, 30, 100, 90, 90).finished();
  const campaign::JointConvention convention(campaign.joint_readings, 6);
  const auto outside = [&](const JointVector& q) {
    const JointVector figures = convention.figures(q);
    return (options.rules.low.head(6) - figures).cwiseMax(figures - options.rules.high.head(6)).maxCoeff();
  };
  const planning::Plan plan = planning::planCampaign(campaign, nullptr, options);
  ASSERT_EQ(plan.postures.size(), 6u);
  for (const planning::PlannedPosture& one : plan.postures) EXPECT_LT(outside(one.candidate.q), 1e-8) << one.id;
  // Of a day without a load, too, whose postures are drawn in the same way; all of what is allowed is drawn from.
  const planning::PlanningArm arm = planning::unloadedPlanningArm(campaign, options.inputs);
  const planning::CandidateDraw draw = planning::drawCandidates(arm, options.rules, 300, 1);
  double most_1 = -1e9, least_3 = 1e9, most_3 = -1e9;
  for (const planning::Candidate& one : draw.kept) {
    EXPECT_LT(outside(one.q), 1e-8);
    most_1 = std::max(most_1, one.q[0]), least_3 = std::min(least_3, one.q[2]), most_3 = std::max(most_3, one.q[2]);
  }
  EXPECT_GT(draw.broken[static_cast<std::size_t>(planning::PostureRule::figures)], 0);
  EXPECT_GT(most_1, 80.0 * io::kDegree);
  EXPECT_LT(least_3, -60.0 * io::kDegree);
  EXPECT_GT(most_3, 30.0 * io::kDegree);
  const planning::PostureLimits limits(campaign.robot, campaign.joint_readings, options.rules);
  EXPECT_NEAR(limits.box()[0].lower, -30.0 * io::kDegree, 1e-12);
  EXPECT_NEAR(limits.box()[0].upper, 90.0 * io::kDegree, 1e-12);
  // Limits that leave nothing are named as they were given, and the joint's own as the controller states them.
  campaign.robot.limits[0] = {-1.0, 1.0};
  options.rules.low[0] = 100.0 * io::kDegree, options.rules.high[0] = 120.0 * io::kDegree;
  try {
    planning::planCampaign(campaign, nullptr, options);
    ADD_FAILURE();
  } catch (const io::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "--min-deg: '100': expected a range of joint 1 within its limits -27.3 to 87.3 deg less "
                 "5 deg at each end, as the controller states them");
  }
}

TEST(Plan, APullShowsJointOneToo) {
  const simulation::SimulationSpec spec = sample();
  planning::PlanOptions options = optionsFor(spec, 6);
  options.candidates = 600;
  options.inputs.pull = true;
  const planning::Plan plan = planning::planCampaign(dayBefore(spec), nullptr, options);
  EXPECT_EQ(plan.unknown, kAllJoints);
  for (const planning::PlannedPosture& one : plan.postures) EXPECT_NEAR(one.pull_in_base.norm(), 1.0, 1e-12);
  for (int j = 0; j < 6; ++j) EXPECT_LT(plan.postures.back().sd[j], plan.random_same.sd[j]) << j;
}

TEST(Plan, RefusesWithTheReason) {
  const simulation::SimulationSpec spec = sample();
  const auto refusal = [&](const campaign::Campaign& campaign, const planning::PlanOptions& options) -> std::string {
    try {
      planning::planCampaign(campaign, nullptr, options);
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "none";
  };
  campaign::Campaign campaign = dayBefore(spec);
  planning::PlanOptions options = optionsFor(spec, 5);
  options.inputs.load.reset();
  EXPECT_EQ(refusal(campaign, options),
            "--load: expected the load in newtons, above 0: this campaign has no measured one to take");
  options.inputs.load = -5.0;
  EXPECT_EQ(refusal(campaign, options), "--load: '-5': expected the load in newtons, above 0");
  options = optionsFor(spec, 5);
  options.rules.low[1] = 10.0 * io::kDegree, options.rules.high[1] = -20.0 * io::kDegree;
  EXPECT_EQ(refusal(campaign, options), "--min-deg: '10': expected at most the -20 of --max-deg for joint 2");
  options = optionsFor(spec, 5);
  options.rules.high[2] = -3.0, options.rules.low[2] = -3.1;  // below the joint's own range
  EXPECT_EQ(refusal(campaign, options).rfind("--max-deg: '-171.887': expected a range of joint 3", 0), 0u)
      << refusal(campaign, options);
  options = optionsFor(spec, 0);
  EXPECT_EQ(refusal(campaign, options), "--postures: '0': expected 1 or more postures");
  options = optionsFor(spec, 5);
  options.augment = true;
  EXPECT_EQ(refusal(campaign, options), "--add: no measured postures that identify: --postures plans the day before");
  options = optionsFor(spec, 5);
  options.rules.low[2] = 1.5, options.rules.high[2] = 1.6;
  EXPECT_NE(refusal(campaign, options).find("expected a range of joint 3 within its limits"), std::string::npos)
      << refusal(campaign, options);
  // A wrist that stays straight: every posture is near its singularity, and the message counts them.
  options = optionsFor(spec, 5);
  options.candidates = 10;
  campaign.robot.limits[4] = {-0.09, 0.09};
  EXPECT_EQ(refusal(campaign, options),
            "plan: expected limits within which some posture keeps the rules; of 4000 drawn; "
            "too near a singularity: 4000");
  // A tracker in the middle of the arm's own column sees nothing past it.
  campaign = dayBefore(spec);
  options.inputs.tracker_in_base = Eigen::Vector3d(0.0, 0.0, 30.0);
  EXPECT_NE(refusal(campaign, options).find("outside the tracker's reach"), std::string::npos);
}

TEST(Plan, ALineOfSightThroughTheArmIsNoSight) {
  const simulation::SimulationSpec spec = sample();
  planning::PlanOptions options = optionsFor(spec, 5);
  const campaign::Campaign campaign = dayBefore(spec);
  planning::PlanningArm arm = planning::planningArm(campaign, nullptr, options.inputs);
  const planning::Candidate seen = planning::drawCandidates(arm, options.rules, 1, 1).kept.front();
  const robot::ArmPosture posture = identification::unloadedPosture(arm.geometry.arm, seen.load_case);
  EXPECT_EQ(planning::brokenRule(arm, options.rules, posture, seen.direction), planning::PostureRule::none);
  // A station beyond the forearm, in one line with it and a reflector.
  const Eigen::Vector3d target = robot::flangeAt(arm.geometry.arm, posture) * arm.targets_in_flange[0];
  const Eigen::Vector3d forearm = robot::axisAt(arm.geometry.arm, posture, 3).point;
  arm.station = target + 6.0 * (forearm - target).normalized();
  EXPECT_STREQ(planning::wordsFor(planning::brokenRule(arm, options.rules, posture, seen.direction)),
               "a reflector hidden from the tracker by the arm");
  arm.station = target + Eigen::Vector3d(0.3, 0.2, 0.1);
  EXPECT_STREQ(planning::wordsFor(planning::brokenRule(arm, options.rules, posture, seen.direction)),
               "outside the tracker's reach");
}

TEST(Plan, AddsToACampaignWhatItLacks) {
  simulation::SimulationSpec spec = sample();
  spec.posture_draw->count = 6;
  const campaign::Campaign campaign = simulation::simulate(spec);
  identification::IdentifyOptions quick;
  quick.subsets.most_all = 1;
  quick.subsets.sample = 2;
  const identification::Identification result = identification::identify(campaign, quick);
  planning::PlanOptions options;
  options.postures = 3;
  options.augment = true;
  options.candidates = 800;
  options.random_sets = 40;
  const planning::Plan plan = planning::planCampaign(campaign, &result, options);
  ASSERT_EQ(plan.postures.size(), 3u);
  EXPECT_EQ(plan.measured, 6);
  EXPECT_NEAR(plan.arm.load, 153 * 9.80665, 5.0);  // the simulated load cell's noise is 1 N
  // The hook of the specification, from the measured wrenches: 0.3 Nm over 1500 N, six times.
  EXPECT_LT((plan.arm.hook_in_flange - spec.loading->hook_in_flange).norm(), 1e-3);
  for (int j = 1; j < 6; ++j) {
    EXPECT_LT(plan.postures.back().sd[j], plan.sd_measured[j]) << j;
    EXPECT_LT(plan.postures.back().sd[j], plan.random_same.sd[j]) << j;
  }
  EXPECT_TRUE(std::isfinite(plan.postures.front().log_det_gain));
  EXPECT_GT(plan.postures.front().log_det_gain, 0.0);
}

// Of a machine of joint springs alone the noise is all that the model leaves: a plan states what the measured postures
// are worth as their identification does, and does not add the noise to itself.
TEST(Plan, CountsTheNoiseOnce) {
  simulation::SimulationSpec spec = sample();
  for (auto& joint : spec.machine.joints) joint.bearing.reset();
  const campaign::Campaign campaign = simulation::simulate(spec);
  identification::IdentifyOptions quick;
  quick.subsets.most_all = 1;
  quick.subsets.sample = 2;
  const identification::Identification result = identification::identify(campaign, quick);
  ASSERT_TRUE(result.noise.has_value());
  const double sigma = result.of(identification::Method::partial_pose).estimate.sigma;
  const double noise = result.noise->per_coordinate;
  const double beyond = std::sqrt(std::max(0.0, sigma * sigma - noise * noise));
  planning::PlanOptions options;
  options.postures = 2;
  options.augment = true;
  options.candidates = 60;
  options.random_sets = 2;
  for (const int repeats : {1, 3}) {  // of the day to come; sigma is of the measured day's
    options.inputs.repeats = repeats;
    EXPECT_DOUBLE_EQ(planning::planningArm(campaign, &result, options.inputs).misfit, beyond) << repeats;
  }
  EXPECT_LT(beyond, 0.7 * sigma);
  const planning::Plan plan = planning::planCampaign(campaign, &result, options);  // three repeats, as measured
  const JointMatrix& stated = result.of(identification::Method::partial_pose).estimate.covariance;
  for (int j = 1; j < 6; ++j) {
    const double ratio = plan.sd_measured[j] / std::sqrt(stated(j, j));
    // identify weighs all readings alike, which is worth less than the plan's weights; with the noise added to itself
    // the plan would state 1.16 to 1.27 of it.
    EXPECT_LT(ratio, 0.85) << j;
    EXPECT_GT(ratio, 0.5) << j;
  }
}

/// Mean square of the standard deviations of c over k's, by Partial Pose, of one simulated campaign.
JointVector squaresOf(const simulation::SimulationSpec& spec) {
  identification::IdentifyOptions quick;
  quick.subsets.most_all = 1;
  quick.subsets.sample = 2;
  const identification::StiffnessEstimate estimate =
      identification::identify(simulation::simulate(spec), quick).of(identification::Method::partial_pose).estimate;
  JointVector squares = JointVector::Zero(6);
  for (int j = 1; j < 6; ++j) {
    squares[j] = estimate.covariance(j, j) * std::pow(*spec.machine.joints[static_cast<std::size_t>(j)].torsion, 2);
  }
  return squares;
}

// Postures chosen against twice as many drawn at random within the same limits and rules, on machines of
// joint springs with geometry errors and noise of their own; the plan knows neither.
TEST(Plan, TenChosenPosturesAreWorthTwentyRandomOnes) {
  const simulation::SimulationSpec spec = sample();
  const campaign::Campaign before = dayBefore(spec);
  planning::PlanOptions options = optionsFor(spec, 10);
  options.candidates = 3000;
  const planning::Plan plan = planning::planCampaign(before, nullptr, options);
  ASSERT_EQ(plan.postures.size(), 10u);
  JointVector chosen = JointVector::Zero(6), random = JointVector::Zero(6);
  constexpr int kMachines = 8;
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    simulation::SimulationSpec machine = spec;
    machine.seed = 1000 + seed;
    machine.posture_draw.reset();
    for (auto& joint : machine.machine.joints) joint.bearing.reset();
    simulation::SimulationSpec drawn = machine;
    for (const planning::PlannedPosture& one : plan.postures)
      machine.postures.push_back({one.candidate.q, std::nullopt});
    for (const planning::Candidate& one : planning::drawCandidates(plan.arm, options.rules, 20, 500 + seed).kept) {
      drawn.postures.push_back({one.q, std::nullopt});
    }
    chosen += squaresOf(machine) / kMachines;
    random += squaresOf(drawn) / kMachines;
  }
  double worst = 0.0, logarithms = 0.0;
  for (int j = 1; j < 6; ++j) {
    const double expected = plan.postures.back().sd[j] / plan.random_double.sd[j];
    const double ratio = std::sqrt(chosen[j] / random[j]);
    std::printf("k%d: 10 chosen %.3f %%, 20 random %.3f %%, ratio %.2f (expected %.2f)\n", j + 1,
                100.0 * std::sqrt(chosen[j]), 100.0 * std::sqrt(random[j]), ratio, expected);
    EXPECT_LE(expected, 1.0) << j;
    worst = std::max(worst, ratio);
    logarithms += std::log(ratio) / 5.0;
  }
  // A stated sd of ten postures and five unknowns is itself known to about 25 %, of eight machines together
  // to 9 %, of the ratio to 11 %: none above 1 by more than that, and below 1 on average over the joints (5
  // %).
  EXPECT_LE(worst, 1.11);
  EXPECT_LE(std::exp(logarithms), 0.95);
}

}  // namespace plan_test
}  // namespace stiffscope
