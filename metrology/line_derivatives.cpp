#include "metrology/line_derivatives.h"

namespace stiffscope {

Eigen::MatrixXd derivativesByLines(const std::vector<MeasuredLine>& lines, const LineNumbers& numbers) {
  constexpr double kStep = 1e-7;  // m and rad: of metres, central differences keep eight digits
  std::vector<Line> moved;
  for (const MeasuredLine& line : lines) moved.push_back(line.line);
  Eigen::MatrixXd derivatives;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
      moved[i] = lines[i].moved(step);
      const Eigen::VectorXd ahead = numbers(moved);
      moved[i] = lines[i].moved(-step);
      const Eigen::VectorXd behind = numbers(moved);
      if (derivatives.size() == 0) derivatives.resize(ahead.size(), 4 * static_cast<Eigen::Index>(lines.size()));
      derivatives.col(4 * static_cast<Eigen::Index>(i) + k) = (ahead - behind) / (2.0 * kStep);
    }
    moved[i] = lines[i].line;
  }
  return derivatives;
}

}  // namespace stiffscope
