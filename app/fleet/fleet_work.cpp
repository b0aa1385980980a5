#include "app/fleet/fleet_work.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "app/fleet/processes.h"
#include "app/terminal.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "core/io/xml.h"
#include "core/numerics/parallel.h"
#include "reports/json/fleet_json.h"

namespace stiffscope::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kKeyDigits = 16;

/// The SHA-256 of a file that campaign.xml names; of what cannot be read, which its campaign will say, nothing.
std::string hashOf(const fs::path& file) {
  try {
    return io::sha256Hex(io::readBytesWithStamp(file).text());
  } catch (const std::exception&) {
    return {};
  }
}

/// Reads the head of a campaign.xml, and adds the files that it names to what the key is of.
void readHead(const fs::path& folder, const io::XmlNode& root, FoundCampaign& found, std::string& key) {
  found.campaign.date = root.attribute("date").value_or("");
  std::string serial, item;
  bool loading = false, load_cell = false;
  for (const io::XmlNode& element : root.children()) {
    const std::string name = element.name();
    if (name == "robot_serial") serial = element.text();
    if (name == "item") item = element.text();
    loading = loading || name == "loading", load_cell = load_cell || name == "load_cell";
    for (const char* attribute : {"file", "urdf"}) {
      if (const auto file = element.attribute(attribute)) key += *file + ' ' + hashOf(folder / *file) + '\n';
    }
  }
  found.campaign.machine = fleet::machineOf(serial, item, folder.string());
  found.maybe_unloaded = loading && !load_cell;
}

FoundCampaign foundIn(const fs::path& folder, bool springs_only) {
  FoundCampaign found;
  found.campaign.folder = folder.string();
  found.campaign.machine = fleet::machineOf({}, {}, folder.string());
  constexpr int kKept = 3;  // of what is kept of a campaign (reports::keptJson): one more where that changes
  std::string key =
      fmt::format("stiffscope {} {} {}\n", STIFFSCOPE_VERSION, kKept, springs_only ? "springs" : "supported");
  // Before it is read as text: what cannot be is another campaign than the next one that cannot.
  const std::string hash = hashOf(folder / "campaign.xml");
  key += (hash.empty() ? folder.string() : hash) + '\n';
  try {
    const std::string xml = io::readTextFile(folder / "campaign.xml", io::kLargestXml);
    const io::XmlFile file((folder / "campaign.xml").string(), xml);
    readHead(folder, file.root(), found, key);
  } catch (const std::exception&) {
    // Its own process says what is wrong.
  }
  found.key = io::sha256Hex(key).substr(0, kKeyDigits);
  return found;
}

/// Folders with a campaign.xml; none is looked for below one, nor in `out`.
void findBelow(const fs::path& folder, const fs::path& out, std::set<fs::path>& seen, std::vector<fs::path>& found) {
  std::error_code none;
  const fs::path real = fs::canonical(folder, none);
  if (real.empty() || real == out || !seen.insert(real).second) return;
  if (fs::exists(folder / "campaign.xml", none)) {
    found.push_back(folder.lexically_normal());
    return;
  }
  std::vector<fs::path> below;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.is_directory(none)) below.push_back(entry.path());
  }
  std::sort(below.begin(), below.end());
  for (const fs::path& one : below) findBelow(one, out, seen, found);
}

fs::path resultFile(const FleetRequest& request, const std::string& key) {
  return request.out / "campaigns" / (key + ".json");
}

fs::path pairFile(const FleetRequest& request, const std::string& before, const std::string& after) {
  return request.out / "pairs" / (before + "-" + after + ".json");
}

fs::path reportFolder(const FleetRequest& request, const std::string& key) { return request.out / "reports" / key; }

/// Where the message of a process that ended without a result is kept.
fs::path messageFile(fs::path file) { return file.replace_extension(".failed"); }

/// One process of this program.
struct Task {
  std::vector<std::string> words;
  fs::path file;  ///< that it leaves
};

/// The last line that was said, without the program's name.
std::string lastLine(std::string said) {
  while (!said.empty() && said.back() == '\n') said.pop_back();
  said.erase(0, said.rfind('\n') + 1);
  const std::string name = "stiffscope: ";
  return said.starts_with(name) ? said.substr(name.size()) : said;
}

std::string endOf(const Ended& ended) {
  if (ended.signal != 0) return fmt::format("ended by signal {}, {}", ended.signal, ::strsignal(ended.signal));
  const std::string said = lastLine(ended.said);
  return said.empty() ? fmt::format("ended with status {} and no result", ended.status) : said;
}

void runTasks(const FleetRequest& request, const std::vector<Task>& tasks, const char* stage) {
  if (tasks.empty()) return;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t jobs = std::min(request.jobs > 0 ? request.jobs : cores, tasks.size());
  const std::string threads = fmt::format("STIFFSCOPE_THREADS={}", std::max<std::size_t>(1, cores / jobs));
  const std::string program = ownProgram().string();
  std::mutex mutex;
  std::size_t done = 0;
  numerics::onThreads(jobs, tasks.size(), [&](std::size_t i) {
    const Task& task = tasks[i];
    const Ended ended = runProcess(program, task.words, Listen::standard_error, {threads});
    std::error_code none;
    if (!fs::exists(task.file, none))
      io::writeFileWhole(messageFile(task.file), endOf(ended));
    else
      fs::remove(messageFile(task.file), none);
    const std::lock_guard lock(mutex);
    ++done;
    atWork(stage, done, tasks.size());
  });
}

Task resultTask(const FleetRequest& request, const std::vector<std::string>& folders, const fs::path& file) {
  Task task{{"fleet"}, file};
  for (const std::string& folder : folders) task.words.push_back(pathWord(folder));
  task.words.insert(task.words.end(), {"--out", pathWord(request.out), "--result", pathWord(file)});
  if (request.springs_only) task.words.emplace_back("--springs-only");
  return task;
}

/// Days that follow each other by their dates alone, days with loads left out.
std::vector<std::pair<std::size_t, std::size_t>> likelyPairs(const std::vector<FoundCampaign>& found) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::map<std::string, std::size_t> last;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i].maybe_unloaded) continue;
    const auto before = last.find(found[i].campaign.machine);
    if (before != last.end()) pairs.emplace_back(before->second, i);
    last[found[i].campaign.machine] = i;
  }
  return pairs;
}

/// Texts of a folder's own files without the folder, where a path begins with it: the same campaign elsewhere has the
/// same result.
std::string withoutFolder(std::string text, const std::string& folder) {
  if (text.starts_with(folder + ": ")) text.erase(0, folder.size() + 2);
  const std::string prefix = folder.ends_with('/') ? folder : folder + '/';
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
    const bool begins = at == 0 || std::string_view(" '\"(").find(text[at - 1]) != std::string_view::npos;
    if (begins)
      text.erase(at, prefix.size());
    else
      at += prefix.size();
  }
  return text;
}

std::optional<reports::Json> readResult(const fs::path& file) {
  std::error_code none;
  if (!fs::exists(file, none)) return std::nullopt;
  return reports::Json::parse(io::readTextFile(file));
}

/// The message of a process that left none of its own.
std::optional<std::string> readMessage(const fs::path& file) {
  std::error_code none;
  if (!fs::exists(messageFile(file), none)) return std::nullopt;
  return io::readTextFile(messageFile(file));
}

}  // namespace

std::vector<FoundCampaign> findCampaigns(const FleetRequest& request) {
  std::error_code none;
  const fs::path out = fs::weakly_canonical(request.out, none);
  std::set<fs::path> seen;
  std::vector<fs::path> folders;
  for (const std::string& folder : request.folders) {
    if (!fs::is_directory(folder, none))
      throw io::InputError({folder}, "", "expected a folder with campaigns in it or below it");
    findBelow(folder, out, seen, folders);
  }
  if (folders.empty())
    throw io::InputError({request.folders.front()}, "", "expected a campaign.xml in it or below it; there is none");
  std::vector<FoundCampaign> found(folders.size());
  numerics::onAllCores(folders.size(), [&](std::size_t i) { found[i] = foundIn(folders[i], request.springs_only); });
  std::sort(found.begin(), found.end(),
            [](const FoundCampaign& a, const FoundCampaign& b) { return fleet::inOrder(a.campaign, b.campaign); });
  return found;
}

void doFleetWork(const FleetRequest& request, const std::vector<FoundCampaign>& found, const numerics::Shard& shard) {
  for (const char* folder : {"campaigns", "pairs"}) io::makeFolder(request.out / folder);
  std::error_code none;
  std::vector<Task> results, reports;
  std::set<fs::path> taken;  // two campaigns of the same bytes are one task
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!shard.has(i)) continue;
    const fs::path file = resultFile(request, found[i].key);
    if (!fs::exists(file, none) && taken.insert(file).second)
      results.push_back(resultTask(request, {found[i].campaign.folder}, file));
    const fs::path report = reportFolder(request, found[i].key);
    if (!request.reports || fs::exists(report / "report.html", none) || !taken.insert(report).second) continue;
    Task task{{"report", pathWord(found[i].campaign.folder), "--out", pathWord(report)}, report / "report.html"};
    if (request.springs_only) task.words.emplace_back("--springs-only");
    reports.push_back(std::move(task));
  }
  const auto pairs = likelyPairs(found);
  std::vector<Task> comparisons;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const FoundCampaign &before = found[pairs[p].first], &after = found[pairs[p].second];
    const fs::path file = pairFile(request, before.key, after.key);
    if (shard.has(p) && !fs::exists(file, none) && taken.insert(file).second)
      comparisons.push_back(resultTask(request, {before.campaign.folder, after.campaign.folder}, file));
  }
  runTasks(request, results, "campaigns");
  runTasks(request, comparisons, "days compared");
  if (!reports.empty()) io::makeFolder(request.out / "reports");
  for (const Task& task : reports) io::makeFolder(task.file.parent_path());
  runTasks(request, reports, "reports");
}

fleet::Fleet fleetFrom(const FleetRequest& request, const std::vector<FoundCampaign>& found) {
  std::vector<fleet::FleetCampaign> campaigns;
  std::map<std::string, std::string> keys;  // by folder
  std::size_t missing = 0;
  std::error_code none;
  for (const FoundCampaign& one : found) {
    fleet::FleetCampaign campaign = one.campaign;
    keys[campaign.folder] = one.key;
    const fs::path file = resultFile(request, one.key);
    if (const auto json = readResult(file)) {
      if (json->contains("failure"))
        campaign.failure = json->at("failure");
      else
        campaign.result = reports::keptCampaign(json->at("result"));
    } else if (const auto message = readMessage(file)) {
      campaign.failure = *message;
    } else {
      ++missing;
    }
    const fs::path report = reportFolder(request, one.key) / "report.html";
    if (request.reports && fs::exists(report, none))
      campaign.report = report.lexically_relative(request.out).string();
    else if (request.reports && campaign.result)
      campaign.report_failure =
          readMessage(report).value_or("not written yet: the same command without --merge does it");
    campaigns.push_back(std::move(campaign));
  }
  if (missing > 0) {
    throw std::runtime_error(
        fmt::format("{}: {} of {} campaigns have no result yet: expected all shards to be done; the same command "
                    "without --merge does what is missing",
                    request.out.string(), missing, found.size()));
  }
  std::vector<fleet::FleetPair> pairs = fleet::pairsOf(fleet::seriesOf(campaigns));
  fleet::compareLoaded(campaigns, pairs);
  const auto fileOf = [&](const fleet::FleetPair& pair) {
    return pairFile(request, keys[campaigns[pair.before].folder], keys[campaigns[pair.after].folder]);
  };
  std::vector<Task> comparisons;
  for (const fleet::FleetPair& pair : pairs) {
    if (pair.result || fs::exists(fileOf(pair), none)) continue;
    comparisons.push_back(
        resultTask(request, {campaigns[pair.before].folder, campaigns[pair.after].folder}, fileOf(pair)));
  }
  runTasks(request, comparisons, "days compared");
  for (fleet::FleetPair& pair : pairs) {
    if (pair.result) continue;
    const auto json = readResult(fileOf(pair));
    if (json && json->contains("result"))
      pair.result = reports::keptPair(json->at("result"), campaigns[pair.after].result->joints());
    else
      pair.failure = json ? json->at("failure").get<std::string>() : readMessage(fileOf(pair)).value_or("");
  }
  fleet::compareUnloaded(campaigns, pairs);
  return fleet::studyFleet(std::move(campaigns), std::move(pairs));
}

void writeOneResult(const std::vector<std::string>& folders, bool springs_only, const fs::path& file) {
  reports::Json json;
  try {
    json["result"] = folders.size() == 1 ? reports::keptJson(fleetDay(folders[0], springs_only))
                                         : reports::keptJson(fleetPair(folders[0], folders[1]));
  } catch (const io::InputError& error) {
    // What the campaign's files say is a result, and is not asked of them again.
    std::string message = error.what();
    for (const std::string& folder : folders) message = withoutFolder(message, folder);
    json["failure"] = message;
  }
  constexpr int kOneLine = -1;
  io::writeFileWhole(file, json.dump(kOneLine, ' ', false, reports::Json::error_handler_t::replace) + '\n');
}

}  // namespace stiffscope::app
