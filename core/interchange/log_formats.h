#pragma once

#include <string>
#include <string_view>

#include "core/interchange/joint_log.h"
#include "core/interchange/point_formats.h"

// The formats of joints, one source a kind. `text` is UTF-8; each throws InputError where something is not as its
// format has it.

namespace stiffscope::interchange {

/// A text with its name for messages and what the user said of it.
struct LogText {
  const std::string& file;
  std::string_view text;
  const LogOptions& options;
};

/// "six": how many joints a machine has.
std::string countedJoints(int joints);

bool looksLikeJointTable(const LogText& text, LogFormat format);

/// A log by time whose header line names its columns: KAREL's and UR's.
RobotLog readJointTable(const LogText& text, LogFormat format);

bool looksLikeFanucProgram(std::string_view text);
RobotLog readFanucProgram(const LogText& text);

bool looksLikeKukaData(const LogText& text);
RobotLog readKukaData(const LogText& text);

bool looksLikeRapid(const LogText& text);
RobotLog readRapid(const LogText& text);

RobotLog readJointColumns(const LogText& text);

}  // namespace stiffscope::interchange
