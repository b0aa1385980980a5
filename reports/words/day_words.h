#pragma once

#include <string>
#include <vector>

#include "reports/report_content.h"

// What a report says by the kind of its days: with a load, without one, of sweeps alone. Rich texts.

namespace stiffscope::reports {

/// "Joint stiffness", "Absolute accuracy", "Geometry by circle sweeps"; of days of several kinds all of theirs.
std::string reportTitle(const std::vector<ReportCampaign>& campaigns);

/// How such a day of a machine of so many joints becomes results, a paragraph.
std::string methodWords(DayKind kind, int joints);

/// What the audit's verdict means for such a day, a sentence.
/// `refers`: to the audit's own section, in which nothing refers to it.
std::string auditMeaning(const audit::AuditReport& audit, DayKind kind, bool refers = true);

/// Before numbers of a day that fails the audit.
std::string doubtedNumbersWords();

/// That too few checks could be made to trust the readings for what such a day is for.
std::string untestedWords(const audit::AuditReport& audit, DayKind kind);

/// Whether the stated intervals hold what effects in the model or beside it could still do.
bool hiddenIsHeld(const identification::Identification& identification);

/// Uncertainty and decision rule, an item each. `limits`: acceptance limits were given, whose rule stands with them.
/// `hidden`: intervals hold what effects in the model or beside it could still do.
std::vector<std::string> scopeWords(DayKind kind, bool limits = false, bool hidden = false);

}  // namespace stiffscope::reports
