// Figures in the report's page: each is itself by its id, scenes have the postures that captions name, charts and
// scenes answer. What needs a browser is skipped where chromium is not installed.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/app/browser.h"

namespace stiffscope {
namespace page_figures_test {

/// The pages of one campaign each: a loaded day, by joint springs alone, and one without a load.
class PageFigures : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    for (const char* day : {"active", "unloaded"}) {
      const std::string words = std::string("report '" STIFFSCOPE_SOURCE_DIR "/samples/") + day +
                                "' --springs-only --raw --out '" + out(day).string() + "'";
      status_ = std::max(status_, runProgram(words, scratch_->path()).status);
    }
  }
  static void TearDownTestSuite() { delete scratch_; }
  void SetUp() override { ASSERT_EQ(status_, 0); }

  static std::filesystem::path out(const std::string& day) { return scratch_->path() / day; }
  static std::string pageOf(const std::string& day) { return contentsOf(out(day) / "report.html"); }

  /// What `script` says between marks in a copy of the page; null where it did not run.
  static nlohmann::json said(const std::string& day, const std::string& script, bool by_webgl) {
    std::string page = pageOf(day);
    page.replace(page.rfind("</body>"), 7, "<script>" + script + "</script></body>");
    const auto copy = scratch_->path() / "copy.html";
    std::ofstream(copy, std::ios::binary) << page;
    const std::string words = "--dump-dom 'file://" + copy.string() + "'";
    const Ran ran = by_webgl ? runBrowserWithWebGl(words, scratch_->path())
                             : runBrowser("--disable-3d-apis --window-size=1400,1000 " + words, scratch_->path());
    const std::size_t close = ran.out.rfind("@@"), open = ran.out.rfind("@@{", close);
    if (open == std::string::npos) return {};
    return nlohmann::json::parse(ran.out.substr(open + 2, close - open - 2), nullptr, false);
  }

  static inline ScratchFolder* scratch_ = nullptr;
  static inline int status_ = 0;
};

TEST_F(PageFigures, NoIdOccursTwice) {
  for (const char* day : {"active", "unloaded"}) {
    std::string page = pageOf(day);
    page.resize(page.find("<script"));  // ids of elements, not of data
    std::map<std::string, int> ids;
    // Not a regular expression over the whole page: pictures in it are megabytes without a blank.
    for (std::size_t at = page.find(" id=\""); at != std::string::npos; at = page.find(" id=\"", at + 1)) {
      const std::size_t begin = at + 5;
      ++ids[page.substr(begin, page.find('"', begin) - begin)];
    }
    EXPECT_GT(ids.size(), 15u);  // it looked at something
    for (const auto& [name, count] : ids) EXPECT_EQ(count, 1) << name << " in the page of " << day;
  }
}

/// The postures that captions name, "of P10 in posture 100", and where the scene of that page has them.
TEST_F(PageFigures, ThePosturesThatCaptionsNameAreInTheScene) {
  const std::string page = pageOf("unloaded");
  const std::string head = "class=\"scene\" data-figure=\"accuracy-before\">";
  const std::size_t begin = page.find(head);
  if (begin == std::string::npos) GTEST_SKIP() << "built without libjs-three";
  const std::size_t end = page.find("</script>", begin);
  const auto scene = nlohmann::json::parse(page.substr(begin + head.size(), end - begin - head.size()));
  EXPECT_EQ(scene["postures"], 100);
  EXPECT_LT(scene["frames"].size(), 100u);
  std::vector<std::string> named;
  const std::regex in_posture("in posture ([^ .;]+)");
  for (std::size_t at = page.find("<figcaption"); at != std::string::npos; at = page.find("<figcaption", at + 1)) {
    const std::string caption = page.substr(at, page.find("</figcaption>", at) - at);
    for (std::sregex_iterator i(caption.begin(), caption.end(), in_posture), last; i != last; ++i)
      named.push_back((*i)[1]);
  }
  ASSERT_GE(named.size(), 2u);
  for (const std::string& posture : named) {
    const bool there = std::any_of(scene["frames"].begin(), scene["frames"].end(),
                                   [&](const nlohmann::json& frame) { return frame["id"] == posture; });
    EXPECT_TRUE(there) << posture;
  }
  EXPECT_EQ(page.find("The same as the figure before, to the same scale"), std::string::npos);
}

constexpr const char* kAskFilter = R"js(
addEventListener('load', function () {
  const input = document.querySelector('nav input[type=search]'), says = document.querySelector('.unknown');
  const hidden = () => document.querySelectorAll('main tr.filtered').length;
  const type = (word) => {
    input.value = word;
    input.dispatchEvent(new Event('input'));
    return { hidden: hidden(), says: says ? says.textContent : 'nothing' };
  };
  const said = { known: type('P11'), unknown: type('zzz'), none: type('') };
  said.figures = (window.stiffscopeCharts || []).map((chart) => [chart.figure.tagName, chart.figure.id,
    chart.figure.querySelectorAll('button.csv').length]);
  const pre = document.createElement('pre');
  pre.textContent = '@@' + JSON.stringify(said) + '@@';
  document.body.appendChild(pre);
});)js";

TEST_F(PageFigures, AnUnknownWordEmptiesNoTableAndEveryChartIsItsOwnFigures) {
  if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
  const nlohmann::json answers = said("active", kAskFilter, false);
  if (!answers.is_object()) GTEST_SKIP() << "the browser did not run the page";
  EXPECT_GT(answers["known"]["hidden"], 0);
  EXPECT_EQ(answers["known"]["says"], "");
  EXPECT_EQ(answers["unknown"]["hidden"], 0);
  EXPECT_EQ(answers["unknown"]["says"], "no posture or reflector is called \u201czzz\u201d");
  EXPECT_EQ(answers["none"]["says"], "");
  EXPECT_GE(answers["figures"].size(), 6u);
  for (const nlohmann::json& figure : answers["figures"]) {
    EXPECT_EQ(figure[0], "FIGURE") << figure.dump();
    EXPECT_EQ(figure[2], 1) << figure.dump();
  }
}

constexpr const char* kAskScene = R"js(
addEventListener('load', async function () {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  for (let i = 0; i < 300 && !(window.stiffscopeScenes || []).length; ++i) await wait(25);
  const say = (what) => {
    const pre = document.createElement('pre');
    pre.textContent = '@@' + JSON.stringify(what) + '@@';
    document.body.appendChild(pre);
  };
  const scene = window.stiffscopeScenes[0];
  if (!scene) return say({ none: 'no scene' });
  const caption = scene.figure.querySelector('figcaption');
  const words = () => (caption.querySelector('.now') || { textContent: '' }).textContent;
  const said = { first: words() };
  scene.stepPosture(1);
  said.next = words();
  said.posture = scene.frame.where;
  scene.stepPosture(-1);
  said.back = words();
  const high = () => {
    const spots = scene.frame.joints.map((joint) => scene.spotOf(joint)[1]);
    return (Math.max(...spots) - Math.min(...spots)) / scene.height;
  };
  said.arm = high();
  scene.magnification *= 1000;  // as one bad reading would be drawn
  scene.draw();
  said.arm_beside_long_vectors = high();
  say(said);
});)js";

TEST_F(PageFigures, TheCaptionSaysWhatTheSceneShowsAndTheArmStaysLarge) {
  if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
  const nlohmann::json answers = said("active", kAskScene, true);
  if (!answers.is_object()) GTEST_SKIP() << "the browser did not run the page";
  if (answers.contains("none")) GTEST_SKIP() << answers["none"];
  EXPECT_EQ(answers["first"], "");
  const std::string next = answers["next"];
  EXPECT_NE(next.find("In the scene now: " + answers["posture"].get<std::string>() + ","), std::string::npos) << next;
  EXPECT_NE(next.find("mm, of P"), std::string::npos) << next;
  EXPECT_EQ(answers["back"], "");
  EXPECT_GT(answers["arm"], 0.3);
  EXPECT_GT(answers["arm_beside_long_vectors"], 0.25);
}

TEST_F(PageFigures, NoPictureIsStretchedInPrint) {
  if (!installed("chromium") || !installed("pdfimages")) GTEST_SKIP() << "chromium or poppler-utils is not installed";
  const std::string pdf = (scratch_->path() / "report.pdf").string();
  runBrowser(
      "--no-pdf-header-footer --print-to-pdf='" + pdf + "' 'file://" + (out("active") / "report.html").string() + "'",
      scratch_->path());
  const Ran ran = runShell("pdfimages -list '" + pdf + "'", scratch_->path());
  std::istringstream lines(ran.out);
  std::string line;
  int pictures = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::vector<std::string> row;
    for (std::string word; words >> word;) row.push_back(word);
    if (row.size() < 14 || row[2] != "image") continue;
    ++pictures;
    const double across = std::stod(row[12]), down = std::stod(row[13]);  // dots an inch
    EXPECT_NEAR(across / down, 1.0, 0.02) << line;
  }
  EXPECT_GT(pictures, 5) << ran.out << ran.err;
}

}  // namespace page_figures_test
}  // namespace stiffscope
