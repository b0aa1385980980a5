#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identification/identify.h"
#include "reports/page/avoided_by_encoders.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// A name with its value: a version, a setting.
struct NamedText {
  std::string name, text;
};

/// Everything the report page shows. Nothing else goes in, no clock and no environment: the same content
/// gives the same bytes. Campaigns are referred to, not copied: they must outlive the page's making.
struct ReportContent {
  std::string title;
  std::string verdict;  ///< one to three sentences; verdictOf makes them
  std::vector<ReportCampaign> campaigns;
  std::optional<AvoidedByEncoders> avoided;  ///< by the double encoders, where both states were measured
  std::vector<Figure> figures;
  std::vector<NamedText> versions;  ///< stiffscope and its libraries
  std::vector<NamedText> settings;
  std::string command_line;         ///< empty: not shown
  bool compare_with_paper = false;  ///< beside the figures of Ambiehl et al., IROS 2017
};

}  // namespace stiffscope
