#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/effects/effect.h"
#include "core/numerics/random.h"
#include "core/simulation/spec.h"

namespace stiffscope::validation {

/// Where an effect shows, and so what its size is measured by (see effect_size.h).
enum class Shows {
  deflection,  ///< in loaded minus unloaded
  nests,       ///< in absolute positions, and the nests see it
  positions,   ///< in absolute positions only
  geometry,    ///< in what the URDF misses, which a calibration takes in
};

/// An effect as it was drawn, all but its strength: which joint, which way, which mechanism.
struct EffectDraw {
  std::string effect;  ///< its id; empty: outside the vocabulary
  std::string detail;  ///< the pair, the reflector, the joint; outside the vocabulary: what it is
  Shows shows = Shows::deflection;
  double most = 1.0;  ///< greatest strength that a real machine might have
  std::function<void(double strength, simulation::SimulationSpec& spec)> apply;  ///< strength 0: nothing
};

/// An effect of the vocabulary on this machine. Mechanism and place are drawn.
EffectDraw drawEffect(effects::Effect effect, const simulation::SimulationSpec& machine,
                      numerics::RandomStream& random);

/// What an arm as it is has of an effect, at half its usual size, at strength 1. For torsion k in the joint (Nm/rad):
///   bearing_tilt     every joint; across its axis 2 k times 8 to 18, in place of the machine's own
///   link_compliance  upper arm and forearm (longestLinks); EI / L = 2 k times 4 to 10, of the joint that the link
///                    follows (at most joint 3's), GJ / L half to twice EI / L
///   base_compliance  about x and y 2 k_2 times 10 to 25, about z ten times that
///   hysteresis       every joint; friction of half a hundredth to one hundredth of its usual torque
/// Throws std::invalid_argument for another effect.
EffectDraw drawAsIs(effects::Effect effect, const simulation::SimulationSpec& machine, numerics::RandomStream& random);

/// Ids of the effects outside the vocabulary: creep, stiffness_ripple, warming_drives, swinging_load,
/// cracked_floor, thermal_growth, eccentric_encoder, dress_pack, refraction.
const std::vector<std::string>& outsideKinds();

/// One of them. Throws std::invalid_argument for an id that is not listed.
EffectDraw drawOutside(const std::string& kind, const simulation::SimulationSpec& machine,
                       numerics::RandomStream& random);

/// The ids of effects of days without a load, and of kinds outside that vocabulary: pulling_cable, zero_by_temperature,
/// loose_plate, layered_air, rattling_reflector, slipped_belt, cracked_floor.
const std::vector<std::string>& unloadedEffects();
const std::vector<std::string>& unloadedOutsideKinds();

/// One of them on a rigid machine without a load, mechanism and place drawn. Throws std::invalid_argument for an id
/// that is not listed.
EffectDraw drawUnloadedEffect(const std::string& id, const simulation::SimulationSpec& machine,
                              numerics::RandomStream& random);
EffectDraw drawUnloadedOutside(const std::string& kind, const simulation::SimulationSpec& machine,
                               numerics::RandomStream& random);

/// Stiffness (Nm/rad) at which the weight beyond a joint's axis, at all joints zero and as if it stood out level, turns
/// by a milliradian: what an unloaded arm's compliances are drawn by.
double milliradianStiffness(const simulation::SimulationSpec& spec, int joint);

/// How long (s) the postures of a day without a load take, nests aside.
double dayLength(const simulation::SimulationSpec& spec);

/// The joints (from 0, in their order) after which the two longest links stand, base and flange aside: the upper arm's
/// and the forearm's, of the catalogue's arms joints 2 and 4.
std::array<int, 2> longestLinks(const simulation::SimulationSpec& spec);

/// A unit vector, all directions alike.
Eigen::Vector3d drawDirection(numerics::RandomStream& random);
int drawIndex(int count, numerics::RandomStream& random);  ///< 0 .. count - 1

/// Greatest load force (N), and the torque (Nm) it puts on a joint of this machine, about: over half the
/// distance of the flange from the joint at all joints zero.
double fullLoad(const simulation::SimulationSpec& spec);
double usualTorque(const simulation::SimulationSpec& spec, int joint);

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
