#include "core/campaign/read_campaign.h"

#include <algorithm>

#include "core/campaign/campaign_files.h"
#include "core/campaign/campaign_names.h"
#include "core/campaign/campaign_xml.h"
#include "core/campaign/check_campaign.h"
#include "core/campaign/circle_sweeps_table.h"
#include "core/campaign/displacements_table.h"
#include "core/campaign/loading_table.h"
#include "core/campaign/nests_table.h"
#include "core/campaign/read_table.h"
#include "core/campaign/states_table.h"
#include "core/campaign/wrist_sweep_table.h"
#include "core/input/input_error.h"
#include "core/input/nearest_name.h"
#include "core/input/read_file.h"
#include "core/robot/read_urdf.h"

namespace stiffscope {

namespace {

// The URDF's own errors name the URDF; a link that campaign.xml gets wrong is an error of campaign.xml.
void requireLink(const CampaignFiles& files, const Robot& robot, std::size_t line,
                 const std::string& attribute, const std::string& link) {
  std::vector<std::string> known;
  for (const LinkFrame& frame : robot.links) known.push_back(frame.name);
  if (std::find(known.begin(), known.end(), link) != known.end()) return;
  throw InputError(
      {files.xmlName(), line, attribute}, link,
      "expected a link of the robot, on its chain or fixed to it" + nearestNameHint(link, known));
}

void readRobot(CampaignFiles& files, const CampaignXml& xml, Campaign& campaign) {
  const TextFile file = files.read(xml.urdf, kLargestXml);
  campaign.robot = parseUrdf(file.text(), files.shown(xml.urdf), campaign.base_link, campaign.flange_link);
  if (!campaign.load_cell) return;
  requireLink(files, campaign.robot, xml.load_cell_line, "parent", campaign.load_cell->parent);
  if (campaign.load_cell->axes_link) {
    requireLink(files, campaign.robot, xml.load_cell_line, "axes", *campaign.load_cell->axes_link);
  }
}

/// Reads the tables one after the other with the same names, so that a pose has one index in all of them.
class TableReader {
 public:
  TableReader(CampaignFiles& files, const CampaignXml& xml, std::vector<std::string>& warnings)
      : files_(files), xml_(xml), warnings_(warnings) {
    for (const Target& target : xml.campaign.targets) names_.targets.add(target.id);
  }

  template <class Row>
  void read(const TableLayout<Row>& layout, std::optional<Table<Row>>& table) {
    const auto reference = xml_.tables.find(layout.element);
    if (reference == xml_.tables.end()) return;
    const FileReference& file = reference->second.file;
    const TextFile bytes = files_.read(file, kLargestTable);
    table = Table<Row>{file.name, reference->second.frame,
                       readTable<Row>({files_.shown(file), bytes.text()}, layout, names_, warnings_)};
  }

  const CampaignNames& names() const { return names_; }

 private:
  CampaignFiles& files_;
  const CampaignXml& xml_;
  std::vector<std::string>& warnings_;
  CampaignNames names_;
};

}  // namespace

CampaignReading readCampaign(const std::filesystem::path& folder_or_xml, Hashes hashes) {
  CampaignReading reading;
  CampaignFiles files(folder_or_xml, hashes == Hashes::taken);
  const CampaignXml xml = readCampaignXml(files.xmlName(), files.readXml().text(), reading.warnings);
  Campaign& campaign = reading.campaign;
  campaign = xml.campaign;
  campaign.folder = files.folder();
  readRobot(files, xml, campaign);

  TableReader tables(files, xml, reading.warnings);
  tables.read(circleSweepsLayout(), campaign.circle_sweeps);
  tables.read(wristSweepLayout(), campaign.wrist_sweep);
  tables.read(loadingLayout(), campaign.loading);
  tables.read(statesLayout(), campaign.states);
  tables.read(displacementsLayout(), campaign.displacements);
  tables.read(nestsLayout(), campaign.nests);
  campaign.pose_ids = tables.names().poses.names();
  campaign.nest_ids = tables.names().nests.names();
  files.requireUnchanged();
  campaign.inputs = files.takeInputs();

  checkCampaign(campaign, reading.warnings);
  return reading;
}

}  // namespace stiffscope
