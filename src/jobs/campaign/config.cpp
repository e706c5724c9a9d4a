// plan.yaml

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <set>

#include "coast/config/derived.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/campaign.hpp"

namespace coast::jobs {

namespace {

namespace fs = std::filesystem;
using config::Node;

/// Files that match a pattern of the shell, sorted by name.
std::vector<fs::path> matching(const fs::path& pattern) {
  glob_t found{};
  std::vector<fs::path> files;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  std::ranges::sort(files);
  return files;
}

/// run.yaml of a folder and of the folders in it.
std::vector<fs::path> runs_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == "run.yaml" && entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

CampaignConfig::Recorded recorded_missions(const Node& item) {
  CampaignConfig::Recorded missions{item.text(), {}};
  const fs::path path = item.path();
  std::error_code none;
  if (fs::is_directory(path, none))
    missions.runs = runs_below(path);
  else if (missions.name.find_first_of("*?[") != std::string::npos)
    missions.runs = matching(path);
  else
    missions.runs = {path};
  if (missions.runs.empty())
    throw item.error(missions.name + ": no run file", "a run file, a folder with run.yaml in it or below, or a pattern",
                     "Relative paths count from the folder of the plan.");
  return missions;
}

std::string own_name(const Node& item, std::set<std::string>& names) {
  std::string name = item.at("name").text();
  if (!names.insert(name).second) throw item.at("name").error(name + " for the second time", "a name of its own");
  return name;
}

/// The sets of a factor, of each of which `value` is read as the run file has it.
std::vector<CampaignConfig::Choice> choices(const Node& root, const char* factor, const std::vector<std::string>& keys) {
  std::vector<CampaignConfig::Choice> sets;
  const auto list = root.find(factor);
  if (!list) return sets;
  std::set<std::string> names;
  for (const Node& item : list->items()) {
    CampaignConfig::Choice set{own_name(item, names), {}};
    for (const std::string& key : keys) {
      const auto value = item.find(key);
      if (!value) continue;
      if (set.value) throw value->error(fmt::format("{} and another set of the same name", key), "one of them");
      set.value = config::with(*value, {});
    }
    sets.push_back(std::move(set));
  }
  if (sets.empty()) throw list->error("an empty list", "at least one {name: ..}", "{name: none} is one without any.");
  return sets;
}

std::size_t at_least_one(const Node& node) {
  const long value = node.integer();
  if (value < 1) throw node.error(fmt::format("{}", value), "a whole number of at least 1");
  return static_cast<std::size_t>(value);
}

void read_missions(const Node& root, CampaignConfig& plan) {
  if (const auto missions = root.find("missions")) {
    if (missions->is_scalar())
      plan.recorded.push_back(recorded_missions(*missions));
    else
      for (const Node& item : missions->items()) plan.recorded.push_back(recorded_missions(item));
  }
  const auto scenarios = root.find("scenarios");
  if (!scenarios) {
    if (plan.recorded.empty()) throw root.error("no mission", "missions: [recordings/*/run.yaml], or scenarios and seeds");
    return;
  }
  std::set<std::string> names;
  for (const Node& item : scenarios->items()) {
    CampaignConfig::Simulated simulated{own_name(item, names), item.at("file").path(), {}};
    if (const auto model = item.find("error_model")) simulated.error_model = model->path();
    plan.simulated.push_back(std::move(simulated));
  }
  const Node seeds = root.at("seeds");
  const long first = seeds.integer("first", 1);
  if (first < 0) throw seeds.at("first").error(fmt::format("{}", first), "a whole number of at least 0");
  plan.first_seed = static_cast<std::uint64_t>(first);
  plan.seeds = at_least_one(seeds.at("count"));
}

const std::set<std::string>& files_to_keep(CampaignJob job) {
  static const std::set<std::string> of_process{"trajectory.csv", "trajectory.nav", "forward.nav",      "innovations.csv",
                                                "report.html",    "report.json",    "run.resolved.yaml"};
  static const std::set<std::string> of_outage{"outage.json", "report.html", "report.json"};
  static const std::set<std::string> of_diagnose{"run.diagnosed.yaml", "error_model.diagnosed.yaml", "report.html",
                                                 "report.json"};
  return job == CampaignJob::kProcess ? of_process : job == CampaignJob::kOutage ? of_outage : of_diagnose;
}

void read_kept(const Node& root, CampaignConfig& plan) {
  const auto list = root.find("keep");
  if (!list) return;
  const std::set<std::string>& known = files_to_keep(plan.job);
  for (const Node& item : list->items()) {
    static_cast<void>(item.choice({known.begin(), known.end()}));
    plan.keep.push_back(item.text());
  }
}

void require_possible(const Node& root, const CampaignConfig& plan) {
  if (plan.job != CampaignJob::kOutage) return;
  if (const auto effects = root.find("effects"); effects && !plan.simulated.empty())
    throw effects->error("effects of simulated studies of outages", "job: process, or no effects",
                         "Each seed of job: outage is simulated in memory, without a run file.");
  for (const CampaignConfig::Choice& set : plan.outages)
    if (!set.value) throw root.at("outages").error(set.name + ": a study of no outages", "a sweep or a list");
  if (plan.outages.empty() && !plan.recorded.empty())
    throw root.error("job: outage of recordings without outages", "outages: [{name: .., sweep: {durations_s: [60]}}]");
}

}  // namespace

const char* name(CampaignJob job) {
  switch (job) {
    case CampaignJob::kProcess:
      return "process";
    case CampaignJob::kOutage:
      return "outage";
    case CampaignJob::kDiagnose:
      return "diagnose";
  }
  return "";
}

CampaignConfig read_campaign(const fs::path& file) {
  const Node root = io::load_yaml(file);
  CampaignConfig plan;
  plan.file = file;
  static_cast<void>(root.text("schema", "coast.campaign/1"));
  plan.job = static_cast<CampaignJob>(root.choice("job", {"process", "outage", "diagnose"}, 0));
  read_missions(root, plan);
  if (const auto list = root.find("error_models")) {
    std::set<std::string> names;
    for (const Node& item : list->items()) plan.error_models.push_back({own_name(item, names), item.at("file").path()});
    if (plan.error_models.empty()) throw list->error("an empty list", "at least one {name: .., file: ..}");
  }
  plan.outages = choices(root, "outages", {"sweep", "list"});
  plan.effects = choices(root, "effects", {"list"});
  const Node diagnose = root.section("diagnose");
  plan.twins = static_cast<int>(diagnose.number_within("twins", 20, 0, 1000));
  plan.quick = diagnose.flag("quick", false);
  read_kept(root, plan);
  if (const auto shards = root.find("shards")) plan.shards = at_least_one(*shards);
  require_possible(root, plan);
  // What stands in a set is checked with the run file in whose place it stands: here it only counts as read.
  for (const char* factor : {"outages", "effects"})
    if (const auto list = root.find(factor))
      for (const Node& item : list->items())
        for (const char* key : {"sweep", "list"})
          if (const auto value = item.find(key)) config::mark_read(*value);
  root.refuse_unasked();
  return plan;
}

}  // namespace coast::jobs
