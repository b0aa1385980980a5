#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/numerics/shard.h"

namespace CLI {
class App;
}

namespace stiffscope::app {

/// How a command's work is shared among jobs.
struct ShardChoice {
  std::string shard;  ///< i/n
  bool merge = false;
  int slurm = 0;         ///< jobs of the array; 0: none
  bool dry_run = false;  ///< write the scripts, submit nothing
  std::vector<std::string> sbatch;

  /// Throws io::InputError where `shard` is not i/n with 1 <= i <= n.
  numerics::Shard part() const;
};

/// Adds --shard, --merge, --slurm, --slurm-dry-run and --sbatch to a command.
void addShardOptions(CLI::App& command, ShardChoice& choice);

/// A command for SLURM: an array of jobs, each with a shard, and a job that merges when all have ended, however.
struct SlurmRequest {
  std::string name;
  std::vector<std::string> command;  ///< this program's words, without shard or merge
  std::string workers_option;        ///< that takes the number of cores a job is given
  std::filesystem::path out;         ///< scripts and logs go into its folder `slurm`
};

/// Writes array.sh and merge.sh, and submits both unless it is a dry run. Returns what there is to say. Throws
/// std::runtime_error where sbatch refuses.
std::string submitToSlurm(const SlurmRequest& request, const ShardChoice& choice);

}  // namespace stiffscope::app
