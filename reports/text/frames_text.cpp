#include "core/campaign/campaign.h"
#include "core/frames/frames.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

Eigen::VectorXd shown(const Eigen::Ref<const Eigen::VectorXd>& values, int decimals) {
  return values.unaryExpr([decimals](double value) { return unsignedZero(value, decimals); });
}

std::string plusMinus(double value, const std::optional<double>& sd, int decimals) {
  return sd ? fmt::format("{:.{}f} +- {:.{}f}", value, decimals, expanded(*sd), decimals)
            : fmt::format("{:.{}f}", value, decimals);
}

void writeAxes(const frames::Frames& frames, Out out) {
  fmt::format_to(out, "\nAxes, in R0 with all joints at zero\n");
  fmt::format_to(out, "  {:<5}{:>32}{:>34}{:>7}{:>9}\n", "axis", "point (m)", "direction", "arc", "rms");
  for (std::size_t i = 0; i < frames.axes.size(); ++i) {
    const metrology::Line& line = frames.arm.arm.axes_in_base_at_zero[i];
    const Eigen::Vector3d point = shown(line.point, 6), direction = shown(line.direction, 6);
    fmt::format_to(out, "  {:<5}{:>12.6f}{:>10.6f}{:>10.6f}{:>12.6f}{:>11.6f}{:>11.6f}", i + 1, point.x(), point.y(),
                   point.z(), direction.x(), direction.y(), direction.z());
    const frames::MeasuredAxis& axis = frames.axes[i];
    if (axis.measured) {
      double arc = 0.0;
      for (const metrology::AxisCircle& circle : axis.fit.circles) arc = std::max(arc, circle.arc);
      fmt::format_to(out, "{:>7}{:>6.1f} µm\n",
                     axis.fit.circles.empty() ? "-" : fmt::format("{:.0f}d", arc / io::kDegree),
                     axis.fit.rms / io::kMicrometre);
    } else {
      fmt::format_to(out, "  nominal: {}\n", words(axis.reason));
    }
  }
}

/// The uncertainties hold what the stiffnesses leave open, and where that was weighed what a sag by joint springs alone
/// gets wrong.
void writeSagStake(const frames::Frames& frames, Out out) {
  fmt::format_to(out, "  taking off the sag moved the distances by");
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    const frames::LinkGeometry& link = frames.links[i];
    fmt::format_to(out, "{} {:.3f} +- {:.3f}", i == 0 ? "" : ",",
                   unsignedZero(link.distance_by_sag / io::kMillimetre, 3),
                   expanded(link.distance_sag_sd) / io::kMillimetre);
  }
  fmt::format_to(out, " mm;\n  +- holds the stiffnesses' uncertainty, {}\n",
                 frames.covariance.hidden.size() > 0 ? "and what could hide besides joint springs under the own weight"
                                                     : "not bearings that give across their axes");
}

void writeLinks(const frames::Frames& frames, Out out) {
  fmt::format_to(out, "\nBetween consecutive axes\n  {:<7}{:>24}{:>12}{:>26}{:>12}\n", "axes", "distance (mm)",
                 "nominal", "angle (deg)", "nominal");
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    const frames::LinkGeometry& link = frames.links[i];
    const auto length_sd = link.distance_sd ? std::optional(*link.distance_sd / io::kMillimetre) : std::nullopt;
    const auto angle_sd = link.angle_sd ? std::optional(*link.angle_sd / io::kDegree) : std::nullopt;
    fmt::format_to(out, "  {}-{:<5}{:>24}{:>12.1f}{:>26}{:>12.1f}{}\n", i + 1, i + 2,
                   plusMinus(link.distance / io::kMillimetre, length_sd, 3), link.nominal_distance / io::kMillimetre,
                   plusMinus(link.angle / io::kDegree, angle_sd, 4), link.nominal_angle / io::kDegree,
                   (link.near_parallel ? "  *" : "") + sourceMark(frames, {i, i + 1}));
  }
  if (frames.sag_removed) writeSagStake(frames, out);
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    const frames::LinkGeometry& link = frames.links[i];
    if (!link.near_parallel) continue;
    const Eigen::Vector3d at = shown(link.at_point_in_r0, 3);
    fmt::format_to(out, "  * nearly parallel: distance in the plane across axis {} at R0 ({:.3f}, {:.3f}, {:.3f}) m\n",
                   i + 1, at.x(), at.y(), at.z());
  }
}

void writeWrist(const campaign::Campaign& campaign, const frames::Frames& frames, Out out) {
  const frames::WristCentre& wrist = frames.wrist;
  if (!wrist.measured) {
    fmt::format_to(out, "\nWrist centre: not measured: {}\n", words(wrist.reason));
    return;
  }
  fmt::format_to(out, "\nWrist centre in R0 by reflector (Table I), mm\n  {:<12}{:>11}{:>11}{:>11}{:>9}{:>10}{:>10}\n",
                 "reflector", "x", "y", "z", "offset", "radius", "readings");
  for (const frames::WristTableRow& row : wrist.table) {
    const Eigen::Vector3d mm = shown(row.centre_in_r0 / io::kMillimetre, 3);
    fmt::format_to(out, "  {:<12}{:>11.3f}{:>11.3f}{:>11.3f}{:>9.3f}{:>10.3f}{:>10}\n",
                   campaign.targets[static_cast<std::size_t>(row.target)].id, mm.x(), mm.y(), mm.z(),
                   row.offset / io::kMillimetre, row.radius / io::kMillimetre, row.readings);
  }
  const auto place = [&](const std::string& name, const Eigen::Vector3d& point) {
    const Eigen::Vector3d mm = shown(point / io::kMillimetre, 3);
    fmt::format_to(out, "  {:<42}{:>11.3f}{:>11.3f}{:>11.3f}\n", name, mm.x(), mm.y(), mm.z());
  };
  const auto uncertain = [&](const Eigen::Matrix3d& covariance) {
    const Eigen::Vector3d mm = expanded(1.0) * covariance.diagonal().cwiseSqrt() / io::kMillimetre;
    fmt::format_to(out, "  {:<42}{:>11.3f}{:>11.3f}{:>11.3f}\n", "  +-, with R0's", mm.x(), mm.y(), mm.z());
  };
  place("mean of the rows", wrist.table_mean_in_r0);
  uncertain(wrist.table_mean_covariance);
  place("common sphere centre", wrist.centre_in_r0);
  uncertain(wrist.covariance);
  const int last = campaign.robot.axes();
  place(fmt::format("nearest to axes {} and {}", last - 1, last), wrist.nearest_last_axes_in_r0);
  place("barycentre of the reflectors (Dumas et al.)", wrist.reflector_barycentre_in_r0);
  const auto miss = [](double value, double sd) {
    return fmt::format("{:.3f} +- {:.3f} mm", value / io::kMillimetre, expanded(sd) / io::kMillimetre);
  };
  std::string misses;
  for (const frames::WristAxesMiss& one : wrist.misses) {
    const auto at = static_cast<std::size_t>(one.first);
    misses += fmt::format("{} {} and {}{} by {}{}", misses.empty() ? "  axes" : ",", one.first + 1, one.first + 2,
                          misses.empty() ? " miss" : "", miss(one.distance, one.sd), sourceMark(frames, {at, at + 1}));
  }
  fmt::format_to(out, "{}\n", misses);
  if (wrist.offset())
    fmt::format_to(out, "  {}\n",
                   wrapped(offsetWristWords(wrist.misses[0].first + 1, wrist.apart) +
                               "; what is printed as one is the common centre of spheres that no reflector moves on",
                           2));
}

void writeR0(const frames::Frames& frames, Out out) {
  if (!frames.arm.points_placed) {
    fmt::format_to(out, "R0 stands on the URDF's axes: axes 1 and 2 are not both measured.\n");
    return;
  }
  fmt::format_to(out, "r0_from_{} (m)\n",
                 frames.points_frame == campaign::PointFrame::tracker ? "tracker" : "base_link");
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector4d values = frames.arm.r0_from_points.matrix().row(row).transpose();
    fmt::format_to(out, "  {:>13.9f}{:>13.9f}{:>13.9f}{:>13.6f}\n", unsignedZero(values[0], 9),
                   unsignedZero(values[1], 9), unsignedZero(values[2], 9), unsignedZero(values[3], 6));
  }
  const metrology::FrameError own = expanded(1.0) * frames.covariance.r0().diagonal().cwiseSqrt();
  const Eigen::Vector3d turn = 1e6 * own.head<3>(), origin = own.tail<3>() / io::kMillimetre;
  fmt::format_to(out,
                 "  U about x0, y0, z0 {:.1f}, {:.1f}, {:.1f} µrad; of the origin "
                 "{:.4f}, {:.4f}, {:.4f} mm\n",
                 turn.x(), turn.y(), turn.z(), origin.x(), origin.y(), origin.z());
}

}  // namespace

std::string framesText(const campaign::Campaign& campaign, const frames::Frames& frames) {
  std::string text;
  Out out(text);
  fmt::format_to(out, "{}: frames and geometry; +- and U: expanded uncertainty, 95 %\n\n", campaign.name);
  writeR0(frames, out);
  writeAxes(frames, out);
  writeLinks(frames, out);
  const Eigen::Vector3d tcp = shown(frames.tcp_in_flange / io::kMillimetre, 3);
  const std::size_t last = frames.axes.size() - 1;
  const std::size_t across = frames::axisAcrossLast(frames.arm.arm.axes_in_base_at_zero);
  if (frames.tcp_at_origin) {
    fmt::format_to(out,
                   "\nP_TCP, the flange's origin: axis {} runs along the flange plane and pierces it nowhere near\n",
                   last + 1);
  } else {
    fmt::format_to(out,
                   "\nP_TCP, where axis {} pierces the flange plane: ({:.3f}, {:.3f}, {:.3f}) mm in the flange{}\n",
                   last + 1, tcp.x(), tcp.y(), tcp.z(), sourceMark(frames, {across, last}));
  }
  writeWrist(campaign, frames, out);
  fmt::format_to(out, "\n{}\n", wrapped("Own weight: " + words(frames.sag_note) + ".", 0));
  return text;
}

}  // namespace stiffscope::reports
