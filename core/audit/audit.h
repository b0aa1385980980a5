#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mistakes/suspected.h"
#include "core/preparation/finding.h"
#include "core/preparation/prepare.h"

namespace stiffscope::audit {

/// What a day's readings are for: stiffness, or of a day without a load the geometry.
enum class Purpose { identify, calibrate };

/// Is this data fit for its purpose?
///
/// Fail: a check fails. Not testable: none does, but checks could not be made without which nothing says that the data
/// are fit. Warn, pass: by the worst check. What a pass needs, each by one check at least that could be made:
///
/// - the postures and loads identify joints: posture_set;
/// - force and displacement are those of an arm: load_size;
/// - a reading under load is worth what is declared: repeatability_along, repeatability_across, rigid_tool,
///   unloaded_positions or return_to_zero;
/// - the load cell shows the load: tare, gravity_direction or moment_lever.
///
/// For a day without a load:
///
/// - the readings are of the URDF's arm: arm_model;
/// - a reading is worth what is declared: repeatability_along, repeatability_across, rigid_tool or return_to_zero;
/// - there are more coordinates than a calibration has parameters.
///
/// Nothing that only sharpens the result is needed: a day of displacements without sweeps can pass.
struct AuditReport {
  Purpose purpose = Purpose::identify;
  preparation::AuditVerdict verdict = preparation::AuditVerdict::pass;
  std::vector<preparation::AuditCheck> checks;
  int made = 0;                    ///< checks, by their ids, that could be made
  int of = 0;                      ///< checks there are
  std::vector<Remark> unanswered;  ///< of what a pass needs, with the measurement that would tell
  std::vector<mistakes::Suspected> suspected;
  std::vector<preparation::RejectedReading> rejected;
};

/// Audits a campaign by its readings alone. What the day did not produce makes its checks not testable, with
/// what is missing; nothing here throws for what data lacks. Limits and their sources are those of
/// core/audit/limits.h.
///
/// The checks look at the campaign that identification sees (core/preparation/prepare.h): without rejected
/// readings, corrected for the station's motion where floor nests show it, so that one cause makes one finding;
/// for the same reason repeats that scatter by more than is declared replace the declared noise in the other
/// checks.
AuditReport audit(campaign::Campaign campaign);
/// Audits what is prepared already. Long sweeps are never copied.
AuditReport audit(const preparation::PreparedCampaign& prepared);

/// Whether some check found what cannot be.
bool findsTheImpossible(const AuditReport& report);

}  // namespace stiffscope::audit
