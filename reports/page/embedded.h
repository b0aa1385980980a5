#pragma once

#include <string_view>

// Files that the page carries, as they stood when the program was built (reports/page/embed.cmake).

namespace stiffscope::page {

extern const std::string_view kTablesScript;  ///< tables.js
extern const std::string_view kSceneScript;   ///< scene.js
extern const std::string_view kChartsScript;  ///< charts.js
/// three.js (MIT licence, threejs.org), compressed by gzip; empty where the package was not there.
extern const std::string_view kThreeGzip;

}  // namespace stiffscope::page
