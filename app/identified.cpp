#include "app/identified.h"

#include <array>
#include <vector>

#include "app/options.h"
#include "app/prepared.h"
#include "core/identification/identify.h"
#include "core/io/input_error.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

MethodAndStep methodAndStep(const std::string& method, const std::string& step) {
  MethodAndStep asked;
  if (!method.empty()) {
    const std::vector<identification::Method> methods = methodsNamed(method);
    if (methods.size() > 1) throw io::InputError({"--method"}, method, "expected one of cp, pp or dpp");
    asked.method = methods.front();
  }
  asked.step = loadStepNamed(step);
  return asked;
}

Identified identifiedBy(const preparation::PreparedCampaign& prepared, const std::string& name,
                        const ModelChoice& model, const MethodAndStep& asked) {
  requireLoad(prepared.campaign);
  identification::IdentifyOptions options;
  options.step = asked.step;
  Identified found;
  found.improved = modelOf(prepared, model, options);
  if (!found.improved) found.springs = identification::identify(prepared.campaign, options);
  const identification::Identification& result = found.result();
  found.method = asked.method ? *asked.method : identification::bestMethod(result);
  found.shown_first =
      asked.method ? identification::shownFirstOf(result, std::array{found.method}) : result.shown_first;
  if (!found.of_method().available) {
    throw io::InputError({name}, "",
                         std::string(reports::namesOf(found.method).full) +
                             " is unavailable here: " + reports::words(found.of_method().reason));
  }
  return found;
}

}  // namespace stiffscope::app
