#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "coast/record/error.hpp"
#include "commands.hpp"
#include "process_run.hpp"
#include "progress.hpp"
#include "run_effects.hpp"

namespace coast::cli {

namespace {

// What turns tell of the times is a candidate for the filter, not advice: with fixes a second apart it is now and then false.
void leave_time_to_the_filter(const RunConfig& config, Recordings& recordings, study::Setup& setup) {
  constexpr double kAgrees = 0.3;    // s
  constexpr double kNothing = 0.15;  // s: the state of the offset finds as much
  if (!recordings.time_shift_s) return;
  const double seen = -*recordings.time_shift_s;
  const bool left = config.setup.unstated.time_offset;
  if (left && std::abs(seen) >= kNothing) setup.unstated.time_offset_seen_s = seen;
  if (!left && std::abs(seen - config.setup.time_offset_s) > kAgrees) return;
  std::erase_if(recordings.inspection_events, [&](const record::Event& event) {
    if (event.kind != "time_shift" && event.kind != "leap_second_shift") return false;
    std::ranges::replace(
        recordings.inspection, event.text,
        fmt::format("Times: turns match best at a shift of {:+.2f} s, which the filter confirms or not.", seen));
    return true;
  });
}

// Where no start is found, a mistake that would explain it is told beside the reason.
std::unique_ptr<ProcessRun> prepare(const RunConfig& config, Recordings recordings, study::Setup setup,
                                    const study::Excerpt& excerpt, const std::filesystem::path& out,
                                    const study::Progress& progress) {
  const study::Setup stated = setup;
  try {
    return std::make_unique<ProcessRun>(config, std::move(recordings), std::move(setup), excerpt, out, progress);
  } catch (const NumericalError& error) {
    const std::string cause = told(study::rank_causes(excerpt, stated));
    if (cause.empty()) throw;
    throw NumericalError("start", "", fmt::format("{} Most likely cause: {}", error.what(), cause));
  }
}

}  // namespace

void process(const std::filesystem::path& run_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = line.stages();
  const RunConfig config = read_run_config(run_yaml);
  Recordings recordings = load(config, progress);
  std::vector<std::string> files = trajectory_files(config.output);
  for (const char* file : {"run.resolved.yaml", "summary.json", "innovations.csv", "report.json", "report.html"})
    files.emplace_back(file);
  const std::filesystem::path out = output_folder(run_yaml, options.out, files);
  line.clear();
  study::Setup setup = setup_of(config, recordings, config.sweep);
  setup.unstated = config.setup.unstated;
  leave_time_to_the_filter(config, recordings, setup);
  print_inspection(recordings, options.quiet);
  refuse_wrong_axes(config, recordings);
  take_out_effects(config, recordings, setup, progress);
  const study::Excerpt excerpt = study::excerpt_of(recordings.imu, recordings.gnss);
  const std::unique_ptr<ProcessRun> prepared = prepare(config, std::move(recordings), std::move(setup), excerpt, out, progress);
  ProcessRun& run = *prepared;
  line.clear();
  if (!options.quiet)
    for (const record::Event& event : run.adaptations()) fmt::print("{}\n", event.text);
  run.solve_without_outages();
  run.run_earlier_passes();
  tbb::parallel_invoke([&run] { run.solve_and_write(); }, [&run] { run.check_lever_arm(); });
  run.offer_gnss_noise();
  run.study_sweep();
  run.separate_forward_and_backward();
  run.judge();
  const std::string summary = run.write_results();
  line.clear();
  if (!options.quiet) fmt::print("{}\n{}report: {}\n", run.verdict().line(), summary, (out / "report.html").string());
  if (run.verdict().standing() == Standing::kUnusable && !config.accept)
    throw NumericalError(
        "the result contradicts its input", "",
        run.verdict().line() + ". Everything was written, marked as unusable; `accept: true` takes it as it is");
}

}  // namespace coast::cli
