#include "core/campaign/write_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/campaign_xml.h"
#include "core/campaign/columns.h"
#include "core/campaign/joint_reading.h"
#include "core/campaign/stated_balancer.h"
#include "core/campaign/table_layouts.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/io/write_folder.h"
#include "core/robot/kinematics.h"

namespace stiffscope::campaign {

/// campaign.xml of a campaign, in the units of the format: the URDF is named robot.urdf, a table after its
/// element (circle_sweeps.csv). Numbers have up to 12 significant digits.
std::string writtenCampaignXml(const Campaign& campaign);

/// A number in the unit of its column, with the decimals of its kind, or as many more as it was read with; "-0.000" is
/// written as "0.000". Throws std::runtime_error, naming the column, for a value that is not finite.
std::string writtenNumber(CellKind kind, double si_value, const std::string& column, WrittenDigits digits);

/// A name as a cell, in quotes where it needs them. Throws std::runtime_error for an empty one and for one
/// with control characters, which no table can hold.
std::string writtenName(const std::string& name, const std::string& column);

/// An index as the file has it: axis and step as numbers, target, pose, nest, station and repeat as names. Throws
/// std::runtime_error for an index without a name.
std::string writtenIndex(CellKind kind, int index, const CampaignNames& names, const std::string& column);

/// How the rows of all tables are written.
struct RowWriting {
  CampaignNames names;
  WrittenDigits digits = WrittenDigits::of_the_format;
};

/// One member of a row as a cell.
template <class Row>
std::string writtenCell(const Column<Row>& column, Row& row, const RowWriting& writing) {
  if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
    const double value = (*number)(row);
    return column.may_be_blank && std::isnan(value) ? std::string()
                                                    : writtenNumber(column.kind, value, column.name, writing.digits);
  }
  if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member)) {
    return writtenIndex(column.kind, (*index)(row), writing.names, column.name);
  }
  return writtenName(std::get<typename Column<Row>::Text>(column.member)(row), column.name);
}

/// Whether the rows have values for an optional column: all of them, or some where the others may be blank; stations
/// where the day has several.
template <class Row>
bool isGiven(const Column<Row>& column, const std::vector<Row>& rows, const RowWriting& writing) {
  if (column.kind == CellKind::station) return writing.names.stations.names().size() > 1;
  if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member); column.kind == CellKind::repeat)
    return std::all_of(rows.begin(), rows.end(), [&](Row row) { return (*index)(row) != kNoRepeat; });
  const auto* number = std::get_if<typename Column<Row>::Number>(&column.member);
  if (number == nullptr) return true;
  const auto has = [&](Row row) { return !std::isnan((*number)(row)); };
  return column.may_be_blank ? std::any_of(rows.begin(), rows.end(), has) : std::all_of(rows.begin(), rows.end(), has);
}

/// The table as CSV, columns in the order of the layout. An optional column is left out unless every row has
/// a value for it, or, where cells may be blank, one row. Handed over a piece at a time: the text of a million rows is
/// larger than they are.
template <class Row>
void writeTable(const TableLayout<Row>& layout, const std::vector<Row>& rows, const RowWriting& writing,
                const io::ByteSink& sink) {
  constexpr std::size_t kPiece = 1 << 16;
  std::vector<const Column<Row>*> columns;
  std::string text;
  for (const Column<Row>& column : layout.columns) {
    if (!column.required && !isGiven(column, rows, writing)) continue;
    if (!columns.empty()) text += ',';
    text += column.name;
    columns.push_back(&column);
  }
  text += '\n';
  for (const Row& own : rows) {
    Row row = own;  // a layout gives access to members of rows that may change
    for (const Column<Row>* column : columns) {
      if (column != columns.front()) text += ',';
      text += writtenCell(*column, row, writing);
    }
    text += '\n';
    if (text.size() < kPiece) continue;
    sink(text);
    text.clear();
  }
  sink(text);
}

namespace {

// Twelve digits hide what the conversion of units adds behind the fifteenth. Adding 0 turns -0 into 0.
std::string written(double value) { return fmt::format("{:.12g}", value + 0.0); }

std::string written(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", written(v.x()), written(v.y()), written(v.z()));
}

/// Elements with text attributes, closed at the end of their scope.
class Element {
 public:
  Element(tinyxml2::XMLPrinter& printer, const char* name) : printer_(printer) { printer.OpenElement(name); }
  ~Element() { printer_.CloseElement(); }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  Element& set(const char* name, const std::string& value) {
    printer_.PushAttribute(name, value.c_str());
    return *this;
  }
  Element& set(const char* name, double value) { return set(name, written(value)); }
  Element& set(const char* name, const Eigen::Vector3d& value) { return set(name, written(value)); }
  Element& setPoint(const Eigen::Vector3d& point) {
    return set("x_mm", point.x() / io::kMillimetre)
        .set("y_mm", point.y() / io::kMillimetre)
        .set("z_mm", point.z() / io::kMillimetre);
  }

 private:
  tinyxml2::XMLPrinter& printer_;
};

void writeTexts(tinyxml2::XMLPrinter& printer, const CampaignTexts& texts) {
  for (const NamedCampaignText& one : kCampaignTexts) {
    if ((texts.*one.text).empty()) continue;
    const Element element(printer, one.element);
    printer.PushText((texts.*one.text).c_str());
  }
}

void writeRobot(tinyxml2::XMLPrinter& printer, const Campaign& campaign) {
  const char* const double_encoder = campaign.double_encoder == DoubleEncoder::active     ? "active"
                                     : campaign.double_encoder == DoubleEncoder::inactive ? "inactive"
                                                                                          : "unspecified";
  Element robot(printer, "robot");
  robot.set("urdf", "robot.urdf").set("base_link", campaign.base_link).set("flange_link", campaign.flange_link);
  robot.set("double_encoder", double_encoder);
  if (!campaign.double_encoder_joints.empty()) {
    std::vector<int> numbers;
    for (const int joint : campaign.double_encoder_joints) numbers.push_back(joint + 1);
    robot.set("double_encoder_joints", fmt::format("{}", fmt::join(numbers, " ")));
  }
  if (campaign.gravity_in_base != Campaign().gravity_in_base) {
    robot.set("gravity_m_s2", campaign.gravity_in_base);
  }
  if (campaign.mass_sigma > 0.0) robot.set("mass_sigma_percent", 100.0 * campaign.mass_sigma);
  if (campaign.controller_model == ControllerModel::nominal) robot.set("controller_model", "nominal");
  if (campaign.controller_model == ControllerModel::absolute_accuracy)
    robot.set("controller_model", "absolute_accuracy");
}

void writeTracker(tinyxml2::XMLPrinter& printer, const Tracker& tracker) {
  Element element(printer, "tracker");
  element.set("model", tracker.model)
      .set("range_fixed_um", tracker.range_fixed / io::kMicrometre)
      .set("range_per_m_um", tracker.range_per_m / io::kMicrometre)
      .set("angle_fixed_um", tracker.angle_fixed / io::kMicrometre)
      .set("angle_per_m_um", tracker.angle_per_m / io::kMicrometre);
  if (!tracker.station.isZero(0.0)) element.setPoint(tracker.station);
  if (tracker.scale_sigma > 0.0) element.set("scale_sigma_ppm", 1e6 * tracker.scale_sigma);
}

void writeTargets(tinyxml2::XMLPrinter& printer, const std::vector<Target>& targets) {
  if (targets.empty()) return;
  const Element list(printer, "targets");
  for (const Target& target : targets) {
    Element element(printer, "target");
    element.set("id", target.id);
    if (target.position_in_flange) element.setPoint(*target.position_in_flange);
  }
}

void writeLoadCell(tinyxml2::XMLPrinter& printer, const LoadCell& cell) {
  Element element(printer, "load_cell");
  element.set("parent", cell.parent);
  if (cell.axes_link) element.set("axes", *cell.axes_link);
  element.set("xyz_mm", Eigen::Vector3d(cell.parent_from_cell.translation() / io::kMillimetre));
  const Eigen::Vector3d rpy = robot::rpyFromRotation(cell.parent_from_cell.linear());
  if (!cell.axes_link) element.set("rpy_deg", Eigen::Vector3d(rpy / io::kDegree));
  element.set("force_sigma_n", cell.force_sigma).set("moment_sigma_nm", cell.moment_sigma);
  if (cell.gain_sigma > 0.0) element.set("gain_sigma_percent", 100.0 * cell.gain_sigma);
  if (cell.angle_sigma > 0.0) element.set("rpy_sigma_deg", cell.angle_sigma / io::kDegree);
  if (cell.point_sigma > 0.0) element.set("xyz_sigma_mm", cell.point_sigma / io::kMillimetre);
}

void writeLaw(const robot::SpringLaw& law, Element& element) {
  element.set("rate_n_per_m", law.rate_n_per_m).set("tension_n", law.tension_n);
  element.set("length_mm", law.length_m / io::kMillimetre);
}

void writeLaw(const robot::GasLaw& law, Element& element) {
  element.set("acts", law.pushes ? "push" : "pull").set("pressure_bar", law.pressure_pa / io::kBar);
  element.set("area_cm2", law.area_m2 / io::kSquareCentimetre).set("volume_l", law.volume_m3 / io::kLitre);
  element.set("length_mm", law.length_m / io::kMillimetre);
  if (law.exponent != 1.0) element.set("exponent", law.exponent);
}

void writeBalancers(tinyxml2::XMLPrinter& printer, const robot::Robot& robot) {
  const auto setEnd = [&](Element& element, const robot::BalancerEnd& end, const char* link, const char* mm) {
    const robot::LinkFrame& frame = linkOf(end, robot);
    const Eigen::Vector3d in_link = frame.base_from_link_at_zero.inverse() * end.in_base_at_zero / io::kMillimetre;
    // A zero comes back from the turn into the link's axes as 1e-13.
    const Eigen::Vector3d shown = in_link.unaryExpr([](double x) { return std::abs(x) < 1e-9 ? 0.0 : x; });
    element.set(link, frame.name).set(mm, shown);
  };
  for (const robot::Balancer& balancer : robot.balancers) {
    Element element(printer, "balancer");
    element.set("kind", std::holds_alternative<robot::GasLaw>(balancer.law) ? "gas" : "spring");
    setEnd(element, balancer.from, "from_link", "from_mm");
    setEnd(element, balancer.to, "to_link", "to_mm");
    std::visit([&](const auto& law) { writeLaw(law, element); }, balancer.law);
    if (balancer.shortest_m) element.set("shortest_mm", *balancer.shortest_m / io::kMillimetre);
    if (balancer.longest_m) element.set("longest_mm", *balancer.longest_m / io::kMillimetre);
  }
}

void writeJointReadings(tinyxml2::XMLPrinter& printer, const std::vector<JointReading>& readings) {
  for (const JointReading& reading : readings) {
    Element element(printer, "joint_reading");
    element.set("joint", std::to_string(reading.joint + 1)).set("sign", reading.sign);
    if (reading.offset != 0.0) element.set("offset_deg", reading.offset / io::kDegree);
    if (reading.plus >= 0) element.set("plus", std::to_string(reading.plus + 1));
  }
}

template <class Row>
void writeTableReference(tinyxml2::XMLPrinter& printer, const std::string& element,
                         const std::optional<Table<Row>>& table) {
  if (!table) return;
  Element node(printer, element.c_str());
  node.set("file", element + ".csv");
  if (table->frame == PointFrame::base_link) node.set("frame", "base_link");
}

}  // namespace

std::string writtenCampaignXml(const Campaign& campaign) {
  tinyxml2::XMLPrinter printer;
  printer.PushDeclaration("xml version=\"1.0\" encoding=\"UTF-8\"");
  {
    Element root(printer, "campaign");
    root.set("format", "1").set("name", campaign.name).set("date", campaign.date);
    writeTexts(printer, campaign.texts);
    writeRobot(printer, campaign);
    if (campaign.tracker) writeTracker(printer, *campaign.tracker);
    writeTargets(printer, campaign.targets);
    if (campaign.load_cell) writeLoadCell(printer, *campaign.load_cell);
    if (campaign.tool) {
      Element tool(printer, "tool");
      tool.set("mass_kg", campaign.tool->mass_kg);
      tool.set("com_mm", Eigen::Vector3d(campaign.tool->com_in_flange / io::kMillimetre));
    }
    for (const KnownStiffness& known : campaign.known_stiffness) {
      Element element(printer, "known_stiffness");
      element.set("joint", std::to_string(known.joint + 1))
          .set("nm_per_rad", known.stiffness)
          .set("sd_nm_per_rad", known.sd)
          .set("source", known.source);
    }
    writeBalancers(printer, campaign.robot);
    writeJointReadings(printer, campaign.joint_readings);
    writeTableReference(printer, "circle_sweeps", campaign.circle_sweeps);
    writeTableReference(printer, "wrist_sweep", campaign.wrist_sweep);
    writeTableReference(printer, "rail_sweep", campaign.rail_sweep);
    writeTableReference(printer, "loading", campaign.loading);
    writeTableReference(printer, "states", campaign.states);
    writeTableReference(printer, "displacements", campaign.displacements);
    writeTableReference(printer, "nests", campaign.nests);
  }
  return printer.CStr();
}

namespace {

[[noreturn]] void fail(const std::string& column, const std::string& why) {
  throw std::runtime_error(fmt::format("the campaign cannot be written: {}: {}", column, why));
}

}  // namespace

std::string writtenNumber(CellKind kind, double si_value, const std::string& column, WrittenDigits digits) {
  if (!std::isfinite(si_value)) fail(column, "a value is not finite");
  const NumberKind& info = numberKind(kind);
  constexpr int kMore = 3;
  const int more = digits == WrittenDigits::as_read ? kMore : 0;
  std::string text = fmt::format("{:.{}f}", si_value / info.si_per_unit, info.decimals + more);
  for (int k = 0; k < more && text.back() == '0'; ++k) text.pop_back();
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
  return text;
}

std::string writtenName(const std::string& name, const std::string& column) {
  if (name.empty()) fail(column, "a name is empty");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(name.begin(), name.end(), is_control)) fail(column, "a name has a control character");
  const bool plain = name.find_first_of(",\";") == std::string::npos && name.front() != ' ' && name.back() != ' ';
  if (plain) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string writtenIndex(CellKind kind, int index, const CampaignNames& names, const std::string& column) {
  if (kind == CellKind::axis) return fmt::format("{}", index + 1);
  if (kind == CellKind::step || (kind == CellKind::repeat && index >= 0)) return fmt::format("{}", index);
  if (kind == CellKind::repeat) index = repeatByName(index);
  const std::vector<std::string>& known = kind == CellKind::target    ? names.targets.names()
                                          : kind == CellKind::pose    ? names.poses.names()
                                          : kind == CellKind::station ? names.stations.names()
                                          : kind == CellKind::repeat  ? names.repeats.names()
                                                                      : names.nests.names();
  if (index < 0 || static_cast<std::size_t>(index) >= known.size()) {
    fail(column, fmt::format("index {} has no name", index));
  }
  // A row may name no station.
  if (kind == CellKind::station && known[static_cast<std::size_t>(index)].empty()) return {};
  return writtenName(known[static_cast<std::size_t>(index)], column);
}

namespace {

template <class Row>
void addTable(const TableLayout<Row>& layout, const std::optional<Table<Row>>& table, const RowWriting& writing,
              std::vector<io::FileToWrite>& files) {
  if (!table) return;
  const bool from_stations = table->frame == PointFrame::tracker && !std::is_same_v<Row, Displacement>;
  const io::ByteSource bytes = [layout, &rows = table->rows, &writing, from_stations](const io::ByteSink& sink) {
    if (from_stations) return writeTable(layout, rows, writing, sink);
    RowWriting without_stations = writing;
    without_stations.names.stations = {};
    writeTable(layout, rows, without_stations, sink);
  };
  files.emplace_back(layout.element + ".csv", bytes);
}

CampaignNames namesOf(const Campaign& campaign) {
  CampaignNames names;
  for (const Target& target : campaign.targets) names.targets.add(target.id);
  for (const std::string& pose : campaign.pose_ids) names.poses.add(pose);
  for (const std::string& nest : campaign.nest_ids) names.nests.add(nest);
  for (const std::string& repeat : campaign.repeat_ids) names.repeats.add(repeat);
  names.stations = {};
  for (const StationPlace& station : campaign.stations) names.stations.add(station.id);
  return names;
}

}  // namespace

namespace {

void writeFigures(const Campaign& campaign, const std::filesystem::path& urdf_file, const std::filesystem::path& folder,
                  const std::vector<io::FileToWrite>& beside, WrittenDigits digits, const std::string& expectation) {
  const std::string urdf = io::readTextFile(urdf_file, io::kLargestXml);
  const RowWriting writing{namesOf(campaign), digits};
  const int joints = campaign.robot.joints();
  std::vector<io::FileToWrite> files{{"robot.urdf", urdf}};
  addTable(circleSweepsLayout(joints), campaign.circle_sweeps, writing, files);
  addTable(wristSweepLayout(joints), campaign.wrist_sweep, writing, files);
  addTable(railSweepLayout(), campaign.rail_sweep, writing, files);
  addTable(loadingLayout(), campaign.loading, writing, files);
  addTable(statesLayout(joints), campaign.states, writing, files);
  addTable(displacementsLayout(), campaign.displacements, writing, files);
  addTable(nestsLayout(), campaign.nests, writing, files);
  files.insert(files.end(), beside.begin(), beside.end());
  // Last, because a folder with a campaign.xml passes for a campaign.
  files.push_back({"campaign.xml", writtenCampaignXml(campaign)});
  for (const io::FileToWrite& file : files) {
    std::error_code none;
    if (expectation.empty() || !std::filesystem::exists(folder / file.name, none)) continue;
    throw std::runtime_error((folder / file.name).string() + ": not written: it is there; " + expectation);
  }
  io::writeFolderWhole(folder, files);
}

}  // namespace

void writeCampaign(const Campaign& campaign, const std::filesystem::path& urdf_file,
                   const std::filesystem::path& folder, const std::vector<io::FileToWrite>& beside,
                   WrittenDigits digits, const std::string& expectation) {
  if (campaign.joint_readings.empty()) return writeFigures(campaign, urdf_file, folder, beside, digits, expectation);
  Campaign figures = campaign;
  anglesToFigures(figures);
  writeFigures(figures, urdf_file, folder, beside, digits, expectation);
}

}  // namespace stiffscope::campaign
