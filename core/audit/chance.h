#pragma once

namespace stiffscope {

/// The value that a chi-square variable with `dof` degrees of freedom exceeds with probability `tail`.
/// By bisection on the regularised incomplete gamma function (DLMF 8.11.4 and 8.9.2), to ten digits.
double chiSquareLimit(double tail, double dof);

/// The value that the magnitude of a standard normal variable exceeds with probability `tail`.
double normalLimit(double tail);

/// The value that the magnitude of Student's t with `dof` degrees of freedom exceeds with probability `tail`.
double studentLimit(double tail, double dof);

}  // namespace stiffscope
