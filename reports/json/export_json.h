#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/elastic_model/elastic_model.h"
#include "core/identification/identification.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// What was exported, and from which method.
struct ExportedModel {
  std::string format, file;  ///< mjcf or sdf
  identification::Method method{};
  bool springs_only = false;  ///< asked for
  const elastic_model::ElasticModel& model;
};

/// Lines for the head of the exported file: what it is of, conventions, and what it lacks.
std::vector<std::string> exportComments(const campaign::Campaign& campaign, const ExportedModel& exported);

/// `campaign`, `method`, `format`, `file`, `frame`, `gravity_m_s2`, `joints`
/// (name, body, kind: drive, turn_spring, shift_spring, stiffness and its unit), `sites` (name, body, xyz_m at zero),
/// `remarks`.
Json exportJson(const campaign::Campaign& campaign, const ExportedModel& exported);

/// The same for a terminal.
std::string exportText(const campaign::Campaign& campaign, const ExportedModel& exported);

/// What was exported as a calibrated URDF: `campaign`, `format`, `file`, `geometry`: unloaded_postures or sweeps; and
/// for a terminal.
Json urdfExportJson(const campaign::Campaign& campaign, const std::string& file, bool by_postures);
std::string urdfExportText(const campaign::Campaign& campaign, const std::string& file, bool by_postures);

}  // namespace stiffscope::reports
