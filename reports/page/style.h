#pragma once

#include <string>

namespace stiffscope::page {

/// The style sheet of the page: light and dark, on a screen and on A4, there with the report's id (hex digits and
/// hyphens) and the page's number at the foot. It has no '<', '>' or '&', which would
/// be escaped, because HTML does not unescape inside <style>.
std::string pageStyle(const std::string& report_id);

}  // namespace stiffscope::page
