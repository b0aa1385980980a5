#include "app/method_option.h"

#include "core/input/input_error.h"
#include "core/input/nearest_name.h"

namespace stiffscope {

std::vector<Method> methodsNamed(const std::string& name) {
  if (name == "all") return {kMethods.begin(), kMethods.end()};
  if (name == "cp") return {Method::complete_pose};
  if (name == "pp") return {Method::partial_pose};
  if (name == "dpp") return {Method::decoupled_partial_pose};
  throw InputError({"--method"}, name, "expected cp, pp, dpp or all" + nearestNameHint(name, {"cp", "pp", "dpp", "all"}));
}

}  // namespace stiffscope
