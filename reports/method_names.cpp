#include "reports/method_names.h"

#include <array>

namespace stiffscope {

const MethodNames& namesOf(Method method) {
  static constexpr std::array<MethodNames, 3> kNames{{{"cp", "CP", "Complete Pose"},
                                                      {"pp", "PP", "Partial Pose"},
                                                      {"dpp", "DPP", "Decoupled Partial Pose"}}};
  return kNames[static_cast<std::size_t>(method)];
}

}  // namespace stiffscope
