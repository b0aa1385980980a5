#pragma once

#include <optional>
#include <vector>

#include "core/identification/identification.h"
#include "core/identification/load_case.h"
#include "metrology/remark.h"

namespace stiffscope::identification {

/// What the load does to the reflectors, before any model: |F| rms over |displacement| rms, N/m.
struct ApparentStiffness {
  double force = 0.0;         ///< rms over the load cases, N
  double displacement = 0.0;  ///< rms over load cases and reflectors, m
  double value() const { return force / displacement; }
};

/// Empty without load cases, or where nothing pushes or nothing moves. Moments alone say nothing here.
std::optional<ApparentStiffness> apparentStiffness(const std::vector<LoadCase>& cases);

/// What arms give at the tool, N/m. Articulated robots are usually below 1e6 (Pan et al., J. Mater.
/// Process. Technol. 173, 2006, against more than 5e7 of machine tools), heavy ones come to a few times that,
/// light collaborative arms to about 1e4. A unit wrong by a thousand leaves the range from half of the
/// softest to the machine tools at one end or the other, but for the lightest arms given too large and the
/// stiffest, above 5e6, given too small.
inline constexpr double kSoftArm = 5e3;
inline constexpr double kStiffArm = 5e7;

/// What no arm gives: 10 kg would sink it by 10 cm; a solid steel column, 0.1 m square and 2 m high.
inline constexpr double kSofterThanAnyArm = 1e3;
inline constexpr double kStifferThanAnyArm = 1e9;

/// Of a stiffness outside kSoftArm to kStiffArm, which wrong units explain; empty inside.
Remark implausibleLoad(const ApparentStiffness& apparent);

/// Unloaded positions that miss by more, rms, m: an arm's own sag is taken off before, and what that leaves of a heavy
/// one is a millimetre or two. Units, angles or the tracker's place are wrong.
inline constexpr double kMissedGeometry = 0.020;

/// What a reader must know before believing the numbers: a residual far above the tracker's noise,
/// negative stiffnesses, forces too small or too large for what they move, a geometry that the readings miss by
/// centimetres, sweeps that do not fit, too few postures. Limits: three times the noise for residuals (beyond what a
/// misdeclared tracker explains), kMissedGeometry for a geometry, half the deflection for noise.
std::vector<Remark> warningsOf(const campaign::Campaign& campaign, const Identification& result);

/// The postures that disagree with the rest, whether they are left out or not; empty where there are none.
Remark outlyingWarning(const campaign::Campaign& campaign, const std::vector<OutlyingPosture>& outlying, bool left_out);
Remark outlyingWarning(const campaign::Campaign& campaign, const Identification& result);

/// Whether some available method has a joint with a positive stiffness.
bool anyUsable(const Identification& result, const std::vector<Method>& methods);

}  // namespace stiffscope::identification
