#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/command.h"
#include "app/output.h"
#include "core/blind/run_blind.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/effect_distance.h"
#include "core/input/write_file.h"
#include "reports/json/blind_json.h"
#include "reports/page/blind_page.h"
#include "reports/text/blind_text.h"

namespace stiffscope {

namespace {

blind::BlindEvents eventsOnStderr() {
  blind::BlindEvents events;
  events.sealed = [](const std::string& seal) {
    std::fprintf(stderr, "labels sealed, SHA-256 %s\n", seal.c_str());
  };
  events.frozen = [](const std::string& hash) {
    std::fprintf(stderr, "answers frozen, SHA-256 %s\n", hash.c_str());
  };
  if (isatty(STDERR_FILENO) != 0) {
    events.progress = [](const char* stage, int done, int total) {
      std::fprintf(stderr, "\r%s %d of %d%s", stage, done, total, done == total ? "\n" : "");
    };
  }
  return events;
}

blind::DiagnosisAnswer diagnosed(const Campaign& campaign) {
  const Diagnosis diagnosis = diagnose(campaign);
  return {diagnosis.verdict, diagnosis.classes};
}

}  // namespace

void addBlind(CLI::App& app, Run& run) {
  struct Arguments {
    blind::BlindOptions options;
    std::string out, json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("blind", "The diagnosis checked on machines whose effect is withheld");
  command->add_option("--cases", arguments->options.cases, "how many machines")
      ->check(CLI::Range(1, 9999))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "another seed, other machines")
      ->capture_default_str();
  command
      ->add_option("--out", arguments->out, "folder for campaigns, labels, answers, results.json, blind.html")
      ->required();
  command->add_flag("--discard", arguments->options.discard, "remove the campaigns when done");
  command->add_option("--threads", arguments->options.threads, "at work at a time; the result is the same")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      arguments->options.out = arguments->out;
      const blind::BlindResult result = blind::runBlind(arguments->options, diagnosed, eventsOnStderr(), distanceFromVocabulary);
      const Json json = blindJson(arguments->options, result);
      writeFileWhole(arguments->options.out / "results.json", json.dump(1) + '\n');
      writeFileWhole(arguments->options.out / "blind.html", blindPage(arguments->options, result));
      deliver([&] { return json; }, [&] { return blindText(result); }, arguments->json);
      return kDone;
    };
  });
}

}  // namespace stiffscope
