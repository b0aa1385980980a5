#include "core/validation/run_blind.h"

#include <fmt/format.h>
#include <charconv>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "core/numerics/parallel.h"
#include "core/simulation/measure.h"
#include "core/validation/case.h"

namespace stiffscope::validation {

namespace fs = std::filesystem;

namespace {

/// splitmix64: unrelated seeds for neighbouring cases.
std::uint64_t caseSeed(std::uint64_t seed, int index) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(index) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

std::string nameOf(int index) { return fmt::format("{:04}", index + 1); }

/// Runs work(index) for all of them on so many threads.
void forAll(int count, int threads, const char* stage, const BlindEvents& events,
            const std::function<void(int)>& work) {
  std::mutex mutex;
  int done = 0;
  numerics::onThreads(static_cast<std::size_t>(threads), static_cast<std::size_t>(count), [&](std::size_t index) {
    work(static_cast<int>(index));
    const std::lock_guard lock(mutex);
    ++done;
    if (events.progress) events.progress(stage, done, count);
  });
}

Answer answerTo(const std::string& name, const std::filesystem::path& folder, const Diagnose& diagnose) {
  try {
    Answer answer = diagnose(campaign::readCampaign(folder).campaign);
    answer.name = name;
    return answer;
  } catch (const std::exception& error) {
    Answer answer;
    answer.name = name;
    answer.failure = error.what();
    return answer;
  }
}

/// Every effect comes with the joint stiffnesses: nothing lies farther from it than from those alone.
bool isMeasured(const Label& label) { return label.kind == CaseKind::outside && label.effects.front().size >= kApart; }

std::map<std::string, double> distancesOf(const std::vector<Label>& labels, const std::filesystem::path& folder,
                                          const BlindOptions& options, const BlindEvents& events,
                                          const Distance& distance) {
  std::vector<std::string> names;
  for (const Label& label : labels) {
    if (isMeasured(label)) names.push_back(label.name);
  }
  std::vector<double> found(names.size());
  forAll(static_cast<int>(names.size()), options.threads, "measured", events, [&](int index) {
    const auto at = static_cast<std::size_t>(index);
    found[at] = distance(campaign::readCampaign(folder / names[at]).campaign);
  });
  std::map<std::string, double> distances;
  for (std::size_t i = 0; i < names.size(); ++i) distances[names[i]] = found[i];
  return distances;
}

const DayKind& daysOf(const BlindOptions& options) {
  return options.unloaded ? unloadedDays() : loadedDays(options.machine);
}

/// Makes the machine of one case and measures its day into `folder`.
Label makeCase(const BlindOptions& options, const CasePlan& plan, int index, const fs::path& folder) {
  const fs::path urdf = folder / nameOf(index) / "robot.urdf";
  const BlindCase one = drawCase(plan, caseSeed(options.seed, index), "case " + nameOf(index), urdf, daysOf(options));
  campaign::writeCampaign(simulation::simulate(one.spec), urdf, folder / nameOf(index));
  return labelOf(nameOf(index), one);
}

std::string distancesCsv(const std::map<std::string, double>& distances) {
  std::string csv = "case,noises\n";
  for (const auto& [name, value] : distances) csv += fmt::format("{},{:.6g}\n", name, value);
  return csv;
}

}  // namespace

std::string openSealed(const std::filesystem::path& file, const std::string& hash) {
  std::string bytes = io::readTextFile(file);
  if (io::sha256Hex(bytes) != hash) {
    throw std::runtime_error(file.string() + ": not what was sealed: its SHA-256 is no longer " + hash);
  }
  return bytes;
}

BlindResult runBlind(const BlindOptions& options, const Diagnose& diagnose, const BlindEvents& events,
                     const Distance& distance) {
  const fs::path folder = options.out / "cases";
  if (std::error_code none; fs::exists(folder, none) && !fs::exists(options.out / "seal.txt", none)) {
    throw std::runtime_error(folder.string() + ": exists and is not an earlier run's; expected a new folder");
  }
  std::error_code error;
  fs::remove_all(folder, error);
  if (error && fs::exists(folder, error))
    throw std::runtime_error(folder.string() + ": cannot be removed: expected a folder that can be written");
  io::makeFolder(folder);
  const DayKind& days = daysOf(options);
  const std::vector<CasePlan> plans = planCases(options.cases, options.seed, options.as_is_share, days);
  const std::size_t count = plans.size();

  BlindResult result;
  {
    std::vector<Label> labels(count);
    forAll(options.cases, options.threads, "simulated", events, [&](int index) {
      const std::size_t at = static_cast<std::size_t>(index);
      labels[at] = makeCase(options, plans[at], index, folder);
    });
    const std::string csv = labelsCsv(labels);
    io::writeFileWhole(options.out / "labels.csv", csv);
    result.seal = io::sha256Hex(csv);
  }
  std::string seals = result.seal + "  labels.csv\n";
  io::writeFileWhole(options.out / "seal.txt", seals);
  if (events.sealed) events.sealed(result.seal);

  {
    std::vector<Answer> answers(count);
    forAll(options.cases, options.threads, "diagnosed", events, [&](int index) {
      answers[static_cast<std::size_t>(index)] = answerTo(nameOf(index), folder / nameOf(index), diagnose);
    });
    const std::string csv = answersCsv(answers);
    io::writeFileWhole(options.out / "answers.csv", csv);
    result.answers_hash = io::sha256Hex(csv);
  }
  seals += result.answers_hash + "  answers.csv\n";
  io::writeFileWhole(options.out / "seal.txt", seals);
  if (events.frozen) events.frozen(result.answers_hash);

  const std::string labels = openSealed(options.out / "labels.csv", result.seal);
  const std::string answers = openSealed(options.out / "answers.csv", result.answers_hash);
  const std::vector<Label> truths = readLabels("labels.csv", labels);
  std::map<std::string, double> distances;
  if (distance) {
    distances = distancesOf(truths, folder, options, events, distance);
    io::writeFileWhole(options.out / "distances.csv", distancesCsv(distances));
  }
  result.score = score(truths, readAnswers("answers.csv", answers), distances, days.vocabulary);
  if (options.discard) fs::remove_all(folder);
  return result;
}

namespace {

/// Where the parts of a test are kept: a file a case and stage.
class BlindParts {
 public:
  BlindParts(const BlindOptions& options, const std::string& program) : options_(options) {
    std::string of = fmt::format("{}\n{} {} {:.17g} {}\n", program, options.cases, options.seed, options.as_is_share,
                                 options.unloaded);
    if (options.machine != MachineKind::six_axis) of += nameOf(options.machine);
    constexpr std::size_t kKeyDigits = 16;
    folder_ = options.out / "parts" / io::sha256Hex(of).substr(0, kKeyDigits);
  }

  const fs::path& folder() const { return folder_; }
  fs::path file(int index, const char* stage) const { return folder_ / (nameOf(index) + stage); }
  bool has(int index, const char* stage) const {
    std::error_code none;
    return fs::exists(file(index, stage), none);
  }
  std::string read(int index, const char* stage) const { return io::readTextFile(file(index, stage)); }

  /// Those of the shard's cases, one after the other.
  std::string rows(const numerics::Shard& shard, const char* stage) const {
    std::string all;
    for (int i = 0; i < options_.cases; ++i) {
      if (shard.has(static_cast<std::size_t>(i))) all += read(i, stage);
    }
    return all;
  }

 private:
  const BlindOptions& options_;
  fs::path folder_;
};

constexpr const char *kLabel = ".label", *kAnswer = ".answer", *kDistance = ".distance";

/// A table's rows without its header, which is the table of none.
std::string rowsOf(const std::string& table, const std::string& header) { return table.substr(header.size()); }

std::string sealName(const numerics::Shard& shard) {
  return fmt::format("seal-{}-of-{}.txt", shard.index + 1, shard.of);
}

/// Seals the labels of a shard, or holds them against the seal that an earlier run of it left.
void sealShard(const BlindParts& parts, const numerics::Shard& shard, const BlindEvents& events) {
  const fs::path file = parts.folder() / sealName(shard);
  const std::string seal = io::sha256Hex(parts.rows(shard, kLabel));
  std::error_code none;
  if (!fs::exists(file, none)) {
    io::writeFileWhole(file, seal + "\n");
  } else if (io::readTextFile(file) != seal + "\n") {
    throw std::runtime_error(file.string() + ": the labels of this shard are not what it sealed");
  }
  if (events.sealed) events.sealed(seal);
}

/// The shard of a seal's name; empty where it is none.
std::optional<numerics::Shard> shardOfSeal(const std::string& name) {
  numerics::Shard shard;
  const std::string before = "seal-", between = "-of-";
  const std::size_t at = name.find(between);
  if (!name.starts_with(before) || at == std::string::npos) return std::nullopt;
  std::from_chars(name.data() + before.size(), name.data() + at, shard.index);
  std::from_chars(name.data() + at + between.size(), name.data() + name.size(), shard.of);
  if (shard.index < 1 || shard.index > shard.of || sealName({shard.index - 1, shard.of}) != name) return std::nullopt;
  return numerics::Shard{shard.index - 1, shard.of};
}

}  // namespace

void runBlindShard(const BlindOptions& options, const numerics::Shard& shard, const std::string& program,
                   const Diagnose& diagnose, const BlindEvents& events, const Distance& distance) {
  const fs::path folder = options.out / "cases";
  const BlindParts parts(options, program);
  io::makeFolder(folder);
  io::makeFolder(parts.folder());
  const std::vector<CasePlan> plans = planCases(options.cases, options.seed, options.as_is_share, daysOf(options));
  std::vector<int> own;
  for (int i = 0; i < options.cases; ++i) {
    if (shard.has(static_cast<std::size_t>(i))) own.push_back(i);
  }
  const auto forOwn = [&](const char* stage, const std::function<bool(int)>& wanted,
                          const std::function<void(int)>& work) {
    std::vector<int> left;
    for (const int i : own) {
      if (wanted(i)) left.push_back(i);
    }
    forAll(static_cast<int>(left.size()), options.threads, stage, events,
           [&](int at) { work(left[static_cast<std::size_t>(at)]); });
  };
  const auto isThere = [&](int i) {
    std::error_code none;
    return fs::exists(folder / nameOf(i), none);
  };
  // A label is written after its campaign, which is whole then.
  forOwn(
      "simulated",
      [&](int i) {
        const bool needed = !parts.has(i, kAnswer) || (distance && !parts.has(i, kDistance));
        return !parts.has(i, kLabel) || (needed && !isThere(i));
      },
      [&](int i) {
        fs::remove_all(folder / nameOf(i));
        const Label label = makeCase(options, plans[static_cast<std::size_t>(i)], i, folder);
        io::writeFileWhole(parts.file(i, kLabel), rowsOf(labelsCsv({label}), labelsCsv({})));
      });
  sealShard(parts, shard, events);
  forOwn(
      "diagnosed", [&](int i) { return !parts.has(i, kAnswer); },
      [&](int i) {
        const Answer answer = answerTo(nameOf(i), folder / nameOf(i), diagnose);
        io::writeFileWhole(parts.file(i, kAnswer), rowsOf(answersCsv({answer}), answersCsv({})));
      });
  if (events.frozen) events.frozen(io::sha256Hex(parts.rows(shard, kAnswer)));
  if (distance) {
    forOwn(
        "measured", [&](int i) { return !parts.has(i, kDistance); },
        [&](int i) {
          const Label label = readLabels(parts.file(i, kLabel).string(), labelsCsv({}) + parts.read(i, kLabel)).front();
          const std::string found =
              isMeasured(label) ? fmt::format("{:.17g}", distance(campaign::readCampaign(folder / nameOf(i)).campaign))
                                : "none";
          io::writeFileWhole(parts.file(i, kDistance), found);
        });
  }
  if (options.discard) {
    for (const int i : own) fs::remove_all(folder / nameOf(i));
  }
}

BlindResult mergeBlind(const BlindOptions& options, const std::string& program, const BlindEvents& events) {
  const BlindParts parts(options, program);
  int missing = 0;
  bool distances_taken = true;
  for (int i = 0; i < options.cases; ++i) {
    missing += parts.has(i, kLabel) && parts.has(i, kAnswer) ? 0 : 1;
    distances_taken = distances_taken && parts.has(i, kDistance);
  }
  if (missing > 0) {
    throw std::runtime_error(
        fmt::format("{}: {} of {} cases are not done: expected all shards to be, by this version "
                    "and with the same options",
                    options.out.string(), missing, options.cases));
  }
  for (const auto& entry : fs::directory_iterator(parts.folder())) {
    const auto shard = shardOfSeal(entry.path().filename().string());
    if (shard && io::readTextFile(entry.path()) != io::sha256Hex(parts.rows(*shard, kLabel)) + "\n")
      throw std::runtime_error(entry.path().string() + ": the labels of this shard are not what it sealed");
  }
  BlindResult result;
  const std::string labels = labelsCsv({}) + parts.rows({}, kLabel), answers = answersCsv({}) + parts.rows({}, kAnswer);
  io::writeFileWhole(options.out / "labels.csv", labels);
  result.seal = io::sha256Hex(labels);
  if (events.sealed) events.sealed(result.seal);
  io::writeFileWhole(options.out / "answers.csv", answers);
  result.answers_hash = io::sha256Hex(answers);
  if (events.frozen) events.frozen(result.answers_hash);
  io::writeFileWhole(options.out / "seal.txt",
                     result.seal + "  labels.csv\n" + result.answers_hash + "  answers.csv\n");
  const std::vector<Label> truths = readLabels("labels.csv", labels);
  std::map<std::string, double> distances;
  if (distances_taken) {
    for (int i = 0; i < options.cases; ++i) {
      if (isMeasured(truths[static_cast<std::size_t>(i)])) distances[nameOf(i)] = std::stod(parts.read(i, kDistance));
    }
    io::writeFileWhole(options.out / "distances.csv", distancesCsv(distances));
  }
  result.score = score(truths, readAnswers("answers.csv", answers), distances, daysOf(options).vocabulary);
  if (options.discard) fs::remove_all(options.out / "cases");
  return result;
}

}  // namespace stiffscope::validation
