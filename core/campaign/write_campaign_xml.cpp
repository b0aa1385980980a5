#include "core/campaign/write_campaign_xml.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/campaign/campaign_xml.h"
#include "core/input/roll_pitch_yaw.h"
#include "core/input/units.h"

namespace stiffscope {

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
    return set("x_mm", point.x() / kMillimetre)
        .set("y_mm", point.y() / kMillimetre)
        .set("z_mm", point.z() / kMillimetre);
  }

 private:
  tinyxml2::XMLPrinter& printer_;
};

void writeTexts(tinyxml2::XMLPrinter& printer, const CampaignTexts& texts) {
  const std::pair<const char*, const std::string&> elements[] = {{"laboratory", texts.laboratory},
                                                                 {"customer", texts.customer},
                                                                 {"operator", texts.operator_name},
                                                                 {"item", texts.item},
                                                                 {"conditions", texts.conditions}};
  for (const auto& [name, text] : elements) {
    if (text.empty()) continue;
    const Element element(printer, name);
    printer.PushText(text.c_str());
  }
}

void writeRobot(tinyxml2::XMLPrinter& printer, const Campaign& campaign) {
  const char* const double_encoder = campaign.double_encoder == DoubleEncoder::active     ? "active"
                                     : campaign.double_encoder == DoubleEncoder::inactive ? "inactive"
                                                                                          : "unspecified";
  Element robot(printer, "robot");
  robot.set("urdf", "robot.urdf")
      .set("base_link", campaign.base_link)
      .set("flange_link", campaign.flange_link);
  robot.set("double_encoder", double_encoder);
  if (campaign.gravity_in_base != Campaign().gravity_in_base) {
    robot.set("gravity_m_s2", campaign.gravity_in_base);
  }
}

void writeTracker(tinyxml2::XMLPrinter& printer, const Tracker& tracker) {
  Element element(printer, "tracker");
  element.set("model", tracker.model)
      .set("range_fixed_um", tracker.range_fixed / kMicrometre)
      .set("range_per_m_um", tracker.range_per_m / kMicrometre)
      .set("angle_fixed_um", tracker.angle_fixed / kMicrometre)
      .set("angle_per_m_um", tracker.angle_per_m / kMicrometre);
  if (!tracker.station.isZero(0.0)) element.setPoint(tracker.station);
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
  element.set("xyz_mm", Eigen::Vector3d(cell.parent_from_cell.translation() / kMillimetre));
  const Eigen::Vector3d rpy = rpyFromRotation(cell.parent_from_cell.linear());
  if (!cell.axes_link) element.set("rpy_deg", Eigen::Vector3d(rpy / kDegree));
  element.set("force_sigma_n", cell.force_sigma).set("moment_sigma_nm", cell.moment_sigma);
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
      tool.set("com_mm", Eigen::Vector3d(campaign.tool->com_in_flange / kMillimetre));
    }
    writeTableReference(printer, "circle_sweeps", campaign.circle_sweeps);
    writeTableReference(printer, "wrist_sweep", campaign.wrist_sweep);
    writeTableReference(printer, "loading", campaign.loading);
    writeTableReference(printer, "states", campaign.states);
    writeTableReference(printer, "displacements", campaign.displacements);
    writeTableReference(printer, "nests", campaign.nests);
  }
  return printer.CStr();
}

}  // namespace stiffscope
