#include "reports/csv/posture_tables.h"

#include "core/io/units.h"
#include "reports/words/names.h"

namespace stiffscope::reports {

namespace {

/// Three rows of a point's equations b = A c.
void addPoint(const std::vector<DataCell>& which, const identification::CaseEquations& rows, Eigen::Index point,
              identification::Method method, const JointVector& compliance, DataTable& table) {
  const Eigen::Vector3d measured = rows.right.segment<3>(3 * point);
  const Eigen::Vector3d predicted = rows.matrix.middleRows<3>(3 * point) * compliance;
  std::vector<DataCell> cells = which;
  cells.emplace_back(std::string(namesOf(method).key));
  for (const Eigen::Vector3d& part : {measured, predicted, Eigen::Vector3d(measured - predicted)})
    for (const double coordinate : part) cells.emplace_back(coordinate / io::kMillimetre);
  cells.emplace_back((measured - predicted).norm() / io::kMillimetre);
  table.rows.push_back(std::move(cells));
}

}  // namespace

DataTable postureTable(const ReportCampaign& one) {
  DataTable table{
      {"pose", "step", "point", "method", "measured_x_mm", "measured_y_mm", "measured_z_mm", "predicted_x_mm",
       "predicted_y_mm", "predicted_z_mm", "residual_x_mm", "residual_y_mm", "residual_z_mm", "residual_mm"},
      {}};
  const identification::Identification& result = one.identification;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const identification::LoadCase& load_case = result.cases[i];
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& own = result.of(method);
      if (!own.available) continue;
      const std::vector<DataCell> posture{one.campaign.pose_ids[static_cast<std::size_t>(load_case.pose)],
                                          static_cast<double>(load_case.step)};
      const auto add = [&](const std::string& point, const identification::CaseEquations& rows, std::size_t at) {
        if (rows.right.size() < static_cast<Eigen::Index>(3 * (at + 1))) return;
        std::vector<DataCell> which = posture;
        which.emplace_back(point);
        addPoint(which, rows, static_cast<Eigen::Index>(at), method, own.estimate.compliance, table);
      };
      for (std::size_t t = 0; t < load_case.targets.size() && i < own.target_rows.size(); ++t)
        add(one.campaign.targets[static_cast<std::size_t>(load_case.targets[t].target)].id, own.target_rows[i], t);
      if (i < own.wrist_rows.size()) add("P_wrist", own.wrist_rows[i], 0);
    }
  }
  return table;
}

}  // namespace stiffscope::reports
