#include "core/campaign/joint_reading.h"

#include <Eigen/LU>
#include <cmath>

#include "core/io/units.h"

namespace stiffscope::campaign {

JointConvention::JointConvention(const std::vector<JointReading>& readings, int joints)
    : matrix_(JointMatrix::Identity(joints, joints)), offset_(JointVector::Zero(joints)) {
  for (const JointReading& reading : readings) {
    matrix_(reading.joint, reading.joint) = reading.sign;
    offset_[reading.joint] = reading.offset;
    if (reading.plus >= 0) matrix_(reading.joint, reading.plus) += 1.0;
  }
}

bool JointConvention::invertible() const {
  // The determinant of whole numbers is one.
  return std::abs(matrix_.determinant()) > 0.5;
}

namespace {

/// Figures are decimals in degrees, and so are their sums and offsets. To the ninth decimal, a thousandth of what any
/// encoder resolves, a sum is then the number that a table of angles would hold, to its last bit.
double decimalAngle(double angle) {
  constexpr double kPerDegree = 1e9;
  return std::isnan(angle) ? angle : std::round(angle / io::kDegree * kPerDegree) / kPerDegree * io::kDegree;
}

}  // namespace

JointVector JointConvention::angles(const JointVector& figures) const { return anglesBeside(figures, figures); }

JointVector JointConvention::figures(const JointVector& angles) const {
  return matrix_.fullPivLu().solve(angles - offset_);
}

JointVector JointConvention::anglesBeside(const JointVector& figures, const JointVector& beside) const {
  JointVector angles(figures.size());
  for (Eigen::Index i = 0; i < figures.size(); ++i) {
    angles[i] = matrix_(i, i) * figures[i] + offset_[i];
    for (Eigen::Index j = 0; j < figures.size(); ++j) {
      if (j != i && matrix_(i, j) != 0.0) angles[i] += std::isnan(figures[j]) ? beside[j] : figures[j];
    }
    const bool itself = matrix_(i, i) == 1.0 && matrix_.row(i).cwiseAbs().sum() == 1.0 && offset_[i] == 0.0;
    if (!itself) angles[i] = decimalAngle(angles[i]);
  }
  return angles;
}

namespace {

/// The inverse of anglesBeside for angles of which some are blank.
JointVector figuresBeside(const JointConvention& convention, const JointVector& angles, const JointVector& beside) {
  JointVector whole = angles;
  for (Eigen::Index i = 0; i < whole.size(); ++i) {
    if (std::isnan(whole[i])) whole[i] = beside[i];
  }
  JointVector figures = convention.figures(whole);
  for (Eigen::Index i = 0; i < whole.size(); ++i) {
    if (std::isnan(angles[i])) figures[i] = kNotGiven;
  }
  return figures;
}

template <class Row, class Turn>
void turnRows(std::optional<Table<Row>>& table, const Turn& turn) {
  if (!table) return;
  for (Row& row : table->rows) turn(row);
}

}  // namespace

void figuresToAngles(Campaign& campaign) {
  if (campaign.joint_readings.empty()) return;
  const JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  const auto turn = [&](auto& row) { row.q = convention.angles(row.q); };
  turnRows(campaign.circle_sweeps, turn);
  turnRows(campaign.wrist_sweep, turn);
  turnRows(campaign.states, [&](State& row) {
    if (row.hasExtras()) {
      StateExtras& extras = row.extras();
      extras.commanded = convention.anglesBeside(extras.commanded, row.q);
      extras.motor_side = convention.anglesBeside(extras.motor_side, row.q);
    }
    turn(row);
  });
}

void anglesToFigures(Campaign& campaign) {
  if (campaign.joint_readings.empty()) return;
  const JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  const auto turn = [&](auto& row) { row.q = convention.figures(row.q); };
  turnRows(campaign.circle_sweeps, turn);
  turnRows(campaign.wrist_sweep, turn);
  turnRows(campaign.states, [&](State& row) {
    if (row.hasExtras()) {
      StateExtras& extras = row.extras();
      extras.commanded = figuresBeside(convention, extras.commanded, row.q);
      extras.motor_side = figuresBeside(convention, extras.motor_side, row.q);
    }
    turn(row);
  });
}

}  // namespace stiffscope::campaign
