#pragma once

namespace stiffscope::page {

/// The style sheet of the page: light and dark, on a screen and on A4. It has no '<', '>' or '&', which would
/// be escaped, because HTML does not unescape inside <style>.
const char* pageStyle();

}  // namespace stiffscope::page
