#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "core/interchange/taught_program.h"
#include "core/toolpath/compensate_path.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "core/campaign/joint_reading.h"
#include "core/io/units.h"
#include "reports/words/compensation_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

/// Of each kind the first, and how many more postures have it.
void addCautions(const std::vector<compensation::CompensatedPosture>& postures, std::string& text) {
  struct Kind {
    int id = 0;
    std::string pose, first;
    std::size_t more = 0;
  };
  std::vector<Kind> kinds;
  for (const compensation::CompensatedPosture& posture : postures) {
    if (!posture.solved) continue;
    std::vector<int> counted;
    for (const Remark& caution : posture.cautions) {
      if (std::find(counted.begin(), counted.end(), caution.id) != counted.end()) continue;
      counted.push_back(caution.id);
      const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& one) { return one.id == caution.id; });
      if (same == kinds.end()) {
        kinds.push_back({caution.id, posture.posture.id, words(caution), 0});
      } else {
        ++same->more;
      }
    }
  }
  for (const Kind& one : kinds) {
    const std::string more = one.more > 0 ? fmt::format("; the like of {} more", one.more) : "";
    text += wrapped(fmt::format("Caution: posture {}: {}{}.", one.pose, one.first, more), 2) + "\n";
  }
}

/// What stands under every table: stiffnesses from elsewhere, how many are refused and why, cautions.
void addKnowledge(const std::vector<compensation::CompensatedPosture>& postures,
                  const std::vector<campaign::KnownStiffness>& known, const std::vector<std::string>& cautions,
                  std::string& text) {
  auto out = std::back_inserter(text);
  for (const campaign::KnownStiffness& one : known) {
    const StiffnessUnit unit = stiffnessUnit(std::vector<double>{one.stiffness});
    fmt::format_to(
        out, "{}\n",
        wrapped(fmt::format("  k{} = {:.4f} +- {:.4f} {} (standard uncertainty) is not of this day, "
                            "which cannot see it, but from: {}.",
                            one.joint + 1, one.stiffness / unit.size, one.sd / unit.size, unit.text, one.source),
                2));
  }
  fmt::format_to(out, "{}\n", wrapped(summaryWords(compensation::summaryOf(postures)) + ".", 2));
  addCautions(postures, text);
  for (const std::string& caution : cautions) fmt::format_to(out, "{}\n", wrapped("Caution: " + caution + ".", 2));
}

}  // namespace

std::string compensationText(const campaign::Campaign& campaign, identification::Method method,
                             const std::vector<compensation::CompensatedPosture>& postures,
                             const std::vector<campaign::KnownStiffness>& known,
                             const std::vector<std::string>& cautions, bool weighs_what_hides) {
  std::string text;
  auto out = std::back_inserter(text);
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  fmt::format_to(out, "{}: predicted deflection of P_TCP and the commands that cancel it, by {}\n\n", campaign.name,
                 namesOf(method).full);
  fmt::format_to(out, "  {:<10}{:>27}{:>9}   {}\n", "pose", "deflection in R0 (mm)", "U", "command (deg)");
  for (const compensation::CompensatedPosture& posture : postures) {
    if (!posture.predicted) {
      fmt::format_to(out, "  {:<10}{:>9}{:>9}{:>9}{:>9}   refused: {}\n", posture.posture.id, "-", "-", "-", "-",
                     words(posture.reason));
      continue;
    }
    const Eigen::Vector3d mm = posture.tcp.deflection / io::kMillimetre;
    fmt::format_to(out, "  {:<10}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}   ", posture.posture.id, unsignedZero(mm.x(), 3),
                   unsignedZero(mm.y(), 3), unsignedZero(mm.z(), 3), posture.tcp.expanded / io::kMillimetre);
    if (posture.solved) {
      for (const double figure : convention.figures(posture.commands))
        fmt::format_to(out, "{:>10.4f}", unsignedZero(figure / io::kDegree, 4));
      fmt::format_to(out, "\n");
    } else {
      fmt::format_to(out, "refused: {}\n", words(posture.reason));
    }
  }
  fmt::format_to(
      out,
      "\n  Deflection of P_TCP under each row's load; U (coverage 95 %): it is within U of what is predicted, by "
      "the\n  stiffnesses, the effects in the model, {}, and what the day left unexplained. Commands\n"
      "  are joints 1 to {}.\n",
      weighs_what_hides ? "those that could hide" : "none that could hide", campaign.robot.joints());
  if (!campaign.joint_readings.empty()) fmt::format_to(out, "  {}\n", kAsControllerStates);
  addKnowledge(postures, known, cautions, text);
  return text;
}

namespace {

/// Root mean square and largest of what `of` says of the poses that are predicted.
void addAlong(const char* what, const toolpath::CompensatedPath& path, bool solved_only,
              const std::function<double(const toolpath::CompensatedPathPose&)>& of, std::string& text) {
  double squares = 0.0, largest = -1.0;
  std::size_t count = 0;
  std::string where;
  for (const toolpath::CompensatedPathPose& pose : path.poses) {
    if (!pose.compensated.predicted || (solved_only && !pose.compensated.solved)) continue;
    const double value = of(pose);
    squares += value * value;
    ++count;
    if (value > largest) {
      largest = value;
      where = pose.compensated.posture.id;
    }
  }
  if (count == 0) return;
  fmt::format_to(std::back_inserter(text), "  {:<52}{:>9.3f}{:>11.3f}   {}\n", what,
                 std::sqrt(squares / static_cast<double>(count)) / io::kMillimetre, largest / io::kMillimetre, where);
}

void addJointsOfPath(const toolpath::PathJob& job, const toolpath::CompensatedPath& path, std::string& text) {
  const toolpath::CompensatedPathPose* nearest = nullptr;
  double conditioning = std::numeric_limits<double>::infinity(), low = 0.0, high = 0.0;
  std::size_t reached = 0;
  for (const toolpath::CompensatedPathPose& pose : path.poses) {
    if (!pose.joints.q.allFinite()) continue;
    low = reached == 0 ? pose.joints.turn : std::min(low, pose.joints.turn);
    high = reached == 0 ? pose.joints.turn : std::max(high, pose.joints.turn);
    ++reached;
    conditioning = std::min(conditioning, pose.joints.conditioning);
    if (nearest == nullptr || pose.joints.limit_margin < nearest->joints.limit_margin) nearest = &pose;
  }
  if (nearest == nullptr) return;
  std::string line = fmt::format("Joints: {} of {} poses held, on one branch{}", reached, path.poses.size(),
                                 job.joints.start ? "" : fmt::format(", the best of {}", path.branches));
  line += std::isfinite(nearest->joints.limit_margin)
              ? fmt::format("; joint {} comes nearest to its limit, {:.1f} deg before it (pose {})",
                            nearest->joints.nearest_limit + 1, nearest->joints.limit_margin / io::kDegree,
                            nearest->compensated.posture.id)
              : "";
  line += fmt::format("; least conditioning {:.3f}", conditioning);
  if (job.turn_free)
    line += fmt::format("; about its axis the tool turns by {:.1f} deg along the path", (high - low) / io::kDegree);
  fmt::format_to(std::back_inserter(text), "{}\n", wrapped(line + ".", 2));
}

}  // namespace

std::string pathText(const campaign::Campaign& campaign, identification::Method method, const toolpath::PathJob& job,
                     const toolpath::CompensatedPath& path, const std::vector<campaign::KnownStiffness>& known,
                     const std::vector<std::string>& cautions) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: {} poses along {:.0f} mm of path, by {}\n\n", campaign.name, path.poses.size(),
                 path.poses.empty() ? 0.0 : path.poses.back().along / io::kMillimetre, namesOf(method).full);
  fmt::format_to(out, "  {:<52}{:>9}{:>11}   {}\n", "deviation of the tool's tip by the process load (mm)", "rms",
                 "largest", "at pose");
  const compensation::CompensationSummary summary = compensation::summaryOf(path.postures());
  if (summary.compensated < summary.asked)
    addAlong(
        "without compensation, refused poses too", path, false,
        [](const auto& pose) { return pose.deflection.shift.norm(); }, text);
  addAlong(
      "without compensation", path, true, [](const auto& pose) { return pose.deflection.shift.norm(); }, text);
  addAlong(
      "with it at most: U (coverage 95 %)", path, true, [](const auto& pose) { return pose.compensated.tcp.expanded; },
      text);
  addAlong(
      "offset of the programmed pose", path, true, [](const auto& pose) { return pose.offset.shift.norm(); }, text);
  text += "\n";
  addJointsOfPath(job, path, text);
  addKnowledge(path.postures(), known, cautions, text);
  return text;
}

namespace {

/// What was left of a program for one reason, with its lines; empty where nothing was.
std::string leftOf(const interchange::TaughtProgram& program, interchange::Skip reason, const char* why) {
  constexpr std::size_t kMostNamed = 12;
  std::vector<std::string> lines;
  std::size_t count = 0;
  for (const interchange::SkippedRow& row : program.log.skipped) {
    if (row.reason != reason) continue;
    if (++count <= kMostNamed) lines.push_back(fmt::format("{}", row.line));
  }
  if (count == 0) return {};
  const std::size_t more = count - lines.size();
  const std::string line =
      fmt::format("Caution: {} {} refused and left as {}: {} ({}:{}{})", count,
                  count == 1 ? "target is" : "targets are", count == 1 ? "it was" : "they were", why, program.file,
                  fmt::join(lines, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
  return wrapped(line + ".", 2) + "\n";
}

}  // namespace

std::string programText(const interchange::TaughtProgram& program, const std::string& out,
                        const std::vector<compensation::CompensatedPosture>& targets, double rounding) {
  const std::size_t replaced = compensation::summaryOf(targets).compensated;
  const auto computed = std::count_if(program.log.skipped.begin(), program.log.skipped.end(),
                                      [](const auto& row) { return row.reason == interchange::Skip::joints_computed; });
  const std::string line =
      replaced == 0 ? fmt::format("{}: no target is compensated; nothing is written", program.file)
                    : fmt::format(
                          "{}: {} of {} joint targets of {} replaced, all else as it was; rounding moves P_TCP by "
                          "up to {:.4f} mm",
                          out, replaced, targets.size() + static_cast<std::size_t>(computed), program.file,
                          rounding / io::kMillimetre);
  return wrapped(line + ".", 2) + "\n" +
         leftOf(program, interchange::Skip::joints_not_given,
                "in space, not in joints, and which joint angles the controller takes is not in the file") +
         leftOf(program, interchange::Skip::joints_computed,
                "computed, given in part or handed on, so that the program is compensated in part only");
}

}  // namespace stiffscope::reports
