#include "core/extended_model/hidden_effects.h"

#include <optional>

#include "core/identification/identify.h"
#include "core/preparation/subsample.h"

namespace stiffscope::extended_model {

namespace {

void makeHeavier(campaign::Campaign& campaign) { robot::scaleMasses(1.0 + campaign.mass_sigma, campaign.robot); }

void stretchReadings(campaign::Campaign& campaign) {
  const double factor = 1.0 + campaign.tracker->scale_sigma;
  const Eigen::Vector3d station = campaign.tracker->station;
  const auto stretch = [&](auto& table) {
    if (!table) return;
    for (auto& row : table->rows) {
      const Eigen::Vector3d& from = row.from.allFinite() ? row.from : station;
      row.point = from + factor * (row.point - from);
    }
  };
  stretch(campaign.circle_sweeps);
  stretch(campaign.wrist_sweep);
  stretch(campaign.loading);
  if (!campaign.displacements) return;
  for (campaign::Displacement& row : campaign.displacements->rows) row.displacement *= factor;
}

}  // namespace

Declared declaredOf(const campaign::Campaign& campaign, const identification::Identification& of_all,
                    const identification::IdentifyOptions& options) {
  Declared declared;
  if (campaign.load_cell) {
    declared.gain_sd = campaign.load_cell->gain_sigma;
    declared.cell_angle_sd = campaign.load_cell->angle_sigma;
    declared.cell_point_sd = campaign.load_cell->point_sigma;
  }
  const bool masses = campaign.mass_sigma > 0.0, scale = campaign.tracker && campaign.tracker->scale_sigma > 0.0;
  // These move stiffnesses alone, after which nobody asks where estimates are all.
  if (options.estimates_only || (!masses && !scale)) return declared;
  std::optional<campaign::Campaign> some;
  identification::Identification by_some;
  if (campaign.pose_ids.size() > preparation::kMostAveraged) {
    some = preparation::evenlySpread(campaign, preparation::kMostAveraged, preparation::kMostSwept, of_all.steps);
    by_some = identification::identify(*some, identification::estimatesOnly(options));
  }
  const identification::Identification& at = some ? by_some : of_all;
  const auto add = [&](BudgetSource source, void (*move)(campaign::Campaign&)) {
    campaign::Campaign other = some ? *some : campaign;
    move(other);
    const identification::Identification moved =
        identification::identify(other, identification::estimatesOnly(options));
    Declared::Column column{source, {}};
    for (const identification::Method which : identification::kMethods) {
      JointVector& change = column.compliance[static_cast<std::size_t>(which)];
      change.setZero(campaign.robot.joints());
      if (at.of(which).available && moved.of(which).available)
        change = moved.of(which).estimate.compliance - at.of(which).estimate.compliance;
    }
    declared.columns.push_back(column);
  };
  if (masses) add(BudgetSource::masses, &makeHeavier);
  if (scale) add(BudgetSource::tracker_scale, &stretchReadings);
  return declared;
}

}  // namespace stiffscope::extended_model
