// Whole figures of the samples against pictures kept in tests/app/baselines, and what new figures show.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/quality/qualityssim.hpp>
#include "app/figures/figures.h"
#include "core/campaign/read_campaign.h"

namespace stiffscope {
namespace page_pictures_test {

/// The sample with the double encoders active, and its figures.
struct Sample {
  campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  identification::Identification identification = identification::identify(campaign);
  reports::ReportCampaign report{campaign, identification};
};

const Sample& sample() {
  static const Sample one;
  return one;
}

/// Structural similarity above which two pictures are the same but for their edges, which another version of a
/// font or of VTK moves by a fraction of a pixel; a series that is missing is seen (TheLimitTellsThemApart).
constexpr double kAlike = 0.97;

TEST(WholeFigures, LookAsTheyDid) {
  const std::filesystem::path kept = STIFFSCOPE_SOURCE_DIR "/tests/app/baselines";
  const auto figures = app::makeFigures({sample().report});
  for (const char* id : {"compensation-bars", "stiffness-intervals", "residuals", "circles", "station-drift"}) {
    SCOPED_TRACE(id);
    const auto figure =
        std::find_if(figures.begin(), figures.end(), [id](const reports::Figure& f) { return f.id == id; });
    ASSERT_NE(figure, figures.end());
    cv::Mat drawn = cv::imdecode(figure->png, cv::IMREAD_GRAYSCALE);
    cv::resize(drawn, drawn, {}, 0.25, 0.25, cv::INTER_AREA);  // of twice the pixels
    const cv::Mat baseline = cv::imread((kept / (std::string(id) + ".png")).string(), cv::IMREAD_GRAYSCALE);
    const bool same_size = baseline.size() == drawn.size();
    cv::Mat map;
    const double similarity = same_size ? cv::quality::QualitySSIM::compute(drawn, baseline, map)[0] : 0.0;
    EXPECT_GT(similarity, kAlike);
    if (similarity > kAlike) continue;
    const std::filesystem::path beside = STIFFSCOPE_TEST_OUTPUT "/pictures";
    std::filesystem::create_directories(beside);
    cv::imwrite((beside / (std::string(id) + "-candidate.png")).string(), drawn);
    if (same_size) {
      cv::Mat difference;
      cv::absdiff(drawn, baseline, difference);
      cv::imwrite((beside / (std::string(id) + "-difference.png")).string(), 255 - difference);
    }
    ADD_FAILURE() << "candidate and difference are in " << beside << "; a change that is meant goes to " << kept;
  }
}

TEST(WholeFigures, TheLimitTellsThemApart) {
  render::PointChart chart = *app::residualDirections(sample().report);
  const auto grey = [](const render::PointChart& one, double shift = 0.0) {
    const render::Image image = render::render(one);
    const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
    cv::Mat half;
    cv::cvtColor(rgb, half, cv::COLOR_RGB2GRAY);
    const cv::Mat moved = (cv::Mat_<double>(2, 3) << 1, 0, shift, 0, 1, shift);
    if (shift != 0.0) cv::warpAffine(half.clone(), half, moved, half.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::resize(half, half, {}, 0.5, 0.5, cv::INTER_AREA);
    return half;
  };
  const cv::Mat whole = grey(chart);
  cv::Mat map;
  EXPECT_GT(cv::quality::QualitySSIM::compute(whole, grey(chart, 0.2), map)[0], kAlike);  // edges moved
  for (render::PointPanel& panel : chart.diagrams) panel.series.pop_back();
  EXPECT_LT(cv::quality::QualitySSIM::compute(whole, grey(chart), map)[0], kAlike);
}

double rmsOfY(const render::PointPanel& panel) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const render::PointSeries& series : panel.series) {
    if (series.joined) continue;  // the line of means
    for (const render::PlotPoint& point : series.points) sum += point.y * point.y, ++count;
  }
  return std::sqrt(sum / static_cast<double>(count));
}

TEST(ResidualDirections, TheSquaresAddUpToThoseOfTheFit) {
  // Directions are turned axes: the squares over the three are those over x, y and z, which the fit states.
  const auto chart = app::residualDirections(sample().report);
  ASSERT_TRUE(chart.has_value());
  ASSERT_EQ(chart->diagrams.size(), 6u);
  double square = 0.0;
  for (std::size_t d = 0; d < 3; ++d) square += std::pow(rmsOfY(chart->diagrams[d]), 2) / 3.0;
  const identification::Identification& shown = sample().identification;
  const double stated = 1e6 * shown.of(identification::bestMethod(shown)).estimate.rms_residual;
  EXPECT_NEAR(std::sqrt(square), stated, 1e-6 * stated);  // rounding
}

TEST(WristSphere, ResidualsAreThoseOfTheFit) {
  const auto chart = app::wristSphere(sample().report, app::rigidSweeps(sample().report));
  ASSERT_TRUE(chart.has_value());
  const double stated = 1e6 * sample().identification.frames.wrist.spheres.rms;
  // The sag is taken off by the stiffnesses of the last round, in the fit by those of the round before: 1e-4 of it.
  EXPECT_NEAR(rmsOfY(chart->diagrams[0]), stated, 0.02 * stated);
}

TEST(SweepCircles, APanelAnAxisWithAScaleThatIsSaid) {
  const auto chart = app::sweepCircles(sample().report, app::rigidSweeps(sample().report));
  ASSERT_TRUE(chart.has_value());
  ASSERT_EQ(chart->shapes.size(), 6u);
  for (const render::ShapePanel& panel : chart->shapes) {
    EXPECT_GT(panel.scale_bar, 0.0);
    EXPECT_EQ(panel.series.size(), 6u);  // ring and readings of three reflectors
    for (const render::PointSeries& series : panel.series) {
      for (const render::PlotPoint& point : series.points) EXPECT_LT(std::hypot(point.x, point.y), 1.2);
    }
  }
}

TEST(StationDrift, ARoundThatMovedStandsWhereItMoved) {
  campaign::Campaign moved = sample().campaign;
  const double last = moved.nests->rows.back().time_s;
  for (campaign::NestReading& reading : moved.nests->rows) {
    if (reading.time_s > last - 60.0) reading.point += Eigen::Vector3d(-0.5e-3, 0.0, 0.0);
  }
  const preparation::StationMotion station = app::stationMotionOf(moved);
  const auto chart = app::stationDrift({moved, sample().identification}, station);
  ASSERT_TRUE(chart.has_value());
  // Readings that went by -0.5 mm are brought back by +0.5 mm, to the nests' noise over the lever to the arm.
  EXPECT_NEAR(chart->diagrams[0].series[0].points.back().y, 500.0, 60.0);
  EXPECT_NE(app::describeStationDrift(station).caption.find("more than noise explains"), std::string::npos);
}

TEST(NewFigures, NothingToShowWithoutItsData) {
  campaign::Campaign bare = sample().campaign;
  bare.nests.reset();
  bare.circle_sweeps.reset();
  bare.wrist_sweep.reset();
  const reports::ReportCampaign report{bare, sample().identification};
  EXPECT_FALSE(app::sweepCircles(report, {}).has_value());
  EXPECT_FALSE(app::wristSphere(report, {}).has_value());
  EXPECT_FALSE(app::stationDrift(report, app::stationMotionOf(bare)).has_value());
}

}  // namespace page_pictures_test
}  // namespace stiffscope
