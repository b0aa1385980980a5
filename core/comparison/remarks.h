#pragma once

namespace stiffscope::comparison {

enum class RemarkId {};

}  // namespace stiffscope::comparison
