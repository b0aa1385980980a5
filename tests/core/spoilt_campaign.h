#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include "core/audit/audit.h"
#include "core/campaign/read_campaign.h"

// A good campaign, spoilt in memory in one way at a time, and what the audit says of it. The machine of
// samples/active has bearings that give, which some checks warn of; what is spoilt must come on top.

namespace stiffscope {

inline const campaign::Campaign& good() {
  static const campaign::Campaign campaign =
      campaign::readCampaign(std::filesystem::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active").campaign;
  return campaign;
}

inline const audit::AuditReport& goodReport() {
  static const audit::AuditReport report = audit::audit(good());
  return report;
}

inline const preparation::AuditCheck& checkNamed(const audit::AuditReport& report, const std::string& id,
                                    const std::string& where = {}) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == id && (where.empty() || check.where == where)) return check;
  }
  throw std::out_of_range("no check " + id + " at " + where);
}

inline audit::AuditReport auditSpoilt(const std::function<void(campaign::Campaign&)>& spoil) {
  campaign::Campaign campaign = good();
  spoil(campaign);
  return audit::audit(campaign);
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace stiffscope
