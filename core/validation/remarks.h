#pragma once

namespace stiffscope::validation {

enum class RemarkId {};

}  // namespace stiffscope::validation
