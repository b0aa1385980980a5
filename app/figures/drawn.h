#pragma once

#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "app/output.h"
#include "render/arm_scene.h"
#include "render/dot_row_chart.h"
#include "render/grouped_bar_chart.h"
#include "render/image.h"
#include "render/interval_chart.h"
#include "render/point_chart.h"
#include "render/spread_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// What the axes of a chart say; of a scene nothing.
template <class Picture>
void nameAxes(const Picture& picture, reports::Figure& figure) {
  if constexpr (requires { picture.category_title; }) {
    figure.value_name = picture.y_title;
    figure.category_name = picture.category_title;
  } else if constexpr (requires { picture.diagrams; }) {
    if (picture.diagrams.empty()) return;
    figure.value_name = picture.diagrams.front().y_title;
    figure.category_name = picture.diagrams.back().x_title;
  } else if constexpr (requires { picture.rows; }) {
    figure.value_name = picture.x_title;
  } else if constexpr (requires {
                         picture.panels;
                         picture.methods;
                       }) {
    figure.value_name = picture.y_title;
    figure.category_name = "Joint";
  }
}

/// The figure with its picture, twice the pixels each way, and with the values that stand in it.
template <class Picture>
reports::Figure drawn(reports::Figure figure, const Picture& picture, render::Size size) {
  size.doubled = true;
  render::Image image = render::render(picture, size);
  nameAxes(picture, figure);
  if constexpr (!std::is_same_v<Picture, render::ArmScene>) {  // that has no values
    for (render::Mark& mark : image.marks) {
      if (mark.quantity.empty()) mark.quantity = figure.value_name;
      figure.marks.push_back({mark.x, mark.y, std::move(mark.series), std::move(mark.category), mark.value,
                              mark.category_at, std::move(mark.quantity)});
    }
  }
  figure.png = render::encodeSmallPng(image);
  figure.width = image.width;
  figure.height = image.height;
  return figure;
}

/// The same; none, with a warning, where the renderer refuses what is to be drawn: a report without one of its figures
/// serves better than none.
template <class Picture>
std::optional<reports::Figure> drawnOrLeftOut(const reports::Figure& figure, const Picture& picture,
                                              render::Size size) {
  try {
    return drawn(figure, picture, size);
  } catch (const std::invalid_argument& refused) {
    printWarnings({fmt::format("figure '{}' is left out: {}", figure.title, refused.what())});
    return std::nullopt;
  }
}

}  // namespace stiffscope::app
