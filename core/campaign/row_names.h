#pragma once

#include <fmt/format.h>
#include <string>

#include "core/campaign/campaign.h"

// What messages call rows, axes, targets and postures.

namespace stiffscope::campaign {

inline std::string rowName(const std::string& file, std::size_t line) { return fmt::format("{}:{}", file, line); }

/// Of a 0-based axis: "axis 1".
inline std::string axisName(std::size_t axis) { return fmt::format("axis {}", axis + 1); }

inline const std::string& targetName(const Campaign& campaign, int target) {
  return campaign.targets[static_cast<std::size_t>(target)].id;
}

inline const std::string& poseName(const Campaign& campaign, int pose) {
  return campaign.pose_ids[static_cast<std::size_t>(pose)];
}

/// Calls `visit(table)` with each table of points that the campaign has.
template <class CampaignType, class Visit>
void forEachPointTable(CampaignType& campaign, const Visit& visit) {
  if (campaign.circle_sweeps) visit(*campaign.circle_sweeps);
  if (campaign.wrist_sweep) visit(*campaign.wrist_sweep);
  if (campaign.rail_sweep) visit(*campaign.rail_sweep);
  if (campaign.loading) visit(*campaign.loading);
  if (campaign.nests) visit(*campaign.nests);
}

}  // namespace stiffscope::campaign
