#include "core/improved/method_rows.h"

#include "core/identification/loaded_arm.h"
#include "core/identification/posture_influence.h"

namespace stiffscope {

namespace {

using Rows = std::vector<CaseEquations>;

bool alike(const Rows& a, const Rows& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].posture != b[i].posture || a[i].right.size() != b[i].right.size()) return false;
  }
  return true;
}

void subtract(const Rows& at, Rows& from) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    from[i].matrix -= at[i].matrix;
    from[i].right -= at[i].right;
  }
}

void add(const Rows& change, double step, Rows& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i].matrix += step * change[i].matrix;
    to[i].right += step * change[i].right;
  }
}

}  // namespace

MethodRows methodRows(const Campaign& campaign, const Identification& result, Method method) {
  const MethodResult& own = result.of(method);
  LoadedArm arm = loadedArm(campaign, own.geometry, result.frames.wrist, result.steps);
  // One settling with the compliances as they are: only the equations are wanted.
  settleArm(arm, result.finite_deflection, [&](const LoadedArm&) { return own.estimate.compliance; });
  MethodRows rows;
  rows.targets = byPosture(reflectorEquations(arm));
  rows.wrist = byPosture(wristPointEquations(arm));
  switch (method) {
    case Method::complete_pose:
      for (const CaseEquations& one : poseEquations(arm, result.frames.tcp_in_flange))
        rows.solved.push_back(normalised(one, result.characteristic_length.length));
      rows.solved = byPosture(rows.solved);
      break;
    case Method::partial_pose:
      rows.solved = rows.targets;
      break;
    case Method::decoupled_partial_pose:
      rows.solved = rows.wrist;
      break;
  }
  return rows;
}

MovingRows::MovingRows(MethodRows at, std::vector<MethodRows> moved) : at_(std::move(at)), moved_(std::move(moved)) {
  for (MethodRows& one : moved_) {
    movable_ = movable_ && alike(at_.solved, one.solved) && alike(at_.targets, one.targets) && alike(at_.wrist, one.wrist);
    if (!movable_) return;
    subtract(at_.solved, one.solved);
    subtract(at_.targets, one.targets);
    subtract(at_.wrist, one.wrist);
  }
}

MethodRows MovingRows::at(const Eigen::VectorXd& steps) const {
  MethodRows rows = at_;
  for (std::size_t k = 0; movable_ && k < moved_.size(); ++k) {
    const double step = steps[static_cast<Eigen::Index>(k)];
    add(moved_[k].solved, step, rows.solved);
    add(moved_[k].targets, step, rows.targets);
    add(moved_[k].wrist, step, rows.wrist);
  }
  return rows;
}

}  // namespace stiffscope
