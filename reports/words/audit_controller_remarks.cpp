#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/audit/remarks.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string auditControllerWords(audit::ControllerRemarkId id, const RemarkValues& values) {
  switch (id) {
    case audit::ControllerRemarkId::controller_states:
      return fmt::format(
          "the poses that the controller states in {} postures miss the URDF's by {:.3f} mm rms, at most {:.3f} mm, "
          "its tool and base frame fitted{}",
          values.count(0), 1e3 * values.number(1), 1e3 * values.number(2),
          fmt::format("{}", fmt::join(words(values.remarks(3)), "")));
    case audit::ControllerRemarkId::poses_mended:
      return ": " + (values.count(0) == 1
                         ? std::string("one of the usual mistakes explains it (suspected)")
                         : fmt::format("{} mistakes would each explain it (suspected)", values.count(0)));
    case audit::ControllerRemarkId::turns_otherwise:
      return fmt::format(
          ": their points agree to {:.3f} mm, so pw_deg, pp_deg and pr_deg are no turns about the fixed x, y and z "
          "axes in this order",
          1e3 * values.number(0));
    case audit::ControllerRemarkId::poses_of_other_geometry:
      return fmt::format(
          "; with axes elsewhere than in the URDF it is {:.3f} mm: the controller computes with another "
          "geometry",
          1e3 * values.number(0));
    case audit::ControllerRemarkId::poses_sag:
      return fmt::format(
          "; with axes elsewhere and joints that give way under the arm's own weight it is {:.3f} mm: the controller's "
          "model sags",
          1e3 * values.number(0));
    case audit::ControllerRemarkId::poses_unexplained:
      return fmt::format("; with axes elsewhere than in the URDF it is {:.3f} mm still", 1e3 * values.number(0));
    case audit::ControllerRemarkId::poses_of_other_arm:
      return "; no machine is that far off its drawing: another URDF, another tool or base frame from some posture on, "
             "or poses of other joints";
    case audit::ControllerRemarkId::accuracy_not_seen:
      return "; controller_model is declared absolute_accuracy, and these poses are the nominal model's: the option is "
             "off, or the controller states nominal poses";
    case audit::ControllerRemarkId::accuracy_as_declared:
      return "; controller_model is declared absolute_accuracy: such a controller bends its commands by this much, and "
             "the joints it states are not those of a nominal path";
    case audit::ControllerRemarkId::accuracy_undeclared:
      return "; where the controller has an absolute accuracy model, declare it (controller_model); else the URDF is "
             "not its machine";
    case audit::ControllerRemarkId::declared_nominal:
      return "; controller_model is declared nominal, and the poses are not the URDF's: an absolute accuracy model is "
             "active, or the URDF is not its machine";
    case audit::ControllerRemarkId::joints_not_compared:
      return fmt::format("; joint{} {} stand{} still: nothing is said of {}", values.counts(0).size() == 1 ? "" : "s",
                         fmt::join(values.counts(0), ", "), values.counts(0).size() == 1 ? "s" : "",
                         values.counts(0).size() == 1 ? "it" : "them");
  }
  return {};
}

}  // namespace stiffscope::reports
