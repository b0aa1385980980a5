#include "core/compensation/implausible_commands.h"

#include <fmt/format.h>

#include "core/input/units.h"

namespace stiffscope {

std::vector<std::string> implausibleCommands(const std::vector<CompensatedPosture>& postures) {
  constexpr double kMost = 2.0 * kDegree;
  std::vector<std::string> sentences;
  for (const CompensatedPosture& posture : postures) {
    if (!posture.solved) continue;
    Eigen::Index joint = 0;
    const double turn = (posture.commands - posture.posture.q).cwiseAbs().maxCoeff(&joint);
    if (turn <= kMost) continue;
    sentences.push_back(
        fmt::format("posture {} would turn joint {} by {:.1f} deg, which no load does to a sound arm: its "
                    "wrench may not be in N and Nm",
                    posture.posture.id, joint + 1, turn / kDegree));
  }
  return sentences;
}

}  // namespace stiffscope
