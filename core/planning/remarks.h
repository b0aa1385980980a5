#pragma once

namespace stiffscope::planning {

enum class RemarkId {};

}  // namespace stiffscope::planning
