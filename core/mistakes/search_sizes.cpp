#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "core/mistakes/searched_arm.h"

namespace stiffscope::mistakes {

namespace {

/// A right angle where one is near.
template <class Shifted>
double snapped(double by, const Shifted& shifted) {
  constexpr double kRight = 90.0 * io::kDegree, kNear = 4.0 * io::kDegree;
  const double right = kRight * std::round(by / kRight);
  if (right == 0.0 || std::abs(by - right) > kNear) return by;
  return fitNominal(shifted(right)).rms < kArmAsWell * fitNominal(shifted(by)).rms ? right : by;
}

/// Where a function of an angle is least: a round in steps of 15 deg, then thirds of the steps about the least.
template <class Function>
double leastOver(const Function& of) {
  constexpr double kStep = 15.0 * io::kDegree;
  double best = 0.0, value = of(0.0);
  for (int k = -11; k <= 12; ++k) {
    const double at = k * kStep, there = k == 0 ? value : of(at);
    if (there < value) value = there, best = at;
  }
  for (double step = kStep / 3.0; step > 1e-5; step /= 3.0) {
    for (const double at : {best - 2.0 * step, best - step, best + step, best + 2.0 * step}) {
      const double there = of(at);
      if (there < value) value = there, best = at;
    }
  }
  return best;
}

/// Everything from a joint on, moved by a rigid motion about where its axis stands at zero.
void moveFrom(std::size_t joint, const Eigen::Vector3d& shift, const Eigen::Matrix3d& turn, robot::Robot& robot) {
  const Eigen::Vector3d at = robot.axes_in_base_at_zero[joint].point;
  const auto moved = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(at + shift + turn * (p - at)); };
  const auto carry = [&](Eigen::Isometry3d& frame) {
    const Eigen::Vector3d place = moved(frame.translation());
    frame.linear() = turn * frame.linear();
    frame.translation() = place;
  };
  for (std::size_t j = joint; j < robot.axes_in_base_at_zero.size(); ++j) {
    robot.axes_in_base_at_zero[j].point = moved(robot.axes_in_base_at_zero[j].point);
    robot.axes_in_base_at_zero[j].direction = turn * robot.axes_in_base_at_zero[j].direction;
  }
  carry(robot.base_from_flange_at_zero);
  for (robot::LinkFrame& link : robot.links) {
    if (link.body > static_cast<int>(joint)) carry(link.base_from_link_at_zero);
  }
  for (std::size_t body = joint + 1; body < robot.bodies.size(); ++body)
    robot.bodies[body].com_in_base_at_zero = moved(robot.bodies[body].com_in_base_at_zero);
  for (robot::Balancer& balancer : robot.balancers) {
    for (robot::BalancerEnd* end : {&balancer.from, &balancer.to}) {
      if (end->body > static_cast<int>(joint)) end->in_base_at_zero = moved(end->in_base_at_zero);
    }
  }
}

void keepOrigin(const SearchedArm& arm, ReadingsOfDay day, Remark remedy, std::vector<ArmCure>& cures) {
  const double rms = fitNominal(day).rms;
  if (!arm.mends(rms)) return;
  ArmCure cure;
  cure.suspected = {"robot_origin", Remark(RemarkId::in_urdf), std::move(remedy), {}};
  cure.rms = rms;
  cure.day = std::move(day);
  cures.push_back(std::move(cure));
}

struct SeenShift {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  std::vector<double> unseen;  ///< unit directions, three numbers each, in which the readings do not tell a shift
};

/// The shift of a joint's origin that brings the readings nearest, by Gauss-Newton on the fit's residuals with
/// differences for derivatives: the fit is nearly linear in it. In directions that the readings hardly see, as along
/// the first axis that moves, a link's length or the reflectors' places do the same: there nothing is said.
SeenShift bestShift(const ReadingsOfDay& as_read, std::size_t joint) {
  const auto misfit = [&](const Eigen::Vector3d& shift) {
    ReadingsOfDay day = as_read;
    moveFrom(joint, shift, Eigen::Matrix3d::Identity(), day.robot);
    return std::pow(affineMisfit(day), 2);
  };
  // A sum of squares of what is linear in the shift is a quadratic form of it.
  constexpr double kStep = 0.1;  // m
  const double middle = misfit(Eigen::Vector3d::Zero());
  Eigen::Vector3d gradient;
  Eigen::Matrix3d curvature;
  std::array<double, 3> up{}, down{};
  for (int k = 0; k < 3; ++k) {
    up[static_cast<std::size_t>(k)] = misfit(kStep * Eigen::Vector3d::Unit(k));
    down[static_cast<std::size_t>(k)] = misfit(-kStep * Eigen::Vector3d::Unit(k));
    gradient[k] = (up[static_cast<std::size_t>(k)] - down[static_cast<std::size_t>(k)]) / (2.0 * kStep);
    curvature(k, k) =
        (up[static_cast<std::size_t>(k)] + down[static_cast<std::size_t>(k)] - 2.0 * middle) / (kStep * kStep);
  }
  for (int k = 0; k < 3; ++k) {
    for (int l = k + 1; l < 3; ++l) {
      const double both = misfit(kStep * (Eigen::Vector3d::Unit(k) + Eigen::Vector3d::Unit(l)));
      curvature(k, l) = curvature(l, k) =
          (both - up[static_cast<std::size_t>(k)] - up[static_cast<std::size_t>(l)] + middle) / (kStep * kStep);
    }
  }
  // A misfit of a millimetre that is no shift looks like at most thirty of them in a direction that counts as seen.
  constexpr double kSeen = 1e-3, kLeast = 1e-12;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(curvature);
  const Eigen::Vector3d& sizes = directions.eigenvalues();
  SeenShift found;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = directions.eigenvectors().col(k);
    if (sizes[k] > kSeen * std::max(kLeast, sizes[2])) {
      found.shift -= direction.dot(gradient) / sizes[k] * direction;
    } else {
      found.unseen.insert(found.unseen.end(), direction.begin(), direction.end());
    }
  }
  return found;
}

}  // namespace

void searchZeros(SearchedArm& arm) {
  std::optional<ArmCure> best;
  for (const Tables& tables : arm.sets) {
    if (tables.size() > 1 && tables.size() < arm.tables.size()) continue;
    for (int joint = 0; joint < arm.campaign.robot.joints(); ++joint) {
      const auto shifted = [&](double by) {
        ArmMistake mistake;
        mistake.angles = [joint, by](JointVector& q) { q[joint] += by; };
        return arm.with(mistake, tables);
      };
      const auto misfit = [&](double by) { return affineMisfit(shifted(by)); };
      const double by = snapped(leastOver(misfit), shifted);
      constexpr double kLeastShift = 2.0 * io::kDegree;  // smaller ones are a machine's, not a convention's
      if (std::abs(by) < kLeastShift) continue;
      ReadingsOfDay day = shifted(by);
      const double rms = fitNominal(day).rms;
      if (!arm.mends(rms) || (best && rms >= best->rms)) continue;
      best.emplace();
      ArmMistake angles;
      angles.angles = [](JointVector&) {};
      best->suspected = {"joint_zero",
                         arm.whereOf(angles, tables),
                         Remark(RemarkId::shift_zero, joint + 1, by, tables.size() == arm.tables.size()),
                         {}};
      best->rms = rms;
      best->day = std::move(day);
    }
  }
  if (best) arm.add(std::move(*best));
}

void searchOrigins(SearchedArm& arm) {
  std::vector<ArmCure> cures;
  for (std::size_t joint = 1; joint < arm.campaign.robot.axes_in_base_at_zero.size(); ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double degrees : {90.0, -90.0, 180.0}) {
        ReadingsOfDay day = arm.day;
        moveFrom(joint, Eigen::Vector3d::Zero(),
                 Eigen::AngleAxisd(degrees * io::kDegree, Eigen::Vector3d::Unit(axis)).toRotationMatrix(), day.robot);
        keepOrigin(arm, std::move(day), Remark(RemarkId::origin_turned, joint + 1, axis, degrees * io::kDegree), cures);
      }
    }
    const auto& [shift, unseen] = bestShift(arm.day, joint);
    if (shift.norm() < arm.limits.least_shift) continue;
    ReadingsOfDay day = arm.day;
    moveFrom(joint, shift, Eigen::Matrix3d::Identity(), day.robot);
    keepOrigin(arm, std::move(day),
               Remark(RemarkId::origin_off, joint + 1, std::vector<double>(shift.begin(), shift.end()), unseen), cures);
  }
  if (cures.empty()) return;
  std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.rms < b.rms; });
  const double best = cures.front().rms;
  for (ArmCure& cure : cures) {
    if (cure.rms <= kArmAsWell * best) arm.add(std::move(cure));
  }
}

void searchTableScales(SearchedArm& arm) {
  if (arm.tables.size() < 2) return;
  for (const SourceTable table : arm.tables) {
    const auto scaled = [&](double by) {
      ArmMistake mistake;
      mistake.points = (1.0 + by) * Eigen::Matrix3d::Identity();
      return arm.with(mistake, {table});
    };
    // The sum of squares is a parabola in the scale.
    constexpr double kStep = 5e-3, kLeast = 3e-3, kMost = 0.1;
    const double middle = std::pow(arm.found.fit.rms, 2), up = std::pow(fitNominal(scaled(kStep)).rms, 2),
                 down = std::pow(fitNominal(scaled(-kStep)).rms, 2), curvature = up + down - 2.0 * middle;
    if (curvature <= 0.0) continue;
    const double by = 0.5 * kStep * (down - up) / curvature;
    if (std::abs(by) < kLeast || std::abs(by) > kMost) continue;
    ReadingsOfDay day = scaled(by);
    const double rms = fitNominal(day).rms;
    if (!arm.mends(rms)) continue;
    ArmCure cure;
    cure.suspected = {"scale",
                      Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"), arm.filesOf({table}, false)),
                      Remark(RemarkId::table_scale_off, 1.0 / (1.0 + by) - 1.0),
                      {}};
    cure.rms = rms;
    cure.day = std::move(day);
    arm.add(std::move(cure));
    return;
  }
}

void searchStations(SearchedArm& arm) {
  if (arm.tables.size() < 2) return;
  for (const SourceTable table : arm.tables) {
    ReadingsOfDay own = arm.day, others = arm.day;
    std::erase_if(own.unloaded, [&](const UnloadedReading& reading) { return reading.table != table; });
    std::erase_if(others.unloaded, [&](const UnloadedReading& reading) { return reading.table == table; });
    const NominalFit apart = fitNominal(own), rest = fitNominal(others);
    if (!apart.done || !rest.done || !arm.mends(apart.rms) || !arm.mends(rest.rms)) continue;
    // One motion for all reflectors of the table, and the reflectors where the others have them.
    const Eigen::Isometry3d moved = rest.base_from_points.inverse() * apart.base_from_points;
    ReadingsOfDay day = arm.day;
    for (UnloadedReading& reading : day.unloaded) {
      if (reading.table == table) reading.point = moved * reading.point;
    }
    if (table == SourceTable::loading) {
      for (LoadedReading& reading : day.loaded) {
        for (ReflectorMove& move : reading.moves) move.displacement = moved.linear() * move.displacement;
      }
    }
    const double rms = fitNominal(day).rms;
    if (!arm.mends(rms)) continue;
    ArmCure cure;
    cure.suspected = {
        "other_station",
        Remark(RemarkId::in_files, std::vector<std::string>{fileOfPoints(arm.campaign, table)}),
        Remark(RemarkId::other_station, moved.translation().norm(), Eigen::AngleAxisd(moved.linear()).angle()),
        {}};
    cure.rms = rms;
    cure.day = std::move(day);
    arm.add(std::move(cure));
    return;
  }
}

void searchScale(SearchedArm& arm) {
  constexpr double kLeast = 3e-3, kMendsScale = 0.5, kWorth = 1e-3;  // share; of the misfit; m
  if (arm.found.fit.rms < kWorth) return;
  const NominalFit scaled = fitNominal(arm.day, {.scale = true});
  if (std::abs(scaled.scale - 1.0) < kLeast || scaled.rms > kMendsScale * arm.found.fit.rms) return;
  ArmCure cure;
  cure.suspected = {"scale",
                    Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"), arm.filesOf(arm.tables, false)),
                    Remark(RemarkId::scale_off, 1.0 / scaled.scale - 1.0),
                    {}};
  cure.day = arm.day;
  for (UnloadedReading& reading : cure.day.unloaded) reading.point *= scaled.scale;
  for (LoadedReading& reading : cure.day.loaded) {
    for (ReflectorMove& move : reading.moves) move.displacement *= scaled.scale;
  }
  cure.rms = scaled.rms;
  arm.add(std::move(cure));
}

void searchMasses(SearchedArm& arm) {
  constexpr double kHeaviest = 20e3;  // kg: several times the heaviest arms that are made
  double sum = 0.0;
  for (const robot::BodyMass& body : arm.day.weight.bodies) sum += body.mass_kg;
  if (sum < kHeaviest) return;
  ArmCure cure;
  cure.suspected = {"robot_unit", Remark(RemarkId::in_urdf), Remark(RemarkId::masses_in, std::string("g"), sum), {}};
  cure.day = arm.day;
  for (robot::BodyMass& body : cure.day.weight.bodies) body.mass_kg *= 1e-3;
  cure.rms = fitNominal(cure.day).rms;
  arm.add(std::move(cure));
}

void searchBase(SearchedArm& arm) {
  const bool in_base = arm.campaign.loading ? arm.campaign.loading->frame == campaign::PointFrame::base_link
                       : arm.campaign.circle_sweeps
                           ? arm.campaign.circle_sweeps->frame == campaign::PointFrame::base_link
                           : false;
  if (!in_base || arm.found.contradicts) return;
  constexpr double kFar = 0.1, kTurned = 5.0 * io::kDegree;  // m, more than a base frame of another convention is off
  const Eigen::Isometry3d& base = arm.found.fit.base_from_points;
  const double off = base.translation().norm(), turn = Eigen::AngleAxisd(base.linear()).angle();
  if (off < kFar && turn < kTurned) return;
  ArmCure cure;
  cure.suspected = {"frame_declared",
                    Remark(RemarkId::in_attribute, std::string("frame"), arm.filesOf(arm.tables, false)),
                    Remark(RemarkId::not_in_base, off, turn),
                    {}};
  cure.rms = arm.found.fit.rms;
  cure.day = arm.day;
  arm.add(std::move(cure));
}

}  // namespace stiffscope::mistakes
