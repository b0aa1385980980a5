#pragma once

#include <functional>

#include "reports/page/html.h"
#include "reports/report_content.h"

// The sections of the report page, in their order. Each writes one <section> with an h2 of its own.

namespace stiffscope::page {

void writeOpening(Html& html, const reports::ReportContent& content);     ///< title, verdict, the three numbers
void writeConditions(Html& html, const reports::ReportContent& content);  ///< method and conditions
void writeWrist(Html& html, const reports::ReportContent& content);       ///< Table I
void writeLinks(Html& html, const reports::ReportContent& content);       ///< link lengths and angles
void writeStiffness(Html& html, const reports::ReportContent& content);   ///< by method, from all postures
bool anySecondEncoders(const reports::ReportContent& content);
void writeTransmission(Html& html, const reports::ReportContent& content);  ///< gears by two encoders; nothing without
void writeSubsets(Html& html, const reports::ReportContent& content);       ///< Table II
void writeCompensation(Html& html, const reports::ReportContent& content);  ///< compensated and avoided shares
void writeExtendedModel(Html& html,
                        const reports::ReportContent& content);    ///< effects in the model: without and with them
void writeGap(Html& html, const reports::ReportContent& content);  ///< the diagnosis: where, which, how far, what next
void writeFigures(Html& html, const reports::ReportContent& content);
bool hasFigures(const reports::ReportContent& content, const std::string& section);
/// The figures of a section; nothing where there is none.
void writeFiguresOf(Html& html, const reports::ReportContent& content, const std::string& section);
void writeAudit(Html& html, const reports::ReportContent& content);  ///< checks with their limits; rejected readings
void writeScope(Html& html,
                const reports::ReportContent& content);  ///< uncertainty, decision rule, what results relate to
void writeLeftOut(Html& html, const reports::ReportContent& content);     ///< what was not used or not found, and why
void writeProvenance(Html& html, const reports::ReportContent& content);  ///< inputs, versions, settings

/// A section with its heading; `write` is called for each campaign, under an h3 with its name where there are
/// several.
void writeForEach(Html& html, const reports::ReportContent& content, const char* id, const char* heading,
                  const std::function<void(const reports::ReportCampaign&)>& write);

/// The same without a section of its own; then the figures of the section `id`: of a single campaign in its columns, of
/// several below them.
void writeEach(Html& html, const reports::ReportContent& content, const char* id,
               const std::function<void(const reports::ReportCampaign&)>& write);

}  // namespace stiffscope::page
