#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace stiffscope::simulation {

/// A Jenkins element: a spring of `rate` (Nm/rad) in series with a slider that holds up to `limit` (Nm) and
/// then slips. C. F. Beards, Damping in Structural Joints (1992); several in parallel are Iwan's model of
/// hysteresis (J. Appl. Mech. 33, 1966).
struct Slider {
  double rate = 0.0, limit = 0.0;
};

/// What acts on one elastic coordinate besides its linear spring: torque (Nm) against twist t (rad), or force
/// (N) against displacement (m). All parts add:
///   stages    piecewise linear through the origin; rate of the first stage up to its `until`, then the next
///             one's, for positive and negative twists apart. A catalogue's K1, K2, K3, a gap, a one-sided
///             contact.
///   cubic     cubic * t^3
///   sliders   clamp(rate (t - anchor), +-limit) each, `anchor` where its spring is unstrained now
/// Its energy's derivative is the torque, and that one's the rate, everywhere but at the corners.
struct TorqueCurve {
  struct Stage {
    double rate = 0.0;
    double until = std::numeric_limits<double>::infinity();  ///< |twist| where the next one begins
  };
  std::vector<Stage> positive, negative;  ///< until rising; empty: no torque on that side
  double cubic = 0.0;
  std::vector<Slider> sliders;

  bool acts() const { return !positive.empty() || !negative.empty() || cubic != 0.0 || !sliders.empty(); }
};

struct CurvePoint {
  double energy = 0.0;  ///< J, from twist 0 and, for sliders, from their anchors
  double torque = 0.0;  ///< dE/dt
  double rate = 0.0;    ///< d torque / dt
};

/// `anchors`: one a slider; null: sliders carry nothing.
CurvePoint evaluate(const TorqueCurve& curve, double twist, const double* anchors);

/// Lets the sliders slip that carry more than their limit at this twist.
void slip(const TorqueCurve& curve, double twist, double* anchors);

/// The stages of an odd curve given by the torques (Nm, rising) where the rate changes: rates.size() is one
/// more than torques.size().
std::vector<TorqueCurve::Stage> stagesByTorque(const std::vector<double>& torques,
                                               const std::vector<double>& rates);

}  // namespace stiffscope::simulation
