#pragma once

#include "core/input/name_list.h"

namespace stiffscope {

/// The identifiers that table rows refer to by index. Targets are those that campaign.xml declares; poses and
/// nests are listed as the tables bring them, in order of first appearance.
struct CampaignNames {
  NameList targets, poses, nests;
};

}  // namespace stiffscope
