#pragma once

#include <cstdint>
#include <filesystem>

#include "core/blind/arm_models.h"
#include "core/simulation/spec.h"

namespace stiffscope::blind {

/// One machine and its day, with nothing wrong beyond what every machine has: link lengths within 10 % of a
/// catalogue arm's, joint stiffness spread by a quarter; axes a tenth of a mm and six thousandths of a degree
/// from nominal, as an arm has them that nobody calibrated; and, well under what the tracker sees in a
/// deflection, bearings that give a thousandth of what the joints do.
/// The day: circle sweeps of six axes (24 stops), a wrist sweep (120 stops), 24 postures with three loads and
/// a return to zero, three reflectors, three repeats, four nests. The load hangs, or a cable pulls it towards
/// one of six directions, another one a posture.
struct MachineDraw {
  SimulationSpec spec;
  std::string arm;      ///< name of the catalogue's
  std::string loading;  ///< hanging or cable
};

/// `urdf_file` is written. All from `seed`; `name` is the campaign's.
MachineDraw drawMachine(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file);

}  // namespace stiffscope::blind
