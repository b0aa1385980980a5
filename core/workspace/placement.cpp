#include "core/workspace/workspace_stiffness.h"

#include <fmt/format.h>
#include <utility>

#include "core/campaign/read_table.h"
#include "core/identification/load_case.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/numerics/parallel.h"

namespace stiffscope::workspace {

namespace {

struct OffsetRow {
  std::string id;
  Eigen::Vector3d by = Eigen::Vector3d::Zero();
  std::size_t line = 0;
};

const campaign::TableLayout<OffsetRow>& offsetsLayout() {
  using Row = OffsetRow;
  static const campaign::TableLayout<Row> layout{
      "offsets",
      {{"offset", campaign::CellKind::text, [](Row& row) -> std::string& { return row.id; }},
       {"dx_mm", campaign::CellKind::millimetre, [](Row& row) -> double& { return row.by.x(); }},
       {"dy_mm", campaign::CellKind::millimetre, [](Row& row) -> double& { return row.by.y(); }},
       {"dz_mm", campaign::CellKind::millimetre, [](Row& row) -> double& { return row.by.z(); }}},
      {"offset"}};
  return layout;
}

/// The load cell's reading that a force at P_TCP gives there: force in the cell's axes, moment about its point.
Vector6d readingOf(const DeflectingArm& arm, const JointVector& q, const Eigen::Vector3d& force) {
  const robot::ArmPosture posture = robot::postureAt(arm.geometry.arm, q);
  const Eigen::Isometry3d flange = robot::flangeAt(arm.geometry.arm, posture);
  Eigen::Matrix3d r0_from_cell;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const robot::Wrench unit =
        identification::cellWrench(*arm.campaign.load_cell, arm.geometry, posture, flange, flange, Vector6d::Unit(k));
    r0_from_cell.col(k) = unit.force;
    point = unit.point;
  }
  Vector6d reading;
  reading << r0_from_cell.transpose() * force,
      r0_from_cell.transpose() * (flange * arm.tcp_in_flange - point).cross(force);
  return reading;
}

/// The joint angles at which the tool stands moved by `by`: in steps, so that the branch is kept.
std::optional<JointVector> movedAngles(const DeflectingArm& arm, const JointVector& q, const Eigen::Vector3d& by,
                                       double least_conditioning) {
  constexpr double kStep = 0.05;    // m
  constexpr double kTurned = 1e-3;  // rad, of fewer than six joints: the same task still
  const Eigen::Isometry3d flange = robot::flangeAt(arm.geometry.arm, robot::postureAt(arm.geometry.arm, q));
  const int steps = std::max(1, static_cast<int>(std::ceil(by.norm() / kStep)));
  JointVector angles = q;
  for (int step = 1; step <= steps; ++step) {
    Eigen::Isometry3d wanted = flange;
    wanted.pretranslate(Eigen::Vector3d(by * step / steps));
    const auto next = continuedAngles(arm.geometry.arm, wanted, arm.tcp_in_flange, angles, least_conditioning, kTurned);
    if (!next) return std::nullopt;
    angles = *next;
  }
  return angles;
}

Placement placed(const DeflectingArm& arm, const Eigen::Vector3d& force, const std::vector<NamedPosture>& postures,
                 const Offset& offset) {
  const compensation::CompensateOptions options;
  Placement placement;
  placement.offset = offset;
  std::vector<compensation::PostureToCompensate> asked;
  for (const NamedPosture& one : postures) {
    const auto q = movedAngles(arm, one.q, offset.by, options.least_conditioning);
    if (q) asked.push_back({one.pose, *q, readingOf(arm, *q, force)});
  }
  placement.reached = asked.size();
  if (asked.size() < postures.size()) return placement;
  for (compensation::CompensatedPosture& one : compensation::compensate(
           arm.campaign, arm.geometry, arm.estimate, arm.tcp_in_flange, asked, options, arm.with, arm.certainty)) {
    if (placement.reason.empty()) placement.reason = one.reason;
    if (!one.predicted ||
        (placement.prediction.predicted && one.tcp.deflection.norm() <= placement.prediction.tcp.deflection.norm()))
      continue;
    placement.worst = one.posture.id;
    placement.prediction = std::move(one);
  }
  return placement;
}

}  // namespace

std::vector<Offset> offsetGrid(double spacing, int count) {
  std::vector<Offset> offsets;
  for (int z = -count; z <= count; ++z)
    for (int y = -count; y <= count; ++y)
      for (int x = -count; x <= count; ++x)
        offsets.push_back({fmt::format("{}", offsets.size() + 1), spacing * Eigen::Vector3d(x, y, z)});
  return offsets;
}

std::vector<Offset> readOffsets(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string bytes = io::readTextFile(file);
  campaign::CampaignNames names;
  std::vector<Offset> offsets;
  for (OffsetRow& row : campaign::readTable<OffsetRow>({file.string(), bytes}, offsetsLayout(), names, warnings))
    offsets.push_back({std::move(row.id), row.by});
  return offsets;
}

PlacementStudy studyPlacements(const DeflectingArm& arm, const Eigen::Vector3d& force,
                               const std::vector<NamedPosture>& postures, const std::vector<Offset>& offsets) {
  PlacementStudy study;
  study.force = force;
  study.postures = postures;
  study.placements.resize(offsets.size());
  numerics::onAllCores(offsets.size(),
                       [&](std::size_t i) { study.placements[i] = placed(arm, force, postures, offsets[i]); });
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (offsets[i].by.isZero(0.0)) study.now = i;
    if (!study.placements[i].judged()) continue;
    if (!study.best || study.placements[i].deflection() < study.placements[*study.best].deflection()) study.best = i;
  }
  return study;
}

}  // namespace stiffscope::workspace
