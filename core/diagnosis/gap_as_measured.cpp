#include "core/diagnosis/gap_as_measured.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "core/diagnosis/gap_start.h"
#include "core/diagnosis/where.h"

namespace stiffscope {

namespace {

Eigen::VectorXd stiffnessesIn(const GapData& data) {
  const Eigen::MatrixXd normal = sumOf(data, std::vector<double>(data.postures.size(), 1.0));
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(data.layout.end);
  parameters.head<6>() = normal.topLeftCorner<6, 6>().completeOrthogonalDecomposition().solve(
      normal.col(data.layout.end).head<6>());
  return parameters;
}

}  // namespace

std::optional<GapAsMeasured> gapAsMeasured(const Campaign& original, const GapInput& input, const GapFit& fit,
                                           const Eigen::VectorXd& after) {
  const GapStart raw = gapStart(original, false);
  if (!raw.reason.empty()) return std::nullopt;
  const GapInput as_read{
      raw.campaign, raw.noise.noise, input.force_sigma, input.moment_sigma, input.models, false, false, {}};
  const GapData data = gapData(as_read, raw.state, {});
  const Eigen::VectorXd parameters = stiffnessesIn(data);
  GapAsMeasured gap;
  std::map<int, HeldOut> left;
  double rows = 0.0, rests = 0.0, deflection = 0.0, position = 0.0;
  for (const GapPosture& posture : data.postures) {
    const double squares = leftIn(posture, {parameters, parameters}, posture, parameters).deflection_before;
    const auto count = static_cast<double>(posture.right.size());
    left[posture.pose].deflection_before = squares;
    deflection += squares;
    rows += count;
    gap.by_posture.rows.push_back(
        {original.pose_ids[static_cast<std::size_t>(posture.pose)], std::sqrt(squares / count)});
  }
  gap.at_points = gapAtPoints(data, parameters, fit.data, after);
  for (const GapRows& one : loadingRows(raw.campaign, raw.state.geometry, raw.state.at, {})) {
    left[one.pose].position_before = one.position.squaredNorm();
    position += left[one.pose].position_before;
    rests += static_cast<double>(one.position.size());
  }
  if (rows > 0.0) gap.deflection = std::sqrt(deflection / rows);
  if (rests > 0.0) gap.position = std::sqrt(position / rests);
  for (const GapPosture& posture : fit.data.postures) {
    HeldOut one = left[posture.pose];
    const HeldOut now = leftIn(posture, {after, after}, posture, after);
    one.deflection_after = now.deflection_after;
    one.position_after = now.position_after;
    gap.left.push_back(one);
  }
  return gap;
}

}  // namespace stiffscope
