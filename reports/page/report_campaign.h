#pragma once

#include "core/campaign/campaign.h"
#include "core/identification/identify.h"

namespace stiffscope {

/// A campaign with what was identified from it. Refers to both.
struct ReportCampaign {
  const Campaign& campaign;
  const Identification& identification;
};

}  // namespace stiffscope
