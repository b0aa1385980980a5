#pragma once

#include <functional>

#include "reports/page/html.h"
#include "reports/report_content.h"

// The sections of the report page, in their order. Each writes one <section> with an h2 of its own.

namespace stiffscope::page {

void writeOpening(Html& html, const reports::ReportContent& content);  ///< title, verdict, the three numbers
/// The result in a small table: of loads the stiffnesses by the method shown first, of an unloaded day its errors, of
/// sweeps the distances between axes.
reports::Table resultTable(const reports::ReportContent& content);
void writeConditions(Html& html, const reports::ReportContent& content);  ///< method and conditions
void writeWrist(Html& html, const reports::ReportContent& content);       ///< Table I
void writeLinks(Html& html, const reports::ReportContent& content);       ///< link lengths and angles
void writeStiffness(Html& html, const reports::ReportContent& content);   ///< by method, from all postures
bool anySecondEncoders(const reports::ReportContent& content);
void writeTransmission(Html& html, const reports::ReportContent& content);  ///< gears by two encoders; nothing without
void writeSubsets(Html& html, const reports::ReportContent& content);       ///< Table II
void writeWorkspace(Html& html, const reports::ReportContent& content);     ///< Cartesian stiffness at P_TCP
void writeCompensation(Html& html, const reports::ReportContent& content);  ///< compensated and avoided shares
void writeExtendedModel(Html& html,
                        const reports::ReportContent& content);    ///< effects in the model: without and with them
void writeGap(Html& html, const reports::ReportContent& content);  ///< the diagnosis: where, which, how far, what next

// Days without a load; nothing where there is none.
void writeAccuracy(Html& html, const reports::ReportContent& content);     ///< before and after, worst postures
void writeParameters(Html& html, const reports::ReportContent& content);   ///< axes, base, reflectors, uncertainties
void writeStation(Html& html, const reports::ReportContent& content);      ///< residuals and nests over the day
void writeAccuracyGap(Html& html, const reports::ReportContent& content);  ///< which effect, where, how far
void writeNextSteps(Html& html, const reports::ReportContent& content);    ///< what to do about it

void writeFigures(Html& html, const reports::ReportContent& content);
bool hasFigures(const reports::ReportContent& content, const std::string& section);
/// The figures of a section; nothing where there is none.
void writeFiguresOf(Html& html, const reports::ReportContent& content, const std::string& section);
void writeAudit(Html& html, const reports::ReportContent& content);  ///< checks with their limits; rejected readings
void writeScope(Html& html,
                const reports::ReportContent& content);  ///< uncertainty, decision rule, what results relate to
void writeLeftOut(Html& html, const reports::ReportContent& content);     ///< what was not used or not found, and why
void writeProvenance(Html& html, const reports::ReportContent& content);  ///< files read
bool hasVersions(const reports::ReportContent& content);
void writeVersions(Html& html, const reports::ReportContent& content);  ///< versions, settings

/// The contents, before what they are of: on a wide screen a column, on a narrow one folded into a bar that stays in
/// view.
void writeContents(Html& html, const std::vector<Html::Section>& sections);

/// What sorts tables and answers for the marks of figures: the page's scripts but for its scenes.
void writeChartScripts(Html& html, const std::vector<reports::Figure>& figures);

/// Which campaigns a section is about.
using About = bool (*)(const reports::ReportCampaign&);
bool isAny(const reports::ReportCampaign& one);
bool isLoaded(const reports::ReportCampaign& one);
bool isCalibrated(const reports::ReportCampaign& one);  ///< a day without a load that could be
bool hasWorkspace(const reports::ReportCampaign& one);  ///< loaded, with stiffnesses
bool hasActions(const reports::ReportCampaign& one);    ///< calibrated, with something to do
bool hasStation(const reports::ReportCampaign& one);    ///< without a load, with something to say of its course
bool hasAxes(const reports::ReportCampaign& one);       ///< loaded, or with circle sweeps
/// What a laboratory can do with the diagnosis's verdict: remedies, each once, and measurements. Rich texts.
std::vector<std::string> diagnosisActions(const diagnosis::Diagnosis& diagnosis);
/// Mistakes of the files that would explain what the audit finds, a sentence each.
std::vector<std::string> suspectedWords(const audit::AuditReport& report);
bool isAudited(const reports::ReportCampaign& one);
bool hasLeftOut(const reports::ReportCampaign& one);  ///< with something left out
bool hasWrist(const reports::ReportCampaign& one);    ///< loaded, or with a wrist sweep

/// A section with its heading; `write` is called for each campaign that it is `about`, under an h3 with its name where
/// there are several. Nothing where it is about none.
void writeForEach(Html& html, const reports::ReportContent& content, const char* id, const char* heading,
                  const About& about, const std::function<void(const reports::ReportCampaign&)>& write);

/// The same without a section of its own; then the figures of the section `id`: of a single campaign in its columns, of
/// several below them.
void writeEach(Html& html, const reports::ReportContent& content, const char* id, const About& about,
               const std::function<void(const reports::ReportCampaign&)>& write);

}  // namespace stiffscope::page
