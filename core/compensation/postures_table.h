#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/compensation/compensate.h"

namespace stiffscope {

/// Reads postures and wrenches from a CSV file: `pose` (any name, not repeated), `q1_deg`..`q6_deg`, and the load-cell
/// reading expected there, `fx_n fy_n fz_n mx_nm my_nm mz_nm`; columns in any order. Throws InputError as the campaign's
/// tables do; unknown columns go to `warnings`.
std::vector<PostureToCompensate> readPostures(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The campaign's own postures in load step `step`.
std::vector<PostureToCompensate> campaignPostures(const Campaign& campaign, int step);

}  // namespace stiffscope
