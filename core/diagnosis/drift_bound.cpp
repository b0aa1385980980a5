#include "core/diagnosis/drift_bound.h"

namespace stiffscope {

void boundDriftByNests(GapStart& start, GapInput& input) {
  if (start.station.course != StationCourse::still) return;
  if (!input.absolute || start.station.rate_weight.isZero()) return;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = start.state.r0_from_sweeps.linear();
  const double span = start.state.at.time_span;
  input.drift = -span * (turn * start.station.rate);
  input.drift_weight = turn * start.station.rate_weight * turn.transpose() / (span * span);
  start.state.at.sweep_time =
      0.5 * (start.station.motion.epochs.front().time_s + start.state.at.first_time);
}

}  // namespace stiffscope
