#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/frames.h"
#include "core/identification/identify.h"
#include "render/arm_scene.h"

namespace stiffscope::app {

/// One picture that the viewer steps to: the arm in one posture under one load, or in one sweep.
struct ViewFrame {
  render::ArmScene scene;  ///< with all its vectors; view, magnification, colours and panels are the viewer's
  std::string name;        ///< for the name of a file: "posture-17-step-3"
  std::string where;       ///< "posture 17"
  std::string load;        ///< "load step 3, 1.50 kN"; empty of a sweep
  int posture = 0;         ///< counts what Right goes through
  int step = 0;            ///< counts what Up goes through
  std::optional<Eigen::Vector3d> force;  ///< of the load, axes of R0, N
};

/// All pictures of a campaign, ordered by step, then posture.
struct ViewMaterial {
  std::string campaign;
  std::string method;   ///< "DPP": by what is predicted; empty where nothing is
  std::string lacking;  ///< why nothing is predicted, or why there are no loads
  std::vector<ViewFrame> frames;
};

/// Postures under every load step, the scenes by the code of the report's deflection picture, a material a method in
/// their order. Vectors are predicted by it with the stiffnesses of `identified`, from whichever step they were
/// identified; of no method one with measured vectors only. `wanted`: by the place among the campaign's postures which
/// of them; null: all.
std::vector<ViewMaterial> loadMaterials(const campaign::Campaign& campaign,
                                        const identification::Identification& identified,
                                        const std::vector<identification::Method>& methods,
                                        const std::function<bool(int posture)>& wanted = nullptr);

/// The command line of stiffscope-view.
struct ViewOptions {
  std::string campaign;
  std::string method;  ///< empty: the one that the report shows
  std::optional<int> step;
  std::string pose;  ///< empty: the one with the median displacement
  std::optional<double> magnification;
  render::View view = render::View::oblique;
  bool dark = false;
  render::Size size{1280, 860};
  std::string screenshot;  ///< empty: interactive
  std::string point;       ///< the point whose numbers are shown
};

/// What there is to see, and where to start.
struct OpenedMaterial {
  std::vector<ViewMaterial> by_method;  ///< the method asked for first, then the others that are available
  std::size_t first = 0;
};

/// The loads of a campaign; where it has none that can be shown, its circle sweeps. Throws InputError for a
/// method, posture or load step that is not there, or, with the reason, where there is nothing to show.
OpenedMaterial openMaterial(const campaign::Campaign& campaign, const ViewOptions& options);

/// The circle sweeps, an axis each: the arm as it stood in the middle of the sweep, with the readings of all
/// sweeps as dots, those of this one in full colour. The arm is drawn rigid, without its gravity sag. No
/// frames, and the reason in `lacking`, where the campaign has no circle sweeps or they do not place R0.
ViewMaterial sweepMaterial(const campaign::Campaign& campaign, const frames::Frames& frames);

/// Another load step of the same campaign as the stiffnesses of `identified` see it: cases, P_wrist and every
/// available method's rows of that step, with K_c and the middle posture that these stiffnesses imply;
/// estimates and frames as they are. What only an identification has (subsets, judgements) stays empty. A
/// case for which a method has no rows gets empty ones.
identification::Identification underLoadStep(const campaign::Campaign& campaign,
                                             const identification::Identification& identified, int step);

}  // namespace stiffscope::app
