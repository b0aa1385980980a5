#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <list>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/command_line.h"
#include "app/figures/figures.h"
#include "app/figures/page_scene.h"
#include "app/identified.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/terminal.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/audit/audit.h"
#include "core/audit/check_design.h"
#include "core/campaign/state_points.h"
#include "core/conformity/decide.h"
#include "core/identification/load_case.h"
#include "core/identification/warnings.h"
#include "core/io/write_folder.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/page/html.h"
#include "reports/page/pages.h"
#include "reports/report_content.h"
#include "reports/words/calibration_words.h"
#include "reports/words/day_words.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/names.h"
#include "reports/words/verdict.h"

namespace stiffscope::app {

namespace {

/// stiffscope's own version and those of the libraries it was built with.
std::vector<reports::NamedText> versions() {
  return {{"stiffscope", STIFFSCOPE_VERSION},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"Ceres Solver", STIFFSCOPE_CERES_VERSION},
          {"VTK", STIFFSCOPE_VTK_VERSION}};
}

namespace fs = std::filesystem;

/// A picture's or a table's bare name: a results.json that names something else was not written here.
bool isPictureOrTable(const std::string& name) {
  const fs::path path(name);
  return (path.extension() == ".png" || path.extension() == ".csv") && path.filename() == path && !path.stem().empty();
}

/// Pictures and tables that the report which is there now lists as its own.
std::vector<std::string> earlierFiles(const fs::path& folder) {
  std::error_code none;
  if (!fs::is_regular_file(folder / "results.json", none)) return {};  // a pipe would be waited for
  std::ifstream file(folder / "results.json", std::ios::binary);
  if (!file) return {};
  // Of what may be tens of megabytes nothing else is kept.
  const auto only_files = [](int depth, reports::Json::parse_event_t event, const reports::Json& parsed) {
    return depth != 1 || event != reports::Json::parse_event_t::key || parsed == "files";
  };
  constexpr bool kThrow = false;
  const reports::Json results = reports::Json::parse(file, only_files, kThrow);
  if (!results.is_object() || !results.contains("files") || !results["files"].is_array()) return {};
  std::vector<std::string> names;
  for (const reports::Json& name : results["files"]) {
    if (name.is_string() && isPictureOrTable(name.get<std::string>())) names.push_back(name.get<std::string>());
  }
  return names;
}

std::set<std::string> namesIn(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) names.insert(entry.path().filename().string());
  return names;
}

/// Throws std::runtime_error where a file to be made is `there` and not `earlier` made by a report: it is the user's.
void requireOwn(const fs::path& folder, const std::set<std::string>& there, const std::vector<std::string>& earlier,
                const std::set<std::string>& made) {
  for (const std::string& name : made) {
    if (!there.contains(name) || std::find(earlier.begin(), earlier.end(), name) != earlier.end()) continue;
    if ((name == "results.json" || name == "report.html") && !earlier.empty()) continue;
    throw std::runtime_error(
        (folder / name).string() +
        ": not written: it is there and of no earlier report; expected another folder, or that file away");
  }
}

/// Writes pictures, tables (CSV), results.json and report.html into a folder that is made where it is absent; they
/// appear together. Pictures and tables that an earlier report there listed as its own (`files` of its results.json)
/// and that this one does not make are removed; nothing else is.
void writeReportFiles(const fs::path& folder, const reports::ReportContent& content, const page::ReportPage& page) {
  // What is there is looked at before what is listed: another run may replace both between the two.
  const std::set<std::string> there = namesIn(folder);
  std::vector<std::string> superseded = earlierFiles(folder);
  std::vector<io::FileToWrite> files;
  for (const reports::Figure& figure : content.figures) {
    files.push_back({reports::pictureFile(figure), {figure.png.begin(), figure.png.end()}});
  }
  for (const reports::TableFile& table : page.tables) files.push_back({table.name + ".csv", table.csv});
  std::set<std::string> made{"results.json", "report.html"};
  for (const io::FileToWrite& file : files) made.insert(file.name);
  requireOwn(folder, there, superseded, made);
  reports::JsonDocument results = reports::resultsJson(content);
  results.json["files"] = made;
  files.push_back({"results.json", io::ByteSource([&results](const io::ByteSink& sink) { writeJson(results, sink); })});
  files.push_back({"report.html", page.html});
  std::erase_if(superseded, [&](const std::string& name) { return made.contains(name); });
  io::writeFolderWhole(folder, files, superseded);
}

}  // namespace

namespace {

struct ReportArguments {
  std::vector<std::string> campaigns;
  std::string out, step, limits;
  bool neglect_kc = false, paper = false, raw = false;
  ModelChoice model;
};

/// Takes away the rows that are load cases by now: neither page nor picture shows them, and they are most of a long
/// day.
void withoutLoadReadings(campaign::Campaign& campaign) {
  const auto let_go = [](auto& table) {
    if (table) table->rows = decltype(table->rows)();
  };
  let_go(campaign.loading);
  let_go(campaign.states);
  let_go(campaign.displacements);
}

/// What is used of one campaign and what comes of it. A campaign without loads gives its frames.
struct Result {
  preparation::PreparedCampaign prepared;
  audit::AuditReport audited;
  std::optional<diagnosis::Diagnosis> diagnosis;
  std::optional<extended_model::ExtendedModel> improved;   ///< effects were asked for
  std::optional<accuracy::AccuracyDiagnosis> accuracy;     ///< of a day without a load
  identification::Identification own;                      ///< without any
  std::optional<workspace::WorkspaceStiffness> workspace;  ///< of a loaded day with stiffnesses
  std::string scene;                                       ///< app/figures/page_scene.h; empty: none
  bool loaded = false;

  const campaign::Campaign& campaign() const { return improved ? improved->campaign : prepared.campaign; }
  const identification::Identification& identification() const { return improved ? improved->with : own; }

  Result(const std::string& folder, const ReportArguments& arguments, const identification::IdentifyOptions& options) {
    campaign::Campaign read = openCampaign(folder);
    prepared = arguments.raw ? preparation::leaveRaw(std::move(read)) : preparation::prepareCampaign(std::move(read));
    loaded = identification::whatLoadsLack(prepared.campaign).empty();
    atWork("identifying and diagnosing " + folder);
    if (!loaded && campaign::isUnloadedDay(prepared.campaign)) accuracy = accuracy::diagnoseAccuracy(prepared);
    if (loaded) improved = modelOf(prepared, arguments.model, options, extended_model::Followed::by_diagnosis);
    if (loaded) diagnosis = diagnosisOf(prepared, improved);
    if (!improved) {
      own = loaded ? identification::identify(prepared.campaign, options)
                   : identification::framesAlone(prepared.campaign);
    }
    addWorkspace();
    addScene();
    atWork("auditing " + folder);
    audited = arguments.raw ? audit::audit(prepared.campaign) : audit::audit(prepared);
    if (diagnosis) audit::addSeparableEffects(*diagnosis, campaign().robot.rail.has_value(), audited);
    withoutLoadReadings(prepared.campaign);
    if (improved) withoutLoadReadings(improved->campaign);
  }

  /// While the rows of the load states are there.
  void addScene() {
    reports::ReportCampaign one{campaign(), identification()};
    one.improved = improved ? &*improved : nullptr;
    one.accuracy = accuracy ? &*accuracy : nullptr;
    if (accuracy)
      scene = accuracySceneJson(one);
    else if (loaded)
      scene = loadedSceneJson(one, prepared.campaign);
    else if (campaign().circle_sweeps)
      scene = sweepSceneJson(one);
  }

  void addWorkspace() {
    identification::Identification& result = improved ? improved->with : own;
    const identification::Method method = identification::bestMethod(result);
    if (result.cases.empty() || !result.of(method).available) return;
    const PredictedArm predicted(campaign(), improved, result, method);
    workspace = workspace::workspaceStiffness(predicted.arm(), result, improved ? &*improved : nullptr, method);
  }

  /// Of loads, stiffnesses are the purpose; without, accuracy; of a day of sweeps alone, the frames.
  bool usable() const {
    if (accuracy) return accuracy->calibration.reason.empty();
    return loaded ? identification::anyUsable(identification(),
                                              {identification::kMethods.begin(), identification::kMethods.end()})
                  : identification().frames.arm.points_placed;
  }
};

/// "10 of 19, 12 of 24": of each campaign that has subsets.
std::string subsetSizes(const std::list<Result>& results) {
  std::string sizes;
  for (const Result& one : results) {
    for (const identification::MethodResult& method : one.identification().methods) {
      if (method.subsets.compliances.empty()) continue;
      sizes += fmt::format("{}{} of {}", sizes.empty() ? "" : ", ", method.subsets.size, method.subsets.of);
      break;
    }
  }
  return sizes.empty() ? "too few" : sizes;
}

/// Of loaded days how they are identified, of unloaded ones how they are held out.
std::vector<reports::NamedText> settingsOf(const identification::IdentifyOptions& options,
                                           const std::list<Result>& results, const reports::ReportContent& content) {
  std::vector<reports::NamedText> settings;
  if (reports::anyOfKind(content.campaigns, reports::DayKind::loaded)) {
    settings = {{"load step", options.step ? std::to_string(*options.step) : "the one with the largest mean force"},
                {"geometric stiffness K_{c}", options.finite_deflection ? "included" : "neglected"},
                {"postures in a subset", subsetSizes(results)},
                {"subsets", "all up to 250 000, else a sample with seed 1"}};
  }
  if (reports::anyOfKind(content.campaigns, reports::DayKind::unloaded))
    settings.push_back({"calibration", reports::foldWords(accuracy::kDiagnosisFolds)});
  return settings;
}

/// What the page says first of the effects in the model, campaign by campaign.
void addExtendedModel(const ModelChoice& choice, const std::list<Result>& results, reports::ReportContent& content) {
  if (!reports::anyOfKind(content.campaigns, reports::DayKind::loaded)) return;
  if (choice.springs_only) {
    content.settings.push_back({"effects in the model", "none: joint springs only"});
    return;
  }
  content.settings.push_back(
      {"effects in the model", choice.with.empty() ? "those that the data support"
                                                   : reports::asIs(fmt::format("{}", fmt::join(choice.with, ", ")))});
  content.settings.push_back({"subsets with effects", "all up to 1000, else a sample with seed 1"});
  for (const Result& one : results) {
    if (!one.improved) continue;
    const std::string state = reports::encoderWords(one.campaign().double_encoder);
    const std::string label = state.empty() ? one.campaign().name : reports::capitalised(state);
    content.verdict +=
        " " + reports::asIs((results.size() > 1 ? label + ": " : std::string()) + reports::gainWords(*one.improved));
  }
}

/// What came of the limits on each day; what active encoders avoid is judged on the day that has them.
std::vector<std::vector<conformity::Decision>> decisionsOf(const conformity::Limits& limits,
                                                           const std::list<Result>& results,
                                                           const reports::ReportContent& content) {
  std::vector<std::vector<conformity::Decision>> by_day;
  for (const Result& one : results) {
    conformity::DayResult day;
    if (!one.identification().cases.empty() || one.loaded) day.identification = &one.identification();
    if (one.campaign().circle_sweeps) day.swept = &one.identification().frames;
    if (one.workspace) day.workspace = &*one.workspace;
    if (one.accuracy) day.calibration = &one.accuracy->calibration;
    by_day.push_back(conformity::decide(limits, day));
    if (!content.avoided || one.campaign().double_encoder != campaign::DoubleEncoder::active) continue;
    day.avoided = &*content.avoided;
    by_day.back() = conformity::decide(limits, day);
  }
  return by_day;
}

/// Each scene stands for its campaign's figure on the first page.
void addScenes(const std::list<Result>& results, reports::ReportContent& content) {
  std::size_t i = 0;
  const std::vector<std::optional<DeflectionScene>> pictures = deflectionScenes(content.campaigns);
  for (const Result& one : results) {
    const std::optional<DeflectionScene>& picture = pictures[i];
    const std::string scene =
        picture && !one.scene.empty() ? beginningAs(one.scene, content.campaigns[i], *picture) : one.scene;
    ++i;
    const std::string suffix = results.size() > 1 ? fmt::format("-{}", i) : std::string();
    for (const char* id : {"deflection", "accuracy-before", "sweeps"}) {
      const bool there = std::any_of(content.figures.begin(), content.figures.end(),
                                     [&](const reports::Figure& figure) { return figure.id == id + suffix; });
      if (there && !scene.empty()) content.scenes.push_back({id + suffix, scene});
    }
  }
}

int writeReport(const ReportArguments& arguments) {
  std::optional<conformity::Limits> limits;  // read first: a mistake in them is not to cost the wait
  if (!arguments.limits.empty()) limits = conformity::readLimits(arguments.limits);
  requireNoCampaign(arguments.out, "expected a folder of the report's own");
  identification::IdentifyOptions options;
  options.step = loadStepNamed(arguments.step);
  options.finite_deflection = !arguments.neglect_kc;
  options.papers_choice = arguments.paper;
  std::list<Result> results;  // a list: the content refers to its elements
  reports::ReportContent content;
  for (const std::string& folder : arguments.campaigns) {
    const Result& one = results.emplace_back(folder, arguments, options);
    content.campaigns.push_back({one.campaign(), one.identification(), &one.audited, &one.prepared.preparation,
                                 &one.prepared.drift.rounds, one.diagnosis ? &*one.diagnosis : nullptr,
                                 one.improved ? &*one.improved : nullptr, one.accuracy ? &*one.accuracy : nullptr,
                                 accuracy::kDiagnosisFolds, one.workspace ? &*one.workspace : nullptr});
  }
  content.avoided = reports::avoidedByEncoders(content.campaigns);
  content.compare_with_paper = arguments.paper;
  content.versions = versions();
  content.settings = settingsOf(options, results, content);
  content.title = reports::reportTitle(content.campaigns);
  content.verdict = reports::verdictOf(content.campaigns, content.avoided);
  addExtendedModel(arguments.model, results, content);
  std::vector<std::vector<conformity::Decision>> decisions;
  if (limits) {
    decisions = decisionsOf(*limits, results, content);
    content.limits_file = limits->file;
    content.settings.push_back(
        {"acceptance limits", reports::asIs(limits->file) + ", SHA-256 `" + limits->sha256 + "`"});
  }
  for (std::size_t i = 0; i < decisions.size(); ++i) content.campaigns[i].decisions = &decisions[i];
  atWork("drawing figures");
  content.figures = makeFigures(content.campaigns, {arguments.paper}, content.avoided);

  addScenes(results, content);

  // Everything is made before the first file is written, and appears at once.
  const page::ReportPage page = page::makeReportPage(content);
  writeReportFiles(arguments.out, content, page);
  printText((std::filesystem::path(arguments.out) / "report.html").string() + '\n');
  const bool usable = std::any_of(results.begin(), results.end(), [](const Result& one) { return one.usable(); });
  // A page of readings that are not fit for it is written, and is no result.
  const bool fit = std::none_of(results.begin(), results.end(), [](const Result& one) {
    return one.audited.verdict == preparation::AuditVerdict::fail;
  });
  const bool accepted = !limits || conformity::overall(decisions) == conformity::Verdict::pass;
  return usable && fit && accepted ? kDone : kNotUsable;
}

}  // namespace

void addReport(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Everything as one page with its pictures");
  command->add_option("CAMPAIGN", arguments->campaigns, "campaign folders; two of one machine are compared")
      ->required()
      ->expected(1, 8);
  command
      ->add_option("--out", arguments->out, "folder for report.html, results.json, the pictures and the tables as CSV")
      ->required();
  command->add_option("--step", arguments->step, "load step to identify from");
  command->add_option("--limits", arguments->limits,
                      "acceptance limits (CSV: name, least, most, reason); status 1 where one is not passed");
  command->add_flag("--neglect-kc", arguments->neglect_kc, "neglect K_c, as the paper does");
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_flag("--paper", arguments->paper,
                    "put the figures of Ambiehl et al. (IROS 2017) beside these, and show first their method, dpp");
  command->callback([arguments, &run] { run = [arguments] { return writeReport(*arguments); }; });
}

}  // namespace stiffscope::app
