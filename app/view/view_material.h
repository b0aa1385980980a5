#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/arm_scene.h"

namespace stiffscope {

/// One picture that the viewer steps to: the arm in one posture under one load, or in one sweep.
struct ViewFrame {
  ArmScene scene;     ///< with all its vectors; view, magnification, colours and panels are the viewer's
  std::string name;   ///< for the name of a file: "posture-17-step-3"
  std::string where;  ///< "posture 17"
  std::string load;   ///< "load step 3, 1.50 kN"; empty of a sweep
  int posture = 0;    ///< counts what Right goes through
  int step = 0;       ///< counts what Up goes through
  std::optional<Eigen::Vector3d> force;  ///< of the load, axes of R0, N
};

/// All pictures of a campaign, ordered by step, then posture.
struct ViewMaterial {
  std::string campaign;
  std::string method;   ///< "DPP": by what is predicted; empty where nothing is
  std::string lacking;  ///< why nothing is predicted, or why there are no loads
  std::vector<ViewFrame> frames;
};

}  // namespace stiffscope
