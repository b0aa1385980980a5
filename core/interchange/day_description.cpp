#include "core/interchange/day_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "core/interchange/delimited_text.h"
#include "core/interchange/length_unit.h"
#include "core/interchange/point_file.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

const std::vector<std::string>& dayElements() {
  static const std::vector<std::string> elements{"points", "log", "loads", "join", "target_name"};
  return elements;
}

/// The place of an attribute's value in a list of names.
template <std::size_t N>
std::size_t named(const io::XmlNode& node, const std::string& attribute, const std::string& value,
                  const std::array<const char*, N>& names) {
  const std::vector<std::string> known(names.begin(), names.end());
  for (std::size_t i = 0; i < N; ++i) {
    if (value == names[i]) return i;
  }
  node.refuse(attribute, value,
              fmt::format("expected {}{}", fmt::join(known, ", "), io::nearestNameHint(value, known)));
}

bool yes(const io::XmlNode& node, const std::string& attribute) {
  const std::string value = node.attribute(attribute).value_or("no");
  if (value != "yes" && value != "no") node.refuse(attribute, value, "expected yes or no");
  return value == "yes";
}

std::size_t wholeNumber(const io::XmlNode& node, const std::string& attribute) {
  if (!node.has(attribute)) return 0;
  const double value = node.number(attribute);
  constexpr double kMost = 1e6;
  if (!(value >= 0.0 && value <= kMost && value == std::floor(value)))
    node.refuse(attribute, node.requiredAttribute(attribute), "expected a whole number, 0 or more");
  return static_cast<std::size_t>(value);
}

double positive(const io::XmlNode& node, const std::string& attribute, double least, double most) {
  const double value = node.number(attribute);
  if (!(value >= least && value <= most))
    node.refuse(attribute, node.requiredAttribute(attribute), fmt::format("expected {:g} to {:g}", least, most));
  return value;
}

/// Attributes that every file has: how it is built.
FileOptions readFileOptions(const io::XmlNode& node) {
  FileOptions options;
  if (const auto encoding = node.attribute("encoding")) {
    const std::size_t place = [&] {
      for (std::size_t i = 0; i < encodingNames().size(); ++i) {
        if (*encoding == encodingNames()[i]) return i;
      }
      node.refuse("encoding", *encoding, fmt::format("expected {}", fmt::join(encodingNames(), ", ")));
    }();
    options.encoding = static_cast<Encoding>(place);
  }
  options.columns = node.attribute("columns").value_or("");
  options.separator = node.attribute("separator").value_or("");
  options.decimal_comma = yes(node, "decimal_comma");
  options.skip = wholeNumber(node, "skip");
  options.unit = node.attribute("unit").value_or("");
  if (!options.unit.empty() && !metresIn(options.unit)) node.refuse("unit", options.unit, "expected mm, m or in");
  return options;
}

constexpr std::array<const char*, 3> kJoinNames{"name", "order", "clock"};

PointsSource readPointsSource(const io::XmlNode& node, JoinBy by, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node,
                    {"role", "file", "format", "encoding", "columns", "separator", "decimal_comma", "skip", "unit",
                     "target", "names", "pose", "step", "axis", "only", "frame", "by"},
                    {}, warnings);
  // Where all rows are of one target, names need not say it.
  const std::string names = node.has("target") ? "{*}" : "{target}";
  PointsSource source{.names = NamePattern(node, "names", node.attribute("names").value_or(names))};
  source.target = node.attribute("target").value_or("");
  source.line = node.line();
  source.file = node.requiredName("file");
  source.role = static_cast<Role>(named(node, "role", node.requiredAttribute("role"), kRoleNames));
  source.by = node.has("by") ? static_cast<JoinBy>(named(node, "by", node.requiredAttribute("by"), kJoinNames)) : by;
  source.options = readFileOptions(node);
  if (const auto format = node.attribute("format"))
    source.options.format = static_cast<PointFormat>(named(node, "format", *format, kPointFormatNames));
  source.pose = node.attribute("pose").value_or("");
  source.step = std::to_string(wholeNumber(node, "step"));
  if (!node.has("step")) source.step.clear();
  if (node.has("axis") && source.role != Role::circle_sweeps)
    node.refuse("axis", node.requiredAttribute("axis"), "expected no axis: only in circle_sweeps does one axis turn");
  if (node.has("axis")) {
    const std::size_t axis = wholeNumber(node, "axis");
    // How many there are is known when the URDF has been read (readDayFiles).
    if (axis < 1) node.refuse("axis", node.requiredAttribute("axis"), "expected an axis, from 1 on");
    source.axis = static_cast<int>(axis) - 1;
  }
  if (const auto only = node.attribute("only"))
    for (const std::string_view one : cellsBetweenBlanks(*only, 1)) source.only.emplace_back(one);
  constexpr std::array<const char*, 2> kFrames{"tracker", "base_link"};
  if (const auto frame = node.attribute("frame"))
    source.frame = static_cast<campaign::PointFrame>(named(node, "frame", *frame, kFrames));
  return source;
}

LogSource readLogSource(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node,
                    {"role", "file", "format", "encoding", "columns", "separator", "decimal_comma", "skip", "names",
                     "rate_hz", "every_s"},
                    {}, warnings);
  LogSource source{.names = NamePattern(node, "names", node.attribute("names").value_or("{pose}"))};
  source.line = node.line();
  source.file = node.requiredName("file");
  if (const auto role = node.attribute("role")) source.role = static_cast<Role>(named(node, "role", *role, kRoleNames));
  source.options.table = readFileOptions(node);
  if (const auto format = node.attribute("format"))
    source.options.format = static_cast<LogFormat>(named(node, "format", *format, kLogFormatNames));
  constexpr double kSlowest = 1e-3, kFastest = 1e5;
  constexpr double kShortest = 1e-3, kLongest = 3600.0;
  if (node.has("every_s")) source.every_s = positive(node, "every_s", kShortest, kLongest);
  if (node.has("rate_hz")) source.options.rate_hz = positive(node, "rate_hz", kSlowest, kFastest);
  return source;
}

LoadsSource readLoadsSource(const io::XmlNode& node, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {"file", "encoding", "columns", "separator", "decimal_comma", "skip"}, {}, warnings);
  return {node.requiredName("file"), node.line(), readFileOptions(node)};
}

JoinBy readJoin(const io::XmlNode& root, ClockOptions& clock, std::vector<std::string>& warnings) {
  // Encoders' digits and noise stay below; a robot leaves it within some milliseconds of a motion.
  constexpr double kBandDeg = 0.02;
  clock.standstill.band = kBandDeg * io::kDegree;
  // A log alone, or points alone, have nothing to be joined with.
  if (!root.child("join") && (root.children("points").empty() || root.children("log").empty())) return JoinBy::order;
  const io::XmlNode node = root.requiredChild("join");
  io::warnOfUnknown(node, {"by", "still_deg", "shortest_s", "offset_s"}, {}, warnings);
  if (node.has("still_deg")) clock.standstill.band = positive(node, "still_deg", 1e-6, 5.0) * io::kDegree;
  if (node.has("shortest_s")) clock.standstill.shortest_s = positive(node, "shortest_s", 1e-3, 3600.0);
  if (node.has("offset_s")) clock.offset_s = node.number("offset_s");
  return static_cast<JoinBy>(named(node, "by", node.requiredAttribute("by"), kJoinNames));
}

}  // namespace

DayDescription parseDayDescription(const std::string& file, std::string_view bytes,
                                   std::vector<std::string>& warnings) {
  const io::XmlFile xml(file, bytes);
  const io::XmlNode root = xml.root();
  if (root.name() != "day") root.refuse(root.name(), "", "expected <day> as the root");
  if (const std::string format = root.requiredAttribute("format"); format != "1")
    root.refuse("format", format, "expected 1, the version of DAY.xml this program reads");
  DayDescription day;
  day.file = file;
  day.folder = std::filesystem::path(file).parent_path();
  day.xml = campaign::readCampaignElements(root, dayElements(), warnings);
  if (const auto certificate = root.child("certificate"))
    warnings.push_back(certificate->warning("certificate", certificate->attribute("number").value_or(""),
                                            "is not taken over; it belongs into the campaign.xml that is written"));
  const JoinBy by = readJoin(root, day.clock, warnings);
  for (const io::XmlNode& node : root.children("points")) day.points.push_back(readPointsSource(node, by, warnings));
  for (const io::XmlNode& node : root.children("log")) {
    day.logs.push_back(readLogSource(node, warnings));
    if (day.logs.back().every_s && !day.points.empty())
      node.refuse("every_s", node.requiredAttribute("every_s"),
                  "expected no such attribute beside points: readings are joined with standstills");
  }
  for (const io::XmlNode& node : root.children("loads")) day.loads.push_back(readLoadsSource(node, warnings));
  for (const io::XmlNode& node : root.children("target_name")) {
    io::warnOfUnknown(node, {"from", "to"}, {}, warnings);
    const std::string from = node.requiredName("from");
    if (!day.target_names.emplace(from, node.requiredName("to")).second)
      node.refuse("from", from, "expected a name that does not repeat");
  }
  if (day.points.empty() && day.logs.empty())
    root.refuse("points", "", "expected this element, a file of points, or log, the robot's joints");
  return day;
}

}  // namespace stiffscope::interchange
