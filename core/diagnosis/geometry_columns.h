#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "core/diagnosis/system_rows.h"
#include "core/diagnosis/system_state.h"

namespace stiffscope::diagnosis {

/// Columns of the geometry's steps (one each of ArmParameters) in the equations of the gap: derivatives of modelled
/// less measured, of each posture of the loading and of each posture of the sweeps.
///
/// They are most of what equations cost, and a fit makes equations at some places again: where it began, once a gap of
/// the model is known or without any effect; where it ended, to weigh them otherwise. Those of the place where it began
/// and of the last one are kept. (Those of a place some millimetres away do not serve: directions in which the geometry
/// is hardly determined make a large step of a small error in a column.)
class GeometryColumns {
 public:
  struct Columns {
    std::vector<Eigen::MatrixXd> loading;  ///< position rows first where these take part, then deflection rows
    std::vector<Eigen::MatrixXd> sweeps;
  };

  /// Those for these rows, made at `state`; the reference holds until the next call. `absolute`: positions of the
  /// loading take part. `maker`: of `loading`.
  const Columns& of(const SystemState& state, bool absolute, const LoadingRows& maker,
                    const std::vector<SystemRows>& loading, const std::vector<SweepRows>& sweeps);

 private:
  /// Where columns were taken: what was there.
  struct Place {
    std::vector<Eigen::VectorXd> points;      ///< measured and modelled ones of reflectors, in R0, m
    std::vector<Eigen::VectorXd> deflection;  ///< modelled, m
    Columns columns;

    bool is(const Place& other) const;
  };

  std::deque<Place> places_;
};

}  // namespace stiffscope::diagnosis
