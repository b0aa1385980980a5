#include "render/vtk/category_frame.h"

namespace stiffscope {

void drawInCategoryFrame(Canvas& canvas, const CategoryFrame& frame,
                         const std::function<void(const Box& plot, const YAxis& axis)>& draw) {
  const double u = canvas.unit();
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, frame.title, frame.subtitle);
  takeLegend(canvas, free, frame.legend);
  takeNote(canvas, free, frame.note);
  const double title_left = free.left;
  const std::vector<std::string> y_title = takeYTitle(canvas, free, frame.y_title);

  YAxis axis = frame.axis(free.height() - 60 * u);
  Box plot = free;
  plot.left = Canvas::snapped(plot.left + tickLabelWidth(canvas, axis));
  const CategoryLabels labels =
      fitCategoryLabels(canvas, frame.categories, plot.width() / static_cast<double>(frame.categories.size()),
                        0.25 * free.height());
  plot.bottom -=
      labels.height + 10 * u + (frame.category_title.empty() ? 0 : 1.2 * axisTitleStyle(canvas).size);
  drawYTitle(canvas, title_left, plot, y_title);
  drawYAxis(canvas, plot, axis);
  draw(plot, axis);
  drawCategories(canvas, plot, frame.categories, labels, frame.category_title);
}

}  // namespace stiffscope
