#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reports/page/html.h"
#include "reports/report_content.h"

namespace stiffscope::page {

/// A fact with its words, campaign by campaign; rich texts, empty where a campaign does not say.
struct Fact {
  std::string name;
  std::vector<std::string> of;
};

/// Name and words of one campaign's facts.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// The facts of all campaigns under each name, in the order in which the names come first.
std::vector<Fact> sideBySide(const std::vector<Facts>& by_campaign);

/// A table of them: what holds for all campaigns stands there once, across their columns. `names` head the columns; of
/// one campaign there is no head. Nothing where there is no fact.
void writeFacts(Html& html, const std::string& caption, const std::vector<std::string>& names,
                const std::vector<Fact>& facts);

/// Names of a report's campaigns that tell them apart: the state of the double encoders where these differ, else the
/// campaigns' own. Rich texts.
std::vector<std::string> columnNames(const reports::ReportContent& content);

/// Who measured what, when and by which instruments: the campaign's texts, and that a certificate is not stated.
Facts whoAndWhat(const reports::ReportCampaign& one);

}  // namespace stiffscope::page
