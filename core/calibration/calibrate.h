#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/arm_fit.h"
#include "core/calibration/denavit_hartenberg.h"
#include "core/calibration/effect_selection.h"
#include "core/calibration/fitted_arm.h"
#include "core/calibration/held_out.h"
#include "core/calibration/remarks.h"
#include "core/calibration/unloaded_day.h"
#include "core/preparation/finding.h"
#include "core/preparation/prepare.h"
#include "metrology/remark.h"

namespace stiffscope::calibration {

/// How well the fullest model predicts held-out postures from the reported joint angles and from the commanded ones. A
/// smaller model would judge by what it lacks, which is often larger than the difference of the angles.
struct AngleComparison {
  PerJoint<bool> joints;  ///< which have commanded angles in every unloaded posture
  double largest = 0.0;   ///< largest difference between the two, rad
  PositionErrors reported, commanded;
  /// Mean over the postures of how much larger the squared error with the reported angles is, over its own standard
  /// uncertainty: positive where the commanded ones fit better.
  double significance = 0.0;
  std::optional<JointAngles> better;  ///< empty: chance could have made the difference
};

/// The largest difference of the two kinds of angles in unloaded postures, rad; 0 where no joint has commanded ones.
double largestDifference(const campaign::Campaign& campaign);

/// What a calibration by one kind of angles makes of the day's readings, in their order.
struct HeldOutReadings {
  const std::vector<double>& weights;             ///< 0: rejected
  const std::vector<Eigen::Vector3d>& residuals;  ///< of the fullest model, held out; not a number: not predicted, m
};

/// A reading that both reject is left out. Neither `joints` nor `largest` is filled.
AngleComparison compareAngles(const UnloadedDay& day, const HeldOutReadings& reported,
                              const HeldOutReadings& commanded);

/// In the order in which they are fitted; each has what the one before it has, but for `effects`, which keeps of the
/// own weight what the selection asks for.
enum class CalibratedModel { nominal, geometry, gravity, effects };

struct ModelResult {
  CalibratedModel model = {};
  ArmFit fit;  ///< to all postures
  PositionErrors fitted;
  PositionErrors held_out;  ///< each fold by what the others fit, selection of effects included, all folds pooled
  /// Measured less predicted, of every reading of the day in its order, by what the other folds fit, in base_link, m;
  /// not a number where these place no arm.
  std::vector<Eigen::Vector3d> held_out_residuals;
  std::vector<Remark> notes;
};

/// An unloaded day calibrated: geometry, own weight, effects, in this order.
struct Calibration {
  Remark reason;  ///< why there is none; then nothing else is filled
  UnloadedDay day;
  std::vector<ModelResult> models;                              ///< gravity is absent where the URDF has no masses
  std::vector<preparation::RejectedReading> rejected;           ///< by the fullest model
  SelectedEffects selected;                                     ///< what the whole day asks for
  std::vector<std::vector<SelectedEffect>> selected_by_others;  ///< what all but one fold ask for, a list a fold
  /// By how much the URDF's arm misses the one that was found with the effects beside it, rms per coordinate at the
  /// reflectors in these postures, base and reflectors placed as well as can be, m.
  double nominal_misses = 0.0;
  double noise = 0.0;                     ///< the tracker's, rms per coordinate over the readings used, m
  std::optional<AngleComparison> angles;  ///< where the log has commanded angles beside the reported
  std::vector<Remark> not_identifiable;   ///< axis parameters of the geometry
  std::vector<Remark> notes;

  const ModelResult& of(CalibratedModel model) const;
  /// The rigid arm that predicts best without effects: axes, base, reflectors and URDF as other programs take them.
  const ModelResult& geometry() const { return of(CalibratedModel::geometry); }
  /// The fullest, by which readings are judged. Its axes are those with the effects beside them.
  const ModelResult& best() const { return models.back(); }
};

/// Fits nominal (base and reflectors alone), geometry, geometry with the own weight's compliances, and geometry with
/// the effects that selectEffects finds. Readings are rejected by the fullest of them; all others are fitted to what it
/// left. Held out: postures of one fold are predicted by models of which nothing was fitted or chosen with them. A
/// reading that is rejected by the fit to all is left out of every figure.
Calibration calibrate(const campaign::Campaign& campaign, const CalibrationOptions& options);

/// With the noise that the repeats of the day show, where there are enough of them, in place of the declared one.
Calibration calibrate(const preparation::PreparedCampaign& prepared, const CalibrationOptions& options);

/// Three numbers with their standard uncertainties by all that was fitted, m or rad; 0: held.
struct UncertainPoint {
  Eigen::Vector3d value = Eigen::Vector3d::Zero(), sd = Eigen::Vector3d::Zero();
};

/// Where the tracker stands in base_link.
UncertainPoint stationInBase(const UnloadedDay& day, const ArmFit& fit);

/// Rotation vector from the readings' axes to base_link's.
UncertainPoint turnOfStation(const ArmFit& fit);

/// Each reflector in the flange's frame, as the fitted arm has it at zero: the flange follows the last axes, which are
/// uncertain too.
std::vector<UncertainPoint> targetsInFlange(const UnloadedDay& day, const ArmFit& fit);

/// Standard uncertainties of the link parameters of a fitted geometry (denavitHartenberg of its arm), in the places of
/// the parameters, m and rad. 0 where nothing that was fitted moves one.
PerJoint<LinkParameters> linkUncertainties(const ArmFit& fit, const robot::Robot& nominal);

}  // namespace stiffscope::calibration
