#include "campaign/run_unit.hpp"

#include <chrono>
#include <set>

#include "coast/io/peak_memory.hpp"
#include "coast/io/writers.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/simulate.hpp"
#include "coast/record/error.hpp"
#include "diagnose/result.hpp"
#include "outage/tables.hpp"
#include "process/summary.hpp"
#include "run_file/run_config.hpp"

namespace coast::jobs {

namespace {

namespace fs = std::filesystem;

/// Removes the files of a job that the plan does not keep.
void leave_only(const std::vector<std::string>& keep, const fs::path& folder) {
  std::set<std::string> kept(keep.begin(), keep.end());
  kept.insert(kSummary);
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(folder))
    if (!kept.contains(entry.path().filename().string())) others.push_back(entry.path());
  for (const fs::path& other : others) fs::remove_all(other);
}

/// The run file of a unit: a recorded mission's own, or that of a recording that is simulated now.
fs::path run_file(Campaign& campaign, const CampaignUnit& unit, const fs::path& folder) {
  const CampaignMission& mission = campaign.mission(unit);
  if (mission.scenario == nullptr) return mission.run;
  const SimulationConfig simulation = read_simulate(campaign.scenario_tree(mission), mission.seed);
  const fs::path recording = folder / "recording";
  fs::create_directories(recording);
  write(simulation, simulate(simulation, {}), recording);
  return recording / "run.yaml";
}

/// Text files of the trajectory are written only if they are kept.
std::vector<std::string> formats_kept(const std::vector<std::string>& keep) {
  std::vector<std::string> formats;
  const std::set<std::string> kept(keep.begin(), keep.end());
  if (kept.contains("trajectory.csv")) formats.emplace_back("csv");
  if (kept.contains("trajectory.nav") || kept.contains("forward.nav")) formats.emplace_back("nav");
  return formats;
}

UnitResult processed(Campaign& campaign, const CampaignUnit& unit, const fs::path& folder) {
  const std::vector<std::string>& keep = campaign.config().keep;
  RunConfig config = read_run_config(campaign.run_tree(run_file(campaign, unit, folder), unit));
  config.output.formats = formats_kept(keep);
  Recordings recordings = load(config, {});
  const std::string temperature = temperature_of(recordings.imu);
  TrajectoryFiles files(config, folder);
  const bool trajectory = !config.output.formats.empty();
  const ProcessResult result = process(config, std::move(recordings), trajectory ? files.sinks() : TrajectorySinks{}, {});
  if (keep.empty()) {
    io::write_text(folder / kSummary, summary_json(result));
  } else {
    files.close();
    write(config, result, folder);
  }
  UnitResult row = unit_result(result);
  row.imu = device_of(config);
  row.temperature = temperature;
  return row;
}

/// A study of one recording, or of one seed.
StudyConfig study_of(Campaign& campaign, const CampaignUnit& unit) {
  const CampaignMission& mission = campaign.mission(unit);
  const CampaignConfig& plan = campaign.config();
  const std::optional<config::Node> set =
      plan.outages.empty() ? std::optional<config::Node>() : config::with(*plan.outages[unit.outages].value, {});
  std::optional<study::NamedModel> filter;
  if (!plan.error_models.empty())
    filter = {plan.error_models[unit.error_model].name,
              noise::ImuErrorModel::from(io::load_yaml(plan.error_models[unit.error_model].file))};
  if (mission.scenario == nullptr) {
    SweepStudy study;
    study.file = mission.run;
    study.run = read_run_config(campaign.run_tree(mission.run, unit));
    study.sweep = sweep_from(*set, study.run);
    study.models.push_back(
        {filter.value_or(study::NamedModel{study.run.setup.model.sensor_name(), study.run.setup.model}), {}});
    return study;
  }
  EnsembleStudy study;
  study.file = study.scenario = mission.scenario->scenario;
  study.plan.scenario = read_simulate(campaign.scenario_tree(mission), mission.seed).scenario;
  study.plan.first_seed = mission.seed;
  study.plan.seeds = 1;
  if (set) study.plan.groups = study_groups(*set, study.plan.scenario.motion.duration);
  const study::NamedModel truth{study.plan.scenario.error_model->sensor_name(), *study.plan.scenario.error_model};
  study.plan.cases.push_back({truth, {filter.value_or(truth)}});
  study.truths = study.filters = 1;
  return study;
}

UnitResult studied(Campaign& campaign, const CampaignUnit& unit, const fs::path& folder) {
  const StudyConfig config = study_of(campaign, unit);
  const OutageStudy study = outage(config, {});
  if (!campaign.config().keep.empty()) write(config, study, folder);
  io::write_text(folder / kSummary, outage_json(study).dump(1) + "\n");
  return unit_result(study);
}

UnitResult diagnosed(Campaign& campaign, const CampaignUnit& unit, const fs::path& folder) {
  DiagnosisConfig config;
  config.run = read_run_config(campaign.run_tree(run_file(campaign, unit, folder), unit));
  config.twins = campaign.config().twins;
  config.quick = campaign.config().quick;
  Recordings recordings = load(config.run, {});
  const std::string temperature = temperature_of(recordings.imu);
  const DiagnosisResult result = diagnose(config, std::move(recordings), {});
  if (!campaign.config().keep.empty()) write(config, result, folder);
  io::write_text(folder / kSummary, diagnosis_json(result));
  UnitResult row = unit_result(result);
  row.imu = device_of(config.run);
  row.temperature = temperature;
  return row;
}

UnitResult computed(Campaign& campaign, const CampaignUnit& unit, const fs::path& folder) {
  UnitResult result;
  switch (campaign.config().job) {
    case CampaignJob::kProcess:
      result = processed(campaign, unit, folder);
      break;
    case CampaignJob::kOutage:
      result = studied(campaign, unit, folder);
      break;
    case CampaignJob::kDiagnose:
      result = diagnosed(campaign, unit, folder);
      break;
  }
  leave_only(campaign.config().keep, folder);
  return result;
}

}  // namespace

bool is_done(Campaign& campaign, const CampaignUnit& unit) {
  return campaign.store().has(campaign.key(unit), kResult);
}

bool has_failed(Campaign& campaign, const CampaignUnit& unit) {
  return campaign.store().has(campaign.key(unit), kError);
}

UnitOutcome run_unit(Campaign& campaign, const CampaignUnit& unit, bool alone) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  UnitOutcome outcome;
  try {
    const std::string key = campaign.key(unit);
    io::ResultStore::Work work(campaign.store(), key);
    if (alone) io::forget_peak_memory();
    UnitResult result;
    try {
      result = computed(campaign, unit, work.folder());
    } catch (const InputError& error) {
      result.error = error.what();
    } catch (const NumericalError& error) {
      result.error = error.what();
    }
    outcome.cost.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    if (alone) outcome.cost.memory_bytes = io::peak_memory();
    if (!result.error.empty()) {
      result.error = campaign.portable(result.error, work.folder());
      leave_only({}, work.folder());
      fs::remove(work.folder() / kSummary);
      io::write_text(work.folder() / kError, result.error + "\n");
      outcome.state = UnitOutcome::State::kFailed;
      outcome.error = result.error;
    }
    if (result.row.contains("likely_cause")) {
      nlohmann::ordered_json& cause = result.row["likely_cause"];
      cause = campaign.portable(cause.get<std::string>(), work.folder());
    }
    io::write_text(work.folder() / kResult, result_json(result, outcome.cost));
    work.finish(kResult);
  } catch (const InputError& error) {  // of the key: there is nothing that a result could be found by
    outcome = {UnitOutcome::State::kFailed, campaign.portable(error.what(), {}), {}};
  } catch (const std::exception& error) {
    outcome = {UnitOutcome::State::kUnwritten, campaign.portable(error.what(), {}), {}};
  }
  return outcome;
}

}  // namespace coast::jobs
