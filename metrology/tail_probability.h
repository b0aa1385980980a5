#pragma once

namespace stiffscope::metrology {

/// Probability that a chi-square variable of 1 or 2 degrees of freedom exceeds `value`.
double chiSquareTail(double value, int degrees);

/// Probability that an F variable of 1 or 2 and `below` degrees of freedom exceeds `value`: M. Abramowitz and
/// I. A. Stegun, Handbook of Mathematical Functions, 26.6.2 (the incomplete beta function, here by its
/// continued fraction 26.5.8).
double fTail(double value, int above, double below);

}  // namespace stiffscope::metrology
