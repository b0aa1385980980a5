#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "reports/json/interchange_json.h"
#include "reports/words/interchange_words.h"

namespace stiffscope::reports {

namespace {

constexpr double kMillimetres = 1e3, kMicrometres = 1e6;

std::string fullName(const interchange::PointReading& point) {
  std::string name;
  for (const std::string* part : {&point.collection(), &point.group(), &point.name}) {
    if (!part->empty()) name += (name.empty() ? "" : "::") + *part;
  }
  return name.empty() ? "-" : name;
}

std::string timeText(const interchange::PointReading& point) {
  if (!point.time) return {};
  return point.time->dated ? isoTime(*point.time) : fmt::format("{:.3f} s", point.time->seconds);
}

std::string headText(const NamedPoints& named) {
  const interchange::PointFile& file = named.points;
  const auto have = [&](const auto& has) { return std::count_if(file.points.begin(), file.points.end(), has); };
  std::string text = fmt::format("{}: format {}, encoding {}, frame {}\n", named.file, interchange::nameOf(file.format),
                                 interchange::nameOf(file.encoding), file.frame.empty() ? "not stated" : file.frame);
  text += fmt::format("{} points, {} with uncertainties, {} with a time; {} rows left out\n", file.points.size(),
                      have([](const auto& point) { return point.sigma.has_value(); }),
                      have([](const auto& point) { return point.time.has_value(); }), file.skipped.size());
  return text;
}

std::string pointText(const interchange::PointReading& point, std::size_t width) {
  const Eigen::Vector3d at = kMillimetres * point.point;
  std::string text = fmt::format("{:>7}  {:<{}} {:>5} {:>13.4f} {:>13.4f} {:>13.4f}", point.line, fullName(point),
                                 width, point.occurrence, at.x(), at.y(), at.z());
  if (point.sigma) {
    const Eigen::Vector3d u = kMicrometres * *point.sigma;
    text += fmt::format(" {:>8.2f} {:>8.2f} {:>8.2f}", u.x(), u.y(), u.z());
  } else {
    text += fmt::format(" {:>8} {:>8} {:>8}", "-", "-", "-");
  }
  return text + (point.time ? "  " + timeText(point) : "") + '\n';
}

}  // namespace

void pointsText(const std::vector<NamedPoints>& files, const io::ByteSink& sink) {
  constexpr std::size_t kPiece = 1 << 16;
  std::string text;
  const auto handOn = [&](std::size_t least) {
    if (text.size() < least) return;
    sink(text);
    text.clear();
  };
  for (const NamedPoints& named : files) {
    text += headText(named);
    std::size_t width = 4;
    for (const interchange::PointReading& point : named.points.points) width = std::max(width, fullName(point).size());
    text += fmt::format("{:>7}  {:<{}} {:>5} {:>13} {:>13} {:>13} {:>8} {:>8} {:>8}  time\n", "line", "name", width,
                        "occ.", "x mm", "y mm", "z mm", "u_x µm", "u_y µm", "u_z µm");
    for (const interchange::PointReading& point : named.points.points) {
      text += pointText(point, width);
      handOn(kPiece);
    }
    for (const interchange::SkippedRow& row : named.points.skipped) {
      text += fmt::format("{:>7}  left out: {}\n", row.line, skipWords(row.reason));
      handOn(kPiece);
    }
  }
  handOn(1);
}

}  // namespace stiffscope::reports
