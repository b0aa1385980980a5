#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/simulation/spec.h"

namespace stiffscope::validation {

/// A six-axis arm with a spherical wrist, as data. At all joints zero it stands upright with the forearm
/// level: axis 1 vertical through the base's origin, axis 2 at (a1, d1), axis 3 a2 above it, axis 4 along the
/// forearm a3 above axis 3, axes 5 and 6 at d4 and d4 + d6 along it (m). Dimensions are those of published
/// data sheets and drawings; masses share the published total out; stiffness is of the order that the
/// literature gives for the size.
struct ArmModel {
  std::string_view name, size_class;
  double d1, a1, a2, a3, d4, d6;
  std::array<int, 6> sense;         ///< of positive turns, against z, y, -y, -x, -y, -x
  std::array<double, 6> masses_kg;  ///< bodies beyond joints 1..6
  std::array<double, 6> stiffness;  ///< Nm/rad
  std::array<double, 2> load_n;     ///< least and greatest full load
  double tool_kg;
};

extern const std::array<ArmModel, 4> kArmModels;

/// The model as URDF: links base_link, link_1..link_6, tool0, inertials included, the joints' senses in the
/// axes. The flange looks along the forearm with x up.
std::string armUrdf(const ArmModel& model);

/// One machine and its day, with nothing wrong beyond what every machine has: link lengths within 10 % of a
/// catalogue arm's, joint stiffness spread by a quarter; axes a tenth of a mm and six thousandths of a degree
/// from nominal, as an arm has them that nobody calibrated; and, well under what the tracker sees in a
/// deflection, bearings that deflect a thousandth of what the joints do.
/// The day: circle sweeps of six axes (24 stops), a wrist sweep (120 stops), 24 postures with three loads and
/// a return to zero, three reflectors, three repeats, four nests. The load hangs, or a cable pulls it towards
/// one of six directions, another one a posture.
struct MachineDraw {
  simulation::SimulationSpec spec;
  std::string arm;      ///< name of the catalogue's
  std::string loading;  ///< hanging or cable
};

/// A machine for a day without a load, rigid: the same arms, axes some tenths of a mm and hundredths of a degree from
/// nominal, as they leave the works. The day: 60 to 200 postures all over the workspace in no order, three reflectors
/// (one on every seventh), two or three repeats, four nests on four of five; temperatures of the hall are in `states`
/// on every second. All from `seed`, as below.
MachineDraw drawUnloadedMachine(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file);

/// `urdf_file` is written. All from `seed`; `name` is the campaign's.
MachineDraw drawMachine(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file);

}  // namespace stiffscope::validation
