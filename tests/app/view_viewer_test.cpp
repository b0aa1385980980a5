#include <gtest/gtest.h>
#include "app/view/view_material.h"
#include "app/view/viewer.h"
#include "core/campaign/read_campaign.h"
#include "core/identification/remarks.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace view_viewer_test {

/// Three postures under one step of the result made by hand, and what the viewer asks of its window.
struct Hand {
  SmallResult small;
  std::string said;
  std::vector<render::View> looked;
  bool closed = false;

  Hand() {
    for (int pose = 0; pose < 3; ++pose) {
      for (const int step : {0, 1}) {
        campaign::State state(6);
        state.pose = pose;
        state.step = step;
        states.rows.push_back(state);
      }
    }
    small.campaign.states = states;
    for (identification::LoadCase& load_case : small.identification.cases) {
      load_case.step = 1;
      load_case.pose = static_cast<int>(&load_case - small.identification.cases.data());
    }
  }

  app::Viewer viewer(std::vector<std::optional<identification::Method>> methods =
                         {identification::Method::decoupled_partial_pose, identification::Method::partial_pose},
                     std::optional<double> magnification = std::nullopt) {
    std::vector<app::ViewMaterial> by_method;
    for (const auto& method : methods) {
      const auto asked = method ? std::vector{*method} : std::vector<identification::Method>{};
      by_method.push_back(app::loadMaterials(small.campaign, small.identification, asked).front());
    }
    app::ViewWindow window;
    window.look = [this](render::View view) { looked.push_back(view); };
    window.turn = [](double, double) {};
    window.zoom = [](double) {};
    window.save = [](const std::string& name) { return "saved " + name + ".png"; };
    window.close = [this] { closed = true; };
    window.say = [this](const std::string& text) { said += text; };
    return app::Viewer(std::move(by_method), 0, magnification, window);
  }

  campaign::States states;
};

TEST(Viewer, StepsThroughThePosturesAndAroundTheEnd) {
  Hand hand;
  app::Viewer viewer = hand.viewer();
  std::vector<std::string> seen;
  for (int i = 0; i < 4; ++i) {
    seen.push_back(viewer.status().substr(0, 18));
    viewer.press("Right");
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"posture A (1 of 3)", "posture B (2 of 3)", "posture C (3 of 3)",
                                            "posture A (1 of 3)"}));
  viewer.press("Left");
  viewer.press("Left");
  EXPECT_EQ(viewer.status().rfind("posture C", 0), 0u) << viewer.status();
}

TEST(Viewer, KeysTakeVectorsAwayAndBringThemBack) {
  Hand hand;
  app::Viewer viewer = hand.viewer();
  const auto wrist = [&] { return *viewer.scene().poses[0].wrist; };
  EXPECT_TRUE(wrist().measured && wrist().predicted && wrist().residual);
  viewer.press("m");
  EXPECT_FALSE(wrist().measured);
  EXPECT_TRUE(wrist().predicted);
  viewer.press("p");
  viewer.press("r");
  EXPECT_FALSE(wrist().predicted || wrist().residual);
  viewer.press("0");
  EXPECT_TRUE(wrist().measured && wrist().predicted && wrist().residual);
  EXPECT_EQ(hand.looked, std::vector<render::View>{render::View::oblique});
  viewer.press("s");
  EXPECT_EQ(viewer.scene().note, "saved posture-A-step-1.png");
  viewer.press("q");
  EXPECT_TRUE(hand.closed);
}

TEST(Viewer, MagnificationDoublesAndComesBackToWhatSuits) {
  Hand hand;
  app::Viewer viewer = hand.viewer({identification::Method::decoupled_partial_pose}, 30.0);
  viewer.press("plus");
  EXPECT_EQ(viewer.scene().magnification, 60.0);
  viewer.press("minus");
  viewer.press("minus");
  EXPECT_EQ(viewer.scene().magnification, 15.0);
  viewer.press("a");
  EXPECT_EQ(viewer.scene().magnification, render::automaticMagnification(viewer.scene()));
  EXPECT_GT(*viewer.scene().magnification, 15.0);
}

TEST(Viewer, ResidualIsMeasuredLessPredictedByEachMethod) {
  Hand hand;
  app::Viewer viewer = hand.viewer();
  EXPECT_NEAR(viewer.scene().poses[0].wrist->residual->z(), -0.1e-3, 1e-15);  // DPP leaves a tenth of 1 mm
  viewer.press("n");
  EXPECT_NE(viewer.status().find("predicted by PP"), std::string::npos);
  // PP's c_2 stands in the estimate as DPP's does; its rows leave a fifth.
  EXPECT_NEAR(viewer.scene().poses[0].wrist->residual->z(), -0.2e-3, 1e-15);
}

TEST(Viewer, PickedPointSaysItsNumbersAndStaysPickedFromPostureToPosture) {
  Hand hand;
  app::Viewer viewer = hand.viewer();
  viewer.pick(3);  // three targets, then P_wrist
  EXPECT_EQ(hand.said,
            "Pwrist, posture A, load step 1, 1.00\u00a0kN, force 0.0 0.0 -1000.0 N\n"
            "  measured     0.0000    0.0000   -1.0000  length 1.0000 mm\n"
            "  predicted    0.0000    0.0000   -0.9000  length 0.9000 mm\n"
            "  residual     0.0000    0.0000   -0.1000  length 0.1000 mm\n");
  viewer.press("Right");
  ASSERT_EQ(viewer.scene().panels.size(), 2u);  // its numbers, and the keys
  EXPECT_EQ(viewer.scene().panels[0].title, "P_{wrist} in posture B");
  EXPECT_EQ(viewer.scene().panels[0].rows[1].cells[4], "3.000");
  EXPECT_TRUE(viewer.scene().picked);
  viewer.pick(std::nullopt);
  EXPECT_FALSE(viewer.scene().picked);
  viewer.press("h");
  EXPECT_TRUE(viewer.scene().panels.empty());
}

TEST(Viewer, WithoutAModelTheMeasuredVectorsStay) {
  Hand hand;
  hand.small.method(identification::Method::partial_pose).reason = Remark(identification::RemarkId::no_joint_turned);
  app::Viewer viewer = hand.viewer({std::nullopt});
  const render::ScenePoint wrist = *viewer.scene().poses[0].wrist;
  EXPECT_TRUE(wrist.measured);
  EXPECT_FALSE(wrist.predicted || wrist.residual);
  EXPECT_NE(viewer.status().find("nothing is predicted: the load turns no joint"), std::string::npos);
}

struct IdentifiedDay {
  campaign::Campaign campaign;
  identification::Identification identified;
};

/// samples/active, identified once for all tests here, without its subsets.
const IdentifiedDay& identifiedSample() {
  static const IdentifiedDay day = [] {
    IdentifiedDay made{campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign, {}};
    identification::IdentifyOptions options;
    options.subsets.most_all = 0;
    options.subsets.sample = 1;
    made.identified = identification::identify(made.campaign, options);
    return made;
  }();
  return day;
}

// Under the step it was identified from, another step's way of working must give the same.
TEST(LoadStep, TheIdentifiedStepComesOutAgain) {
  const auto& [campaign, identified] = identifiedSample();
  const identification::Identification again = app::underLoadStep(campaign, identified, identified.step);
  ASSERT_EQ(again.cases.size(), identified.cases.size());
  for (const identification::Method method : identification::kMethods) {
    ASSERT_EQ(again.of(method).available, identified.of(method).available);
    const JointVector& compliance = identified.of(method).estimate.compliance;
    for (std::size_t i = 0; i < again.cases.size(); ++i) {
      const Eigen::VectorXd before = identified.of(method).target_rows[i].matrix * compliance;
      const Eigen::VectorXd now = again.of(method).target_rows[i].matrix * compliance;
      // The rounds of K_c end at a millionth of a deflection of millimetres.
      EXPECT_LT((before - now).cwiseAbs().maxCoeff(), 1e-8) << i;
    }
  }
}

// The springs are linear: under another step the prediction goes with the force, but for K_c (below a
// hundredth).
TEST(LoadStep, PredictionGoesWithTheLoad) {
  const auto& [campaign, identified] = identifiedSample();
  const identification::Identification lighter = app::underLoadStep(campaign, identified, 1);
  ASSERT_EQ(lighter.cases.size(), identified.cases.size());
  const identification::MethodResult& method = identified.of(identification::Method::decoupled_partial_pose);
  for (std::size_t i = 0; i < lighter.cases.size(); ++i) {
    ASSERT_EQ(lighter.cases[i].pose, identified.cases[i].pose);
    const double share = lighter.cases[i].wrench.force.norm() / identified.cases[i].wrench.force.norm();
    EXPECT_LT(share, 0.9);
    const Eigen::VectorXd full = method.target_rows[i].matrix * method.estimate.compliance;
    const Eigen::VectorXd less =
        lighter.of(identification::Method::decoupled_partial_pose).target_rows[i].matrix * method.estimate.compliance;
    EXPECT_LT((less - share * full).norm(), 0.02 * full.norm()) << i;
  }
}

// What a page of a long day shows is the same as of all, and nothing else is made.
TEST(LoadMaterials, OfSomePosturesAreThoseOfAll) {
  const auto& [campaign, identified] = identifiedSample();
  const std::vector<identification::Method> methods{identification::Method::partial_pose,
                                                    identification::Method::decoupled_partial_pose};
  const auto all = app::loadMaterials(campaign, identified, methods);
  const auto some = app::loadMaterials(campaign, identified, methods, [](int posture) { return posture % 5 == 2; });
  ASSERT_EQ(all.size(), 2u);
  ASSERT_EQ(some.size(), 2u);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    EXPECT_EQ(some[m].method, all[m].method);
    std::size_t next = 0;
    for (const app::ViewFrame& frame : all[m].frames) {
      if (frame.posture % 5 != 2) continue;
      ASSERT_LT(next, some[m].frames.size());
      const app::ViewFrame& same = some[m].frames[next++];
      EXPECT_EQ(same.name, frame.name);
      const auto &here = same.scene.poses.front().targets, &there = frame.scene.poses.front().targets;
      ASSERT_EQ(here.size(), there.size());
      for (std::size_t t = 0; t < here.size(); ++t) EXPECT_EQ(*here[t].predicted, *there[t].predicted);
    }
    EXPECT_EQ(next, some[m].frames.size());
    EXPECT_LT(next, all[m].frames.size());
  }
}

TEST(SweepMaterial, EachAxisWithItsReadingsOnTheArm) {
  const campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  const frames::Frames frames = frames::measureFrames(campaign);
  const app::ViewMaterial material = app::sweepMaterial(campaign, frames);
  ASSERT_EQ(material.frames.size(), 6u);
  for (const app::ViewFrame& frame : material.frames) {
    std::size_t readings = 0;
    for (const render::SceneTrace& trace : frame.scene.traces) {
      if (!trace.faint) readings += trace.points.size();
    }
    const auto& rows = campaign.circle_sweeps->rows;
    EXPECT_EQ(readings,
              static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](const campaign::CircleReading& one) {
                return one.axis == frame.posture;
              })));
    // A reflector is on the tool: at the middle of its sweep less than a metre from the flange.
    const render::SceneTrace* own = nullptr;
    for (const render::SceneTrace& trace : frame.scene.traces) {
      if (!trace.faint && own == nullptr) own = &trace;
    }
    ASSERT_NE(own, nullptr);
    const Eigen::Vector3d flange = frame.scene.poses[0].joint_points.back();
    EXPECT_LT((own->points[own->points.size() / 2] - flange).norm(), 1.0);
  }
}

TEST(SweepMaterial, SaysWhyThereIsNothing) {
  campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  campaign.circle_sweeps.reset();
  const app::ViewMaterial material = app::sweepMaterial(campaign, frames::measureFrames(campaign));
  EXPECT_TRUE(material.frames.empty());
  EXPECT_NE(material.lacking.find("neither loads nor circle sweeps"), std::string::npos);
}

}  // namespace view_viewer_test
}  // namespace stiffscope
