#include "reports/csv/motion_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <functional>

#include "core/campaign/joint_reading.h"
#include "core/io/units.h"
#include "reports/csv/csv_table.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

/// Names and cells of a line, column after column.
class MotionLine {
 public:
  void addText(const std::string& name, const std::string& text) { add(name, csvField(text)); }

  void addNumber(const std::string& name, double value, int decimals) {
    add(name, std::isfinite(value) ? fmt::format("{:.{}f}", unsignedZero(value, decimals), decimals) : "");
  }

  /// `pattern` with the component's name in place of {}; blank where they are not given.
  template <class Values>
  void addVector(const char* pattern, const char* components, const Values& values, double unit, int decimals,
                 bool given = true) {
    for (Eigen::Index k = 0; k < values.size(); ++k)
      addNumber(fmt::format(fmt::runtime(pattern), components[k]), given ? values[k] / unit : NAN, decimals);
  }

  std::string header() const { return fmt::format("{}\n", fmt::join(names_, ",")); }
  std::string cells() const { return fmt::format("{}\n", fmt::join(cells_, ",")); }

 private:
  void add(const std::string& name, const std::string& cell) {
    names_.push_back(name);
    cells_.push_back(cell);
  }

  std::vector<std::string> names_, cells_;
};

constexpr const char *kJoints = "12345678", *kAxes = "xyz";
constexpr int kAngleDecimals = 6, kLengthDecimals = 5;

void addAngles(const compensation::CompensatedPosture& posture, const campaign::JointConvention* convention,
               MotionLine& line) {
  line.addVector("q{}_deg", kJoints, posture.posture.q, io::kDegree, kAngleDecimals);
  line.addVector("c{}_deg", kJoints, posture.commands, io::kDegree, kAngleDecimals, posture.solved);
  if (convention != nullptr)
    line.addVector("reading{}_deg", kJoints, convention->figures(posture.commands), io::kDegree, kAngleDecimals,
                   posture.solved);
}

void addDeflection(const compensation::CompensatedPosture& posture, const Eigen::Vector3d& deflection,
                   const Eigen::Vector3d& rotation, MotionLine& line) {
  line.addVector("deflection_{}_mm", kAxes, deflection, io::kMillimetre, kLengthDecimals, posture.predicted);
  line.addNumber("u_deflection_mm", posture.predicted ? posture.tcp.expanded / io::kMillimetre : NAN, kLengthDecimals);
  line.addVector("rotation_{}_deg", kAxes, rotation, io::kDegree, kAngleDecimals, posture.predicted);
}

void addJudgement(const compensation::CompensatedPosture& posture, MotionLine& line) {
  line.addNumber("conditioning", posture.predicted ? posture.conditioning : NAN, 5);
  line.addNumber("load_ratio", posture.predicted && posture.load_ratio > 0.0 ? posture.load_ratio : NAN, 4);
  line.addText("refused", posture.solved ? "" : words(posture.reason));
  line.addText("cautions", fmt::format("{}", fmt::join(words(posture.cautions), "; ")));
}

std::string table(std::size_t count, const std::function<MotionLine(std::size_t)>& line) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionLine one = line(i);
    if (i == 0) text = one.header();
    text += one.cells();
  }
  return text;
}

std::optional<campaign::JointConvention> conventionOf(const campaign::Campaign& campaign) {
  if (campaign.joint_readings.empty()) return std::nullopt;
  return campaign::JointConvention(campaign.joint_readings, campaign.robot.joints());
}

}  // namespace

std::string commandsCsv(const campaign::Campaign& campaign,
                        const std::vector<compensation::CompensatedPosture>& postures) {
  const std::optional<campaign::JointConvention> convention = conventionOf(campaign);
  return table(postures.size(), [&](std::size_t i) {
    const compensation::CompensatedPosture& posture = postures[i];
    MotionLine line;
    line.addText("pose", posture.posture.id);
    addAngles(posture, convention ? &*convention : nullptr, line);
    addDeflection(posture, posture.tcp.deflection, posture.rotation, line);
    addJudgement(posture, line);
    return line;
  });
}

std::string pathCsv(const campaign::Campaign& campaign, const toolpath::CompensatedPath& path) {
  const std::optional<campaign::JointConvention> convention = conventionOf(campaign);
  return table(path.poses.size(), [&](std::size_t i) {
    const toolpath::CompensatedPathPose& pose = path.poses[i];
    const compensation::CompensatedPosture& posture = pose.compensated;
    const toolpath::ToolWrench at_tip = pose.wrenchAtTip();
    MotionLine line;
    line.addText("pose", posture.posture.id);
    line.addNumber("along_mm", pose.along / io::kMillimetre, kLengthDecimals);
    line.addVector("{}_mm", kAxes, pose.tip_in_workpiece, io::kMillimetre, kLengthDecimals);
    addAngles(posture, convention ? &*convention : nullptr, line);
    line.addNumber("turn_deg", pose.joints.turn / io::kDegree, kAngleDecimals);
    line.addVector("f{}_n", kAxes, at_tip.force, 1.0, 3, at_tip.reason.empty());
    line.addVector("m{}_nm", kAxes, at_tip.moment, 1.0, 4, at_tip.reason.empty());
    addDeflection(posture, pose.deflection.shift, pose.deflection.turn, line);
    line.addVector("offset_{}_mm", kAxes, pose.offset.shift, io::kMillimetre, kLengthDecimals, posture.solved);
    line.addVector("offset_r{}_deg", kAxes, pose.offset.turn, io::kDegree, kAngleDecimals, posture.solved);
    line.addVector("torque{}_nm", kJoints, pose.joint_torque, 1.0, 3, posture.predicted);
    line.addNumber("limit_margin_deg", posture.posture.q.allFinite() ? pose.joints.limit_margin / io::kDegree : NAN, 3);
    addJudgement(posture, line);
    return line;
  });
}

}  // namespace stiffscope::reports
