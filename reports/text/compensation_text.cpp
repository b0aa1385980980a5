#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <iterator>

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

std::string compensationText(const campaign::Campaign& campaign, identification::Method method,
                             const std::vector<compensation::CompensatedPosture>& postures,
                             const std::vector<std::string>& cautions) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: predicted deflection of P_TCP and the commands that cancel it, by {}\n\n", campaign.name,
                 namesOf(method).full);
  fmt::format_to(out, "  {:<10}{:>27}{:>9}   {}\n", "pose", "deflection in R0 (mm)", "+-", "command (deg)");
  for (const compensation::CompensatedPosture& posture : postures) {
    if (!posture.predicted) {
      fmt::format_to(out, "  {:<10}{:>9}{:>9}{:>9}{:>9}   refused: {}\n", posture.posture.id, "-", "-", "-", "-",
                     words(posture.reason));
      continue;
    }
    const Eigen::Vector3d mm = posture.tcp.deflection / io::kMillimetre;
    fmt::format_to(out, "  {:<10}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}   ", posture.posture.id, unsignedZero(mm.x(), 3),
                   unsignedZero(mm.y(), 3), unsignedZero(mm.z(), 3), posture.tcp.sd.norm() / io::kMillimetre);
    if (posture.solved) {
      for (int joint = 0; joint < 6; ++joint)
        fmt::format_to(out, "{:>10.4f}", unsignedZero(posture.commands[joint] / io::kDegree, 4));
      fmt::format_to(out, "\n");
    } else {
      fmt::format_to(out, "refused: {}\n", words(posture.reason));
    }
  }
  fmt::format_to(out,
                 "\n  Deflection of P_TCP under each row's load; +- is its standard uncertainty (mm, length of the "
                 "three)\n  from the stiffnesses and the effects in the model. Commands are joints 1 to 6.\n");
  for (const std::string& caution : cautions) fmt::format_to(out, "{}\n", wrapped("Caution: " + caution + ".", 2));
  return text;
}

}  // namespace stiffscope::reports
