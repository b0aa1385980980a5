#include "core/extended_model/hidden_frames.h"

#include <cmath>

#include "core/effects/gravity_equilibrium.h"

namespace stiffscope::extended_model {

namespace {

/// What the sweeps read, and nothing else of the day.
campaign::Campaign sweepsOf(const campaign::Campaign& campaign) {
  campaign::Campaign sweeps = campaign;
  sweeps.loading.reset();
  sweeps.states.reset();
  sweeps.displacements.reset();
  sweeps.nests.reset();
  return sweeps;
}

/// Calls visit(point) for every reading of the sweeps, in their order.
template <class Visit>
void forEachReading(campaign::Campaign& sweeps, const Visit& visit) {
  if (sweeps.circle_sweeps) {
    for (campaign::CircleReading& row : sweeps.circle_sweeps->rows) visit(row.q, row.target, row.time_s, row.point);
  }
  if (sweeps.wrist_sweep) {
    for (campaign::WristReading& row : sweeps.wrist_sweep->rows) visit(row.q, row.target, row.time_s, row.point);
  }
}

/// Columns of the effects at the sweeps' readings, three rows a reading, in the sweeps' frame; m per unit.
Eigen::MatrixXd columnsAtSweeps(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                campaign::Campaign& sweeps) {
  const diagnosis::SystemState& state = study.fit.state;
  const diagnosis::GapLayout& layout = study.fit.data.layout;
  const Eigen::Matrix3d sweeps_from_r0 = state.r0_from_sweeps.linear().transpose();
  std::vector<Eigen::MatrixXd> rows;
  effects::ArmState rest;
  forEachReading(sweeps, [&](const Vector6d& q, int target, double time_s, const Eigen::Vector3d& point) {
    if (rows.empty() || rest.q != q) rest = effects::gravityEquilibrium(state.geometry, state.at, q);
    rest.pose = -1;
    rest.time_s = time_s;
    rest.targets = {target};
    rest.points = {state.r0_from_sweeps * point};
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3, layout.end - layout.effects);
    for (const std::size_t m : columns.models) {
      const effects::EffectModel& model = study.input->models[m];
      all.middleCols(layout.model_at[m] - layout.effects, static_cast<Eigen::Index>(model.parameters())) =
          model.columns(state.at, {rest}, 0);
    }
    rows.push_back(sweeps_from_r0 * all(Eigen::all, columns.parameters));
  });
  Eigen::MatrixXd together(3 * static_cast<Eigen::Index>(rows.size()), columns.parameters.size());
  for (std::size_t i = 0; i < rows.size(); ++i) together.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = rows[i];
  return together;
}

}  // namespace

Eigen::MatrixXd framesByEffects(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                const Eigen::MatrixXd& off, const Eigen::MatrixXd& compliance_off,
                                const campaign::Campaign& campaign, const frames::Frames& frames,
                                const Vector6d& compliance) {
  if (!frames.sag_removed || !frames.arm.points_placed || !study.input->sweeps) return {};
  campaign::Campaign sweeps = sweepsOf(campaign);
  const Eigen::MatrixXd at_sweeps = columnsAtSweeps(study, columns, sweeps);
  const Eigen::VectorXd here = frames::framesChange(sweeps, frames, compliance);
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(here.size(), off.cols());
  for (Eigen::Index k = 0; k < off.rows(); ++k) {
    const double size = std::sqrt(off.row(k).squaredNorm() / static_cast<double>(off.cols()));
    if (size == 0.0 || at_sweeps.col(k).isZero(0.0)) continue;
    campaign::Campaign shifted = sweeps;
    Eigen::Index row = 0;
    forEachReading(shifted, [&](const Vector6d&, int, double, Eigen::Vector3d& point) {
      point -= size * at_sweeps.col(k).segment<3>(row);
      row += 3;
    });
    moved += (frames::framesChange(shifted, frames, compliance) - here) * (off.row(k) / size);
  }
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double size = std::sqrt(compliance_off.row(j).squaredNorm() / static_cast<double>(compliance_off.cols()));
    if (size == 0.0) continue;
    const Eigen::VectorXd change = frames::framesChange(sweeps, frames, compliance + size * Vector6d::Unit(j)) - here;
    moved += change * (compliance_off.row(j) / size);
  }
  return moved;
}

}  // namespace stiffscope::extended_model
