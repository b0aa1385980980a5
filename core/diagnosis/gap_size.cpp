#include "core/diagnosis/gap_size.h"

#include <cmath>

#include "core/diagnosis/held_out.h"

namespace stiffscope {

namespace {

/// Squares, summed over the postures, and how many coordinates they are of.
struct GapSquares {
  Gap sum;
  double count = 0.0;

  Gap rms() const {
    if (count == 0.0) return {};
    const auto root = [&](double squares) { return std::sqrt(squares / count); };
    return {root(sum.before), root(sum.noise), root(sum.after), root(sum.deflection)};
  }
};

template <class Add>
Gap summed(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit,
           const Eigen::VectorXd& after, const Add& add) {
  GapSquares squares;
  for (std::size_t p = 0; p < fit.data.postures.size(); ++p) {
    const GapPosture& posture = fit.data.postures[p];
    add(leftIn(alone.data.postures[p], before, posture, after), posture, squares);
  }
  return squares.rms();
}

}  // namespace

Gap deflectionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit,
                  const Eigen::VectorXd& after) {
  return summed(alone, before, fit, after,
                [](const HeldOut& left, const GapPosture& posture, GapSquares& squares) {
                  const Eigen::Index rows = posture.right.size() - posture.position_rows;
                  squares.sum.before += left.deflection_before;
                  squares.sum.after += left.deflection_after;
                  squares.sum.noise += noiseSquares(posture);
                  squares.sum.deflection += posture.right.tail(rows).squaredNorm();
                  squares.count += static_cast<double>(rows);
                });
}

Gap positionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit,
                const Eigen::VectorXd& after) {
  return summed(alone, before, fit, after,
                [](const HeldOut& left, const GapPosture& posture, GapSquares& squares) {
                  squares.sum.before += left.position_before;
                  squares.sum.after += left.position_after;
                  squares.sum.noise += posture.noiseSquares(0, posture.position_rows);
                  squares.count += static_cast<double>(posture.position_rows);
                });
}

}  // namespace stiffscope
