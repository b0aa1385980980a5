#pragma once

#include <string>
#include <vector>

#include "reports/report_content.h"

// What the page and its pictures say of days without a load. Rich texts.

namespace stiffscope::reports {

const char* modelWords(calibration::CalibratedModel model);       ///< "geometry calibrated"
const char* shortModelWords(calibration::CalibratedModel model);  ///< "calibrated": heads a column

/// "0.158 mm", to three digits.
std::string millimetres(double metres);

/// Accuracy by each model, what the diagnosis finds, what the audit says: a sentence each.
std::string accuracyVerdict(const ReportCampaign& one);

/// The result of a day of sweeps alone: the axes that were found.
std::string sweepsVerdict(const ReportCampaign& one);

/// Largest difference of a distance between measured axes from the nominal one, m.
double largestLinkDifference(const frames::Frames& frames);

/// What is there besides the geometry; and what each effect of it means.
std::string accuracyFinding(const accuracy::AccuracyDiagnosis& accuracy);

/// Of which readings the cause is, and of which the accuracy, where they are not the same.
std::string asReadWords();
std::vector<std::string> accuracyMeanings(const accuracy::AccuracyDiagnosis& accuracy);

/// Whether the model with all effects has none beside those that the verdict names.
bool onlyVerdictFitted(const accuracy::AccuracyDiagnosis& accuracy);

/// "transmission error, backlash": of that model.
std::string fittedNames(const accuracy::AccuracyDiagnosis& accuracy);

/// Why joint stiffnesses by the own weight are to be taken with care: the verdict does not name joint compliance, or
/// not alone. Empty where it does.
std::string stiffnessDoubt(const accuracy::AccuracyDiagnosis& accuracy);

/// How far the gap falls, with noise and interval; empty where nothing is known of it.
std::string accuracyFigures(const accuracy::AccuracyDiagnosis& accuracy);

/// What a laboratory can do: remedies, each once, measurements, and how to use the calibration.
std::vector<std::string> accuracyActions(const accuracy::AccuracyDiagnosis& accuracy);

/// How many parts of the effects a table leaves out, and where all of them are.
std::string morePartsWords(std::size_t count);

/// Parameters that are not known, those with one reason in one sentence.
std::vector<std::string> notIdentifiableWords(const calibration::Calibration& calibration);

}  // namespace stiffscope::reports
