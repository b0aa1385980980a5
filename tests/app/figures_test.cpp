#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include "app/figures/arm_scenes.h"
#include "app/figures/drawn.h"
#include "app/figures/figures.h"
#include "core/campaign/read_campaign.h"
#include "reports/page/pages.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace figures_test {

reports::ReportCampaign of(const SmallResult& small) { return {small.campaign, small.identification}; }

TEST(ResidualBars, GreyThenTheMethodsInMillimetres) {
  const SmallResult small;
  const render::GroupedBarChart chart = app::residualBars(of(small));
  EXPECT_EQ(chart.categories, (std::vector<std::string>{"A", "B", "C"}));
  ASSERT_EQ(chart.series.size(), 3u);  // CP is not available
  EXPECT_EQ(chart.series[0].colour, render::colours::kNone);
  EXPECT_EQ(chart.series[1].colour, render::colours::kPp);
  EXPECT_EQ(chart.series[2].colour, render::colours::kDpp);
  EXPECT_EQ(chart.series[0].values, (std::vector<double>{1.0, 3.0, 2.0}));
  EXPECT_DOUBLE_EQ(chart.series[1].values[1], 0.6);
  EXPECT_DOUBLE_EQ(chart.series[2].values[1], 0.3);
  EXPECT_NE(chart.title.find("P_{wrist}"), std::string::npos);
}

TEST(ResidualBars, AtTheReflectorsWhereTheWristIsNotMeasured) {
  SmallResult small;
  small.identification.wrist.clear();
  small.identification.wrist_displacement.clear();
  const render::GroupedBarChart chart = app::residualBars(of(small));
  EXPECT_EQ(chart.series[0].values, (std::vector<double>{2.0, 6.0, 4.0}));
  EXPECT_EQ(chart.title, "Displacement of the reflectors (mean of 3)");
  EXPECT_EQ(app::residualZoom(of(small)).series.size(), 2u);
}

TEST(DeflectionScene, TheMedianPostureWithItsVectors) {
  const SmallResult small;
  EXPECT_EQ(app::medianCase(of(small)), 2u);  // of 1, 3 and 2 mm
  const render::ArmScene scene = app::deflectionScene(of(small));
  ASSERT_EQ(scene.poses.size(), 1u);
  const render::ArmPose& pose = scene.poses[0];
  ASSERT_EQ(pose.joint_points.size(), 7u);
  ASSERT_EQ(pose.axis_directions.size(), 6u);
  ASSERT_TRUE(pose.wrist && pose.wrist->measured && pose.wrist->predicted);
  EXPECT_NEAR(pose.wrist->measured->z(), -2e-3, 1e-15);
  EXPECT_NEAR(pose.wrist->predicted->z(), -1.8e-3, 1e-15);  // DPP leaves a tenth
  ASSERT_EQ(pose.targets.size(), 3u);
  EXPECT_EQ(pose.targets[0].label, "P_{10}");
  EXPECT_NEAR(pose.targets[0].measured->z(), -4e-3, 1e-15);
  app::DeflectionScene drawn{2, scene};
  drawn.scene.magnification = 100;
  const std::string caption = app::describeDeflectionScene(of(small), drawn).caption;
  EXPECT_NE(caption.find("2.00\u00a0mm, magnified 100 times"), std::string::npos) << caption;
}

TEST(DeflectionScene, OfTwoStatesInOnePostureToOneScale) {
  // The second day moves by half as much, so that its median posture and its own scale would be others.
  const SmallResult first(campaign::DoubleEncoder::inactive), second(campaign::DoubleEncoder::active, 0.3);
  const auto scenes = app::deflectionScenes({of(first), of(second)});
  ASSERT_EQ(scenes.size(), 2u);
  ASSERT_TRUE(scenes[0] && scenes[1]);
  EXPECT_EQ(scenes[0]->load_case, 2u);
  EXPECT_EQ(scenes[1]->load_case, 2u);
  ASSERT_TRUE(scenes[0]->scene.magnification && scenes[1]->scene.magnification);
  EXPECT_EQ(*scenes[0]->scene.magnification, *scenes[1]->scene.magnification);
  EXPECT_EQ(scenes[0]->scene.residual_factor, scenes[1]->scene.residual_factor);
  EXPECT_LT(*scenes[1]->scene.magnification, render::automaticMagnification(app::deflectionScene(of(second))));
  EXPECT_TRUE(scenes[0]->as_in.empty());
  EXPECT_EQ(scenes[1]->as_in, "small");
  // Each makes room for the arrows of the other, so that both are drawn to one scale.
  EXPECT_FALSE(scenes[0]->scene.also_fitted.empty());
  EXPECT_FALSE(scenes[1]->scene.also_fitted.empty());
}

TEST(DeflectionScene, WithoutACommonPostureEachDayItsOwn) {
  const SmallResult first(campaign::DoubleEncoder::inactive);
  SmallResult second(campaign::DoubleEncoder::active, 0.3);
  second.campaign.pose_ids = {"D", "E", "F"};
  const auto scenes = app::deflectionScenes({of(first), of(second)});
  ASSERT_TRUE(scenes[0] && scenes[1]);
  EXPECT_TRUE(scenes[1]->as_in.empty());
  EXPECT_EQ(*scenes[1]->scene.magnification, render::automaticMagnification(app::deflectionScene(of(second))));
}

TEST(DeflectionScene, EveryJointPointIsOnItsAxis) {
  SmallResult small;
  identification::LoadCase& load_case = small.identification.cases[0];
  load_case.q_sagged = JointVector::Constant(6, 0.4);
  const render::ArmPose pose = app::armPose(of(small), 0, identification::Method::decoupled_partial_pose);
  for (int joint = 0; joint < 6; ++joint) {
    const metrology::Line axis =
        robot::axisAt(small.campaign.robot, identification::unloadedPosture(small.campaign.robot, load_case), joint);
    const Eigen::Vector3d off = pose.joint_points[static_cast<std::size_t>(joint)] - axis.point;
    EXPECT_LT(off.cross(axis.direction).norm(), 1e-12) << joint;  // rounding only
  }
}

TEST(DeflectionScene, TheFloorIsWhereTheRobotStands) {
  SmallResult small;
  small.identification.frames.arm.r0_from_base_link.translation() << 0, 0, -0.94;
  EXPECT_DOUBLE_EQ(app::heightOfR0(small.identification.frames), 0.94);
  const render::ArmPose pose = app::armPose(of(small), 0, identification::Method::decoupled_partial_pose);
  EXPECT_NEAR(pose.wrist->position.z(), 2.31 + 0.94, 1e-12);
}

TEST(AllPostures, GhostsWithTheWristsVectors) {
  const SmallResult small;
  const render::ArmScene scene = app::allPosturesScene(of(small));
  ASSERT_EQ(scene.poses.size(), 3u);
  for (const render::ArmPose& pose : scene.poses) {
    EXPECT_TRUE(pose.ghost);
    EXPECT_TRUE(pose.targets.empty());
    EXPECT_TRUE(pose.wrist.has_value());
  }
}

TEST(SubsetSpreads, APanelForEachJointThatIsSeen) {
  const SmallResult small;
  const render::SpreadChart chart = app::subsetSpreads(of(small), true);
  ASSERT_EQ(chart.methods.size(), 2u);
  ASSERT_EQ(chart.panels.size(), 5u);
  EXPECT_EQ(chart.panels[0].title, "k_{2}");
  ASSERT_TRUE(chart.panels[0].spreads[1].has_value());
  EXPECT_NEAR(chart.panels[0].spreads[1]->p50, 5.0, 1e-12);
  EXPECT_NEAR(chart.panels[0].spreads[1]->mean, (5.0 / 0.9 + 5.0 + 5.0 / 1.1) / 3.0, 1e-12);
  EXPECT_EQ(chart.panels[0].references[1], 5.6);  // the paper's DPP, active
  EXPECT_TRUE(app::subsetSpreads(of(small), false).panels[0].references.empty());
  const SmallResult undeclared(campaign::DoubleEncoder::unspecified);
  EXPECT_TRUE(app::subsetSpreads(of(undeclared), true).reference_name.empty());
}

TEST(StiffnessIntervals, ExpandedUncertaintyAndAGapForWhatIsNotSeen) {
  const SmallResult small;
  const render::IntervalChart chart = app::stiffnessIntervals(of(small));
  ASSERT_EQ(chart.series.size(), 2u);
  EXPECT_TRUE(std::isnan(chart.series[1].intervals[0].value));
  const render::Interval& second = chart.series[1].intervals[1];
  EXPECT_NEAR(second.value, 5e6, 1e-3);
  // The standard uncertainty is a tenth; t for one degree of freedom is 12.706 (tables give as many digits).
  EXPECT_NEAR(second.lower, 5e6 - 12.706 * 0.5e6, 500);
  EXPECT_NEAR(second.upper, 5e6 + 12.706 * 0.5e6, 500);
  EXPECT_TRUE(chart.series[0].intervals[3].doubtful);  // negative
  EXPECT_FALSE(chart.doubtful_name.empty());
}

TEST(StiffnessIntervals, ANegativeFitThatOnlySaysAtLeastIsDrawn) {
  SmallResult small;
  identification::StiffnessEstimate& estimate = small.method(identification::Method::partial_pose).estimate;
  for (int j = 0; j < 6; ++j) estimate.stated.push_back({estimate.compliance[j] - 1e-8, estimate.compliance[j] + 1e-8});
  estimate.stated[3].high = 1e-6;  // of a fit of -4e-6
  const render::IntervalChart chart = app::stiffnessIntervals(of(small));
  EXPECT_DOUBLE_EQ(chart.series[0].intervals[3].lower, 1e6);
  EXPECT_TRUE(std::isinf(chart.series[0].intervals[3].upper));
  EXPECT_NO_THROW(render::render(chart));
}

TEST(Figures, OfNegativeStiffnessesAloneThereIsNoLogarithmicAxis) {
  SmallResult small;
  for (const identification::Method method : identification::kMethods) {
    small.method(method).estimate.compliance = -small.method(method).estimate.compliance.cwiseAbs();
    small.method(method).estimate.covariance *= 1e-4;
  }
  reports::ReportContent content;
  content.campaigns.push_back(of(small));
  content.figures = app::makeFigures(content.campaigns);
  EXPECT_FALSE(content.figures.empty());
  for (const reports::Figure& figure : content.figures) EXPECT_NE(figure.id, "stiffness-intervals");
  const char* why = "There is no picture of the stiffnesses: none is positive";
  EXPECT_NE(page::reportPage(content).find(why), std::string::npos);
  const SmallResult usual;
  content.campaigns.clear();
  content.campaigns.push_back(of(usual));
  EXPECT_EQ(page::reportPage(content).find(why), std::string::npos);
}

TEST(Figures, OneThatCannotBeDrawnIsLeftOut) {
  render::IntervalChart chart;
  chart.categories = {"k_{1}"};
  chart.series = {{"CP", render::colours::kCp, {{5, 6, 7}}}};
  EXPECT_FALSE(app::drawnOrLeftOut({}, chart, {960, 560}));
  chart.series[0].intervals[0].lower = 4;
  EXPECT_TRUE(app::drawnOrLeftOut({}, chart, {960, 560}));
}

TEST(EncoderBars, BothStatesInMillimetres) {
  const SmallResult inactive(campaign::DoubleEncoder::inactive, 2.0), active(campaign::DoubleEncoder::active);
  const auto avoided = reports::avoidedByEncoders({of(inactive), of(active)});
  ASSERT_TRUE(avoided.has_value());
  const render::GroupedBarChart chart = app::encoderBars(*avoided);
  EXPECT_EQ(chart.series[0].values, (std::vector<double>{2.0, 6.0, 4.0}));
  EXPECT_EQ(chart.series[1].values, (std::vector<double>{1.0, 3.0, 2.0}));
  EXPECT_NE(app::describeEncoderBars(*avoided).caption.find("50.0\u00a0%"), std::string::npos);
}

TEST(Figures, NothingToDrawWithoutACase) {
  SmallResult small;
  small.identification.cases.clear();
  EXPECT_TRUE(app::makeFigures({of(small)}).empty());
}

TEST(Figures, APracticeCampaignFillsAPage) {
  const std::filesystem::path folder = STIFFSCOPE_SHARED_DIR "/practice/01";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the practice campaigns are not here";
  const campaign::Campaign campaign = campaign::readCampaign(folder).campaign;
  const identification::Identification identification = identification::identify(campaign);
  reports::ReportContent content;
  content.campaigns.push_back({campaign, identification});
  content.figures = app::makeFigures(content.campaigns);
  std::vector<std::string> ids;
  for (const reports::Figure& figure : content.figures) {
    ids.push_back(figure.id);
    EXPECT_EQ(figure.png[1], 'P');
    EXPECT_FALSE(figure.alt.empty());
    EXPECT_EQ(figure.alt.find("_{"), std::string::npos) << figure.alt;
  }
  EXPECT_EQ(ids, (std::vector<std::string>{"deflection", "all-postures", "compensation-bars", "compensation-zoom",
                                           "subset-spreads", "stiffness-intervals", "residuals", "circles",
                                           "wrist-sphere", "station-drift"}));
  EXPECT_LT(page::reportPage(content).size(), 5'000'000u);
  const render::GroupedBarChart chart = app::residualBars(content.campaigns[0]);
  EXPECT_EQ(chart.series.size(), 4u);
  EXPECT_DOUBLE_EQ(chart.series[0].values[3], 1e3 * identification.wrist_displacement[3]);
}

}  // namespace figures_test
}  // namespace stiffscope
