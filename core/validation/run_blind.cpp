#include "core/validation/run_blind.h"

#include <fmt/format.h>
#include <map>
#include <mutex>
#include <stdexcept>

#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "core/numerics/parallel.h"
#include "core/simulation/measure.h"
#include "core/validation/case.h"

namespace stiffscope::validation {

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

std::map<std::string, double> distancesOf(const std::vector<Label>& labels, const std::filesystem::path& folder,
                                          const BlindOptions& options, const BlindEvents& events,
                                          const Distance& distance) {
  std::vector<std::string> names;
  for (const Label& label : labels) {
    // Every effect comes with the joint stiffnesses: nothing lies farther from it than from those alone.
    if (label.kind == CaseKind::outside && label.effects.front().size >= kApart) names.push_back(label.name);
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
  namespace fs = std::filesystem;
  const fs::path folder = options.out / "cases";
  if (std::error_code none; fs::exists(folder, none) && !fs::exists(options.out / "seal.txt", none)) {
    throw std::runtime_error(folder.string() + ": exists and is not an earlier run's; expected a new folder");
  }
  std::error_code error;
  fs::remove_all(folder, error);
  if (error && fs::exists(folder, error))
    throw std::runtime_error(folder.string() + ": cannot be removed: expected a folder that can be written");
  io::makeFolder(folder);
  const DayKind& days = options.unloaded ? unloadedDays() : loadedDays();
  const std::vector<CasePlan> plans = planCases(options.cases, options.seed, options.as_is_share, days);
  const std::size_t count = plans.size();

  BlindResult result;
  {
    std::vector<Label> labels(count);
    forAll(options.cases, options.threads, "simulated", events, [&](int index) {
      const std::size_t at = static_cast<std::size_t>(index);
      const fs::path urdf = folder / nameOf(index) / "robot.urdf";
      const BlindCase one = drawCase(plans[at], caseSeed(options.seed, index), "case " + nameOf(index), urdf, days);
      campaign::writeCampaign(simulation::simulate(one.spec), urdf, folder / nameOf(index));
      labels[at] = labelOf(nameOf(index), one);
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

}  // namespace stiffscope::validation
