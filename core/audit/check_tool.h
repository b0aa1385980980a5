#pragma once

#include <array>
#include <vector>

#include "core/campaign/state_points.h"

namespace stiffscope::audit {

/// One distance between two reflectors in one state, against its reference.
struct ToolDistance {
  std::size_t state = 0;  ///< index into the states
  int first = 0, second = 0;
  double change = 0.0;  ///< against the reference, m
  double sd = 0.0;      ///< of the change, m
};

/// Distances between reflectors over all states, and their references: the tool is rigid.
struct ToolDistances {
  struct Pair {
    int first = 0, second = 0;
    double reference = 0.0;  ///< weighted mean over unloaded states, those far off the median left out, m
    double reference_sd = 0.0;
    int states = 0;
  };
  std::vector<Pair> pairs;
  std::vector<ToolDistance> distances;
  double limit = 0.0;  ///< of |change| / sd, over all distances

  const Pair* pair(int first, int second) const;
};

/// A pair that fewer than three states show is left out.
ToolDistances toolDistances(const std::vector<campaign::StatePoints>& states, int targets,
                            const metrology::TrackerNoise& noise);

}  // namespace stiffscope::audit
