#include "core/mistakes/arm_mistakes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numeric>

#include "core/io/units.h"
#include "core/mistakes/remarks.h"

namespace stiffscope::mistakes {

std::vector<SignedPermutation> signedPermutations() {
  std::vector<SignedPermutation> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      SignedPermutation one{Eigen::Matrix3d::Zero(), {}};
      for (int k = 0; k < 3; ++k) {
        const bool negative = (signs >> k & 1) != 0;
        const int from = order[static_cast<std::size_t>(k)];
        one.map(k, from) = negative ? -1.0 : 1.0;
        one.rows.push_back(std::string(negative ? "-" : "") + "xyz"[from]);
      }
      all.push_back(std::move(one));
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

namespace {

void addSigns(int count, std::vector<ArmMistake>& all) {
  for (int set = 1; set < 1 << count; ++set) {
    std::vector<int> joints;
    for (int j = 0; j < count; ++j) {
      if ((set >> j & 1) != 0) joints.push_back(j + 1);
    }
    ArmMistake mistake;
    mistake.id = "joint_sign";
    // All of them is one thing: another convention.
    mistake.things = static_cast<int>(joints.size()) == count ? 1 : static_cast<int>(joints.size());
    mistake.angles = [joints](JointVector& q) {
      for (const int j : joints) q[j - 1] *= -1.0;
    };
    mistake.remedy = [joints](bool everywhere) { return Remark(RemarkId::turn_signs, joints, everywhere); };
    all.push_back(std::move(mistake));
  }
}

/// `stands`: the joint whose angle stands in each column.
ArmMistake orderOf(const PerJoint<int>& stands) {
  ArmMistake mistake;
  mistake.id = "joint_order";
  mistake.angles = [stands](JointVector& q) {
    const JointVector read = q;
    for (std::size_t column = 0; column < stands.size(); ++column)
      q[stands[column] - 1] = read[static_cast<Eigen::Index>(column)];
  };
  mistake.remedy = [stands](bool) {
    return Remark(RemarkId::order_of_joints, std::vector<int>(stands.begin(), stands.end()));
  };
  return mistake;
}

void addOrders(int count, std::vector<ArmMistake>& all) {
  const auto joints = static_cast<std::size_t>(count);
  PerJoint<int> as_written(joints);
  std::iota(as_written.begin(), as_written.end(), 1);
  PerJoint<int> order = as_written;
  std::reverse(order.begin(), order.end());
  all.push_back(orderOf(order));
  for (std::size_t a = 0; a < joints; ++a) {
    for (std::size_t b = a + 1; b < joints; ++b) {
      order = as_written;
      std::swap(order[a], order[b]);
      all.push_back(orderOf(order));
    }
  }
  for (const int shift : {1, count - 1}) {
    order = as_written;
    std::rotate(order.begin(), order.begin() + shift, order.end());
    all.push_back(orderOf(order));
  }
}

void addCouplings(int count, std::vector<ArmMistake>& all) {
  // Neighbours within the arm, but axis 1, which is upright, and neighbours within the wrist, whose motors sit on one
  // arm.
  std::vector<std::pair<int, int>> pairs{{3, 2}};
  for (int joint = 4; joint <= robot::armJointsOf(count); ++joint) pairs.emplace_back(joint, joint - 1);
  for (int joint = robot::armJointsOf(count) + 2; joint <= count; ++joint) pairs.emplace_back(joint, joint - 1);
  for (const auto& [joint, other] : pairs) {
    for (const int sign : {1, -1}) {
      ArmMistake mistake;
      mistake.id = "joint_coupling";
      mistake.angles = [joint = joint, other = other, sign](JointVector& q) { q[joint - 1] += sign * q[other - 1]; };
      mistake.remedy = [joint = joint, other = other, sign](bool) {
        return Remark(RemarkId::add_joint, joint, other, sign);
      };
      all.push_back(std::move(mistake));
    }
  }
}

/// All lengths of a robot by one factor.
void resize(double factor, robot::Robot& robot) {
  for (metrology::Line& axis : robot.axes_in_base_at_zero) axis.point *= factor;
  robot.base_from_flange_at_zero.translation() *= factor;
  for (robot::LinkFrame& link : robot.links) link.base_from_link_at_zero.translation() *= factor;
  for (robot::BodyMass& body : robot.bodies) body.com_in_base_at_zero *= factor;
}

double sizeOf(const robot::Robot& robot) {
  double size = robot.base_from_flange_at_zero.translation().norm();
  for (const metrology::Line& axis : robot.axes_in_base_at_zero) size = std::max(size, axis.point.norm());
  return size;
}

void addUnits(const robot::Robot& robot, std::vector<ArmMistake>& all) {
  constexpr double kLongestArm = 20.0;  // m
  if (sizeOf(robot) > kLongestArm) {
    ArmMistake mistake;
    mistake.id = "robot_unit";
    mistake.robot_size = 1e-3;
    mistake.of_some_tables = mistake.of_one_group = false;
    mistake.remedy = [](bool) { return Remark(RemarkId::robot_in, std::string("mm")); };
    all.push_back(std::move(mistake));
    return;
  }

  struct Unit {
    const char* name;
    double factor;
  };
  for (const Unit unit : {Unit{"radians", 1.0 / io::kDegree}, Unit{"gon", 0.9}, Unit{"turns", 360.0}}) {
    ArmMistake mistake;
    mistake.id = "angle_unit";
    mistake.angles = [unit](JointVector& q) { q *= unit.factor; };
    mistake.remedy = [unit](bool) { return Remark(RemarkId::angles_in, std::string(unit.name)); };
    all.push_back(std::move(mistake));
  }
  for (const Unit unit : {Unit{"m", 1e3}, Unit{"inches", 25.4}, Unit{"cm", 10.0}, Unit{"um", 1e-3}}) {
    ArmMistake mistake;
    mistake.id = "point_unit";
    mistake.points = unit.factor * Eigen::Matrix3d::Identity();
    mistake.remedy = [unit](bool) { return Remark(RemarkId::points_in, std::string(unit.name)); };
    all.push_back(std::move(mistake));
  }
}

void addRows(std::vector<ArmMistake>& all) {
  for (const AnglesRow row : {AnglesRow::before, AnglesRow::after}) {
    ArmMistake mistake;
    mistake.id = "row_order";
    mistake.row = row;
    mistake.of_one_group = false;
    mistake.remedy = [row](bool) { return Remark(RemarkId::angles_of_row, row == AnglesRow::after); };
    all.push_back(std::move(mistake));
  }
}

void addAxesOfPoints(std::vector<ArmMistake>& all) {
  ArmMistake mirror;
  mirror.id = "point_axes";
  mirror.points = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  mirror.of_some_tables = mirror.of_one_group = false;
  mirror.remedy = [](bool) { return Remark(RemarkId::left_handed); };
  all.push_back(std::move(mirror));
  for (const SignedPermutation& one : signedPermutations()) {
    if (one.map.isIdentity()) continue;
    ArmMistake mistake;
    mistake.id = "point_axes";
    mistake.points = one.map;
    mistake.of_all_tables = false;  // where all are turned alike the base stands turned, which is no mistake
    mistake.remedy = [rows = one.rows](bool) { return Remark(RemarkId::axes_of_points, rows); };
    all.push_back(std::move(mistake));
  }
}

void addRenamings(const std::vector<std::string>& names, std::vector<ArmMistake>& all) {
  constexpr std::size_t kMost = 4;  // 23 orders; of more reflectors pairs would be the most that can be tried
  if (names.size() < 2 || names.size() > kMost) return;
  std::vector<int> is(names.size());
  std::iota(is.begin(), is.end(), 0);
  while (std::next_permutation(is.begin(), is.end())) {
    ArmMistake mistake;
    mistake.id = "reflectors_exchanged";
    mistake.targets = is;
    mistake.of_all_tables = false;  // names are free
    std::vector<std::string> pairs;
    for (std::size_t k = 0; k < is.size(); ++k) {
      if (is[k] == static_cast<int>(k)) continue;
      pairs.push_back(names[k]);
      pairs.push_back(names[static_cast<std::size_t>(is[k])]);
    }
    mistake.remedy = [pairs](bool) { return Remark(RemarkId::reflectors_renamed, pairs); };
    all.push_back(std::move(mistake));
  }
}

}  // namespace

std::vector<ArmMistake> armMistakes(const ReadingsOfDay& day, const std::vector<std::string>& target_names) {
  std::vector<ArmMistake> all;
  addSigns(day.robot.joints(), all);
  addOrders(day.robot.joints(), all);
  addCouplings(day.robot.joints(), all);
  addUnits(day.robot, all);
  addRows(all);
  addAxesOfPoints(all);
  addRenamings(target_names, all);
  return all;
}

ReadingsOfDay takenBack(const ReadingsOfDay& day, const ArmMistake& mistake, const Where& where,
                        const std::function<bool(int pose)>& of_loads) {
  ReadingsOfDay mended = day;
  if (mistake.robot_size != 1.0) {
    resize(mistake.robot_size, mended.robot);
    for (robot::BodyMass& body : mended.weight.bodies) body.com_in_base_at_zero *= mistake.robot_size;
    // Its ends were placed by links of the wrong size: less is wrong without it.
    mended.robot.balancers.clear();
    mended.weight.balancers.clear();
  }
  const auto renamed = [&](int target) {
    return target < static_cast<int>(mistake.targets.size()) ? mistake.targets[static_cast<std::size_t>(target)]
                                                             : target;
  };
  for (UnloadedReading& reading : mended.unloaded) {
    if (!where(reading)) continue;
    if (mistake.row == AnglesRow::before) reading.q = reading.q_before;
    if (mistake.row == AnglesRow::after) reading.q = reading.q_after;
    if (mistake.angles) {
      for (JointVector* q : {&reading.q, &reading.q_before, &reading.q_after}) mistake.angles(*q);
    }
    if (mistake.points) reading.point = *mistake.points * reading.point;
    reading.target = renamed(reading.target);
  }
  for (LoadedReading& reading : mended.loaded) {
    if (!of_loads(reading.pose)) continue;
    if (mistake.row != AnglesRow::own) {
      // Unloaded angles of the postures before and after are with the unloaded readings.
      for (const UnloadedReading& own : mended.unloaded) {
        if (own.pose == reading.pose) reading.q = own.q;
      }
    }
    if (mistake.angles) mistake.angles(reading.q);
    for (ReflectorMove& move : reading.moves) {
      if (mistake.points) move.displacement = *mistake.points * move.displacement;
      move.target = renamed(move.target);
    }
  }
  return mended;
}

}  // namespace stiffscope::mistakes
