#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/io/write_folder.h"

namespace stiffscope::campaign {

/// How many decimals numbers have in tables: those of the format, or up to three more where they were read with more.
enum class WrittenDigits { of_the_format, as_read };

/// Writes campaign.xml and every table present into `folder` (made if absent), in the units of the campaign
/// format, with the same bytes for the same campaign: mm with 4 decimals, deg with 5, N with 3, Nm with 4,
/// s with 1, or by `digits` up to three more. Tables are named after their element (circle_sweeps.csv, whatever
/// Table::file says), and `urdf_file` is copied beside them as robot.urdf. A time that is NaN leaves an optional column
/// out; of angles of a second encoder, commanded angles and temperatures it leaves a cell blank. With joint readings
/// the tables hold the controller's figures again. `beside`: further files that come with it. Throws InputError where
/// the URDF cannot be read, std::filesystem::filesystem_error or std::runtime_error where the folder cannot be written
/// (it is then as it was) or a value cannot be (not finite, an index without a name).
///
/// With an `expectation` no file that is there is written over: throws std::runtime_error that names it and ends so.
void writeCampaign(const Campaign& campaign, const std::filesystem::path& urdf_file,
                   const std::filesystem::path& folder, const std::vector<io::FileToWrite>& beside = {},
                   WrittenDigits digits = WrittenDigits::of_the_format, const std::string& expectation = {});

}  // namespace stiffscope::campaign
