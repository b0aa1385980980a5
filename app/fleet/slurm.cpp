#include "app/fleet/slurm.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cctype>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "app/fleet/processes.h"
#include "core/io/input_error.h"
#include "core/io/write_file.h"

namespace stiffscope::app {

numerics::Shard ShardChoice::part() const {
  numerics::Shard part;
  if (shard.empty()) return part;
  std::size_t index = 0;
  const char *begin = shard.data(), *end = begin + shard.size();
  const auto first = std::from_chars(begin, end, index);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, part.of);
    if (second.ec == std::errc() && second.ptr == end && index >= 1 && index <= part.of) {
      part.index = index - 1;
      return part;
    }
  }
  throw io::InputError({"--shard"}, shard, "expected i/n, the i-th of n parts: 1/4");
}

void addShardOptions(CLI::App& command, ShardChoice& choice) {
  CLI::Option* shard =
      command.add_option("--shard", choice.shard, "do the i-th of n parts alone, and no results of all")
          ->type_name("I/N");
  CLI::Option* merge = command.add_flag("--merge", choice.merge, "join what all shards have done")->excludes(shard);
  constexpr int kMostJobs = 10000;
  CLI::Option* slurm =
      command.add_option("--slurm", choice.slurm, "submit to SLURM: an array of so many jobs, and one that merges")
          ->type_name("JOBS")
          ->check(CLI::Range(1, kMostJobs))
          ->excludes(shard)
          ->excludes(merge);
  command.add_flag("--slurm-dry-run", choice.dry_run, "write SLURM's scripts and submit nothing")->needs(slurm);
  command
      .add_option("--sbatch", choice.sbatch,
                  "an option of sbatch for the jobs of the array, as --sbatch=--mem=2G; may be given again")
      ->type_name("OPTION")
      ->allow_extra_args(false)
      ->needs(slurm);
}

namespace {

/// One word for a shell.
std::string shellWord(const std::string& word) {
  bool plain = !word.empty();
  for (const char c : word)
    plain = plain && (std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_./=:,+", c) != nullptr);
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shellCommand(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shellWord(word);
  return line;
}

std::vector<std::string> commandFor(const SlurmRequest& request) {
  std::vector<std::string> words{ownProgram().string()};
  words.insert(words.end(), request.command.begin(), request.command.end());
  return words;
}

std::string submitted(const std::vector<std::string>& arguments) {
  const Ended ended = runProcess("sbatch", arguments, Listen::standard_output);
  if (!ended.well()) throw std::runtime_error("sbatch: the job was not taken; its message stands above");
  return ended.said.substr(0, ended.said.find_first_of(";\n"));
}

}  // namespace

std::string submitToSlurm(const SlurmRequest& request, const ShardChoice& choice) {
  const std::filesystem::path folder = std::filesystem::absolute(request.out) / "slurm";
  io::makeFolder(folder);
  const std::string command = shellCommand(commandFor(request));
  // Jobs start where they were submitted: the names of folders, which stand in results, are those that were given.
  const std::string here = "#SBATCH --chdir=\"" + std::filesystem::current_path().string() + "\"\n";
  std::string options;
  for (const std::string& one : choice.sbatch) options += "#SBATCH " + one + "\n";
  // A job whose node fails is put into the queue again, and does what is missing.
  const std::string array = fmt::format(
      "#!/bin/sh\n#SBATCH --job-name=stiffscope-{0}\n#SBATCH --array=1-{1}\n#SBATCH --requeue\n#SBATCH "
      "--open-mode=append\n#SBATCH --output=\"{2}/shard-%a.log\"\n{6}{3}exec {4} --shard \"$SLURM_ARRAY_TASK_ID/{1}\" "
      "{5} "
      "\"${{SLURM_CPUS_ON_NODE:-1}}\"\n",
      request.name, choice.slurm, folder.string(), options, command, request.workers_option, here);
  const std::string merge = fmt::format(
      "#!/bin/sh\n#SBATCH --job-name=stiffscope-{0}-merge\n#SBATCH --output=\"{1}/merge.log\"\n{3}exec {2} --merge\n",
      request.name, folder.string(), command, here);
  const std::filesystem::path array_script = folder / "array.sh", merge_script = folder / "merge.sh";
  io::writeFileWhole(array_script, array);
  io::writeFileWhole(merge_script, merge);
  if (choice.dry_run)
    return fmt::format("{}\n{}\nnot submitted: --slurm-dry-run\n", array_script.string(), merge_script.string());
  const std::string job = submitted({"--parsable", array_script.string()});
  const std::string last = submitted({"--parsable", "--dependency=afterany:" + job, merge_script.string()});
  return fmt::format("{}: job {}, {} shards\n{}: job {}, when all of these have ended\n", array_script.string(), job,
                     choice.slurm, merge_script.string(), last);
}

}  // namespace stiffscope::app
