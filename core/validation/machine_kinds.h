#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/validation/effect_draw.h"

namespace stiffscope::validation {

/// Kinds of machines that blind tests draw. `six_axis` are the arms of the catalogue of draw.h, with a spherical wrist;
/// each other kind is one machine of published dimensions, scaled by up to a tenth:
/// - offset_wrist: six joints whose last axes do not meet (dimensions of a UR10),
/// - seven_axis: one joint more than a pose needs, last three axes meeting (dimensions of an LBR iiwa 14),
/// - palletiser: five joints, of which the last two meet,
/// - parallelogram: six joints, rods hold the forearm where joint 3 has it whatever joint 2 does (dimensions of the
/// paper's
///   class, 2.7 m),
/// - rail: six joints with a spherical wrist on a linear axis of 6 m (dimensions of a KR 210 R2700).
enum class MachineKind { six_axis, offset_wrist, seven_axis, palletiser, parallelogram, rail };

inline constexpr std::array<std::string_view, 6> kMachineKindNames{"six_axis",   "offset_wrist",  "seven_axis",
                                                                   "palletiser", "parallelogram", "rail"};

constexpr std::string_view nameOf(MachineKind kind) { return kMachineKindNames[static_cast<std::size_t>(kind)]; }

std::optional<MachineKind> machineKindOf(std::string_view name);

/// The URDF of a machine of that kind other than six_axis, its lengths scaled by `scale`.
std::string kindUrdf(MachineKind kind, double scale);

/// A machine of that kind and the clean day on which it is measured under load; as drawMachine, which it is for
/// six_axis. Springs, geometry errors, instruments and loads are drawn from `seed`.
MachineDraw drawMachineOfKind(MachineKind kind, std::uint64_t seed, const std::string& name,
                              const std::filesystem::path& urdf_file);

}  // namespace stiffscope::validation
