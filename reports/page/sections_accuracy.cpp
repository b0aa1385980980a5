#include <fmt/format.h>
#include <cmath>

#include "core/calibration/position_errors.h"
#include "core/io/units.h"
#include "core/numerics/resampling.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/calibration_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

using calibration::CalibratedModel;

std::string inMm(double metres) { return reports::fixed(metres / io::kMillimetre, 3); }

/// Plain 3-D distances; percentiles and largest of the held-out ones where there are such.
reports::Table modelsTable(const calibration::Calibration& calibration,
                           const std::vector<calibration::ReadingError>& errors) {
  reports::Table table{"Position error before and after, 3-D, mm",
                       {"Model", "rms, held out", "Median", "95 %", "Largest", "rms, fitted", "Parameters"},
                       {{}},
                       false,
                       "accuracy"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"model",      "rms_held_out_mm", "median_mm", "quantile_95_mm",
                  "largest_mm", "rms_fitted_mm",   "parameters"};
  for (const calibration::ModelResult& model : calibration.models) {
    const std::vector<double> lengths = calibration::errorLengths(errors, model.model);
    if (lengths.empty()) continue;
    const bool held_out = model.held_out.readings > 0;
    constexpr double kMost = 0.95;
    table.groups.front().rows.push_back(
        {reports::capitalised(reports::modelWords(model.model)), held_out ? inMm(model.held_out.rms) : "–",
         inMm(numerics::quantile(lengths, 0.5)), inMm(numerics::quantile(lengths, kMost)), inMm(lengths.back()),
         inMm(model.fitted.rms), fmt::format("{}", model.fit.parameters)});
    const auto cell = [](double metres) { return reports::DataCell(metres / io::kMillimetre); };
    data.rows.push_back({reports::modelWords(model.model), held_out ? cell(model.held_out.rms) : reports::DataCell(),
                         cell(numerics::quantile(lengths, 0.5)), cell(numerics::quantile(lengths, kMost)),
                         cell(lengths.back()), cell(model.fitted.rms), static_cast<double>(model.fit.parameters)});
  }
  return table;
}

std::string anglesOf(const JointVector& q) {
  std::string text;
  for (Eigen::Index j = 0; j < q.size(); ++j)
    text += (j > 0 ? ", " : "") + reports::fixed(reports::unsignedZero(q[j] / io::kDegree, 0), 0);
  return text;
}

reports::Table worstTable(const calibration::Calibration& calibration,
                          const std::vector<calibration::ReadingError>& errors) {
  constexpr std::size_t kShown = 10;
  const bool effects = !calibration.best().fit.parts.empty();
  const CalibratedModel last = effects ? CalibratedModel::effects : CalibratedModel::geometry;
  const bool reflectors = calibration.day.targets.size() > 1;
  reports::Table table{fmt::format("Worst postures, {}: position error, and its direction in base_link, mm",
                                   reports::shortModelWords(last)),
                       {"Posture"},
                       {{}},
                       false,
                       "worst-postures"};
  if (reflectors) table.columns.emplace_back("Reflector");
  reports::DataTable& data = table.data.emplace();
  data.columns = {"pose",       "reflector",  "nominal_mm", "calibrated_mm", "with_effects_mm",
                  "error_x_mm", "error_y_mm", "error_z_mm"};
  for (int joint = 1; joint <= calibration.day.arm.joints(); ++joint)
    data.columns.push_back(fmt::format("q{}_deg", joint));
  for (const char* column : {"Nominal", "Calibrated"}) table.columns.emplace_back(column);
  if (effects) table.columns.emplace_back("With effects");
  for (const char* column : {"x", "y", "z", "Joint angles (°)"}) table.columns.emplace_back(column);
  for (const calibration::ReadingError& error : calibration::worstPostures(errors, last, kShown)) {
    const calibration::Posture& posture = calibration.day.postures[error.posture];
    reports::Row row{reports::asIs(calibration.day.pose_ids[static_cast<std::size_t>(posture.pose)])};
    if (reflectors)
      row.emplace_back(reports::pointName(calibration.day.targets[static_cast<std::size_t>(error.target)]));
    for (const CalibratedModel model : {CalibratedModel::nominal, CalibratedModel::geometry})
      row.emplace_back(inMm(error.of(model).norm()));
    if (effects) row.emplace_back(inMm(error.of(last).norm()));
    for (int k = 0; k < 3; ++k) row.emplace_back(inMm(error.of(last)[k]));
    row.emplace_back("", anglesOf(posture.q));
    std::vector<reports::DataCell> cells{calibration.day.pose_ids[static_cast<std::size_t>(posture.pose)],
                                         calibration.day.targets[static_cast<std::size_t>(error.target)]};
    for (const CalibratedModel model : {CalibratedModel::nominal, CalibratedModel::geometry})
      cells.emplace_back(error.of(model).norm() / io::kMillimetre);
    cells.push_back(effects ? reports::DataCell(error.of(last).norm() / io::kMillimetre) : reports::DataCell());
    for (const double part : error.of(last)) cells.emplace_back(part / io::kMillimetre);
    for (const double q : posture.q) cells.emplace_back(q / io::kDegree);
    data.rows.push_back(std::move(cells));
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

void writeAccuracy(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) {
    const calibration::Calibration& calibration = one.accuracy->calibration;
    const std::vector<calibration::ReadingError> errors = calibration::readingErrors(calibration);
    writeTable(html, modelsTable(calibration, errors));
    html.paragraph(reports::capitalised(reports::foldWords(one.calibrated_by)) + ".", "faint");
    std::vector<std::string> notes = reports::modelNotes(calibration);
    for (const Remark& note : calibration.notes) notes.push_back(reports::words(note));
    if (calibration.angles) notes.push_back(reports::angleWords(*calibration.angles, calibration.day.angles));
    for (std::string& note : notes) note = reports::asIs(reports::capitalised(note)) + ".";
    html.list(notes);
    writeTable(html, worstTable(calibration, errors));
  };
  writeForEach(html, content, "accuracy", "Accuracy before and after", isCalibrated, write);
}

}  // namespace stiffscope::page
