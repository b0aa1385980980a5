// The scene and the charts of the report's page: their data against the results, and, where chromium is installed, what
// it draws against the offscreen picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>

#include "app/figures/arm_scenes.h"
#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "reports/words/names.h"
#include "reports/words/rich_text.h"
#include "tests/app/browser.h"

namespace stiffscope {
namespace page_scene_test {

/// A report of the sample with joint springs alone, so that what is drawn is what identify computes.
class PageScene : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    const std::string sample = STIFFSCOPE_SOURCE_DIR "/samples/active";
    status_ =
        runProgram("report '" + sample + "' --springs-only --raw --out '" + out().string() + "'", scratch_->path())
            .status;
  }
  static void TearDownTestSuite() { delete scratch_; }
  void SetUp() override {
    ASSERT_EQ(status_, 0);
    page_ = contentsOf(out() / "report.html");
  }

  static std::filesystem::path out() { return scratch_->path() / "out"; }

  /// The text of the script of this class for this figure.
  nlohmann::json dataOf(const std::string& css_class, const std::string& figure) const {
    const std::string head = "class=\"" + css_class + "\" data-figure=\"" + figure + "\">";
    const std::size_t begin = page_.find(head);
    if (begin == std::string::npos) return {};
    const std::size_t end = page_.find("</script>", begin);
    return nlohmann::json::parse(page_.substr(begin + head.size(), end - begin - head.size()));
  }

  static inline ScratchFolder* scratch_ = nullptr;
  static inline int status_ = -1;
  std::string page_;
};

/// Cells of a CSV file without quotes that hold commas, a row each.
std::vector<std::map<std::string, std::string>> rowsOf(const std::filesystem::path& file) {
  std::istringstream lines(contentsOf(file));
  const auto cells = [](std::string line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> all;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) all.push_back(cell);
    return all;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> head = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = cells(line);
    for (std::size_t i = 0; i < std::min(head.size(), row.size()); ++i) {
      if (i == 0) rows.emplace_back();
      rows.back()[head[i]] = row[i];
    }
  }
  return rows;
}

TEST_F(PageScene, VectorsAreThoseOfTheResults) {
  const nlohmann::json scene = dataOf("scene", "deflection");
  if (scene.is_null()) GTEST_SKIP() << "built without libjs-three";
  int compared = 0;
  for (const auto& row : rowsOf(out() / "postures.csv")) {
    for (const nlohmann::json& frame : scene["frames"]) {
      if (frame["id"] != row.at("pose") || std::to_string(frame["step"].get<int>()) != row.at("step")) continue;
      for (const nlohmann::json& point : frame["points"]) {
        const bool wrist = point.value("wrist", false);
        if (wrist ? row.at("point") != "P_wrist" : point["label"] != reports::pointName(row.at("point"))) continue;
        for (int i = 0; i < 3; ++i) {
          // The scene has a hundredth of a micrometre. What is measured is in the swept frames, as the picture has it;
          // Partial Pose's rows are in its calibrated ones.
          if (row.at("method") != "pp")
            EXPECT_NEAR(point["m"][static_cast<std::size_t>(i)].get<double>(),
                        1e3 * std::stod(row.at(std::string("measured_") + "xyz"[i] + "_mm")), 0.0051);
          EXPECT_NEAR(point["p"][row.at("method")][static_cast<std::size_t>(i)].get<double>(),
                      1e3 * std::stod(row.at(std::string("predicted_") + "xyz"[i] + "_mm")), 0.0051);
          ++compared;
        }
      }
    }
  }
  EXPECT_GE(compared, 3 * 19 * 4 * 2);  // coordinates, postures, points, two methods at least
}

TEST_F(PageScene, AValueIsNamedByTheAxisOfItsOwnPanel) {
  // Residuals in several panels, and one of their norms over the noise. Names may have commas in them, the last column
  // has none.
  std::istringstream file(contentsOf(out() / "figure-residuals.csv"));
  std::string line;
  std::getline(file, line);
  const nlohmann::json chart = dataOf("marks", "residuals");
  ASSERT_FALSE(chart.is_null());
  std::map<std::string, int> found;
  for (std::size_t i = 0; std::getline(file, line); ++i) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    const std::string quantity = line.substr(line.rfind(',') + 1);
    ASSERT_LT(i, chart["marks"].size());
    EXPECT_EQ(chart["quantities"][chart["marks"][i][6].get<std::size_t>()], quantity);
    ++found[quantity];
  }
  EXPECT_EQ(found.size(), 2u);
  EXPECT_EQ(found["Residual / noise sd"], 3 * 19);  // reflectors, postures
  EXPECT_GE(found["Residual (µm)"], 3 * 3 * 19);
}

TEST_F(PageScene, MarksOfAChartAreItsValuesAtTheirPlaces) {
  const nlohmann::json chart = dataOf("marks", "compensation-bars");
  ASSERT_FALSE(chart.is_null());
  EXPECT_EQ(chart["categories"].size(), 19u);
  EXPECT_EQ(chart["marks"].size(), 19u * 4u);
  const auto rows = rowsOf(out() / "figure-compensation-bars.csv");
  ASSERT_EQ(rows.size(), chart["marks"].size());
  const cv::Mat picture = cv::imread((out() / "compensation-bars.png").string());
  ASSERT_EQ(picture.cols, 1920);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const nlohmann::json& mark = chart["marks"][i];
    EXPECT_NEAR(mark[4].get<double>(), std::stod(rows[i].at("value")), 1e-4 * std::abs(std::stod(rows[i].at("value"))));
    // A bar ends there: above its end is paper, a grid line or a whisker, below it its colour, which is none of them.
    const int x = static_cast<int>(mark[0].get<double>() * picture.cols),
              y = static_cast<int>(mark[1].get<double>() * picture.rows);
    const cv::Vec3b below = picture.at<cv::Vec3b>(std::min(y + 5, picture.rows - 1), x - 4);
    const cv::Vec3b above = picture.at<cv::Vec3b>(y - 5, x - 4);
    EXPECT_GT(cv::norm(below, above), 20.0) << "mark " << i << " at " << x << ", " << y;
  }
}

/// What the browser says of the scene, and its picture.
constexpr const char* kLook = R"js(<script>
addEventListener('load', async function () {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  for (let i = 0; i < 400 && !(window.stiffscopeScenes || []).length; ++i) await wait(25);
  const say = (text) => { const pre = document.createElement('pre'); pre.textContent = '@@' + text + '@@'; document.body.appendChild(pre); };
  const scene = window.stiffscopeScenes[0];
  if (!scene) return say(JSON.stringify({ none: document.getElementById('deflection').dataset.scene || 'no scene' }));
  scene.fixedWidth = 900; scene.fixedHeight = 600; scene.dark = false;
  scene.held = { centre: [1000, 0, 1200], high_mm: 3600 };
  scene.shown = { m: true, p: false, r: false, e: false };
  scene.draw();
  const spots = scene.frame.points.map((point) => [point.label, ...scene.spotOf(point.at)]);
  scene.direction = [-0.5, 0.85, -0.42].map((x) => x / Math.hypot(0.5, 0.85, 0.42));
  scene.draw();
  say(JSON.stringify({ magnification: scene.magnification, spots, picture: scene.canvas.toDataURL('image/png') }));
});
</script></body>)js";

/// What `script` says, between marks, in a copy of the page that the browser draws by software WebGL; null where it did
/// not run.
nlohmann::json saidWithWebGl(std::string page, const char* script, const std::filesystem::path& scratch) {
  page.replace(page.rfind("</body>"), 7, script);
  const auto copy = scratch / "look.html";
  std::ofstream(copy, std::ios::binary) << page;
  const Ran ran = runBrowserWithWebGl("--dump-dom 'file://" + copy.string() + "'", scratch);
  const std::size_t close = ran.out.rfind("@@"), open = ran.out.rfind("@@{", close);
  if (open == std::string::npos) return {};
  return nlohmann::json::parse(ran.out.substr(open + 2, close - open - 2), nullptr, false);
}

TEST_F(PageScene, IsDrawnAsTheOffscreenPictureIs) {
  if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
  const nlohmann::json seen = saidWithWebGl(page_, kLook, scratch_->path());
  if (!seen.is_object()) GTEST_SKIP() << "the browser did not run the page";
  if (seen.contains("none")) GTEST_SKIP() << seen["none"];
  const auto campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  const auto identified = identification::identify(campaign);
  render::ArmScene scene = app::deflectionScene({campaign, identified});
  scene.magnification = seen["magnification"].get<double>();
  scene.framing = render::SceneFraming{{1.0, 0.0, 1.2}, 3.6};
  for (render::ScenePoint& target : scene.poses.front().targets) target.predicted.reset(), target.residual.reset();
  if (scene.poses.front().wrist)
    scene.poses.front().wrist->predicted.reset(), scene.poses.front().wrist->residual.reset();
  const render::Image image = render::render(scene, {1200, 800});

  // Where the points stand in both gives scale and shift between the two; all points must agree.
  ASSERT_EQ(image.marks.size(), seen["spots"].size());
  const auto there = [&](std::size_t i) {
    return cv::Point2d(image.marks[i].x * image.width, image.marks[i].y * image.height);
  };
  const auto here = [&](std::size_t i) { return cv::Point2d(seen["spots"][i][1], seen["spots"][i][2]); };
  const std::size_t last = image.marks.size() - 1;
  const double scale = cv::norm(there(last) - there(0)) / cv::norm(here(last) - here(0));
  const cv::Point2d shift = there(0) - scale * here(0);
  for (std::size_t i = 0; i <= last; ++i)
    EXPECT_LT(cv::norm(there(i) - scale * here(i) - shift), 0.5) << seen["spots"][i][0];  // half a pixel

  const std::string url = seen["picture"];
  std::vector<std::uint8_t> png;
  unsigned bits = 0, count = 0;
  for (const char c : url.substr(url.find(',') + 1)) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t value = digits.find(c);
    if (value == std::string::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) >= 8) png.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
  }
  cv::Mat drawn = cv::imdecode(png, cv::IMREAD_COLOR), moved;
  ASSERT_FALSE(drawn.empty());
  const cv::Mat map = (cv::Mat_<double>(2, 3) << scale, 0, shift.x, 0, scale, shift.y);
  cv::warpAffine(drawn, moved, map, {image.width, image.height}, cv::INTER_AREA, cv::BORDER_CONSTANT, {255, 255, 255});
  cv::Mat offscreen;
  cv::cvtColor(cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data())), offscreen,
               cv::COLOR_RGB2BGR);
  // The arm itself: the parts of both that are darker than floor and paper, without words, which the page writes
  // elsewhere.
  const auto solid = [](const cv::Mat& picture) {
    cv::Mat grey, mask;
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    mask = grey < 222;
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, cv::Mat::ones(7, 7, CV_8U));  // letters and lines are thinner
    return mask;
  };
  const cv::Mat a = solid(moved), b = solid(offscreen);
  const double both = cv::countNonZero(a & b), either = cv::countNonZero(a | b);
  EXPECT_GT(either, 20000.0);      // it looked at an arm
  EXPECT_GT(both / either, 0.93);  // edges of 900 against 1200 pixels, labels' rims and the axes' arrows on the arm
  // And in the same colours where both have it, to the rounding of light at corners.
  cv::Mat difference;
  cv::absdiff(moved, offscreen, difference);
  const cv::Scalar mean = cv::mean(difference, a & b);
  EXPECT_LT((mean[0] + mean[1] + mean[2]) / 3.0, 8.0);
}

/// Marks a posture by a click in a chart, then steps on in the scene by its key; says what scene, tables and chart
/// show.
constexpr const char* kFollow = R"js(<script>
addEventListener('load', async function () {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  for (let i = 0; i < 400 && !(window.stiffscopeScenes || []).length; ++i) await wait(25);
  const say = (what) => { const pre = document.createElement('pre'); pre.textContent = '@@' + JSON.stringify(what) + '@@'; document.body.appendChild(pre); };
  const scene = window.stiffscopeScenes[0];
  if (!scene) return say({ none: document.getElementById('deflection').dataset.scene || 'no scene' });
  const shown = () => ({ posture: scene.frame.id, step: scene.frame.step, choice: scene.postures.value, status: scene.status.textContent,
    spots: scene.frame.points.map((point) => [point.label, ...point.at]), picture: scene.canvas.toDataURL('image/png'),
    rows: Array.from(new Set(Array.from(document.querySelectorAll('main tr.marked')).map((row) =>
      Array.from(row.cells).map((cell) => cell.textContent.trim()).find((text) => text === scene.frame.id) || 'another'))) });
  const said = { before: shown() };
  const chart = window.stiffscopeCharts.find((one) => one.hasPostures);
  const i = chart.data.marks.findIndex((mark) => mark[3] >= 0 && chart.categories[mark[3]] !== scene.frame.id);
  chart.layer.scrollIntoView({ block: 'center' });
  const box = chart.layer.getBoundingClientRect(), mark = chart.data.marks[i];
  const clientX = box.left + mark[0] * box.width, clientY = box.top + mark[1] * box.height;
  for (const type of ['pointermove', 'click'])
    document.elementFromPoint(clientX, clientY).dispatchEvent(new PointerEvent(type, { clientX, clientY, bubbles: true }));
  said.clicked = chart.categories[chart.data.marks[chart.under][3]];
  said.after_click = shown();
  scene.canvas.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
  said.after_key = shown();
  say(said);
});
</script></body>)js";

TEST_F(PageScene, FollowsAClickInAChartAndChartsFollowIt) {
  if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
  const nlohmann::json said = saidWithWebGl(page_, kFollow, scratch_->path());
  if (!said.is_object()) GTEST_SKIP() << "the browser did not run the page";
  if (said.contains("none")) GTEST_SKIP() << said["none"];
  const nlohmann::json &before = said["before"], &clicked = said["after_click"], &stepped = said["after_key"];
  EXPECT_EQ(before["rows"].dump(), "[]");  // nothing is marked at first
  EXPECT_NE(clicked["posture"], before["posture"]);
  EXPECT_EQ(clicked["posture"], said["clicked"]);
  EXPECT_EQ(clicked["step"], before["step"]);  // another posture, the same load
  EXPECT_NE(stepped["posture"], clicked["posture"]);
  const nlohmann::json scene = dataOf("scene", "deflection");
  for (const nlohmann::json* one : {&clicked, &stepped}) {
    const std::string posture = one->at("posture");
    EXPECT_EQ(one->at("choice"), posture);
    EXPECT_NE(one->at("status").get<std::string>().find("posture " + posture + " ("), std::string::npos);
    EXPECT_EQ(one->at("rows"), nlohmann::json::array({posture}));  // the marked rows are all of this posture
    const auto frame = std::find_if(scene["frames"].begin(), scene["frames"].end(), [&](const nlohmann::json& any) {
      return any["id"] == posture && any["step"] == one->at("step");
    });
    ASSERT_NE(frame, scene["frames"].end());
    nlohmann::json places = nlohmann::json::array();
    for (const nlohmann::json& point : (*frame)["points"])
      places.push_back({point["label"], point["at"][0], point["at"][1], point["at"][2]});
    EXPECT_EQ(one->at("spots"), places);
  }
  // And it is drawn: three postures, three pictures.
  EXPECT_NE(clicked["picture"], before["picture"]);
  EXPECT_NE(stepped["picture"], clicked["picture"]);
}

/// Points at every chart, marks a posture by a click and by another takes the mark off, filters; says what came of it.
/// Events go to what lies under the pointer, so that a chart that something covers does not answer.
constexpr const char* kAsk = R"js(<script>
addEventListener('load', function () {
  const charts = window.stiffscopeCharts || [], said = { charts: [], wrong: [] };
  const at = (chart, i) => {
    const mark = chart.data.marks[i], box = chart.layer.getBoundingClientRect();
    return [box.left + mark[0] * box.width, box.top + mark[1] * box.height];
  };
  const send = (chart, i, type) => {
    chart.layer.scrollIntoView({ block: 'center' });
    const [clientX, clientY] = at(chart, i), under = document.elementFromPoint(clientX, clientY);
    if (under !== chart.layer) said.wrong.push(chart.figure.id + ' is covered by ' + (under && under.outerHTML.slice(0, 60)));
    else under.dispatchEvent(new PointerEvent(type, { clientX, clientY, bubbles: true }));
  };
  // Whether a ring of this colour is drawn about a mark.
  const ringed = (chart, i) => {
    const scale = chart.layer.width / chart.layer.getBoundingClientRect().width, mark = chart.data.marks[i];
    if (!chart.copy) {
      chart.copy = Object.assign(document.createElement('canvas'), { width: chart.layer.width, height: chart.layer.height });
      chart.copy.getContext('2d', { willReadFrequently: true }).drawImage(chart.layer, 0, 0);
    }
    const pen = chart.copy.getContext('2d');
    return [[7, 0], [-7, 0], [0, 7], [0, -7]].some(([dx, dy]) => {
      const [r, g, b, a] = pen.getImageData(mark[0] * chart.layer.width + scale * dx, mark[1] * chart.layer.height + scale * dy, 1, 1).data;
      return a > 128 && r > 200 && g > 140 && g < 190 && b < 90;
    });
  };
  for (const chart of charts) {
    const i = Math.floor(chart.data.marks.length / 3);
    send(chart, i, 'pointermove');
    // Another mark may lie nearer to the pointer by a rounding; which one answered is part of the answer.
    said.charts.push({ id: chart.figure.id, hidden: chart.tip.hidden, tip: chart.tip.textContent, mark: chart.under, asked: i });
    chart.layer.dispatchEvent(new PointerEvent('pointerleave'));
    if (!chart.tip.hidden) said.wrong.push(chart.figure.id + ' keeps its tip');
  }
  const rows = (test) => Array.from(document.querySelectorAll('main tbody tr')).filter(test);
  const cellsOf = (row) => Array.from(row.cells).map((cell) => cell.textContent.trim());
  const first = charts.find((chart) => chart.hasPostures), chosen = 2 * Math.floor(first.data.marks.length / 4);
  send(first, chosen, 'pointermove');
  const posture = first.categories[first.data.marks[first.under][3]];
  send(first, chosen, 'click');
  first.layer.dispatchEvent(new PointerEvent('pointerleave'));
  said.posture = posture;
  said.marked_rows = rows((row) => row.classList.contains('marked')).map(cellsOf);
  said.ringed = 0;
  for (const chart of charts) {
    if (!chart.hasPostures) continue;
    chart.data.marks.forEach((mark, i) => {
      const own = chart.categories[mark[3]] === posture;
      if (own && ringed(chart, i)) ++said.ringed;
      else if (own) said.wrong.push(chart.figure.id + ': a mark of the posture has no ring');
    });
  }
  send(first, chosen, 'pointermove');
  send(first, chosen, 'click');
  said.marked_after = rows((row) => row.classList.contains('marked')).length;
  const input = document.querySelector('nav input[type=search]');
  const filtered = (text) => {
    input.value = text;
    input.dispatchEvent(new Event('input'));
    return rows((row) => row.classList.contains('filtered')).every((row) => getComputedStyle(row).display === 'none');
  };
  said.hidden_by_posture = filtered(posture);
  said.left_by_posture = rows((row) => row.closest('table').querySelector('tr.filtered') && !row.classList.contains('filtered')).map(cellsOf);
  said.hidden_by_reflector = filtered('P11');
  said.left_by_reflector = rows((row) => row.closest('table').querySelector('tr.filtered') && !row.classList.contains('filtered')).map(cellsOf);
  filtered('');
  said.filtered_after = rows((row) => row.classList.contains('filtered')).length;
  said.live = document.querySelectorAll('figure.live').length;
  said.pictures = Array.from(document.querySelectorAll('figure img')).map((image) => {
    const box = image.getBoundingClientRect();
    return [image.closest('figure').id, box.left + scrollX, box.top + scrollY, box.width, box.height];
  });
  const pre = document.createElement('pre');
  pre.textContent = '@@' + JSON.stringify(said) + '@@';
  document.body.appendChild(pre);
});
</script></body>)js";

struct Answers {
  nlohmann::json said;
  std::string console;
};

/// What a page without WebGL answers to kAsk.
Answers asked(std::string page, const std::filesystem::path& scratch) {
  page.replace(page.rfind("</body>"), 7, kAsk);
  const auto copy = scratch / "ask.html";
  std::ofstream(copy, std::ios::binary) << page;
  const Ran ran =
      runBrowser("--disable-3d-apis --window-size=1400,1000 --dump-dom 'file://" + copy.string() + "'", scratch);
  const std::size_t close = ran.out.rfind("@@"), open = ran.out.rfind("@@{", close);
  if (open == std::string::npos) return {{}, writtenToConsole(ran.err)};
  std::string text = ran.out.substr(open + 2, close - open - 2);
  for (const auto& [entity, letter] : {std::pair("&lt;", "<"), std::pair("&gt;", ">"), std::pair("&amp;", "&")})
    for (std::size_t at = text.find(entity); at != std::string::npos; at = text.find(entity))
      text.replace(at, std::string(entity).size(), letter);
  return {nlohmann::json::parse(text, nullptr, false), writtenToConsole(ran.err)};
}

/// A rich text as the page shows it.
std::string shown(const std::string& rich) { return reports::plain(rich); }

/// `data_of` gives the marks of a chart by its id, as they stand in the page.
void expectAnswers(const Answers& answers, const std::function<nlohmann::json(const std::string&)>& data_of) {
  EXPECT_EQ(answers.console, "");
  const nlohmann::json& said = answers.said;
  ASSERT_TRUE(said.is_object());
  EXPECT_EQ(said["wrong"].dump(), "[]");
  for (const nlohmann::json& chart : said["charts"]) {
    SCOPED_TRACE(chart.dump());
    const nlohmann::json data = data_of(chart["id"]);
    ASSERT_FALSE(chart["hidden"].get<bool>());
    const nlohmann::json& mark = data["marks"][chart["mark"].get<std::size_t>()];
    const nlohmann::json& asked_for = data["marks"][chart["asked"].get<std::size_t>()];
    for (const std::size_t way : {0u, 1u})  // a shared place at most: a thousandth of the figure
      EXPECT_NEAR(mark[way].get<double>(), asked_for[way].get<double>(), 1e-3);
    const std::string tip = chart["tip"];
    EXPECT_EQ(std::stod(tip.substr(tip.rfind(": ") + 2)), mark[4].get<double>());
    EXPECT_NE(tip.find(shown(data["series"][mark[2].get<std::size_t>()])), std::string::npos);
    const std::string category = shown(data["category"]);
    if (mark[3].get<int>() >= 0) {
      const std::string name = shown(data["categories"][mark[3].get<std::size_t>()]);
      EXPECT_NE(tip.find(category.empty() ? name : category + " " + name), std::string::npos);
    }
  }
  const std::string posture = said["posture"];
  EXPECT_GT(said["marked_rows"].size(), 0u);
  for (const nlohmann::json& row : said["marked_rows"])
    EXPECT_NE(std::find(row.begin(), row.end(), posture), row.end()) << row.dump();
  EXPECT_GT(said["ringed"], 1);
  EXPECT_EQ(said["marked_after"], 0);
  EXPECT_TRUE(said["hidden_by_posture"].get<bool>());
  EXPECT_GT(said["left_by_posture"].size(), 0u);
  for (const nlohmann::json& row : said["left_by_posture"])
    EXPECT_NE(std::find(row.begin(), row.end(), posture), row.end()) << row.dump();
  EXPECT_TRUE(said["hidden_by_reflector"].get<bool>());
  for (const nlohmann::json& row : said["left_by_reflector"])
    EXPECT_NE(std::find(row.begin(), row.end(), "P11"), row.end()) << row.dump();
  EXPECT_EQ(said["filtered_after"], 0);
}

TEST_F(PageScene, ChartsAnswerAndThePictureStandsWithoutWebGlOrScript) {
  if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
  const Answers answers = asked(page_, scratch_->path());
  expectAnswers(answers, [&](const std::string& id) { return dataOf("marks", id); });
  ASSERT_TRUE(answers.said.is_object());
  EXPECT_GE(answers.said["charts"].size(), 6u);
  EXPECT_GT(answers.said["left_by_reflector"].size(), 0u);
  // The chart of residuals names posture and reflector.
  const auto residuals = std::find_if(answers.said["charts"].begin(), answers.said["charts"].end(),
                                      [](const nlohmann::json& chart) { return chart["id"] == "residuals"; });
  ASSERT_NE(residuals, answers.said["charts"].end());
  EXPECT_NE(residuals->at("tip").get<std::string>().find("P1"), std::string::npos);
  EXPECT_NE(residuals->at("tip").get<std::string>().find("Posture "), std::string::npos);

  EXPECT_EQ(answers.said["live"], 0);
  cv::Rect place;
  for (const nlohmann::json& picture : answers.said["pictures"]) {
    if (picture[0] == "deflection")
      // Within its border of a pixel; a browser sets pictures on whole pixels.
      place = cv::Rect(cv::Point(cvRound(picture[1].get<double>() + 1), cvRound(picture[2].get<double>() + 1)),
                       cv::Size(cvRound(picture[3].get<double>() - 2), cvRound(picture[4].get<double>() - 2)));
  }
  ASSERT_GT(place.width, 400);
  std::string silent = page_;  // the browser runs no script of it
  silent.insert(silent.find("<head>") + 6,
                "<meta http-equiv=\"Content-Security-Policy\" content=\"script-src 'none'\">");
  const auto copy = scratch_->path() / "silent.html", shot = scratch_->path() / "without-script.png";
  std::ofstream(copy, std::ios::binary) << silent;
  runBrowser("--window-size=1400,1400 --screenshot='" + shot.string() + "' 'file://" + copy.string() + "'",
             scratch_->path());
  const cv::Mat screen = cv::imread(shot.string());
  ASSERT_FALSE(screen.empty());
  ASSERT_EQ(place & cv::Rect(0, 0, screen.cols, screen.rows), place);  // on the first screen
  cv::Mat picture, difference;
  cv::resize(cv::imread((out() / "deflection.png").string()), picture, place.size(), 0, 0, cv::INTER_AREA);
  cv::absdiff(screen(place), picture, difference);
  const cv::Scalar mean = cv::mean(difference);
  EXPECT_LT((mean[0] + mean[1] + mean[2]) / 3.0, 4.0);  // another way to scale, a pixel's shift; without a picture 15
}

TEST_F(PageScene, ChartsOfTheComparePageAnswer) {
  if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
  const auto& scratch = scratch_->path();
  for (const char* day : {"inactive", "active"})
    ASSERT_EQ(runProgram(std::string("identify '" STIFFSCOPE_SOURCE_DIR "/samples/") + day +
                             "' --springs-only --json '" + (scratch / day).string() + ".json'",
                         scratch)
                  .status,
              0);
  const auto file = scratch / "compare.html";
  const Ran ran = runProgram("compare '" + (scratch / "inactive.json").string() + "' '" +
                                 (scratch / "active.json").string() + "' --html '" + file.string() + "'",
                             scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
  page_ = contentsOf(file);
  const Answers answers = asked(page_, scratch);
  expectAnswers(answers, [&](const std::string& id) { return dataOf("marks", id); });
  ASSERT_TRUE(answers.said.is_object());
  EXPECT_GE(answers.said["charts"].size(), 2u);
}

}  // namespace page_scene_test
}  // namespace stiffscope
