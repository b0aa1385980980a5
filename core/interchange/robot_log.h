#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/interchange/joint_log.h"

namespace stiffscope::interchange {

/// The format of that name. Throws InputError, naming `option`, for another.
LogFormat logFormatNamed(const std::string& name, const std::string& option);

/// Reads joints from a file of any of these formats; which one follows from how it is built:
/// - fanuc_karel: `Time [ms];...;J1;...;J6;`, a sample a line, degrees;
/// - fanuc_tp: a program's `/POS` section, `P[1]{ ... J1= 6.2 deg, ... }`; targets in space are left out;
/// - kuka_krl: `DECL AXIS` and `DECL E6AXIS` with a value, and what a variable or an element of an array is given,
/// `XP[1]={A1 0.0,A2 -90.0,...}`, degrees; E6POS are left out;
/// - rapid: `jointtarget NAME := [[q1,...,q6],[...]]`, arrays of them, and what such a variable is given, degrees;
/// robtargets are left out; also Rokae's `jointtarget j1 = j:{...}`;
/// - ur: a header line that names six joints (actual_q_0, Joint0, shoulder_pan_joint, ...), radians, perhaps a
/// timestamp;
/// - columns: q1_deg and so on, as the user or the header line names them.
/// Of a machine with another number of joints (LogOptions::joints) tables by time, columns, FANUC's programs and
/// Rokae's targets have as many; KRL and ABB's RAPID state six axes and external ones, not which joint of such a
/// machine each is, and are refused. Joints of a table beyond the machine's are left out with a warning. Throws
/// InputError, with line, where nothing fits, the file is not of the format wanted, a value is none, or no joint angles
/// are in it.
RobotLog readRobotLog(const std::filesystem::path& path, const LogOptions& options = {});

/// The same of bytes; `file` is their name for messages.
RobotLog parseRobotLog(const std::string& file, std::string_view bytes, const LogOptions& options = {});

}  // namespace stiffscope::interchange
