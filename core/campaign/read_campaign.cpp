#include "core/campaign/read_campaign.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "core/campaign/campaign_xml.h"
#include "core/campaign/check_campaign.h"
#include "core/campaign/columns.h"
#include "core/campaign/joint_reading.h"
#include "core/campaign/read_table.h"
#include "core/campaign/row_names.h"
#include "core/campaign/table_layouts.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/robot/read_urdf.h"

namespace stiffscope::campaign {

namespace fs = std::filesystem;

namespace {

bool leadsInside(const fs::path& folder, const fs::path& path) {
  const fs::path root = fs::weakly_canonical(folder);
  const fs::path file = fs::weakly_canonical(path);
  return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

bool isXml(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".xml";
}

}  // namespace

CampaignFiles::CampaignFiles(const fs::path& folder_or_xml, bool hashed) : hashed_(hashed) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_or_xml, error);
  if (!fs::exists(status)) {
    throw io::InputError({folder_or_xml.string(), 0, ""}, "",
                         "expected a campaign folder or its campaign.xml; there is none");
  }
  const bool is_folder = fs::is_directory(status);
  if (!is_folder && !isXml(folder_or_xml)) {
    throw io::InputError({folder_or_xml.string(), 0, ""}, "",
                         "expected a campaign folder or its campaign.xml: give the folder that holds this file");
  }
  xml_ = is_folder ? folder_or_xml / "campaign.xml" : folder_or_xml;
  folder_ = is_folder ? folder_or_xml : folder_or_xml.parent_path();
  if (folder_.empty()) folder_ = ".";
  if (is_folder && !fs::exists(xml_, error)) {
    throw io::InputError({folder_or_xml.string(), 0, ""}, "", "expected a campaign folder; it holds no campaign.xml");
  }
}

io::TextFile CampaignFiles::readXml() { return readAndRecord(xml_, xml_.filename().string(), io::kLargestXml); }

io::TextFile CampaignFiles::read(const FileReference& reference, std::size_t largest) {
  const auto refuse = [&](const std::string& why) {
    throw io::InputError({xmlName(), reference.line, reference.attribute}, reference.name,
                         "expected a file inside the campaign's folder; " + why);
  };
  const fs::path name(reference.name);
  if (name.is_absolute()) refuse("this path is absolute");
  const fs::path normal = name.lexically_normal();
  if (!normal.empty() && *normal.begin() == "..") refuse("this path leads out of it");
  const fs::path path = folder_ / normal;
  std::error_code error;
  if (!fs::exists(path, error)) refuse("there is none of this name");
  if (!leadsInside(folder_, path)) refuse("a link leads out of it");
  return readAndRecord(path, reference.name, largest);
}

io::TextFile CampaignFiles::readAndRecord(const fs::path& path, const std::string& name, std::size_t largest) {
  io::TextFile file = io::readTextFileWithStamp(path, largest);
  read_.push_back({path, name, file.stamp, {}});
  if (!hashed_) return file;
  constexpr std::size_t kOwnThread = 1 << 20;  // hashed in a millisecond
  // Where no thread is to be had, either policy lets it be hashed when the hash is asked for.
  const auto when = file.size < kOwnThread ? std::launch::deferred : std::launch::async | std::launch::deferred;
  // What is hashed goes: the rows of all tables come while the hashes wait to be asked for.
  read_.back().sha256 =
      std::async(when, [text = file]() mutable { return io::sha256Hex(std::exchange(text, {}).text()); });
  return file;
}

std::vector<InputFile> CampaignFiles::takeInputs() {
  std::vector<InputFile> inputs;
  for (Read& file : read_) inputs.push_back({file.name, hashed_ ? file.sha256.get() : std::string()});
  read_.clear();
  return inputs;
}

void CampaignFiles::requireUnchanged() const {
  for (const Read& file : read_) {
    if (io::stampOf(file.path) == file.stamp) continue;
    throw io::InputError({file.path.string(), 0, ""}, "",
                         "expected a file that stays as it is; it changed while the campaign was read");
  }
}

namespace {

// The URDF's own errors name the URDF; a link that campaign.xml gets wrong is an error of campaign.xml.
void requireLink(const CampaignFiles& files, const robot::Robot& robot, std::size_t line, const std::string& attribute,
                 const std::string& link) {
  std::vector<std::string> known;
  for (const robot::LinkFrame& frame : robot.links) known.push_back(frame.name);
  if (std::find(known.begin(), known.end(), link) != known.end()) return;
  throw io::InputError({files.xmlName(), line, attribute}, link,
                       "expected a link of the robot, on its chain or fixed to it" + io::nearestNameHint(link, known));
}

void readRobot(CampaignFiles& files, const CampaignXml& xml, Campaign& campaign) {
  const io::TextFile file = files.read(xml.urdf, io::kLargestXml);
  campaign.robot = robot::parseUrdf(file.text(), files.shown(xml.urdf), campaign.base_link, campaign.flange_link);
  requireJoints(xml.joint_numbers, campaign.robot.joints());
  placeBalancers(xml.balancers, campaign.robot);
  if (!campaign.load_cell) return;
  requireLink(files, campaign.robot, xml.load_cell_line, "parent", campaign.load_cell->parent);
  if (campaign.load_cell->axes_link) {
    requireLink(files, campaign.robot, xml.load_cell_line, "axes", *campaign.load_cell->axes_link);
  }
}

/// Reads the tables one after the other with the same names, so that a pose has one index in all of them.
class TableReader {
 public:
  TableReader(CampaignFiles& files, const CampaignXml& xml, int joints, std::vector<std::string>& warnings)
      : files_(files), xml_(xml), warnings_(warnings) {
    for (const Target& target : xml.campaign.targets) names_.targets.add(target.id);
    names_.axes = joints;
  }

  template <class Row>
  void read(const TableLayout<Row>& layout, std::optional<Table<Row>>& table) {
    const auto reference = xml_.tables.find(layout.element);
    if (reference == xml_.tables.end()) return;
    const FileReference& file = reference->second.file;
    const io::TextFile bytes = files_.read(file, io::kLargestTable);
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

namespace {

/// The stations that tables name, in order of first appearance; before them that of the rows that name none, where
/// there are such rows. None where no table names one.
void takeStations(const NameList& names, Campaign& campaign) {
  if (names.names().size() < 2) return;
  bool unnamed = false;
  forEachPointTable(campaign, [&](const auto& table) {
    if (table.frame != PointFrame::tracker) return;
    unnamed =
        unnamed || std::any_of(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.station == 0; });
  });
  for (const std::string& name : names.names()) {
    if (!name.empty() || unnamed) campaign.stations.push_back({name});
  }
  if (unnamed) return;
  forEachPointTable(campaign, [](auto& table) {
    for (auto& row : table.rows) row.station = std::max(0, row.station - 1);
  });
}

}  // namespace

CampaignReading readCampaign(const std::filesystem::path& folder_or_xml, Hashes hashes) {
  CampaignReading reading;
  CampaignFiles files(folder_or_xml, hashes == Hashes::taken);
  const CampaignXml xml = readCampaignXml(files.xmlName(), files.readXml().text(), reading.warnings);
  Campaign& campaign = reading.campaign;
  campaign = xml.campaign;
  campaign.folder = files.folder();
  readRobot(files, xml, campaign);

  const int joints = campaign.robot.joints();
  TableReader tables(files, xml, joints, reading.warnings);
  tables.read(circleSweepsLayout(joints), campaign.circle_sweeps);
  tables.read(wristSweepLayout(joints), campaign.wrist_sweep);
  tables.read(railSweepLayout(), campaign.rail_sweep);
  tables.read(loadingLayout(), campaign.loading);
  tables.read(statesLayout(joints), campaign.states);
  tables.read(displacementsLayout(), campaign.displacements);
  tables.read(nestsLayout(), campaign.nests);
  campaign.pose_ids = tables.names().poses.names();
  campaign.nest_ids = tables.names().nests.names();
  campaign.repeat_ids = tables.names().repeats.names();
  requireStationsWherePointsAre(campaign, tables.names().stations.names());
  takeStations(tables.names().stations, campaign);
  files.requireUnchanged();
  campaign.inputs = files.takeInputs();

  figuresToAngles(campaign);
  checkCampaign(campaign, reading.warnings);
  return reading;
}

}  // namespace stiffscope::campaign
