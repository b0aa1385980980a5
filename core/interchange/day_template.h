#pragma once

#include <array>
#include <string>

namespace stiffscope::interchange {

/// Makers whose controllers a template knows.
enum class Maker { fanuc, kuka, abb, ur };

inline constexpr std::array<const char*, 4> kMakerNames{"fanuc", "kuka", "abb", "ur"};

/// The maker of that name. Throws InputError, naming `option`, for another.
Maker makerNamed(const std::string& name, const std::string& option);

/// A DAY.xml with a comment at every place that is to be filled in, for a controller of that make: the format of its
/// log and how it states its joints.
std::string dayTemplate(Maker maker);

/// A campaign.xml with such comments, for tables that are there already.
std::string campaignTemplate(const std::string& base_link, const std::string& flange_link);

}  // namespace stiffscope::interchange
