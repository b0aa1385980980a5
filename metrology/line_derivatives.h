#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "metrology/measured_line.h"

namespace stiffscope {

using LineNumbers = std::function<Eigen::VectorXd(const std::vector<Line>&)>;

/// Derivatives of numbers that depend on lines by the lines' parameters, by central differences: a row a number, four
/// columns a line in the order of MeasuredLine (shift_u, shift_v by m, tilt_u, tilt_v by rad). Meant for numbers that
/// are smooth over micrometres.
Eigen::MatrixXd derivativesByLines(const std::vector<MeasuredLine>& lines, const LineNumbers& numbers);

}  // namespace stiffscope
