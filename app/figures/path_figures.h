#pragma once

#include <optional>

#include "core/campaign/campaign.h"
#include "core/toolpath/compensate_path.h"
#include "render/image.h"
#include "render/point_chart.h"

namespace stiffscope::app {

/// The path in the plane of its two longest extents, true to scale: as asked for, as the tip runs under the process
/// load with its deviations magnified, and with compensation the band in which it is (U, 95 %), magnified as much. None
/// without a predicted pose.
std::optional<render::PointChart> pathShapes(const campaign::Campaign& campaign, const toolpath::CompensatedPath& path);

/// The deviation over the length of the path: its size without compensation and U with it, and its components in the
/// workpiece's axes, mm. None without a predicted pose.
std::optional<render::PointChart> pathDeviations(const campaign::Campaign& campaign,
                                                 const toolpath::CompensatedPath& path);

/// Both, one below the other: what `compensate --path --picture` draws.
std::optional<render::Image> pathPicture(const campaign::Campaign& campaign, const toolpath::CompensatedPath& path);

}  // namespace stiffscope::app
