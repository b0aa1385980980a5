#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/validation/case.h"

namespace stiffscope::bench {

/// Families of simulated machines by which stated uncertainties are judged: clean (joint springs alone), none (and
/// bearings of a thousandth), single (each effect of the vocabulary in turn), double, bearings_links, as_they_are
/// (bearings, links, base and friction at half their usual sizes), gain (a load cell one per cent off, declared so),
/// outside (something that no effect of the vocabulary is).
inline constexpr const char* kFamilies = "clean none single double bearings_links as_they_are gain outside";

/// Machine `i` of a family; its URDF is written to `urdf`.
validation::BlindCase drawMachine(const std::string& family, int i, std::uint64_t seed,
                                  const std::filesystem::path& urdf);

}  // namespace stiffscope::bench
