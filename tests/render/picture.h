#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>
#include "render/colours.h"
#include "render/image.h"

namespace stiffscope {

/// A picture as a reader of the report gets it: through the PNG file. Channels blue, green, red.
inline cv::Mat decoded(const render::Image& image) { return cv::imdecode(render::encodePng(image), cv::IMREAD_COLOR); }

inline cv::Mat maskOf(const cv::Mat& picture, render::Colour colour) {
  cv::Mat mask;
  const cv::Scalar bgr(colour.blue, colour.green, colour.red);
  cv::inRange(picture, bgr, bgr, mask);
  return mask;
}

/// Everything that is not white paper.
inline cv::Mat inkOf(const cv::Mat& picture) {
  cv::Mat paper;
  cv::inRange(picture, cv::Scalar(250, 250, 250), cv::Scalar(255, 255, 255), paper);
  return ~paper;
}

/// The connected pieces of exactly this colour, from left to right, without specks (letters of the same
/// colour).
inline std::vector<cv::Rect> piecesOf(const cv::Mat& mask, int least_area = 20) {
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 4);
  std::vector<cv::Rect> pieces;
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < least_area) continue;
    pieces.emplace_back(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                        stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
  }
  std::sort(pieces.begin(), pieces.end(), [](const cv::Rect& a, const cv::Rect& b) { return a.x < b.x; });
  return pieces;
}

/// Ink on the outermost pixels means that something was cut off.
inline void expectNothingClipped(const cv::Mat& picture) {
  const cv::Mat ink = inkOf(picture);
  EXPECT_EQ(cv::countNonZero(ink.row(0)), 0) << "top";
  EXPECT_EQ(cv::countNonZero(ink.row(ink.rows - 1)), 0) << "bottom";
  EXPECT_EQ(cv::countNonZero(ink.col(0)), 0) << "left";
  EXPECT_EQ(cv::countNonZero(ink.col(ink.cols - 1)), 0) << "right";
}

}  // namespace stiffscope
