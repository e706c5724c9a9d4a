#include "campaign/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "coast/io/sha256.hpp"
#include "coast/io/shipped.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/run_file.hpp"
#include "coast/jobs/simulate.hpp"

namespace coast::jobs {

namespace {

namespace fs = std::filesystem;

/// A factor that the plan leaves out has one value: the run's own.
std::size_t values(std::size_t listed) {
  return std::max<std::size_t>(1, listed);
}

fs::path existing(const fs::path& path) {
  std::error_code none;
  return fs::exists(path, none) ? path : io::shipped_file(path).value_or(path);
}

double bytes_of(const fs::path& path) {
  std::error_code failed;
  const auto size = fs::file_size(path, failed);
  return failed ? 0.0 : static_cast<double>(size);
}

/// Replaces a folder where a path begins with it.
void replace_folder(std::string& text, const std::string& folder, const std::string& by) {
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at + by.size())) {
    const char before = at == 0 ? ' ' : text[at - 1];
    const bool inside = std::isalnum(static_cast<unsigned char>(before)) != 0 || before == '/' || before == '.' ||
                        before == '_' || before == '-' || before == '}';
    if (inside)
      at += folder.size();
    else
      text.replace(at, folder.size(), by);
    if (at >= text.size()) return;
  }
}

std::vector<std::pair<std::string, std::string>> folders_of_machine(const fs::path& plan) {
  std::vector<std::pair<std::string, std::string>> folders;
  if (const char* data = std::getenv("COAST_DATA"); data != nullptr && *data != '\0')
    folders.emplace_back(fs::absolute(data).lexically_normal().string() + "/", "${COAST_DATA}/");
  std::string up;
  for (fs::path folder = plan; folder.has_relative_path(); folder = folder.parent_path(), up += "../")
    folders.emplace_back(folder.string() + "/", up);
  return folders;
}

}  // namespace

Campaign::Campaign(const CampaignConfig& config, const fs::path& out)
    : config_(config), store_(out), digests_(out / "digests") {
  const fs::path plan = fs::absolute(config.file).lexically_normal().parent_path();
  folders_ = folders_of_machine(plan);
  for (const CampaignConfig::Recorded& entry : config.recorded) {
    kinds_.push_back({entry.name, missions_.size(), entry.runs.size()});
    for (const fs::path& run : entry.runs) missions_.push_back({mission_name(run), run, nullptr, 0});
  }
  for (const CampaignConfig::Simulated& entry : config.simulated) {
    kinds_.push_back({entry.name, missions_.size(), config.seeds});
    for (std::size_t i = 0; i < config.seeds; ++i)
      missions_.push_back({fmt::format("{}/{}", entry.name, config.first_seed + i), {}, &entry, config.first_seed + i});
  }
  identities_.resize(missions_.size());
}

// With its folder, run.yaml says nothing more.
std::string Campaign::mission_name(const fs::path& run) const {
  const fs::path name = portable(fs::absolute(run).lexically_normal().string(), {});
  return (name.filename() == "run.yaml" && name.has_parent_path() ? name.parent_path() : name).generic_string();
}

std::size_t Campaign::groups() const {
  return kinds_.size() * values(config_.error_models.size()) * values(config_.outages.size()) * values(config_.effects.size());
}

std::size_t Campaign::size() const {
  return missions_.size() * values(config_.error_models.size()) * values(config_.outages.size()) *
         values(config_.effects.size());
}

CampaignGroup Campaign::group(std::size_t index) const {
  CampaignGroup group;
  std::size_t rest = index;
  const auto next = [&rest](std::size_t count) {
    const std::size_t value = rest % count;
    rest /= count;
    return value;
  };
  group.effects = next(values(config_.effects.size()));
  group.outages = next(values(config_.outages.size()));
  group.error_model = next(values(config_.error_models.size()));
  group.kind = rest;
  const std::size_t each = groups() / kinds_.size();
  group.count = kinds_[group.kind].count;
  group.first = kinds_[group.kind].first * each + (index - group.kind * each) * group.count;
  return group;
}

CampaignUnit Campaign::unit(std::size_t index) const {
  const std::size_t each = groups() / kinds_.size();
  const auto after = std::ranges::upper_bound(kinds_, index, {}, [&](const MissionKind& kind) { return kind.first * each; });
  const auto kind = static_cast<std::size_t>(after - kinds_.begin()) - 1;
  const std::size_t within = index - kinds_[kind].first * each;
  const CampaignGroup g = group(kind * each + within / kinds_[kind].count);
  return {g.kind, kinds_[kind].first + within % kinds_[kind].count, g.error_model, g.outages, g.effects};
}

std::string Campaign::error_model(std::size_t index) const {
  return config_.error_models.empty() ? "" : config_.error_models[index].name;
}
std::string Campaign::outages(std::size_t index) const {
  return config_.outages.empty() ? "" : config_.outages[index].name;
}
std::string Campaign::effects(std::size_t index) const {
  return config_.effects.empty() ? "" : config_.effects[index].name;
}

std::vector<config::Replacement> Campaign::replacements(const CampaignUnit& unit) const {
  std::vector<config::Replacement> all;
  if (!config_.error_models.empty())
    all.push_back({{"imu", "error_model"},
                   config::value_of(fs::absolute(config_.error_models[unit.error_model].file).lexically_normal().string())});
  // Studies of outages have a sweep beside the run.
  const bool beside = config_.job == CampaignJob::kOutage;
  if (!config_.outages.empty())
    all.push_back({{"outages"}, beside ? std::optional<config::Node>() : config_.outages[unit.outages].value});
  if (!config_.effects.empty()) all.push_back({{"effects"}, config_.effects[unit.effects].value});
  return all;
}

config::Node Campaign::run_tree(const fs::path& run, const CampaignUnit& unit) const {
  return config::with(io::load_yaml(run), replacements(unit));
}

config::Node Campaign::scenario_tree(const CampaignMission& mission) const {
  std::vector<config::Replacement> own;
  if (mission.scenario->error_model)
    own.push_back(
        {{"imu", "error_model"}, config::value_of(fs::absolute(*mission.scenario->error_model).lexically_normal().string())});
  return config::with(io::load_yaml(mission.scenario->scenario), own);
}

// Only keys of the run's own stand in the identity of a mission; those of the factors are added unit by unit. A run that is
// wrong by itself has none.
Campaign::Identity Campaign::recorded_identity(const CampaignUnit& unit) {
  const CampaignMission& mission = missions_[unit.mission];
  const config::Node tree = run_tree(mission.run, {unit.kind, unit.mission, 0, 0, 0});
  static_cast<void>(read_run_config(tree));
  std::set<std::string> factors;
  if (!config_.error_models.empty()) factors.insert("imu.error_model");
  if (!config_.outages.empty()) factors.insert("outages");
  if (!config_.effects.empty()) factors.insert("effects");
  Identity identity;
  identity.digest = config::canonical(
      tree, [this](const fs::path& path) { return digests_.of(existing(path)); }, factors);
  for (const fs::path& path : config::paths_read(tree)) identity.extent += bytes_of(existing(path));
  return identity;
}

Campaign::Identity Campaign::simulated_identity(const CampaignMission& mission) {
  const config::Node tree = scenario_tree(mission);
  const SimulationConfig simulation = read_simulate(tree);
  return {config::canonical(tree, [this](const fs::path& path) { return digests_.of(existing(path)); }, {"seed"}),
          simulation.scenario.motion.duration};
}

const Campaign::Identity& Campaign::identity(const CampaignUnit& unit) {
  const CampaignMission& its = missions_[unit.mission];
  const std::size_t place = its.scenario != nullptr ? kinds_[unit.kind].first : unit.mission;
  {
    const std::scoped_lock lock(mutex_);
    if (identities_[place]) return *identities_[place];
  }
  Identity found = its.scenario != nullptr ? simulated_identity(its) : recorded_identity(unit);
  const std::scoped_lock lock(mutex_);
  if (!identities_[place]) identities_[place] = std::move(found);
  return *identities_[place];
}

std::string Campaign::choice_digest(const std::vector<CampaignConfig::Choice>& choices, std::size_t index) const {
  if (choices.empty()) return "own";
  if (!choices[index].value) return "none";
  return config::canonical(*choices[index].value, [](const fs::path& path) { return path.string(); });
}

std::string Campaign::key(const CampaignUnit& unit) {
  const Identity& base = identity(unit);
  const CampaignMission& its = missions_[unit.mission];
  const std::string model =
      config_.error_models.empty() ? "own" : digests_.of(existing(config_.error_models[unit.error_model].file));
  std::string text = fmt::format("coast {} {}", COAST_VERSION, name(config_.job));
  if (config_.job == CampaignJob::kDiagnose) text += fmt::format(" {} {}", config_.twins, config_.quick);
  for (const std::string& file : config_.keep) text += " " + file;
  text += fmt::format("\n{} {}\n{}\n{}\n{}\n{}\n", its.scenario != nullptr ? "seed" : "run", its.seed, base.digest, model,
                      choice_digest(config_.outages, unit.outages), choice_digest(config_.effects, unit.effects));
  return io::sha256(text);
}

double Campaign::extent(const CampaignUnit& unit) {
  return identity(unit).extent;
}

std::string Campaign::portable(std::string text, const fs::path& own) const {
  if (!own.empty()) replace_folder(text, fs::absolute(own).lexically_normal().string() + "/", "");
  for (const auto& [folder, by] : folders_) replace_folder(text, folder, by);
  return text;
}

Shard shard_from(const std::string& text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  const auto whole = [&](const std::string& part) -> std::size_t {
    if (part.empty() || part.size() > 9 || part.find_first_not_of("0123456789") != std::string::npos) return 0;
    return static_cast<std::size_t>(std::stoul(part));
  };
  if (slash != std::string::npos) shard = {whole(text.substr(0, slash)), whole(text.substr(slash + 1))};
  if (slash == std::string::npos || shard.index < 1 || shard.index > shard.count)
    throw InputError({"", 0, "--shard " + text, "a number and how many there are, as 3/40", ""});
  return shard;
}

}  // namespace coast::jobs
