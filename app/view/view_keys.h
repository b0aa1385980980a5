#pragma once

#include <string>
#include <vector>

#include "app/view/viewer.h"

namespace stiffscope {

/// One thing that keys do.
struct ViewKey {
  std::vector<std::string> names;  ///< X names
  std::string shown;               ///< in the list; empty: not listed
  std::string does;
  void (*act)(Viewer&);
};

/// All keys, in the order in which they are listed.
const std::vector<ViewKey>& viewKeys();

/// The list for the window and for --help.
ScenePanel keysPanel();
std::string keysText();

}  // namespace stiffscope
