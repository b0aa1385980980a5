#pragma once

namespace stiffscope::metrology {

/// Probability that a chi-square variable exceeds `value`.
double chiSquareTail(double value, int degrees);

/// The value that a chi-square variable exceeds with probability `tail`.
double chiSquareLimit(double tail, int degrees);

/// Probability that an F variable of `above` and `below` degrees of freedom exceeds `value`; 0 of an infinite one.
double fTail(double value, int above, double below);

/// The value that an F variable exceeds with probability `tail`.
double fLimit(double tail, int above, double below);

}  // namespace stiffscope::metrology
