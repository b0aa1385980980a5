#include <gtest/gtest.h>

#ifndef STIFFSCOPE_VIEW_BINARY

TEST(ViewWindow, IsNotBuilt) { GTEST_SKIP() << "stiffscope-view or the XTest library is not here"; }

#else

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include "app/view/view_material.h"
#include "core/campaign/read_campaign.h"
#include "tests/app/view_session.h"

namespace stiffscope {
namespace view_window_test {

const std::string kActive = STIFFSCOPE_SOURCE_DIR "/samples/active";

#define NEED_XVFB(display) \
  if ((display).name().empty()) GTEST_SKIP() << "Xvfb is not here"

// Solids are shaded, so colours are told by their hue: how far one channel stands above the others.
cv::Mat channel(const cv::Mat& picture, int which) {
  cv::Mat one;
  cv::extractChannel(picture, one, which);
  one.convertTo(one, CV_32S);
  return one;
}
cv::Mat redOf(const cv::Mat& p) { return (channel(p, 2) - channel(p, 1) > 70) & (channel(p, 2) - channel(p, 0) > 70); }
cv::Mat blueOf(const cv::Mat& p) { return (channel(p, 0) - channel(p, 2) > 60) & (channel(p, 0) - channel(p, 1) > 40); }
cv::Mat greenOf(const cv::Mat& p) {
  return (channel(p, 1) - channel(p, 2) > 60) & (channel(p, 1) - channel(p, 0) > 20);
}
cv::Mat amberOf(const cv::Mat& p) {
  return (channel(p, 2) - channel(p, 0) > 100) & (channel(p, 1) - channel(p, 0) > 60);
}

/// The scene without the legend above it and the scale and status below.
cv::Mat sceneOf(const cv::Mat& picture) { return picture.rowRange(90, picture.rows - 60); }

int count(const cv::Mat& mask) { return cv::countNonZero(mask); }

cv::Point2d centreOf(const cv::Mat& mask) {
  const cv::Moments m = cv::moments(mask, true);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

/// The same pictures as the window shows, as data.
app::ViewFrame frameAt(const std::string& pose) {
  static const campaign::Campaign campaign = campaign::readCampaign(kActive).campaign;
  app::ViewOptions options;
  options.pose = pose;
  const app::OpenedMaterial opened = app::openMaterial(campaign, options);
  return opened.by_method.front().frames[opened.first];
}

// From the side a parallel projection is (a + s x, b - s z). The wrist centre, amber, in two postures gives
// a, s and b; the vector's place follows from the campaign's numbers alone.
TEST(ViewWindow, DrawsTheMeasuredVectorAtItsPlaceAndAllObeyTheirKeys) {
  const VirtualDisplay display;
  NEED_XVFB(display);
  const ScratchFolder scratch;
  ViewSession window(display.name(),
                     {kActive, "--view", "side", "--pose", "5", "--magnification", "60", "--size", "1000", "700"},
                     scratch.path());
  ASSERT_TRUE(window.opened());
  EXPECT_NE(window.title().find("posture 5, load step 3"), std::string::npos) << window.title();
  const auto darkAtTheRight = [&] {  // letters of the list of keys
    cv::Mat dark;
    cv::inRange(window.picture().colRange(800, 1000), cv::Scalar(0, 0, 0), cv::Scalar(90, 90, 90), dark);
    return count(dark);
  };
  EXPECT_GT(darkAtTheRight(), 1000);
  window.press("h");
  EXPECT_LT(darkAtTheRight(), 300);

  const cv::Mat all = sceneOf(window.picture());
  EXPECT_GT(count(redOf(all)), 100);
  EXPECT_GT(count(blueOf(all)), 100);
  EXPECT_GT(count(greenOf(all)), 30);
  window.press("r");
  EXPECT_EQ(count(greenOf(sceneOf(window.picture()))), 0);
  window.press("p");
  EXPECT_EQ(count(blueOf(sceneOf(window.picture()))), 0);

  const app::ViewFrame frame = frameAt("5"), other = frameAt("6");
  const cv::Mat here = window.picture();
  const cv::Point2d wrist = centreOf(amberOf(here));
  const int red_once = count(redOf(sceneOf(here)));
  window.press("Right");
  EXPECT_NE(window.title().find("posture 6, load step 3"), std::string::npos) << window.title();
  const cv::Point2d other_wrist = centreOf(amberOf(window.picture()));
  const render::ScenePoint& point = *frame.scene.poses[0].wrist;
  const Eigen::Vector3d apart = other.scene.poses[0].wrist->position - point.position;
  const double scale = (other_wrist.x - wrist.x) / apart.x();
  EXPECT_NEAR(other_wrist.y - wrist.y, -scale * apart.z(), 2);  // pixels: centres of shaded balls
  const auto at = [&](double share) {
    const Eigen::Vector3d v = 60 * share * *point.measured;
    return cv::Point(cv::saturate_cast<int>(wrist.x + scale * v.x()), cv::saturate_cast<int>(wrist.y - scale * v.z()));
  };
  EXPECT_NE(redOf(here).at<std::uint8_t>(at(0.7)), 0) << at(0.7);
  EXPECT_EQ(redOf(here).at<std::uint8_t>(at(1.3)), 0) << at(1.3);

  window.press("Left");
  EXPECT_EQ(count(redOf(sceneOf(window.picture()))), red_once) << "the same picture again";
  window.press("m");
  EXPECT_EQ(count(redOf(sceneOf(window.picture()))), 0);
  window.press("q");
  EXPECT_EQ(window.ended().status, 0);
}

TEST(ViewWindow, MagnificationDoublesArrowsAndClickingReadsNumbers) {
  const VirtualDisplay display;
  NEED_XVFB(display);
  const ScratchFolder scratch;
  ViewSession window(display.name(),
                     {kActive, "--view", "side", "--pose", "5", "--magnification", "80", "--size", "1000", "700"},
                     scratch.path());
  ASSERT_TRUE(window.opened());
  window.press("h");
  window.press("p");
  window.press("r");
  const auto lengthNow = [&] {  // from the wrist centre to the lowest tip below it, which is that of its own arrow
    const cv::Mat now = window.picture();
    const cv::Point2d wrist = centreOf(amberOf(now));
    cv::Mat column = redOf(now).colRange(static_cast<int>(wrist.x) - 6, static_cast<int>(wrist.x) + 7);
    column.rowRange(0, static_cast<int>(wrist.y)).setTo(0);
    column.rowRange(now.rows - 60, now.rows).setTo(0);
    const cv::Rect extent = cv::boundingRect(column);
    return extent.br().y - wrist.y;
  };
  const double once = lengthNow();
  EXPECT_GT(once, 5);
  window.press("plus", true);
  EXPECT_NE(window.title().find("vectors \u00d7 160"), std::string::npos) << window.title();
  EXPECT_NEAR(lengthNow(), 2 * once, 2);  // pixels: edges of both arrows
  window.press("minus");
  EXPECT_NEAR(lengthNow(), once, 1);
  window.press("m");  // the wrist centre is hidden by nothing now

  const cv::Point2d wrist = centreOf(amberOf(window.picture()));
  window.click({static_cast<int>(wrist.x), static_cast<int>(wrist.y)});
  const std::string said = window.out();
  const app::ViewFrame frame = frameAt("5");
  const Eigen::Vector3d mm = 1e3 * *frame.scene.poses[0].wrist->measured;
  char expected[100];
  std::snprintf(expected, sizeof expected, "%9.4f %9.4f %9.4f", mm.x(), mm.y(), mm.z());
  EXPECT_NE(said.find("Pwrist, posture 5, load step 3"), std::string::npos) << said;
  EXPECT_NE(said.find(expected), std::string::npos) << said << "expected" << expected;

  window.press("Down");
  EXPECT_NE(window.title().find("load step 2"), std::string::npos) << window.title();
  window.press("s");
  const cv::Mat saved = cv::imread((scratch.path() / "stiffscope-posture-5-step-2.png").string());
  EXPECT_EQ(saved.size(), cv::Size(1000, 700));
  window.press("q");
  const Ran ran = window.ended();
  EXPECT_EQ(ran.status, 0);
  EXPECT_TRUE(ran.err.empty()) << ran.err;
}

TEST(ViewWindow, TurnsZoomsAndComesBack) {
  const VirtualDisplay display;
  NEED_XVFB(display);
  const ScratchFolder scratch;
  ViewSession window(display.name(), {kActive, "--size", "1000", "700"}, scratch.path());
  ASSERT_TRUE(window.opened());
  const cv::Mat first = window.picture();
  const auto differs = [&] { return cv::norm(first, window.picture(), cv::NORM_INF) > 0; };
  window.drag({400, 400}, {480, 440});
  EXPECT_TRUE(differs());
  window.press("0");
  EXPECT_FALSE(differs());
  const int amber = count(amberOf(first));
  for (int i = 0; i < 3; ++i) window.wheel({400, 400}, true);
  EXPECT_TRUE(differs());
  window.press("3");
  EXPECT_TRUE(differs());
  window.press("4");
  EXPECT_FALSE(differs()) << amber;
  window.press("b");
  EXPECT_LT(cv::mean(window.picture())[0], 80) << "dark paper";
  window.close();
  EXPECT_EQ(window.ended().status, 0);
}

Ran runView(const std::string& words, const std::string& display, const std::filesystem::path& scratch) {
  const std::string out = (scratch / "stdout").string(), err = (scratch / "stderr").string();
  const std::string set = display.empty() ? "env -u DISPLAY" : "env DISPLAY=" + display;
  const int raw =
      std::system((set + " '" STIFFSCOPE_VIEW_BINARY "' " + words + " >'" + out + "' 2>'" + err + "'").c_str());
  return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, contentsOf(out), contentsOf(err)};
}

TEST(ViewWindow, WrongWordsAndNoDisplayAreOneLineAndStatusTwo) {
  const ScratchFolder scratch;
  const std::pair<std::string, std::string> cases[] = {
      {"'" + kActive + "'", "no display to open a window on: DISPLAY is not set"},
      {"'" + kActive + "' --magnificaton 3", "did you mean '--magnification'?"},
      {"'" + kActive + "' --magnification -3", "expected a number above 0"},
      {"'" + kActive + "' --view frnt", "did you mean 'front'?"},
      {"", "CAMPAIGN"},
  };
  for (const auto& [words, hint] : cases) {
    const Ran ran = runView(words, "", scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(hint), std::string::npos) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
  for (const char* words : {"--help", "--version"}) EXPECT_EQ(runView(words, "", scratch.path()).status, 0) << words;
}

/// samples/active without these elements of its campaign.xml.
std::filesystem::path campaignWithout(const std::vector<std::string>& elements, const std::filesystem::path& scratch) {
  const std::filesystem::path folder = scratch / "campaign";
  std::filesystem::remove_all(folder);
  std::filesystem::copy(kActive, folder);
  std::istringstream lines(contentsOf(folder / "campaign.xml"));
  std::ofstream left(folder / "campaign.xml.new");
  for (std::string line; std::getline(lines, line);) {
    const bool out = std::any_of(elements.begin(), elements.end(),
                                 [&](const std::string& name) { return line.find("<" + name) != std::string::npos; });
    if (!out) left << line << '\n';
  }
  left.close();
  std::filesystem::rename(folder / "campaign.xml.new", folder / "campaign.xml");
  return folder;
}

TEST(ViewWindow, ScreenshotsOfLoadsAndOfSweepsAlone) {
  const VirtualDisplay display;
  NEED_XVFB(display);
  const ScratchFolder scratch;
  const std::string shot = (scratch.path() / "shot.png").string();
  const Ran whole = runView("'" + kActive + "' --screenshot '" + shot + "' --size 800 600 --point P10", display.name(),
                            scratch.path());
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(whole.out.rfind("P10, posture ", 0), 0u) << whole.out;
  const cv::Mat loads = cv::imread(shot);
  ASSERT_EQ(loads.size(), cv::Size(800, 600));
  EXPECT_GT(count(blueOf(sceneOf(loads))), 50);

  const auto sweeps_only = campaignWithout({"states", "loading", "load_cell"}, scratch.path());
  const Ran sweeps =
      runView("'" + sweeps_only.string() + "' --screenshot '" + shot + "'", display.name(), scratch.path());
  ASSERT_EQ(sweeps.status, 0) << sweeps.err;
  const cv::Mat circles = cv::imread(shot);
  EXPECT_GT(count(redOf(sceneOf(circles))), 300) << "readings of a sweep";
  EXPECT_EQ(count(blueOf(sceneOf(circles))), 0);

  const auto nothing =
      campaignWithout({"states", "loading", "load_cell", "circle_sweeps", "wrist_sweep"}, scratch.path());
  const Ran refused = runView("'" + nothing.string() + "'", display.name(), scratch.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("nothing to show"), std::string::npos) << refused.err;

  const Ran posture = runView("'" + kActive + "' --pose 99", display.name(), scratch.path());
  EXPECT_EQ(posture.status, 2);
  EXPECT_NE(posture.err.find("not a posture of this campaign"), std::string::npos) << posture.err;
}

}  // namespace view_window_test
}  // namespace stiffscope

#endif
