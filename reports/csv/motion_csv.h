#pragma once

#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/toolpath/compensate_path.h"

namespace stiffscope::reports {

/// Compensated motion as CSV, a posture a line, one quantity a column, its unit in the column's name, cells blank where
/// a quantity is not given: pose, q1_deg.. (asked for), c1_deg.. (to command), of a campaign with joint
/// readings reading1_deg.. (the commands as the controller states joints), deflection_x_mm.. of P_TCP in R0
/// and u_deflection_mm (coverage 95 %), rotation_x_deg.. of the flange, conditioning, load_ratio, refused, cautions.
std::string commandsCsv(const campaign::Campaign& campaign,
                        const std::vector<compensation::CompensatedPosture>& postures);

/// The same of a path, places and vectors in the workpiece's axes: besides along_mm, x_mm.. (the tip), turn_deg (of the
/// tool about its axis, from the pose as given), fx_n.., mx_nm.. (on the tool, moment about the tip), offset_x_mm..
/// and offset_rx_deg.. (to add to the programmed pose), torque1_nm.. (of the process on the joints),
/// limit_margin_deg.
std::string pathCsv(const campaign::Campaign& campaign, const toolpath::CompensatedPath& path);

}  // namespace stiffscope::reports
