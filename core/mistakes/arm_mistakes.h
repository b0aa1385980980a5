#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/mistakes/readings_of_day.h"
#include "core/mistakes/suspected.h"
#include "metrology/remark.h"

namespace stiffscope::mistakes {

/// Of which row of its table a reading's joint angles are.
enum class AnglesRow { own, before, after };

/// One way in which angles, points or names of reflectors are usually written wrongly: what takes it back.
struct ArmMistake {
  MistakeId id;
  /// How many things it asks to be wrong: of cures that mend as well the one with the fewest is believed.
  int things = 1;
  std::function<void(JointVector&)> angles;
  AnglesRow row = AnglesRow::own;
  std::optional<Eigen::Matrix3d> points;
  std::vector<int> targets;                                               ///< what each is; empty: as they are called
  double robot_size = 1.0;                                                ///< factor on all lengths of the URDF
  bool of_all_tables = true, of_some_tables = true, of_one_group = true;  ///< where it can be
  /// What is to be done; `everywhere`: in all tables.
  std::function<Remark(bool everywhere)> remedy;
};

/// The table of them: signs, order, coupling and units of joint angles, rows, axes and units of points, names.
/// `target_names` are those of the campaign.
std::vector<ArmMistake> armMistakes(const ReadingsOfDay& day, const std::vector<std::string>& target_names);

using Where = std::function<bool(const UnloadedReading&)>;

/// The readings with a mistake taken back where `where` says; of the loads where `of_loads` says, by posture.
ReadingsOfDay takenBack(const ReadingsOfDay& day, const ArmMistake& mistake, const Where& where,
                        const std::function<bool(int pose)>& of_loads);

/// The 48 matrices that exchange axes and turn signs, the identity first.
struct SignedPermutation {
  Eigen::Matrix3d map;
  std::vector<std::string> rows;  ///< "-y": what stands for x, y, z
  bool proper() const { return map.determinant() > 0.0; }
};
std::vector<SignedPermutation> signedPermutations();

}  // namespace stiffscope::mistakes
