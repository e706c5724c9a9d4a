#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <new>

#include "coast/jobs/array_study.hpp"
#include "coast/jobs/calibrate.hpp"
#include "coast/jobs/convert.hpp"
#include "coast/jobs/estimator_study.hpp"
#include "coast/jobs/file_kind.hpp"
#include "coast/jobs/ppk.hpp"
#include "coast/jobs/synth.hpp"
#include "coast/jobs/tumble.hpp"
#include "commands.hpp"
#include "interrupt.hpp"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr int kNumbersFailed = 3;

using coast::cli::CommonOptions;

CLI::App* subcommand(CLI::App& app, const char* name, const char* help, const char* example, CommonOptions& common) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("--out", common.out, "folder for the results (default: the input's name with .out)");
  command->add_option("--threads", common.threads, "threads (default: all)")->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", common.quiet, "only warnings and errors");
  command->footer(std::string("Example:\n  ") + example);
  return command;
}

void add_process(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* process =
      subcommand(app, "process", "IMU + GNSS -> forward filter -> smoother -> trajectory, summary.json, report.html",
                 "coast process run.yaml --out results", common);
  process->add_option("run", input, "run.yaml")->required();
  process->footer(
      "Example:\n  coast process run.yaml --out results\n\nThe smallest run.yaml (all keys: docs/reference/run.md):\n"
      "  imu:\n"
      "    file: imu.csv\n"
      "    gps_week: 2374                        # where times are seconds of week\n"
      "    columns: {time: 1, gyro: [2, 3, 4], accel: [5, 6, 7]}\n"
      "    units: {gyro: rad/s, accel: m/s^2}\n"
      "    axes: [x, y, z]                       # the sensor's axes that point forward, right, down\n"
      "    error_model: error_model.yaml         # of configs/imu, or coast calibrate\n"
      "    lever_arm_m: [0.3, -0.2, -1.1]        # IMU to antenna: forward, right, down\n"
      "  gnss:\n"
      "    file: gnss.pos");
  process->callback([&input, &common] {
    coast::jobs::require_kind(input, "process");
    coast::cli::process(input, common);
  });
}

void add_simulate(CLI::App& app, std::filesystem::path& input, std::optional<std::uint64_t>& seed, CommonOptions& common) {
  auto* simulate = subcommand(app, "simulate", "trajectory + sensors -> a recording with its truth",
                              "coast simulate configs/scenarios/car_roundabout.yaml --out recording --seed 7", common);
  simulate->add_option("scenario", input, "scenario.yaml")->required();
  simulate->add_option("--seed", seed, "seed of the simulated noise (default: the scenario's)");
  simulate->callback([&input, &seed, &common] {
    coast::jobs::require_kind(input, "simulate");
    coast::cli::simulate(input, seed, common);
  });
}

void add_outage(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* outage =
      subcommand(app, "outage", "outages x error models -> drift tables and figures, of a recording or of simulated seeds",
                 "coast outage configs/studies/straight_130s.yaml --out study", common);
  outage->add_option("study", input, "study.yaml: run and sweep, or scenario and seeds")->required();
  outage->callback([&input, &common] {
    coast::jobs::require_kind(input, "outage");
    coast::cli::outage(input, common);
  });
}

void add_calibrate(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* calibrate = subcommand(
      app, "calibrate", "static records -> IMU error model with intervals; rests in many poses -> scale, misalignment, bias",
      "", common);
  calibrate
      ->add_option("input", input,
                   "an IMU file at rest (default CSV columns, KF-GINS, IMR), calibration.yaml, tumble.yaml, or study.yaml")
      ->required();
  calibrate->footer(fmt::format(
      "Examples:\n  coast calibrate imu.csv --out imu-model\n  coast calibrate calibration.yaml\n\n"
      "calibration.yaml (all keys: docs/reference/calibrate.md):\n{}\n\ntumble.yaml, one recording of rests in many "
      "poses and the turns between them:\n{}\n\nstudy.yaml, the estimators on simulated "
      "records of known processes:\n{}",
      coast::jobs::calibration_example("  "), coast::jobs::tumble_example("  "), coast::jobs::estimator_study_example("  ")));
  calibrate->callback([&input, &common] {
    if (input.extension() == ".yaml") coast::jobs::require_kind(input, "calibrate");
    coast::cli::calibrate(input, common);
  });
}

void add_synth(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* synth =
      subcommand(app, "synth", "several IMUs -> one synthetic IMU: mean, weighted, garch, corrected or extended", "", common);
  synth->add_option("array", input, "array.yaml, or study.yaml")->required();
  synth->footer(
      fmt::format("Example:\n  coast synth array.yaml --out synthetic\n\narray.yaml (all keys: "
                  "docs/reference/synth.md):\n{}\n\nstudy.yaml, simulated arrays with known "
                  "truth:\n{}",
                  coast::jobs::array_example("  "), coast::jobs::array_study_example("  ")));
  synth->callback([&input, &common] {
    coast::jobs::require_kind(input, "synth");
    coast::cli::synth(input, common);
  });
}

void add_ppk(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* ppk = subcommand(app, "ppk", "RINEX of rover and base -> fixed carrier-phase positions", "", common);
  ppk->add_option("input", input, "run.yaml with gnss: {ppk: ..}, or ppk.yaml")->required();
  ppk->footer(fmt::format("Example:\n  coast ppk ppk.yaml --out positions\n\nppk.yaml (all keys: docs/reference/ppk.md):\n{}",
                          coast::jobs::ppk_example("  ")));
  ppk->callback([&input, &common] {
    coast::jobs::require_kind(input, "ppk");
    coast::cli::ppk(input, common);
  });
}

void add_compare(CLI::App& app, std::filesystem::path& first, std::filesystem::path& second, std::vector<double>& lever_arm,
                 CommonOptions& common) {
  auto* compare = subcommand(app, "compare", "two trajectories: N, E, D and attitude differences, first minus second",
                             "coast compare results/trajectory.nav truth.nav", common);
  compare->add_option("first", first, ".nav, CSV or SBET")->required();
  compare->add_option("second", second, ".nav, CSV or SBET: the differences are taken at its epochs")->required();
  compare->add_option("--lever-arm", lever_arm, "from the first's point to the second's, forward right down, m")->expected(3);
  compare->callback([&first, &second, &lever_arm, &common] {
    coast::cli::compare(first, second, Eigen::Vector3d(lever_arm[0], lever_arm[1], lever_arm[2]), common);
  });
}

void add_convert(CLI::App& app, std::filesystem::path& input, std::filesystem::path& output, coast::cli::ConvertOptions& choice,
                 CommonOptions& common) {
  auto* convert = app.add_subcommand("convert", "a trajectory in another format");
  convert->add_option("trajectory", input, ".nav, CSV or SBET")->required();
  convert->add_option("output", output, "the file to write; its extension names the format")->required();
  convert->add_option("--to", choice.format, "format, where the extension is another");
  convert->add_option("--gps-week", choice.gps_week, "of files with seconds of week only")->check(CLI::Range(1, 9999));
  convert->add_option("--rate", choice.rate_hz, "Hz (default: every epoch)")->check(CLI::Range(1e-3, 1e5));
  convert->add_option("--geoid-height", choice.geoid_height_m, "geoid above the ellipsoid, m, for heights above mean sea level")
      ->check(CLI::Range(-120.0, 120.0));
  convert->add_flag("--quiet", common.quiet, "only warnings and errors");
  convert->footer("Example:\n  coast convert results/trajectory.nav trajectory.gpx --rate 1\n\nFormats:\n" +
                  coast::jobs::convert_formats("  "));
  convert->callback([&] { coast::cli::convert(input, output, choice, common); });
}

void add_inspect(CLI::App& app, std::filesystem::path& input, std::optional<int>& gps_week) {
  auto* inspect = app.add_subcommand("inspect", "what is in a file: kind, span, rates, satellites and signals, gaps, damage");
  inspect->add_option("file", input, "a recording of an IMU or of GNSS, RINEX, or a trajectory")->required();
  inspect->add_option("--gps-week", gps_week, "of files with seconds of week only")->check(CLI::Range(1, 9999));
  inspect->footer("Example:\n  coast inspect rover.ubx.gz");
  inspect->callback([&input, &gps_week] { coast::cli::inspect(input, gps_week, {}); });
}

void add_diagnose(CLI::App& app, std::filesystem::path& input, coast::cli::DiagnoseOptions& choice, CommonOptions& common) {
  auto* diagnose = subcommand(
      app, "diagnose", "errors that the configured model leaves out: which, how large, how certain, what modelling them gains",
      "coast diagnose run.yaml --out diagnosis\n\nKeys that differ from coast process: docs/reference/diagnose.md", common);
  diagnose->add_option("run", input, "run.yaml, as for `coast process`")->required();
  diagnose->add_option("--twins", choice.twins, "simulated twins that the recording is set against; 0: none")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  diagnose->add_flag("--quick", choice.quick, "one search and no twins: a first answer in a fraction of the time")
      ->excludes("--twins");
  diagnose->add_option("--simulation", choice.simulation,
                       "your own simulation in place of the twins: a scenario, or the run.yaml of a simulated recording");
  diagnose->callback([&] {
    coast::jobs::require_kind(input, "process");
    coast::cli::diagnose(input, choice, common);
  });
}

// Suggests the nearest subcommand if the first word is none.
void require_subcommand(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-')) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (std::ranges::find(names, word) != names.end()) return;
  const std::string near = coast::jobs::nearest(word, names);
  throw coast::InputError({"", 0,
                           near.empty() ? fmt::format("{} is no subcommand, there are: {}", word, fmt::join(names, ", "))
                                        : fmt::format("{} is no subcommand: did you mean {}?", word, near),
                           "", ""});
}

int run(int argc, char** argv) {
  CLI::App app{"coast: post-mission INS/GNSS trajectories"};
  app.set_version_flag("--version", COAST_VERSION);
  app.require_subcommand(1);
  app.footer("Exit status: 0 done, 2 bad input or configuration, 3 the numbers failed, 1 anything else.");
  CommonOptions common;
  std::filesystem::path input;
  std::filesystem::path other;
  std::optional<std::uint64_t> seed;
  std::vector<double> lever_arm{0.0, 0.0, 0.0};

  add_process(app, input, common);

  coast::cli::DiagnoseOptions diagnose_choice;
  add_diagnose(app, input, diagnose_choice, common);

  add_simulate(app, input, seed, common);

  add_outage(app, input, common);

  add_calibrate(app, input, common);

  add_ppk(app, input, common);

  add_synth(app, input, common);

  add_compare(app, input, other, lever_arm, common);

  coast::cli::ConvertOptions convert_choice;
  add_convert(app, input, other, convert_choice, common);

  std::optional<int> gps_week;
  add_inspect(app, input, gps_week);

  auto* report = subcommand(app, "report", "the HTML page again from stored results", "coast report results", common);
  report->add_option("folder", input, "folder of a run")->required();
  report->callback([&] { coast::cli::report(input, common); });

  std::optional<tbb::global_control> limit;
  app.parse_complete_callback([&] {
    if (common.threads > 0)
      limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(common.threads));
  });
  if (argc > 1) require_subcommand(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  coast::cli::keep_standard_streams();
  coast::cli::end_cleanly_on_signals();
  try {
    const int status = run(argc, argv);
    coast::cli::flush_standard_output();
    return status;
  } catch (const coast::InputError& error) {
    fmt::print(stderr, "coast: {}\n", error.what());
    return kBadInput;
  } catch (const coast::NumericalError& error) {
    fmt::print(stderr, "coast: {}\n", error.what());
    return kNumbersFailed;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "coast: out of memory\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "coast: {}\n", error.what());
    return kFailed;
  }
}
