#pragma once

#include <string>

#include "reports/page/report_content.h"

namespace stiffscope {

/// The report as one HTML5 page that needs nothing beside it: pictures as data: URIs, style inside, no
/// script, no network. Well-formed as XML after its doctype. Every text of a campaign is escaped.
std::string reportPage(const ReportContent& content);

}  // namespace stiffscope
