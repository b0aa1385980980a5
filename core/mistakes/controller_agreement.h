#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/mistakes/suspected.h"

namespace stiffscope::mistakes {

/// The URDF's forward kinematics against the poses that the controller states beside its joints (State::tool_pose):
///
///   p_i = B G(q_i) T,
///
/// with its base frame B and its tool T constant and fitted, as nobody says where they are. Distances in m are root
/// mean squares over the tool's point and, where turns are stated, three points kLever from it along the tool's axes.
/// No reading enters: what is left is of the URDF, of how the joints are stated, or of the controller's own model.
struct ControllerAgreement {
  static constexpr double kLever = 0.1;  ///< m
  static constexpr std::size_t kFewest = 6;

  std::size_t postures = 0;             ///< with a pose, each joint figure once
  bool turns = false;                   ///< poses have their turns, too
  std::vector<int> still;               ///< joints, from 1, of which nothing is said: they do not move
  std::optional<double> miss;           ///< empty below kFewest postures
  double largest = 0.0;                 ///< of one posture
  std::size_t line = 0;                 ///< that posture's row
  std::optional<double> position_miss;  ///< of the tool's point alone, where turns are stated
  std::vector<Suspected> cures;         ///< one change each of files or URDF that brings them together

  // Where none does: what fitted axes leave, and axes with joints that give way under the own weight. Empty where there
  // are too few postures for that, or no masses.
  std::optional<double> geometry_miss, elastic_miss;
};

/// `trusted`: distances up to that are agreement, m; beyond it cures are looked for.
ControllerAgreement controllerAgreement(const campaign::Campaign& campaign, double trusted);

}  // namespace stiffscope::mistakes
