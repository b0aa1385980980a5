#include <cmath>
#include <map>
#include <optional>

#include "core/interchange/point_formats.h"
#include "core/io/xml.h"

namespace stiffscope::interchange {

namespace {

constexpr const char* kRoot = "oiProjectData";

/// Values and standard uncertainties of a reading by their type: azimuth, zenith, distance; or x, y, z.
struct Measured {
  double value = 0.0, sigma = 0.0;
};
using Measurements = std::map<std::string, Measured>;

Measurements measurementsOf(const io::XmlNode& reading) {
  Measurements all;
  const auto list = reading.child("measurements");
  if (!list) return all;
  for (const io::XmlNode& one : list->children("measurement")) {
    const double sigma = one.has("sigma") ? one.number("sigma") : 0.0;
    if (sigma < 0.0)
      one.refuse("sigma", one.requiredAttribute("sigma"), "expected a standard uncertainty, not below zero");
    all[one.requiredName("type")] = {one.number("value"), sigma};
  }
  return all;
}

bool has(const Measurements& all, std::initializer_list<const char*> types) {
  for (const char* type : types) {
    if (!all.contains(type)) return false;
  }
  return true;
}

/// x = d sin z cos a, y = d sin z sin a, z = d cos z; a second face has z beyond pi and a turned by pi, which gives the
/// same point. Uncertainties by the derivatives; none where none is stated.
void placePolar(const Measurements& all, PointReading& point) {
  const Measured azimuth = all.at("azimuth"), zenith = all.at("zenith"), distance = all.at("distance");
  const double sz = std::sin(zenith.value), cz = std::cos(zenith.value), sa = std::sin(azimuth.value),
               ca = std::cos(azimuth.value), d = distance.value;
  point.point = d * Eigen::Vector3d(sz * ca, sz * sa, cz);
  Eigen::Matrix3d derivative;
  derivative.col(0) = d * Eigen::Vector3d(-sz * sa, sz * ca, 0.0);
  derivative.col(1) = d * Eigen::Vector3d(cz * ca, cz * sa, -sz);
  derivative.col(2) = Eigen::Vector3d(sz * ca, sz * sa, cz);
  const Eigen::Vector3d sigmas(azimuth.sigma, zenith.sigma, distance.sigma);
  if (!sigmas.isZero(0.0)) point.sigma = (derivative * sigmas.asDiagonal()).rowwise().norm();
}

void placeCartesian(const Measurements& all, PointReading& point) {
  const Measured &x = all.at("x"), &y = all.at("y"), &z = all.at("z");
  point.point = {x.value, y.value, z.value};
  const Eigen::Vector3d sigmas(x.sigma, y.sigma, z.sigma);
  if (!sigmas.isZero(0.0)) point.sigma = sigmas;
}

/// Names of elements by their ids.
using Names = std::map<std::string, std::string>;

void addNames(const io::XmlNode& root, const char* list, const char* element, Names& names) {
  const auto all = root.child(list);
  if (!all) return;
  for (const io::XmlNode& one : all->children(element)) {
    names[one.attribute("id").value_or("")] = one.attribute("name").value_or("");
  }
}

std::string nameBy(const io::XmlNode& observation, const char* element, const Names& names) {
  const std::vector<io::XmlNode> links = observation.children(element);
  if (links.empty()) return {};
  const std::string id = links.front().requiredAttribute("ref");
  const auto found = names.find(id);
  if (found == names.end()) links.front().refuse("ref", id, "expected the id of an element of this project");
  return found->second;
}

std::optional<PointReading> pointOfReading(const io::XmlNode& reading) {
  const Measurements all = measurementsOf(reading);
  PointReading point;
  if (has(all, {"azimuth", "zenith", "distance"})) {
    placePolar(all, point);
  } else if (has(all, {"x", "y", "z"})) {
    placeCartesian(all, point);
  } else {
    return std::nullopt;
  }
  point.line = reading.line();
  if (const auto time = reading.attribute("time"); time && !time->empty()) {
    point.time = parseTimestamp(*time);
    if (!point.time) reading.refuse("time", *time, "expected a date and a time, as 2019-05-28T15:19:48");
  }
  return point;
}

/// As XML writes truth, by either of its two ways.
bool isValid(const io::XmlNode& observation) {
  const std::string value = observation.attribute("isValid").value_or("1");
  if (value == "1" || value == "true") return true;
  if (value != "0" && value != "false") observation.refuse("isValid", value, "expected 1 or true, 0 or false");
  return false;
}

}  // namespace

bool looksLikeOpenIndy(std::string_view text) {
  const std::string_view start = trimmed(text.substr(0, 2000));
  return start.starts_with('<') && start.find(kRoot) != std::string_view::npos;
}

PointFile readOpenIndy(const FileText& text) {
  const io::XmlFile xml(text.file, text.text);
  const io::XmlNode root = xml.root();
  if (root.name() != kRoot) root.refuse(root.name(), "", "expected <oiProjectData>, a project of OpenIndy");
  Names stations, geometries;
  addNames(root, "stations", "station", stations);
  addNames(root, "geometries", "geometry", geometries);
  PointFile points;
  points.format = PointFormat::openindy;
  PointGroups groups;
  const auto observations = root.child("observations");
  if (!observations) root.refuse("observations", "", "expected this element, which holds the readings");
  for (const io::XmlNode& observation : observations->children("observation")) {
    const std::string station = nameBy(observation, "station", stations);
    const bool valid = isValid(observation);
    for (const io::XmlNode& reading : observation.children("reading")) {
      auto point = pointOfReading(reading);
      if (!valid || !point) {
        points.skipped.push_back({reading.line(), point ? Skip::marked_invalid : Skip::no_point});
        continue;
      }
      if (points.frame.empty()) points.frame = station;
      if (station != points.frame)
        observation.refuse("station", station,
                           "expected readings of one station, " + points.frame + "; their frames differ");
      point->of = groups.of("", station);
      point->name = nameBy(observation, "measuredTargetGeometry", geometries);
      points.points.push_back(std::move(*point));
    }
  }
  return points;
}

}  // namespace stiffscope::interchange
