#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "core/numerics/shard.h"
#include "core/validation/score.h"
#include "core/validation/tables.h"

namespace stiffscope::validation {

struct BlindOptions {
  int cases = 300;
  std::uint64_t seed = 1;
  std::filesystem::path out;
  bool discard = false;             ///< remove the campaigns when done
  int threads = 2;                  ///< the result does not depend on it
  double as_is_share = kAsIsShare;  ///< see planCases
  bool unloaded = false;            ///< days without a load
  MachineKind machine = MachineKind::six_axis;
};

/// Told of what goes on; any may be empty. Called from one thread at a time.
struct BlindEvents {
  std::function<void(const char* stage, int done, int total)> progress;  ///< simulated, diagnosed, measured
  std::function<void(const std::string& seal)> sealed;                   ///< before the diagnosis starts
  std::function<void(const std::string& hash)> frozen;                   ///< before the labels are opened
};

/// How many noises the gap of a campaign outside the vocabulary lies away from what any one effect can do.
using Distance = std::function<double(const campaign::Campaign&)>;

struct BlindResult {
  std::string seal;          ///< SHA-256 of labels.csv, hex
  std::string answers_hash;  ///< of answers.csv
  Score score;
};

/// The whole test, in this order: machines drawn and measured into out/cases/NNN; their truth into
/// out/labels.csv, whose hash is sealed (event, out/seal.txt); every campaign read back from its folder and
/// diagnosed; the answers frozen in out/answers.csv, their hash added to seal.txt; then both files opened
/// again from disk and scored. `distance`, where given, is asked of the cases outside the vocabulary, of size 2 and
/// more, after that, for their rates alone; out/distances.csv keeps it. The same count and seed give the same bytes. A
/// diagnosis that throws has not answered. An earlier run's cases in the same place are replaced. Throws InputError or
/// std::runtime_error where a file cannot be written, out/cases is somebody else's, or either file is not what was
/// hashed.
BlindResult runBlind(const BlindOptions& options, const Diagnose& diagnose, const BlindEvents& events = {},
                     const Distance& distance = {});

/// The same test in parts that run anywhere beside each other and share `out`: each simulates its cases, seals their
/// labels (out/parts/KEY/seal-I-of-N.txt), diagnoses them and freezes the answers. What is done of a case is a file of
/// its own there that appears whole, and is not done again; KEY is of `program` and the options that the result depends
/// on. Throws as runBlind, and where a shard's labels are not what it sealed.
void runBlindShard(const BlindOptions& options, const numerics::Shard& shard, const std::string& program,
                   const Diagnose& diagnose, const BlindEvents& events = {}, const Distance& distance = {});

/// Joins what the shards have done, whatever their number, and scores it: the files and the result of runBlind, byte
/// for byte. Throws std::runtime_error where cases are missing or not what was sealed.
BlindResult mergeBlind(const BlindOptions& options, const std::string& program, const BlindEvents& events = {});

/// Reads `file` and throws std::runtime_error, naming it, where its SHA-256 is not `hash`.
std::string openSealed(const std::filesystem::path& file, const std::string& hash);

}  // namespace stiffscope::validation
