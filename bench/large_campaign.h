#pragma once

#include <filesystem>

namespace stiffscope::bench {

/// Writes a campaign of `postures` postures with 15 load steps of three reflectors each, 45 readings a posture.
void writeManyPostures(const std::filesystem::path& folder, int postures);

/// Writes a campaign whose wrist sweep has `readings` readings of one reflector.
void writeLongWristSweep(const std::filesystem::path& folder, int readings);

}  // namespace stiffscope::bench
