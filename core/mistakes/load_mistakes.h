#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
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

}  // namespace stiffscope::mistakes
