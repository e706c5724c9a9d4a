#include "commands.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "coast/jobs/array_study.hpp"
#include "coast/jobs/calibrate.hpp"
#include "coast/jobs/campaign.hpp"
#include "coast/jobs/compare.hpp"
#include "coast/jobs/convert.hpp"
#include "coast/jobs/diagnose.hpp"
#include "coast/jobs/estimator_study.hpp"
#include "coast/jobs/file_kind.hpp"
#include "coast/jobs/fleet.hpp"
#include "coast/jobs/inspect.hpp"
#include "coast/jobs/outage.hpp"
#include "coast/jobs/ppk.hpp"
#include "coast/jobs/process.hpp"
#include "coast/jobs/report.hpp"
#include "coast/jobs/simulate.hpp"
#include "coast/jobs/synth.hpp"
#include "coast/jobs/tumble.hpp"
#include "progress.hpp"

namespace coast::cli {

namespace {

/// Output of a job to the terminal: the progress line, sentences below each other, warnings on standard error.
jobs::Progress on_terminal(ProgressLine& line, bool quiet) {
  jobs::Progress progress;
  progress.stage = line.stages();
  if (!quiet)
    progress.say = [&line](const std::string& text) {
      line.clear();
      fmt::print("{}\n", text);
    };
  progress.warn = [&line](const std::string& text) {
    line.clear();
    fmt::print(stderr, "warning: {}\n", text);
  };
  return progress;
}

template <class Config, class Result>
void finish(const Config& config, const Result& result, const std::filesystem::path& out, ProgressLine& line, bool quiet) {
  line.show("writing", 0.0);
  jobs::write(config, result, out);
  line.clear();
  if (!quiet) fmt::print("{}", jobs::told(config, result, out));
}

/// @param job  of the configuration and the folder of its results
template <class Config, class Job>
void run(const Config& config, Job job, const std::filesystem::path& input, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const std::filesystem::path out = jobs::results_folder(input, options.out, jobs::files_of(config));
  finish(config, job(out, on_terminal(line, options.quiet)), out, line, options.quiet);
}

}  // namespace

void process(const std::filesystem::path& run_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const jobs::Progress progress = on_terminal(line, options.quiet);
  const jobs::RunConfig config = jobs::read_run_config(run_yaml);
  jobs::Recordings recordings = jobs::load(config, progress);
  const std::filesystem::path out = jobs::results_folder(run_yaml, options.out, jobs::files_of(config));
  jobs::TrajectoryFiles files(config, out);
  const jobs::ProcessResult result = jobs::process(config, std::move(recordings), files.sinks(), progress);
  files.close();
  finish(config, result, out, line, options.quiet);
  jobs::require_usable(config, result);
}

void simulate(const std::filesystem::path& scenario_yaml, std::optional<std::uint64_t> seed, const CommonOptions& options) {
  const jobs::SimulationConfig config = jobs::read_simulate(scenario_yaml, seed);
  run(
      config, [&](const auto&, const auto& progress) { return jobs::simulate(config, progress); }, scenario_yaml, options);
}

void outage(const std::filesystem::path& study_yaml, const CommonOptions& options) {
  const jobs::StudyConfig config = jobs::read_outage(study_yaml);
  run(
      config, [&](const auto& out, const auto& progress) { return jobs::outage(config, progress, out); }, study_yaml, options);
}

void calibrate(const std::filesystem::path& input, const CommonOptions& options) {
  if (jobs::names_schema(input, "coast.estimator_study/")) {
    const jobs::EstimatorStudyConfig study = jobs::read_estimator_study(input);
    run(
        study, [&](const auto&, const auto& progress) { return jobs::estimator_study(study, progress); }, input, options);
    return;
  }
  if (jobs::names_schema(input, "coast.tumble/")) {
    const jobs::TumbleConfig poses = jobs::read_tumble(input);
    run(
        poses, [&](const auto&, const auto& progress) { return jobs::tumble_calibration(poses, progress); }, input, options);
    return;
  }
  const jobs::CalibrationConfig config = jobs::read_calibrate(input);
  run(
      config, [&](const auto&, const auto& progress) { return jobs::calibrate(config, progress); }, input, options);
}

void ppk(const std::filesystem::path& input, const CommonOptions& options) {
  const jobs::PpkConfig config = jobs::read_ppk(input);
  ProgressLine line(options.quiet);
  const std::filesystem::path out = jobs::results_folder(input, options.out, jobs::files_of(config));
  const jobs::PpkResult result = jobs::ppk(config, on_terminal(line, options.quiet));
  finish(config, result, out, line, options.quiet);
  jobs::require_positions(config, result, out);
}

void synth(const std::filesystem::path& input, const CommonOptions& options) {
  if (jobs::names_schema(input, "coast.array_study/")) {
    const jobs::ArrayStudyConfig study = jobs::read_array_study(input);
    run(
        study, [&](const auto&, const auto& progress) { return jobs::array_study(study, progress); }, input, options);
    return;
  }
  const jobs::ArrayConfig config = jobs::read_synth(input);
  run(
      config, [&](const auto&, const auto& progress) { return jobs::synth(config, progress); }, input, options);
}

void fleet(const std::filesystem::path& input, const CommonOptions& options) {
  const jobs::FleetConfig config = jobs::read_fleet(input);
  run(
      config, [&](const auto&, const auto& progress) { return jobs::fleet_statistics(config, progress); }, input, options);
}

void diagnose(const std::filesystem::path& run_yaml, const DiagnoseOptions& choice, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const jobs::Progress progress = on_terminal(line, options.quiet);
  jobs::DiagnosisConfig config = jobs::read_diagnose(run_yaml);
  config.twins = choice.twins;
  config.quick = choice.quick;
  config.simulation = choice.simulation;
  jobs::Recordings recordings = jobs::load(config.run, progress);
  // By default not that of coast process, whose page would be replaced.
  const std::filesystem::path own = std::filesystem::path(run_yaml).replace_extension(".diagnosis.out");
  const std::filesystem::path out =
      jobs::results_folder(run_yaml, options.out.empty() ? own : options.out, jobs::files_of(config));
  finish(config, jobs::diagnose(config, std::move(recordings), progress), out, line, options.quiet);
}

void compare(const std::filesystem::path& first, const std::filesystem::path& second, const Eigen::Vector3d& lever_arm_b,
             const CommonOptions& options) {
  ProgressLine line(true);
  const jobs::ComparisonConfig config{first, second, lever_arm_b};
  const jobs::ComparisonResult result = jobs::compare(config, on_terminal(line, options.quiet));
  if (!options.out.empty()) jobs::write(config, result, jobs::results_folder(first, options.out, jobs::files_of(config)));
  if (!options.quiet) fmt::print("{}", jobs::told(config, result, options.out));
}

void convert(const std::filesystem::path& input, const std::filesystem::path& output, const ConvertOptions& choice,
             const CommonOptions& options) {
  ProgressLine line(true);
  jobs::ConvertConfig config = jobs::read_convert(input, output, choice.format);
  config.gps_week = choice.gps_week;
  config.rate_hz = choice.rate_hz;
  config.geoid_height_m = choice.geoid_height_m;
  if (!choice.projection.crs.empty()) {
    io::ProjectionOptions projection = choice.projection;
    if (!choice.heights.empty()) projection.orthometric = choice.heights == "orthometric";
    config.projection = std::make_shared<io::Projection>(projection);
  }
  finish(config, jobs::convert(config, on_terminal(line, options.quiet)), output.parent_path(), line, options.quiet);
}

void inspect(const std::filesystem::path& file, std::optional<int> gps_week, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const jobs::InspectConfig config{file, gps_week};
  const jobs::InspectResult result = jobs::inspect(config, on_terminal(line, options.quiet));
  line.clear();
  fmt::print("{}", jobs::told(config, result));
}

namespace {

void tell(const std::string& text, ProgressLine& line, bool quiet) {
  line.clear();
  if (!quiet) fmt::print("{}", text);
}

/// @throws NumericalError  some units have failed  @throws OutputError  results could not be stored
void require_whole(const jobs::CampaignRun& run, const std::filesystem::path& out) {
  if (run.unwritten > 0)
    throw OutputError(out.string(), fmt::format("{} of {} units have no result", run.unwritten, run.units));
  if (run.failed > 0)
    throw NumericalError(fmt::format("{} of {} units failed", run.failed, run.units), "",
                         "the others are done; missions.csv lists the errors");
}

void run_shard(const jobs::CampaignConfig& config, const std::filesystem::path& out, const CampaignOptions& choice,
               const CommonOptions& options, ProgressLine& line) {
  const jobs::Shard shard = choice.shard.empty() ? jobs::Shard{} : jobs::shard_from(choice.shard);
  const jobs::CampaignRun run = jobs::run_campaign(config, out, shard, choice.again, on_terminal(line, options.quiet));
  line.clear();
  for (const std::string& failure : run.failures) fmt::print(stderr, "failed: {}\n", failure);
  if (!options.quiet)
    fmt::print("{} units: {} computed, {} were there, {} failed\n", run.units, run.computed, run.found, run.failed);
  require_whole(run, out);
}

void submit(const jobs::CampaignConfig& config, const std::filesystem::path& out, const CampaignOptions& choice,
            const CommonOptions& options, ProgressLine& line) {
  if (choice.engine.empty()) throw InputError({"", 0, "submit without an engine", "--engine slurm, parallel or snakemake", ""});
  using jobs::CampaignEngine;
  const CampaignEngine engine = choice.engine == "slurm"      ? CampaignEngine::kSlurm
                                : choice.engine == "parallel" ? CampaignEngine::kParallel
                                                              : CampaignEngine::kSnakemake;
  const jobs::CampaignEstimate estimate = jobs::estimate_campaign(config, out, on_terminal(line, options.quiet));
  const std::string command = jobs::write_submission(config, out, engine, estimate);
  tell(told(estimate) + (choice.now ? "" : "start it with: " + command + "\n"), line, options.quiet);
  if (choice.now && std::system(command.c_str()) != 0) throw std::runtime_error("this command failed: " + command);
}

}  // namespace

void campaign(const std::filesystem::path& plan_yaml, const CampaignOptions& choice, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const jobs::CampaignConfig config = jobs::read_campaign(plan_yaml);
  const std::filesystem::path out = jobs::results_folder(plan_yaml, options.out, jobs::files_of(config));
  if (choice.what == "run") return run_shard(config, out, choice, options, line);
  if (choice.what == "submit") return submit(config, out, choice, options, line);
  if (choice.what == "plan")
    return tell(told(jobs::estimate_campaign(config, out, on_terminal(line, options.quiet))), line, options.quiet);
  if (choice.what == "status")
    return tell(
        told(jobs::campaign_status(config, out, choice.shard.empty() ? config.shards : jobs::shard_from(choice.shard).count)),
        line, false);
  const jobs::CampaignCollection all = jobs::collect_campaign(config, out, on_terminal(line, options.quiet));
  tell(told(all, out), line, options.quiet);
  if (all.failed + all.missing > 0)
    throw NumericalError(fmt::format("{} of {} units failed and {} are missing", all.failed, all.units, all.missing), "",
                         "missions.csv lists them");
}

void report(const std::filesystem::path& folder, const CommonOptions& options) {
  const std::filesystem::path html = jobs::render_again(folder, options.out);
  if (!options.quiet) fmt::print("report: {}\n", html.string());
}

}  // namespace coast::cli
