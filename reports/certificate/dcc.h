#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/campaign/certificate.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identification.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// What a certificate is made of. Refers to all of it; nothing of `certificate` is missing.
struct DccContent {
  const campaign::Campaign& campaign;
  const campaign::Certificate& certificate;
  const identification::Identification& result;
  identification::Method method{};
  const extended_model::ExtendedModel* model = nullptr;  ///< null: joint springs alone
  std::string version;                                   ///< of this program
};

/// Version of PTB's schema of Digital Calibration Certificates that is written, with D-SI 2.2 inside.
inline constexpr const char* kDccSchema = "3.3.0";

/// The certificate as XML: administrative data, method, equipment, and the stiffnesses of the identifiable joints as
/// one D-SI list of real numbers with expanded uncertainty, coverage factor and probability; the others are named with
/// the reason. Not signed. The same content gives the same bytes.
std::string dccXml(const DccContent& content);

/// `campaign`, `method`, `format`, `file`, `schema`, `number`, `joints` (those in the list).
Json dccExportJson(const DccContent& content, const std::string& file);
std::string dccExportText(const DccContent& content, const std::string& file);

}  // namespace stiffscope::reports
