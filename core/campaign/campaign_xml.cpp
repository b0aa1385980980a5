#include "core/campaign/campaign_xml.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/campaign/columns.h"
#include "core/campaign/iso_date.h"
#include "core/campaign/joint_reading.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/io/xml.h"
#include "core/robot/kinematics.h"

// One function a section of campaign.xml; each takes the section's element, converts to SI and radians, and
// throws InputError for what the format does not allow.

namespace stiffscope::campaign {

Tracker readTracker(const io::XmlNode& node, std::vector<std::string>& warnings);
std::vector<Target> readTargets(const io::XmlNode& node, std::vector<std::string>& warnings);
LoadCell readLoadCell(const io::XmlNode& node, std::vector<std::string>& warnings);
robot::Tool readTool(const io::XmlNode& node, std::vector<std::string>& warnings);
KnownStiffness readKnownStiffness(const io::XmlNode& node, std::vector<std::string>& warnings);
TableReference readTableReference(const io::XmlNode& node, std::vector<std::string>& warnings);

namespace {

double numberOrZero(const io::XmlNode& node, const std::string& attribute) {
  return node.has(attribute) ? node.number(attribute) : 0.0;
}

double notNegative(const io::XmlNode& node, const std::string& attribute) {
  const double value = node.number(attribute);
  if (value < 0.0) node.refuse(attribute, node.requiredAttribute(attribute), "expected 0 or more");
  return value;
}

// The same limits hold for an attribute as for the cells of a table.
void requirePlausible(const io::XmlNode& node, const std::string& attribute, CellKind kind, double magnitude) {
  const NumberKind& info = numberKind(kind);
  if (magnitude > info.limit) node.refuse(attribute, node.requiredAttribute(attribute), info.expectation);
}

// Readings without noise would outweigh all others without bound; and no tracker is a decimetre off.
void requireNoise(const io::XmlNode& node, const std::string& attribute, double sum) {
  constexpr double kLeast = 1e-9, kMost = 0.1;  // m
  if (sum >= kLeast && sum <= kMost) return;
  node.refuse(attribute, node.requiredAttribute(attribute),
              "expected, together with what grows by the metre, 0.001 to 100000 um");
}

double atMost(const io::XmlNode& node, const std::string& attribute, double limit) {
  const double value = notNegative(node, attribute);
  if (value > limit)
    node.refuse(attribute, node.requiredAttribute(attribute), fmt::format("expected 0 to {:.0f}", limit));
  return value;
}

Eigen::Vector3d millimetres(const io::XmlNode& node, const std::string& attribute) {
  const Eigen::Vector3d value = node.vector(attribute);
  requirePlausible(node, attribute, CellKind::millimetre, value.cwiseAbs().maxCoeff());
  return value * io::kMillimetre;
}

Eigen::Vector3d pointOf(const io::XmlNode& node) {
  Eigen::Vector3d point;
  const char* const attributes[] = {"x_mm", "y_mm", "z_mm"};
  for (int i = 0; i < 3; ++i) {
    const double value = numberOrZero(node, attributes[i]);
    requirePlausible(node, attributes[i], CellKind::millimetre, std::abs(value));
    point[i] = value * io::kMillimetre;
  }
  return point;
}

/// A standard uncertainty that may be stated, in units of `unit`; 0 where it is not.
double declaredSigma(const io::XmlNode& node, const char* attribute, double most, double unit) {
  return node.has(attribute) ? atMost(node, attribute, most) * unit : 0.0;
}

Target readTarget(const io::XmlNode& node) {
  Target target{node.requiredName("id"), std::nullopt};
  const int given = node.has("x_mm") + node.has("y_mm") + node.has("z_mm");
  if (given == 0) return target;
  if (given != 3) node.refuse("target", target.id, "expected all three of x_mm, y_mm and z_mm, or none");
  target.position_in_flange = pointOf(node);
  return target;
}

}  // namespace

Tracker readTracker(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node,
                    {"model", "range_fixed_um", "range_per_m_um", "angle_fixed_um", "angle_per_m_um", "x_mm", "y_mm",
                     "z_mm", "scale_sigma_ppm"},
                    {}, warnings);
  Tracker tracker;
  tracker.model = node.requiredAttribute("model");
  tracker.range_fixed = notNegative(node, "range_fixed_um") * io::kMicrometre;
  tracker.range_per_m = notNegative(node, "range_per_m_um") * io::kMicrometre;
  tracker.angle_fixed = notNegative(node, "angle_fixed_um") * io::kMicrometre;
  tracker.angle_per_m = notNegative(node, "angle_per_m_um") * io::kMicrometre;
  requireNoise(node, "range_fixed_um", tracker.range_fixed + tracker.range_per_m);
  requireNoise(node, "angle_fixed_um", tracker.angle_fixed + tracker.angle_per_m);
  tracker.station = pointOf(node);
  constexpr double kMostPpm = 10'000.0, kPpm = 1e-6;
  tracker.scale_sigma = declaredSigma(node, "scale_sigma_ppm", kMostPpm, kPpm);
  return tracker;
}

std::vector<Target> readTargets(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {}, {"target"}, warnings);
  std::vector<Target> targets;
  std::unordered_map<std::string, std::size_t> first_line;
  // Each has three unknowns of its own, and what is computed from them grows with their square.
  constexpr std::size_t kMost = 100;
  for (const io::XmlNode& child : node.children("target")) {
    io::warnOfUnknown(child, {"id", "x_mm", "y_mm", "z_mm"}, {}, warnings);
    targets.push_back(readTarget(child));
    if (targets.size() > kMost)
      child.refuse("id", targets.back().id, "expected at most 100 targets: each has a place that is fitted");
    const auto [first, added] = first_line.emplace(targets.back().id, child.line());
    if (!added) {
      child.refuse("id", targets.back().id,
                   fmt::format("expected an id that does not repeat; line {} has it first", first->second));
    }
  }
  return targets;
}

LoadCell readLoadCell(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node,
                    {"parent", "xyz_mm", "rpy_deg", "force_sigma_n", "moment_sigma_nm", "axes", "gain_sigma_percent",
                     "rpy_sigma_deg", "xyz_sigma_mm"},
                    {}, warnings);
  LoadCell cell;
  cell.parent = node.requiredName("parent");
  cell.parent_from_cell.translation() = millimetres(node, "xyz_mm");
  if (node.has("axes")) cell.axes_link = node.requiredName("axes");
  if (!cell.axes_link || node.has("rpy_deg")) {
    const Eigen::Vector3d rpy = node.vector("rpy_deg");
    requirePlausible(node, "rpy_deg", CellKind::degree, rpy.cwiseAbs().maxCoeff());
    if (!cell.axes_link) cell.parent_from_cell.linear() = robot::rotationFromRpy(rpy * io::kDegree);
  }
  constexpr double kMostSigma = 1e6;  // N and Nm, as of the readings themselves
  cell.force_sigma = atMost(node, "force_sigma_n", kMostSigma);
  cell.moment_sigma = atMost(node, "moment_sigma_nm", kMostSigma);
  constexpr double kMostGainPercent = 50.0;
  cell.gain_sigma = declaredSigma(node, "gain_sigma_percent", kMostGainPercent, 0.01);
  constexpr double kMostTurn = 20.0, kMostOffset = 500.0;  // deg and mm
  cell.angle_sigma = declaredSigma(node, "rpy_sigma_deg", kMostTurn, io::kDegree);
  cell.point_sigma = declaredSigma(node, "xyz_sigma_mm", kMostOffset, io::kMillimetre);
  const double lever = cell.parent_from_cell.translation().norm() / io::kMillimetre;
  if (lever > 0.0 && lever < 1.0)
    warnings.push_back(
        node.warning("xyz_mm", node.requiredAttribute("xyz_mm"), "less than a millimetre: written in metres?"));
  return cell;
}

robot::Tool readTool(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {"mass_kg", "com_mm"}, {}, warnings);
  constexpr double kMostMass = 5000.0;  // kg, more than the strongest arm carries
  return {atMost(node, "mass_kg", kMostMass), millimetres(node, "com_mm")};
}

namespace {

/// From 0, of an attribute that counts joints from 1.
int jointNumbered(const io::XmlNode& node, const std::string& attribute) {
  const double joint = node.number(attribute);
  if (joint != std::floor(joint) || joint < 1.0 || joint > kMostJoints)
    node.refuse(attribute, node.requiredAttribute(attribute),
                fmt::format("expected a joint's number, 1 to {}", kMostJoints));
  return static_cast<int>(joint) - 1;
}

}  // namespace

std::vector<JointNumber> readDoubleEncoderJoints(const io::XmlNode& node) {
  constexpr const char* kAttribute = "double_encoder_joints";
  std::vector<JointNumber> numbers;
  if (!node.has(kAttribute)) return numbers;
  const std::string text = node.requiredAttribute(kAttribute);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    // One digit: kMostJoints is less than ten.
    if (word.size() != 1 || word[0] < '1' || word[0] > '0' + kMostJoints)
      node.refuse(kAttribute, word, fmt::format("expected joints' numbers, 1 to {}, with blanks between", kMostJoints));
    const int joint = word[0] - '1';
    if (std::any_of(numbers.begin(), numbers.end(), [joint](const JointNumber& one) { return one.joint == joint; }))
      node.refuse(kAttribute, word, "expected a joint that does not repeat");
    numbers.push_back({joint, node.file(), node.line(), kAttribute, word});
  }
  if (numbers.empty()) node.refuse(kAttribute, text, "expected joints' numbers, as 1 2 3, or no such attribute");
  std::sort(numbers.begin(), numbers.end(), [](const auto& a, const auto& b) { return a.joint < b.joint; });
  return numbers;
}

JointReading readJointReading(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {"joint", "sign", "offset_deg", "plus"}, {}, warnings);
  JointReading reading;
  reading.joint = jointNumbered(node, "joint");
  if (node.has("sign")) {
    reading.sign = node.number("sign");
    if (std::abs(reading.sign) != 1.0) node.refuse("sign", node.requiredAttribute("sign"), "expected 1 or -1");
  }
  if (node.has("offset_deg")) {
    const double offset = node.number("offset_deg");
    requirePlausible(node, "offset_deg", CellKind::degree, std::abs(offset));
    reading.offset = offset * io::kDegree;
  }
  if (!node.has("plus")) return reading;
  reading.plus = jointNumbered(node, "plus");
  if (reading.plus == reading.joint)
    node.refuse("plus", node.requiredAttribute("plus"), "expected another joint than this one");
  return reading;
}

KnownStiffness readKnownStiffness(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {"joint", "nm_per_rad", "sd_nm_per_rad", "source"}, {}, warnings);
  KnownStiffness known;
  known.joint = jointNumbered(node, "joint");
  // From a toy's joint to a hundred times the stiffest drive.
  constexpr double kLeast = 1.0, kMost = 1e10;
  known.stiffness = node.number("nm_per_rad");
  if (!(known.stiffness >= kLeast && known.stiffness <= kMost))
    node.refuse("nm_per_rad", node.requiredAttribute("nm_per_rad"), "expected Nm/rad, 1 to 1e10");
  known.sd = node.number("sd_nm_per_rad");
  // Nothing is known exactly, and what is known no better than to a factor of two is not known.
  constexpr double kMostShare = 0.5;
  if (!(known.sd > 0.0 && known.sd <= kMostShare * known.stiffness))
    node.refuse("sd_nm_per_rad", node.requiredAttribute("sd_nm_per_rad"),
                "expected a standard uncertainty above 0 and at most half of nm_per_rad");
  known.source = node.requiredName("source");
  return known;
}

TableReference readTableReference(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {"file", "frame"}, {}, warnings);
  TableReference table{{node.requiredName("file"), "file", node.line()}, PointFrame::tracker};
  const std::string frame = node.attribute("frame").value_or("tracker");
  if (frame == "base_link") {
    table.frame = PointFrame::base_link;
  } else if (frame != "tracker") {
    node.refuse("frame", frame, "expected base_link, or tracker, or no such attribute");
  }
  return table;
}

namespace {

std::vector<std::string> knownElements(const std::vector<std::string>& also) {
  std::vector<std::string> known{"robot",           "tracker",       "targets",  "load_cell",  "tool",
                                 "known_stiffness", "joint_reading", "balancer", "certificate"};
  known.insert(known.end(), also.begin(), also.end());
  for (const NamedCampaignText& one : kCampaignTexts) known.emplace_back(one.element);
  return known;
}

void requireFormatOne(const io::XmlNode& root) {
  if (root.name() != "campaign") {
    root.refuse(root.name(), "", "expected <campaign> as the root of campaign.xml");
  }
  const std::string format = root.requiredAttribute("format");
  if (format != "1") root.refuse("format", format, "expected 1, the version of the format this program reads");
}

DoubleEncoder readDoubleEncoder(const io::XmlNode& node) {
  const std::string value = node.attribute("double_encoder").value_or("unspecified");
  if (value == "active") return DoubleEncoder::active;
  if (value == "inactive") return DoubleEncoder::inactive;
  if (value == "unspecified") return DoubleEncoder::unspecified;
  node.refuse(
      "double_encoder", value,
      "expected active, inactive or unspecified" + io::nearestNameHint(value, {"active", "inactive", "unspecified"}));
}

ControllerModel readControllerModel(const io::XmlNode& node) {
  const std::string value = node.attribute("controller_model").value_or("unspecified");
  if (value == "unspecified") return ControllerModel::unspecified;
  if (value == "nominal") return ControllerModel::nominal;
  if (value == "absolute_accuracy") return ControllerModel::absolute_accuracy;
  node.refuse("controller_model", value,
              "expected nominal, absolute_accuracy or unspecified" +
                  io::nearestNameHint(value, {"nominal", "absolute_accuracy", "unspecified"}));
}

/// Joints that report something else than the URDF's angle, each once and none in a circle.
void readJointReadings(const io::XmlNode& root, Campaign& campaign, std::vector<std::string>& warnings) {
  for (const io::XmlNode& node : root.children("joint_reading")) {
    const JointReading reading = readJointReading(node, warnings);
    if (std::any_of(campaign.joint_readings.begin(), campaign.joint_readings.end(),
                    [&](const JointReading& one) { return one.joint == reading.joint; }))
      node.refuse("joint", node.requiredAttribute("joint"), "expected a joint that does not repeat");
    campaign.joint_readings.push_back(reading);
    if (JointConvention(campaign.joint_readings, kMostJoints).invertible()) continue;
    node.refuse("plus", node.requiredAttribute("plus"), "expected joints that are not added to each other in a circle");
  }
}

void readRobotElement(const io::XmlNode& node, CampaignXml& xml, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node,
                    {"urdf", "base_link", "flange_link", "double_encoder", "double_encoder_joints", "gravity_m_s2",
                     "mass_sigma_percent", "controller_model"},
                    {}, warnings);
  xml.urdf = {node.requiredName("urdf"), "urdf", node.line()};
  xml.campaign.base_link = node.requiredName("base_link");
  xml.campaign.flange_link = node.requiredName("flange_link");
  xml.campaign.double_encoder = readDoubleEncoder(node);
  for (JointNumber& number : readDoubleEncoderJoints(node)) {
    xml.campaign.double_encoder_joints.push_back(number.joint);
    xml.joint_numbers.push_back(std::move(number));
  }
  xml.campaign.controller_model = readControllerModel(node);
  constexpr double kMostMassPercent = 50.0;
  xml.campaign.mass_sigma = declaredSigma(node, "mass_sigma_percent", kMostMassPercent, 0.01);
  if (!node.has("gravity_m_s2")) return;
  xml.campaign.gravity_in_base = node.vector("gravity_m_s2");
  constexpr double kStrongest = 20.0;
  if (xml.campaign.gravity_in_base.norm() > kStrongest) {
    node.refuse("gravity_m_s2", node.requiredAttribute("gravity_m_s2"), "expected m/s^2, at most 20");
  }
}

void readSections(const io::XmlNode& root, CampaignXml& xml, std::vector<std::string>& warnings) {
  Campaign& campaign = xml.campaign;
  readRobotElement(root.requiredChild("robot"), xml, warnings);
  if (const auto node = root.child("tracker")) campaign.tracker = readTracker(*node, warnings);
  if (const auto node = root.child("targets")) campaign.targets = readTargets(*node, warnings);
  if (const auto node = root.child("load_cell")) {
    campaign.load_cell = readLoadCell(*node, warnings);
    xml.load_cell_line = node->line();
  }
  if (const auto node = root.child("tool")) campaign.tool = readTool(*node, warnings);
  for (const io::XmlNode& node : root.children("known_stiffness")) {
    campaign.known_stiffness.push_back(readKnownStiffness(node, warnings));
    const int joint = campaign.known_stiffness.back().joint;
    if (std::count_if(campaign.known_stiffness.begin(), campaign.known_stiffness.end(),
                      [&](const KnownStiffness& one) { return one.joint == joint; }) > 1)
      node.refuse("joint", node.requiredAttribute("joint"), "expected a joint that does not repeat");
  }
  for (const io::XmlNode& node : root.children("balancer")) xml.balancers.push_back(readBalancer(node, warnings));
  readJointReadings(root, campaign, warnings);
  for (const char* element : {"known_stiffness", "joint_reading"}) {
    for (const io::XmlNode& node : root.children(element)) {
      for (const char* attribute : {"joint", "plus"}) {
        if (!node.has(attribute)) continue;
        xml.joint_numbers.push_back(
            {jointNumbered(node, attribute), node.file(), node.line(), attribute, node.requiredAttribute(attribute)});
      }
    }
  }
  for (const NamedCampaignText& one : kCampaignTexts) {
    if (const auto node = root.child(one.element)) campaign.texts.*one.text = node->text();
  }
}

}  // namespace

void requireJoints(const std::vector<JointNumber>& numbers, int joints) {
  for (const JointNumber& number : numbers) {
    if (number.joint < joints) continue;
    throw io::InputError({number.file, number.line, number.attribute}, number.value,
                         fmt::format("expected a joint's number, 1 to {}", joints));
  }
}

const std::vector<std::string>& tableElements() {
  static const std::vector<std::string> elements{"circle_sweeps", "wrist_sweep",   "rail_sweep", "loading",
                                                 "states",        "displacements", "nests"};
  return elements;
}

CampaignXml readCampaignElements(const io::XmlNode& root, const std::vector<std::string>& also,
                                 std::vector<std::string>& warnings) {
  io::warnOfUnknown(root, {"format", "name", "date"}, knownElements(also), warnings);
  CampaignXml xml;
  xml.campaign.name = root.requiredAttribute("name");
  xml.campaign.date = root.requiredAttribute("date");
  if (!xml.campaign.date.empty() && !beginsWithIsoDate(xml.campaign.date))
    warnings.push_back(root.warning("date", xml.campaign.date,
                                    "expected a date such as 2026-11-21; kept as text: `fleet` cannot put it in order, "
                                    "and no certificate takes it"));
  readSections(root, xml, warnings);
  return xml;
}

CampaignXml readCampaignXml(const std::string& file, std::string_view bytes, std::vector<std::string>& warnings) {
  const io::XmlFile xml_file(file, bytes);
  const io::XmlNode root = xml_file.root();
  requireFormatOne(root);
  CampaignXml xml = readCampaignElements(root, tableElements(), warnings);
  for (const std::string& element : tableElements()) {
    if (const auto node = root.child(element)) xml.tables[element] = readTableReference(*node, warnings);
  }
  return xml;
}

}  // namespace stiffscope::campaign
