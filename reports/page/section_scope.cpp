#include "reports/page/sections.h"

namespace stiffscope::page {

void writeScope(Html& html, const ReportContent&) {
  const auto section = html.element("section", {{"id", "scope"}});
  html.leaf("h2", "Uncertainty, decision rule and scope");
  html.list(
      {"Uncertainty: the standard uncertainty u of a compliance is from the scatter between postures (sandwich "
       "estimate, CR2) and from what they all share and the campaign tells of: frames, wrist radii, geometry; that of a "
       "stiffness is u(c)/c², to first order. U = k u with Student's t for about 95\u00a0%. The scales of the load cell "
       "and of the tracker, of which no reading tells, are not in it.",
       "Decision rule: no statement of conformity to a specification is made. A joint counts as seen where the load "
       "turns it by more than three times what wrench, frame and angle uncertainty alone would. A stiffness is "
       "imprecise where u exceeds the value, and negative ones are shown as found; uncertainty is not used to move a "
       "limit.",
       "The results relate only to the items measured, in the state and under the conditions stated here.",
       "Number and date of this report are those of its input: the same files and settings give the same report."});
}

}  // namespace stiffscope::page
