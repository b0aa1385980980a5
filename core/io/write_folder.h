#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/io/write_file.h"

namespace stiffscope::io {

struct FileToWrite {
  std::string name;  ///< in the folder, without one of its own
  ByteSource bytes;

  FileToWrite(std::string file, std::string text)
      : name(std::move(file)), bytes([own = std::move(text)](const ByteSink& sink) { sink(own); }) {}
  FileToWrite(std::string file, ByteSource source) : name(std::move(file)), bytes(std::move(source)) {}
};

/// Writes files into a folder (made where absent) so that they appear together or not at all, whenever the program is
/// killed, the disk fills, or another run writes to the same folder: they are written to a new folder beside it, into
/// which what else the old one holds is linked, and the two folders are exchanged in one step (renameat2). A killed run
/// may leave that new folder, `.NAME.part-XXXXXX`, which the next one removes. Runs that write beside each other take
/// turns.
///
/// Where folders cannot be exchanged (a mount point, a folder above it without write permission, a file system without
/// the call, the current folder), all files are written under other names first and then renamed one by one, in the
/// order given: each is whole, and only a kill within these microseconds leaves some new and some old.
///
/// `superseded` are files of an earlier run that this one does not write: they are gone afterwards.
///
/// Throws std::runtime_error with path and reason; the folder is as it was then, and nothing is left beside it.
void writeFolderWhole(const std::filesystem::path& folder, const std::vector<FileToWrite>& files,
                      const std::vector<std::string>& superseded = {});

}  // namespace stiffscope::io
