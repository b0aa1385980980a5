#pragma once

#include "core/audit/audit.h"
#include "core/audit/prepare.h"
#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/identification/identify.h"
#include "core/improved/improved_model.h"

namespace stiffscope {

/// A campaign as it was used, with what was identified from it, how the audit judges the readings, and what was
/// done to them beforehand, how the station moved before that was taken off, and what the model misses. Refers to
/// all of these; the pointers may be null. Readings of sweeps and nests are shown; load states are shown as the
/// identification's cases, the rows of their tables need not be there.
struct ReportCampaign {
  const Campaign& campaign;
  const Identification& identification;
  const AuditReport* audit = nullptr;
  const Preparation* preparation = nullptr;
  const StationMotion* station = nullptr;
  const Diagnosis* diagnosis = nullptr;
  const ImprovedModel* improved = nullptr;  ///< effects were asked for: `campaign` and `identification` are of it
};

}  // namespace stiffscope
