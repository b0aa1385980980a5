#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/mistakes/nominal_fit.h"
#include "core/mistakes/readings_of_day.h"
#include "core/mistakes/spring_fit.h"
#include "core/mistakes/suspected.h"
#include "metrology/remark.h"

namespace stiffscope::mistakes {

/// One way in which a load cell's readings, or how they are declared, are usually wrong: what takes it back.
struct LoadMistake {
  MistakeId id;
  int things = 1;  ///< how many things it asks to be wrong
  CellReading meant;
  Remark where, remedy;
  double mends = 0.5;          ///< it has to bring what springs leave to that share, where nothing else speaks for it
  bool of_one_posture = true;  ///< whether it can be in the rows of one posture
};

/// The table of them: signs, order, units of forces and moments, the cell's axes and point, rows.
std::vector<LoadMistake> loadMistakes(const campaign::Campaign& campaign);

/// The remedy that turns the declared cell about axes of its own.
LoadMistake turnedCell(const campaign::Campaign& campaign, const Eigen::Matrix3d& turn);

/// The remedy that moves its point, in the axes of its parent, m.
LoadMistake movedCell(const campaign::Campaign& campaign, const Eigen::Vector3d& to);

/// Two postures, the earlier first, whose wrenches are the same digit by digit in all steps although the joints are
/// not: no load cell repeats to the last digit of six columns. None where the cell's axes do not turn with the flange.
std::optional<std::pair<int, int>> posesOfEqualWrenches(const campaign::Campaign& campaign);

/// Postures in which two loaded steps, in the same way in all of them, have one wrench digit by digit although the
/// reflectors stand elsewhere.
struct RepeatedSteps {
  std::vector<int> poses;
  int step = 0, own = 0;  ///< the later has the wrench of the earlier, whose own it is
};
/// Those two steps that the most postures have so; none where posesOfEqualWrenches has none for the cell.
std::optional<RepeatedSteps> stepsOfEqualWrenches(const campaign::Campaign& campaign);

/// Whether the forces of some load step are three times those of another (rms): a load of couples alone leaves the
/// same noise in all of them, loaded or not, of which no lever and no stiffness follows. The ratio does not ask for
/// units. True of a single step.
bool forcesStandOut(const campaign::Campaign& campaign);

/// What the loads say of joint springs on the URDF's arm, and what would mend them where they contradict it.
struct LoadSearch {
  bool done = false;         ///< a load cell and six loaded states or more
  SpringFit fit;             ///< as read
  bool contradicts = false;  ///< springs that give way explain less than half of the displacements
  std::vector<Suspected> cures;
};

/// Tries the table of mistakes, always where forces stand out: a fit takes a fraction of a
/// millisecond. One is believed where, with it, one of these holds and none of them gets worse:
///
/// - the forces of all states pull down, and as declared they do not: a load that hangs;
/// - springs leave half of what they leave as declared, which is more than unmodelled effects make;
/// - one point of the tool carries the load, and as declared none does.
LoadSearch searchLoads(const campaign::Campaign& campaign, const ReadingsOfDay& day, const NominalFit& arm);

// What the weights say, besides the springs.

/// A weight that turns with the postures in rows without load: F = m g in the cell's axes, and a constant.
std::optional<Suspected> weightNotTared(const campaign::Campaign& campaign, const ReadingsOfDay& day);

/// Scatter of the unloaded cell over what is declared: standard deviations; 0 where nothing says.
struct CellScatter {
  double force = 0.0, moment = 0.0;
};
CellScatter unloadedScatter(const campaign::Campaign& campaign);

/// Sag of the own weight in parts of what these springs make of it; 0 where no masses are known.
double sagBy(const ReadingsOfDay& day, const SpringFit& springs);

/// Units in which the wrenches may be although springs explain them as they are: all in one other unit makes springs as
/// much softer. The cell's unloaded scatter against what is declared shows them, and the own weight's sag by these
/// springs. `as_read`: the fit of the loads as they stand; `table`: loadMistakes.
std::vector<Suspected> unitsByScatter(const campaign::Campaign& campaign, const ReadingsOfDay& day,
                                      const LoadsOfDay& loads, const SpringFit& as_read,
                                      const std::vector<LoadMistake>& table);

/// The own weight's sag is the opposite of what masses and springs make of it, and the day fits by that.
std::optional<Suspected> gravityReversed(const ReadingsOfDay& day, const SpringFit& springs);

/// Share of the displacements that joint springs leave beyond which the loads contradict the model. Simulated machines
/// with every effect of the vocabulary, and with what none of them is, leave 0.15 at most.
inline constexpr double kContradicts = 0.5;

}  // namespace stiffscope::mistakes
