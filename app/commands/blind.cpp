#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include "app/command_line.h"
#include "app/fleet/slurm.h"
#include "app/options.h"
#include "app/output.h"
#include "app/terminal.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/effect_distance.h"
#include "core/io/write_file.h"
#include "core/validation/run_blind.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/page/pages.h"
#include "reports/text/text.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

validation::BlindEvents eventsOnStderr() {
  validation::BlindEvents events;
  events.sealed = [](const std::string& seal) {
    clearProgress(), std::fprintf(stderr, "labels sealed, SHA-256 %s\n", seal.c_str());
  };
  events.frozen = [](const std::string& hash) {
    clearProgress(), std::fprintf(stderr, "answers frozen, SHA-256 %s\n", hash.c_str());
  };
  events.progress = [](const char* stage, int done, int total) {
    atWork(stage, static_cast<std::size_t>(done), static_cast<std::size_t>(total));
  };
  return events;
}

validation::Answer diagnosed(const campaign::Campaign& campaign) {
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(campaign);
  return validation::answerOf(diagnosis.verdict, diagnosis.classes);
}

validation::Answer diagnosedUnloaded(const campaign::Campaign& campaign) {
  const accuracy::AccuracyDiagnosis diagnosis = accuracy::diagnoseAccuracy(campaign);
  if (!diagnosis.usable) throw std::runtime_error(reports::words(diagnosis.unusable_reason));
  return validation::answerOf(diagnosis);
}

std::vector<std::string> blindWordsOf(const validation::BlindOptions& options) {
  std::vector<std::string> words{
      "blind", "--cases",           std::to_string(options.cases), "--seed", std::to_string(options.seed),
      "--out", options.out.string()};
  if (options.unloaded)
    words.emplace_back("--unloaded");
  else
    words.insert(words.end(), {"--as-is", fmt::format("{}", options.as_is_share)});
  if (options.machine != validation::MachineKind::six_axis)
    words.insert(words.end(), {"--machine", std::string(validation::nameOf(options.machine))});
  if (options.discard) words.emplace_back("--discard");
  return words;
}

/// All of it, a shard's part (then without a result), or what the shards have done joined.
std::optional<validation::BlindResult> blindResult(const validation::BlindOptions& options, const ShardChoice& choice) {
  const validation::Diagnose diagnose = options.unloaded ? diagnosedUnloaded : diagnosed;
  const validation::Distance distance =
      options.unloaded ? validation::Distance() : validation::Distance(diagnosis::distanceFromVocabulary);
  const numerics::Shard shard = choice.part();
  if (choice.merge) return validation::mergeBlind(options, STIFFSCOPE_VERSION, eventsOnStderr());
  if (choice.shard.empty()) return validation::runBlind(options, diagnose, eventsOnStderr(), distance);
  validation::runBlindShard(options, shard, STIFFSCOPE_VERSION, diagnose, eventsOnStderr(), distance);
  return std::nullopt;
}

}  // namespace

void addBlind(CLI::App& app, Run& run) {
  struct BlindArguments {
    validation::BlindOptions options;
    std::string out, json;
    ShardChoice shard;
  };
  const auto arguments = std::make_shared<BlindArguments>();
  CLI::App* command = app.add_subcommand("blind", "The diagnosis checked on machines whose effect is withheld");
  command->add_option("--cases", arguments->options.cases, "how many machines")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "another seed, other machines")->capture_default_str();
  command->add_option("--out", arguments->out, "folder for campaigns, labels, answers, results.json, blind.html")
      ->required();
  CLI::Option* unloaded = command->add_flag("--unloaded", arguments->options.unloaded,
                                            "days without a load: postures alone, by own weight");
  std::map<std::string, validation::MachineKind> kinds;
  for (std::size_t k = 0; k < validation::kMachineKindNames.size(); ++k)
    kinds.emplace(validation::kMachineKindNames[k], static_cast<validation::MachineKind>(k));
  command
      ->add_option("--machine", arguments->options.machine,
                   fmt::format("kind of machine: {}", fmt::join(validation::kMachineKindNames, ", ")))
      ->transform(CLI::CheckedTransformer(kinds).description(""))
      ->type_name("KIND")
      ->excludes(unloaded);
  command->add_flag("--discard", arguments->options.discard, "remove the campaigns when done");
  command
      ->add_option("--as-is", arguments->options.as_is_share,
                   "share of the cases that are machines as they are: several effects at half their usual size")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str()
      ->excludes(unloaded);
  command->add_option("--threads", arguments->options.threads, "at work at a time; the result is the same")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  addShardOptions(*command, arguments->shard);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      arguments->options.out = arguments->out;
      if (arguments->options.unloaded) arguments->options.as_is_share = 0.0;
      if (arguments->shard.slurm > 0) {
        printText(submitToSlurm({"blind", blindWordsOf(arguments->options), "--threads", arguments->options.out},
                                arguments->shard));
        return kDone;
      }
      const std::optional<validation::BlindResult> made = blindResult(arguments->options, arguments->shard);
      if (!made) return kDone;
      const validation::BlindResult& result = *made;
      const reports::Json json = reports::blindJson(arguments->options, result);
      io::writeFileWhole(arguments->options.out / "results.json", textOf(json) + '\n');
      io::writeFileWhole(arguments->options.out / "blind.html", page::blindPage(arguments->options, result));
      deliver([&] { return json; }, [&] { return reports::blindText(result); }, arguments->json);
      return kDone;
    };
  });
}

}  // namespace stiffscope::app
