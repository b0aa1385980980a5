#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>

#include "core/io/units.h"
#include "reports/words/compensation_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

/// Of each kind the first, and how many more postures have it.
void addCautions(const std::vector<compensation::CompensatedPosture>& postures, std::string& text) {
  struct Kind {
    int id = 0;
    std::string pose, first;
    std::size_t more = 0;
  };
  std::vector<Kind> kinds;
  for (const compensation::CompensatedPosture& posture : postures) {
    if (!posture.solved) continue;
    std::vector<int> counted;
    for (const Remark& caution : posture.cautions) {
      if (std::find(counted.begin(), counted.end(), caution.id) != counted.end()) continue;
      counted.push_back(caution.id);
      const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& one) { return one.id == caution.id; });
      if (same == kinds.end()) {
        kinds.push_back({caution.id, posture.posture.id, words(caution), 0});
      } else {
        ++same->more;
      }
    }
  }
  for (const Kind& one : kinds) {
    const std::string more = one.more > 0 ? fmt::format("; the like of {} more", one.more) : "";
    text += wrapped(fmt::format("Caution: posture {}: {}{}.", one.pose, one.first, more), 2) + "\n";
  }
}

}  // namespace

std::string compensationText(const campaign::Campaign& campaign, identification::Method method,
                             const std::vector<compensation::CompensatedPosture>& postures,
                             const std::vector<campaign::KnownStiffness>& known,
                             const std::vector<std::string>& cautions) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: predicted deflection of P_TCP and the commands that cancel it, by {}\n\n", campaign.name,
                 namesOf(method).full);
  fmt::format_to(out, "  {:<10}{:>27}{:>9}   {}\n", "pose", "deflection in R0 (mm)", "U", "command (deg)");
  for (const compensation::CompensatedPosture& posture : postures) {
    if (!posture.predicted) {
      fmt::format_to(out, "  {:<10}{:>9}{:>9}{:>9}{:>9}   refused: {}\n", posture.posture.id, "-", "-", "-", "-",
                     words(posture.reason));
      continue;
    }
    const Eigen::Vector3d mm = posture.tcp.deflection / io::kMillimetre;
    fmt::format_to(out, "  {:<10}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}   ", posture.posture.id, unsignedZero(mm.x(), 3),
                   unsignedZero(mm.y(), 3), unsignedZero(mm.z(), 3), posture.tcp.expanded / io::kMillimetre);
    if (posture.solved) {
      for (int joint = 0; joint < 6; ++joint)
        fmt::format_to(out, "{:>10.4f}", unsignedZero(posture.commands[joint] / io::kDegree, 4));
      fmt::format_to(out, "\n");
    } else {
      fmt::format_to(out, "refused: {}\n", words(posture.reason));
    }
  }
  fmt::format_to(
      out,
      "\n  Deflection of P_TCP under each row's load; U (coverage 95 %): it is within U of what is predicted, by "
      "the\n  stiffnesses, the effects in the model, those that could hide, and what the day left unexplained. "
      "Commands\n  are joints 1 to 6.\n");
  for (const campaign::KnownStiffness& one : known)
    fmt::format_to(out, "{}\n",
                   wrapped(fmt::format("  k{} = {:.4f} +- {:.4f} 1e6 Nm/rad (standard uncertainty) is not of this day, "
                                       "which cannot see it, but from: {}.",
                                       one.joint + 1, one.stiffness / 1e6, one.sd / 1e6, one.source),
                           2));
  fmt::format_to(out, "{}\n", wrapped(summaryWords(compensation::summaryOf(postures)) + ".", 2));
  addCautions(postures, text);
  for (const std::string& caution : cautions) fmt::format_to(out, "{}\n", wrapped("Caution: " + caution + ".", 2));
  return text;
}

}  // namespace stiffscope::reports
