#pragma once

#include <filesystem>

#include "core/input/file_stamp.h"

namespace stiffscope {

/// Files that this process has read as input (readTextFileWithStamp), whatever name or link led to them. A measured day
/// cannot be had again: who writes a result asks first whether that would be over one of them.
void recordRead(const FileStamp& stamp);

/// Throws std::runtime_error where `path` was read.
void requireNotRead(const std::filesystem::path& path);

}  // namespace stiffscope
