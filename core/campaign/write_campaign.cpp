#include "core/campaign/write_campaign.h"

#include "core/campaign/circle_sweeps_table.h"
#include "core/campaign/displacements_table.h"
#include "core/campaign/loading_table.h"
#include "core/campaign/nests_table.h"
#include "core/campaign/states_table.h"
#include "core/campaign/wrist_sweep_table.h"
#include "core/campaign/write_campaign_xml.h"
#include "core/campaign/write_table.h"
#include "core/input/read_file.h"
#include "core/input/write_folder.h"

namespace stiffscope {

namespace {

template <class Row>
void addTable(const TableLayout<Row>& layout, const std::optional<Table<Row>>& table, const CampaignNames& names,
              std::vector<FileToWrite>& files) {
  if (table) files.push_back({layout.element + ".csv", writtenTable(layout, table->rows, names)});
}

CampaignNames namesOf(const Campaign& campaign) {
  CampaignNames names;
  for (const Target& target : campaign.targets) names.targets.add(target.id);
  for (const std::string& pose : campaign.pose_ids) names.poses.add(pose);
  for (const std::string& nest : campaign.nest_ids) names.nests.add(nest);
  return names;
}

}  // namespace

void writeCampaign(const Campaign& campaign, const std::filesystem::path& urdf_file,
                   const std::filesystem::path& folder) {
  const std::string urdf = readTextFile(urdf_file, kLargestXml);
  const CampaignNames names = namesOf(campaign);
  std::vector<FileToWrite> files{{"robot.urdf", urdf}};
  addTable(circleSweepsLayout(), campaign.circle_sweeps, names, files);
  addTable(wristSweepLayout(), campaign.wrist_sweep, names, files);
  addTable(loadingLayout(), campaign.loading, names, files);
  addTable(statesLayout(), campaign.states, names, files);
  addTable(displacementsLayout(), campaign.displacements, names, files);
  addTable(nestsLayout(), campaign.nests, names, files);
  // Last, because a folder with a campaign.xml passes for a campaign.
  files.push_back({"campaign.xml", writtenCampaignXml(campaign)});
  writeFolderWhole(folder, files);
}

}  // namespace stiffscope
