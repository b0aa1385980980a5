// What holds for all pictures: no display, same bytes, letters, fonts, threads.
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include "render/grouped_bar_chart.h"
#include "tests/render/picture.h"

namespace stiffscope {
namespace offscreen_test {

render::GroupedBarChart titled(const std::string& title) {
  render::GroupedBarChart chart;
  chart.title = title;
  chart.y_title = "k (10\u2076 Nm/rad)";
  chart.categories = {"1", "2"};
  chart.series = {{"", render::colours::kDpp, {1, 2}, {}}};
  return chart;
}

TEST(Offscreen, NeedsNoDisplay) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  EXPECT_NO_THROW(render::render(titled("no display")));
}

TEST(Offscreen, SameInputGivesSameBytes) {
  const auto first = render::encodePng(render::render(titled("twice")));
  render::render(titled("something else in between"), {640, 480});
  EXPECT_EQ(first, render::encodePng(render::render(titled("twice"))));
}

TEST(Offscreen, SeveralThreadsMayDraw) {
  const auto expected = render::encodePng(render::render(titled("thread")));
  std::vector<std::uint8_t> a, b;
  std::thread first([&a] { a = render::encodePng(render::render(titled("thread"))); });
  std::thread second([&b] { b = render::encodePng(render::render(titled("thread"))); });
  first.join();
  second.join();
  EXPECT_EQ(a, expected);
  EXPECT_EQ(b, expected);
}

TEST(Offscreen, TitleIsInkAtTheTopLeft) {
  const cv::Rect place(0, 0, 200, 45);
  EXPECT_GT(cv::countNonZero(inkOf(decoded(render::render(titled("Displacement"))))(place)), 500);
  // Without a title the plot moves up, but its tick labels stay left of it: what is gone is the title's ink.
  const cv::Mat title = decoded(render::render(titled("Displacement")))(cv::Rect(16, 14, 150, 26));
  EXPECT_GT(cv::countNonZero(maskOf(title, render::colours::kInk)), 200);
}

TEST(Offscreen, GreekLettersAreLetters) {
  // A font without them would draw the same empty box for both.
  const cv::Mat theta = decoded(render::render(titled("\u03b8"))), mu = decoded(render::render(titled("\u03bc")));
  const cv::Rect place(10, 8, 40, 40);
  EXPECT_GT(cv::norm(theta(place), mu(place), cv::NORM_L1), 5000);
}

TEST(Offscreen, SubscriptIsLowerAndSmaller) {
  const cv::Rect place(10, 5, 60, 50);
  const auto sub = piecesOf(inkOf(decoded(render::render(titled("P_{P}")))(place)), 10);
  ASSERT_GE(sub.size(), 2u);
  EXPECT_GT(sub[1].br().y, sub[0].br().y + 2);
  EXPECT_LT(sub[1].height, sub[0].height);
}

TEST(Offscreen, YTitleStandsUprightAtTheLeft) {
  const cv::Mat picture = decoded(render::render(titled("upright")));
  cv::Mat strip = inkOf(picture)(cv::Rect(10, 100, 28, 500)).clone();
  cv::dilate(strip, strip, cv::getStructuringElement(cv::MORPH_RECT, {9, 15}));
  const auto words = piecesOf(strip, 400);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_GT(words[0].height, 3 * words[0].width);
}

TEST(Offscreen, TwiceTheSizeIsTheSamePicture) {
  const cv::Mat small = decoded(render::render(titled("scale"), {1200, 700}));
  cv::Mat large = decoded(render::render(titled("scale"), {2400, 1400}));
  cv::resize(large, large, small.size(), 0, 0, cv::INTER_AREA);
  cv::Mat difference;
  cv::absdiff(small, large, difference);
  // Fonts are hinted and edges rounded to pixels, so letters and edges differ a little; nothing moves.
  EXPECT_LT(cv::mean(difference)[0], 1.0);
}

TEST(Offscreen, LettersGrowWithoutThePicture) {
  // 960 x 560 are 0.8 of 1200 x 700, so that letters 1.25 times as large are those of the larger picture.
  const render::Image small = render::render(titled("H"), {960, 560, false, 1.25});
  EXPECT_EQ(small.width, 960);
  const cv::Rect place(10, 8, 40, 40);
  const auto heightOf = [&](const render::Image& image) {
    const auto letters = piecesOf(inkOf(decoded(image)(place)), 10);
    return letters.empty() ? 0 : letters.front().height;
  };
  const int large = heightOf(render::render(titled("H"), {1200, 700}));
  EXPECT_GT(large, 14);
  EXPECT_NEAR(heightOf(small), large, 1);  // edges are rounded to pixels
  EXPECT_LT(heightOf(render::render(titled("H"), {960, 560})), large - 2);
}

TEST(Offscreen, MissingFontIsSaid) {
  setenv("STIFFSCOPE_FONTS", "/nonexistent/fonts", 1);
  try {
    render::render(titled("no font"));
    ADD_FAILURE() << "drew without a font";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no DejaVuSans.ttf and DejaVuSans-Bold.ttf in /nonexistent/fonts"),
              std::string::npos)
        << error.what();
  }
  unsetenv("STIFFSCOPE_FONTS");
  EXPECT_NO_THROW(render::render(titled("font")));
}

TEST(Offscreen, LongTextsAreBrokenOrCut) {
  std::string text;
  for (int i = 0; i < 40; ++i) text += "a long title ";
  render::GroupedBarChart chart = titled(text.substr(0, 200));
  chart.subtitle = std::string(300, 'x');
  chart.y_title = text.substr(0, 120);
  chart.category_title = text;
  chart.series[0].name = std::string(300, 'y');
  expectNothingClipped(decoded(render::render(chart)));
}

TEST(Png, IsSmallAndTrue) {
  const render::Image image = render::render(titled("png"));
  const auto bytes = render::encodePng(image);
  EXPECT_LT(bytes.size(), 300'000u);
  const cv::Mat picture = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ASSERT_EQ(picture.size(), cv::Size(image.width, image.height));
  for (const cv::Point p : {cv::Point(0, 0), cv::Point(25, 25), cv::Point(600, 400), cv::Point(1199, 699)}) {
    const cv::Vec3b bgr = picture.at<cv::Vec3b>(p);
    const std::uint8_t* rgb = image.at(p.x, p.y);
    EXPECT_EQ(cv::Vec3b(rgb[2], rgb[1], rgb[0]), bgr);
  }
}

TEST(Png, RefusesBytesThatDoNotFit) {
  EXPECT_THROW(render::encodePng({2, 2, std::vector<std::uint8_t>(11), {}}), std::invalid_argument);
  EXPECT_THROW(render::encodePng({}), std::invalid_argument);
}

}  // namespace offscreen_test
}  // namespace stiffscope
