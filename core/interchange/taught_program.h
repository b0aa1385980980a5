#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/interchange/joint_log.h"

namespace stiffscope::interchange {

/// A robot's program whose joint targets can be replaced where they stand.
struct TaughtProgram {
  std::string file;   ///< for messages
  std::string bytes;  ///< as they are in the file
  RobotLog log;       ///< its joint targets, in the order of the file; those in space or computed are in `skipped`
  int decimals = 3;   ///< behind the point of a figure in degrees, as this maker's programs have them at least
};

/// Reads a program of FANUC (.ls), KUKA (.dat, .src) or ABB (.mod) by the grammar of readRobotLog, targets in
/// instructions too. Throws InputError as that does, for another format, for one in UTF-16, and, with the first line of
/// such a target, where all targets are in space. `joints`: of the machine, as LogOptions has it.
TaughtProgram readTaughtProgram(const std::filesystem::path& path, int joints);
TaughtProgram parseTaughtProgram(const std::string& file, std::string_view bytes, int joints);

/// Digits behind the point with which the figures of a target are written: those that it has, at least the program's.
int decimalsOfTarget(const TaughtProgram& program, std::size_t target);

/// The bytes of the program with the figures (rad, as the controller states them) of each target that has some; all
/// else stays as it is, to the byte. A figure that the target has already, to its last digit, stays as it is written.
std::string withFigures(const TaughtProgram& program, const std::vector<std::optional<JointVector>>& figures);

}  // namespace stiffscope::interchange
