#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/diagnosis_input.h"
#include "core/diagnosis/linear_system.h"
#include "core/diagnosis/projection.h"
#include "core/numerics/random.h"
#include "core/preparation/prepare.h"

namespace stiffscope::diagnosis {

/// An effect to be added to a day, all but its size: which of its equations and parts, which direction.
struct Spike {
  effects::Effect effect = effects::Effect::link_compliance;
  std::size_t model = 0;           ///< of effectModelsOf; none for the geometry
  std::vector<std::string> parts;  ///< as the effect's record names them: "joint 3", "P12"; empty: it has no names
  /// Parameters of the model, or of the geometry the zeros (rad) of joints 2 to n - 1 and the lengths (m) before them,
  /// as they are at a size of 1 m.
  Eigen::VectorXd parameters;
  double largest = 0.0;  ///< size at which a parameter reaches its physical bound, m
};

/// A real day to which effects can be added.
///
/// What an effect adds to a reading is u = X(s) theta, X the columns of the effect's own record (effects::EffectModel)
/// in the state s of that reading, at the stiffnesses, geometry and wrenches that identification finds: to readings of
/// loading and sweeps u, to displacements u less that of the unloaded state; a drift moves nests and rail sweep, too.
/// s is where the prepared day has the reading (stations joined, the carriage at zero); u is added in the axes of the
/// station that read it. Where an equation bends with its own size (friction, play), X is taken at that size. Wrenches,
/// angles and all else stay as they were read, so that noise, drift and every effect that the day has stay in it.
/// kinematic_error, whose record has no columns, turns or shifts what lies beyond a joint by a wrong zero or length, in
/// every reading alike.
///
/// Size is in the unit of DetectableSize: sqrt(theta^T N theta / n) times the noise of one state's displacement, N the
/// whitened normal equations of X over the day's n equations, theta at first order. For kinematic_error: rms per
/// coordinate of what base and reflectors cannot follow in the unloaded positions (GeometryError::rms).
///
/// It shares its equations with the diagnosis. What it shows is whether an effect that follows them is seen and told
/// from others in this day's readings; not whether the machine follows them.
class SpikedDay {
 public:
  /// Throws InputError as diagnose does.
  explicit SpikedDay(campaign::Campaign campaign);
  SpikedDay(const SpikedDay&) = delete;
  SpikedDay& operator=(const SpikedDay&) = delete;

  /// Why nothing can be added; empty where it can.
  const Remark& unusable() const { return start_.reason; }

  /// An effect with a model, one part (two in a third of the draws, where its parts may be present together), signs
  /// and proportions of the parameters drawn; parts that joint springs and geometry hide are not drawn. `largest`: size
  /// that should be within the physical bounds of the parameters; where none of 40 draws is, the last one stands.
  /// Empty where the effect has nothing that this day could show.
  std::optional<Spike> draw(effects::Effect effect, double largest, numerics::RandomStream& random) const;

  /// The day as it was read, with the effect in that size (m) added.
  campaign::Campaign with(const Spike& spike, double size) const;

 private:
  /// Displacement of reflectors in R0, three rows a reflector of the state.
  using Field = std::function<Eigen::VectorXd(const effects::PostureStates& posture, std::size_t state)>;

  struct Part {
    std::size_t model = 0, part = 0;
    Eigen::Index first = 0;  ///< of its parameters among all effects'
  };

  std::vector<Part> seenParts(effects::Effect effect) const;
  std::optional<Spike> drawGeometry(numerics::RandomStream& random) const;
  Field fieldOf(const Spike& spike, double size) const;
  Eigen::VectorXd byGeometry(const Eigen::VectorXd& errors, const effects::ArmState& state) const;
  double geometryLeft(const Eigen::VectorXd& errors) const;  ///< GeometryError::rms that they make, m
  effects::ArmState atRest(int target, const JointVector& q, const Eigen::Vector3d& point, double time_s,
                           double carriage) const;
  void moveLoading(const Field& field, campaign::Campaign& campaign) const;
  void moveDisplacements(const Field& field, campaign::Campaign& campaign) const;
  /// A displacement of R0 in the axes in which a station reads it; `r0_from_points` of the first one's frame.
  Eigen::Vector3d asRead(int station, const Eigen::Isometry3d& r0_from_points, const Eigen::Vector3d& in_r0) const;
  // `placed`: the same rows of placed_.
  template <class Row>
  void moveSweep(const Field& field, const std::vector<Row>& placed, std::vector<Row>& rows) const;
  template <class Row>
  void moveWithInstrument(const Field& field, const std::vector<Row>& placed, std::vector<Row>& rows) const;

  campaign::Campaign campaign_;  ///< as read
  preparation::PreparedCampaign prepared_;
  campaign::Campaign placed_;  ///< row by row as read, points where the preparation has them
  DiagnosisInput start_;
  SystemInput input_;
  LinearSystem data_;
  Eigen::MatrixXd normal_;  ///< of the effects' columns, nothing projected off
  Projection projection_;
};

struct SpikeOptions {
  std::vector<effects::Effect> effects;              ///< empty: all
  std::vector<double> sizes = {0.5, 1.0, 2.0, 4.0};  ///< times the effect's smallest detectable size
  int draws = 8;                                     ///< realisations of an effect; each in all sizes
  std::uint64_t seed = 1;
};

/// What is said of a day with an effect added in one size.
struct SpikeCounts {
  double times = 0.0;       ///< the detectable size
  double size = 0.0;        ///< m
  int draws = 0;            ///< realisations that are within the physical bounds at this size and have an answer
  int named = 0;            ///< the effect is a member of an entry of the verdict
  int part_named = 0;       ///< and the entry names the drawn parts; of effects without named parts: as `named`
  double class_size = 0.0;  ///< members of that entry, mean over `named`
  /// Answers with an entry that neither has the effect nor any that the day itself is said to have.
  int other_named = 0;
  int unknown = 0;                                      ///< answers with `unknown` where the day itself had none
  std::vector<std::pair<effects::Effect, int>> others;  ///< by the first member of such an entry, most often first
};

struct SpikedEffect {
  effects::Effect effect = effects::Effect::link_compliance;
  std::optional<double> detectable;  ///< m; empty: nothing was added, for `reason`
  Remark reason;
  bool in_baseline = false;  ///< the day is said to have it without being added: `named` says nothing then
  std::vector<SpikeCounts> sizes;
};

/// How a diagnosis fares on a user's own day when the cause is known.
struct SpikeStudy {
  std::vector<SpikedEffect> effects;  ///< those asked for, in the vocabulary's order
  std::uint64_t seed = 1;
  int draws = 0;  ///< asked for
};

/// Adds effects (SpikedDay) to the readings and diagnoses each spiked day from the start, as if it had been read so.
/// `baseline`: the diagnosis of the campaign; its effects stay in the readings. A long day is studied on the postures
/// that the diagnosis looks at. A spiked day that cannot be diagnosed has no answer. Runs on all cores; the same seed
/// gives the same counts on any number of them. `progress`: told how many days of how many are done, from one thread at
/// a time.
SpikeStudy spikeStudy(const campaign::Campaign& campaign, const Diagnosis& baseline, const SpikeOptions& options,
                      const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stiffscope::diagnosis
