#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "coast/jobs/array_study.hpp"
#include "coast/jobs/calibrate.hpp"
#include "coast/jobs/convert.hpp"
#include "coast/jobs/estimator_study.hpp"
#include "coast/jobs/file_kind.hpp"
#include "coast/jobs/fleet.hpp"
#include "coast/jobs/ppk.hpp"
#include "coast/jobs/synth.hpp"
#include "coast/jobs/tumble.hpp"
#include "coast/record/error.hpp"

namespace coast::cli {

namespace {

// What stands for a value in --help; the completions of a shell read it too.
constexpr const char* kFile = "FILE";
constexpr const char* kFolder = "FOLDER";

CLI::App* subcommand(CLI::App& app, const char* name, const char* help, const char* example, CommonOptions& common) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("--out", common.out, "folder for the results (default: the input's name with .out)")->type_name(kFolder);
  command->add_option("--threads", common.threads, "threads (default: all)")->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", common.quiet, "only warnings and errors");
  command->footer(std::string("Example:\n  ") + example);
  return command;
}

void add_process(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* process =
      subcommand(app, "process", "IMU + GNSS -> forward filter -> smoother -> trajectory, summary.json, report.html",
                 "coast process run.yaml --out results", common);
  process->add_option("run", input, "run.yaml")->required()->type_name(kFile);
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
    jobs::require_kind(input, "process");
    cli::process(input, common);
  });
}

void add_simulate(CLI::App& app, std::filesystem::path& input, std::optional<std::uint64_t>& seed, CommonOptions& common) {
  auto* simulate = subcommand(app, "simulate", "trajectory + sensors -> a recording with its truth",
                              "coast simulate configs/scenarios/car_roundabout.yaml --out recording --seed 7", common);
  simulate->add_option("scenario", input, "scenario.yaml")->required()->type_name(kFile);
  simulate->add_option("--seed", seed, "seed of the simulated noise (default: the scenario's)");
  simulate->callback([&input, &seed, &common] {
    jobs::require_kind(input, "simulate");
    cli::simulate(input, seed, common);
  });
}

void add_outage(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* outage =
      subcommand(app, "outage", "outages x error models -> drift tables and figures, of a recording or of simulated seeds",
                 "coast outage configs/studies/straight_130s.yaml --out study", common);
  outage->add_option("study", input, "study.yaml: run and sweep, or scenario and seeds")->required()->type_name(kFile);
  outage->callback([&input, &common] {
    jobs::require_kind(input, "outage");
    cli::outage(input, common);
  });
}

void add_calibrate(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* calibrate = subcommand(
      app, "calibrate", "static records -> IMU error model with intervals; rests in many poses -> scale, misalignment, bias",
      "", common);
  calibrate
      ->add_option("input", input,
                   "an IMU file at rest (default CSV columns, KF-GINS, IMR), calibration.yaml, tumble.yaml, or study.yaml")
      ->required()
      ->type_name(kFile);
  calibrate->footer(fmt::format(
      "Examples:\n  coast calibrate imu.csv --out imu-model\n  coast calibrate calibration.yaml\n\n"
      "calibration.yaml (all keys: docs/reference/calibrate.md):\n{}\n\ntumble.yaml, one recording of rests in many "
      "poses and the turns between them:\n{}\n\nstudy.yaml, the estimators on simulated "
      "records of known processes:\n{}",
      jobs::calibration_example("  "), jobs::tumble_example("  "), jobs::estimator_study_example("  ")));
  calibrate->callback([&input, &common] {
    if (input.extension() == ".yaml") jobs::require_kind(input, "calibrate");
    cli::calibrate(input, common);
  });
}

void add_synth(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* synth =
      subcommand(app, "synth", "several IMUs -> one synthetic IMU: mean, weighted, garch, corrected or extended", "", common);
  synth->add_option("array", input, "array.yaml, or study.yaml")->required()->type_name(kFile);
  synth->footer(
      fmt::format("Example:\n  coast synth array.yaml --out synthetic\n\narray.yaml (all keys: "
                  "docs/reference/synth.md):\n{}\n\nstudy.yaml, simulated arrays with known "
                  "truth:\n{}",
                  jobs::array_example("  "), jobs::array_study_example("  ")));
  synth->callback([&input, &common] {
    jobs::require_kind(input, "synth");
    cli::synth(input, common);
  });
}

void add_fleet(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* fleet =
      subcommand(app, "fleet",
                 "estimates of many missions of the same sensors -> their values, what changed and when, which missions depart",
                 "", common);
  fleet->add_option("input", input, "estimates.csv, or fleet.yaml")->required()->type_name(kFile);
  fleet->footer(
      fmt::format("Examples:\n  coast fleet estimates.csv --out fleet\n  coast fleet fleet.yaml\n\nfleet.yaml (all keys: "
                  "docs/reference/fleet.md):\n{}\n\nestimates.csv, SI:\n"
                  "  mission,unit,start,quantity,axis,value,sigma,unit_of_value,temperature_degC\n"
                  "  m0001,imu-07,2025-07-08T19:34:18,lever_arm,x,0.412,0.004,m,23.5",
                  jobs::fleet_example("  ")));
  fleet->callback([&input, &common] {
    if (input.extension() == ".yaml") jobs::require_kind(input, "fleet");
    cli::fleet(input, common);
  });
}

void add_ppk(CLI::App& app, std::filesystem::path& input, CommonOptions& common) {
  auto* ppk = subcommand(app, "ppk", "RINEX of rover and base -> fixed carrier-phase positions", "", common);
  ppk->add_option("input", input, "run.yaml with gnss: {ppk: ..}, or ppk.yaml")->required()->type_name(kFile);
  ppk->footer(fmt::format("Example:\n  coast ppk ppk.yaml --out positions\n\nppk.yaml (all keys: docs/reference/ppk.md):\n{}",
                          jobs::ppk_example("  ")));
  ppk->callback([&input, &common] {
    jobs::require_kind(input, "ppk");
    cli::ppk(input, common);
  });
}

void add_compare(CLI::App& app, std::filesystem::path& first, std::filesystem::path& second, std::vector<double>& lever_arm,
                 CommonOptions& common) {
  auto* compare = subcommand(app, "compare", "two trajectories: N, E, D and attitude differences, first minus second",
                             "coast compare results/trajectory.nav truth.nav", common);
  compare->add_option("first", first, ".nav, CSV or SBET")->required()->type_name(kFile);
  compare->add_option("second", second, ".nav, CSV or SBET: the differences are taken at its epochs")
      ->required()
      ->type_name(kFile);
  compare->add_option("--lever-arm", lever_arm, "from the first's point to the second's, forward right down, m")->expected(3);
  compare->callback([&first, &second, &lever_arm, &common] {
    cli::compare(first, second, Eigen::Vector3d(lever_arm[0], lever_arm[1], lever_arm[2]), common);
  });
}

void add_convert(CLI::App& app, std::filesystem::path& input, std::filesystem::path& output, ConvertOptions& choice,
                 CommonOptions& common) {
  auto* convert = app.add_subcommand("convert", "a trajectory, or a receiver's own file, in another format");
  convert->add_option("input", input, "a trajectory, or any recording that coast reads")->required()->type_name(kFile);
  convert->add_option("output", output, "the file to write; its extension names the format")->required()->type_name(kFile);
  convert->add_option("--to", choice.format, "format, where the extension is another")
      ->type_name(fmt::format("{}", fmt::join(jobs::convert_format_names(), "|")));
  convert->add_option("--gps-week", choice.gps_week, "of files with seconds of week only")->check(CLI::Range(1, 9999));
  convert->add_option("--rate", choice.rate_hz, "Hz (default: every epoch)")->check(CLI::Range(1e-3, 1e5));
  convert->add_option("--geoid-height", choice.geoid_height_m, "geoid above the ellipsoid, m, for heights above mean sea level")
      ->check(CLI::Range(-120.0, 120.0));
  auto* crs = convert->add_option("--crs", choice.projection.crs, "CRS of a map: EPSG:25832, EPSG:25832+5773, or a PROJ string")
                  ->type_name("CRS");
  convert->add_option("--from", choice.projection.from, "geographic CRS of the input: EPSG:7912 is ITRF2014")
      ->type_name("CRS")
      ->capture_default_str()
      ->needs(crs);
  convert->add_option("--epoch", choice.projection.epoch, "decimal year at which the positions are valid (default: their time)")
      ->check(CLI::Range(1980.0, 2100.0))
      ->needs(crs);
  convert
      ->add_option("--heights", choice.heights,
                   "ellipsoidal or orthometric (default: orthometric if the CRS has a vertical part)")
      ->type_name("KIND")
      ->check(CLI::IsMember({"ellipsoidal", "orthometric"}))
      ->needs(crs);
  convert->add_flag("--quiet", common.quiet, "only warnings and errors");
  convert->footer(
      "Examples:\n  coast convert results/trajectory.nav trajectory.gpx --rate 1\n  coast convert rover.ubx "
      "rover.obs\n  coast convert results/trajectory.nav utm.csv --to grid --crs EPSG:25832\n\nFormats:\n" +
      jobs::convert_formats("  "));
  convert->callback([&] { cli::convert(input, output, choice, common); });
}

void add_inspect(CLI::App& app, std::filesystem::path& input, std::optional<int>& gps_week) {
  auto* inspect = app.add_subcommand("inspect", "what is in a file: kind, span, rates, satellites and signals, gaps, damage");
  inspect->add_option("file", input, "a recording of an IMU or of GNSS, RINEX, a trajectory, or a run file")
      ->required()
      ->type_name(kFile);
  inspect->add_option("--gps-week", gps_week, "of files with seconds of week only")->check(CLI::Range(1, 9999));
  inspect->footer("Example:\n  coast inspect rover.ubx.gz");
  inspect->callback([&input, &gps_week] { cli::inspect(input, gps_week, {}); });
}

void add_diagnose(CLI::App& app, std::filesystem::path& input, DiagnoseOptions& choice, CommonOptions& common) {
  auto* diagnose = subcommand(
      app, "diagnose", "errors that the configured model leaves out: which, how large, how certain, what modelling them gains",
      "coast diagnose run.yaml --out diagnosis\n\nKeys that differ from coast process: docs/reference/diagnose.md", common);
  diagnose->get_option("--out")->description("folder for the results (default: the input's name with .diagnosis.out)");
  diagnose->add_option("run", input, "run.yaml, as for `coast process`")->required()->type_name(kFile);
  diagnose->add_option("--twins", choice.twins, "simulated twins that the recording is set against; 0: none")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  diagnose->add_flag("--quick", choice.quick, "one search and no twins: a first answer in a fraction of the time")
      ->excludes("--twins");
  diagnose
      ->add_option("--simulation", choice.simulation,
                   "your own simulation in place of the twins: a scenario, or the run.yaml of a simulated recording")
      ->type_name(kFile);
  diagnose->callback([&] {
    jobs::require_kind(input, "diagnose");
    cli::diagnose(input, choice, common);
  });
}

void add_campaign(CLI::App& app, std::filesystem::path& input, CampaignOptions& choice, CommonOptions& common) {
  auto* campaign =
      subcommand(app, "campaign", "many missions x error models x outages x effects, on one machine or a cluster", "", common);
  campaign->add_option("what", choice.what, "plan: try one of each kind; run; status; collect: merge; submit: to an engine")
      ->required()
      ->check(CLI::IsMember({"plan", "run", "status", "collect", "submit"}))
      ->type_name("plan|run|status|collect|submit");
  campaign->add_option("plan", input, "plan.yaml")->required()->type_name(kFile);
  campaign->add_option("--shard", choice.shard, "run: one part of the units, as 3/40 (default: all)")->type_name("I/N");
  campaign->add_flag("--again", choice.again, "run: units that have failed, too");
  campaign->add_option("--engine", choice.engine, "submit: what runs the shards")
      ->check(CLI::IsMember({"slurm", "parallel", "snakemake"}))
      ->type_name("slurm|parallel|snakemake");
  campaign->add_flag("--now", choice.now, "submit: start it at once");
  campaign->footer(
      "Examples:\n  coast campaign plan plan.yaml\n  coast campaign run plan.yaml --shard 3/40\n"
      "  coast campaign collect plan.yaml\n\nplan.yaml (all keys: docs/reference/campaign.md):\n"
      "  schema: coast.campaign/1\n"
      "  missions: [recordings/*/run.yaml]\n"
      "  error_models:\n"
      "    - {name: data sheet, file: configs/imu/adis16505.yaml}\n"
      "  outages:\n"
      "    - {name: none}\n"
      "    - {name: minute, sweep: {every_s: 120, durations_s: [60]}}");
  campaign->callback([&] {
    jobs::require_kind(input, "campaign");
    cli::campaign(input, choice, common);
  });
}

void add_report(CLI::App& app, std::filesystem::path& folder, CommonOptions& common) {
  auto* report = subcommand(app, "report", "the HTML page again from stored results", "coast report results", common);
  report->add_option("folder", folder, "folder of a run")->required()->type_name(kFolder);
  report->callback([&folder, &common] { cli::report(folder, common); });
}

// Suggests the nearest subcommand if the first word is none.
void require_subcommand(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-')) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (std::ranges::find(names, word) != names.end()) return;
  const std::string near = jobs::nearest(word, names);
  throw InputError({"", 0,
                    near.empty() ? fmt::format("{} is no subcommand, there are: {}", word, fmt::join(names, ", "))
                                 : fmt::format("{} is no subcommand: did you mean {}?", word, near),
                    "", ""});
}

}  // namespace

CommandLine::CommandLine() : app_("coast: post-mission INS/GNSS trajectories", "coast") {
  app_.set_version_flag("--version", COAST_VERSION);
  app_.require_subcommand(1);
  app_.footer(
      "Exit status: 0 done, 2 bad input or configuration, 3 the numbers failed, 1 anything else.\n\n"
      "A first page:\n"
      "  coast simulate configs/scenarios/car_roundabout.yaml --out recording\n"
      "  coast process recording/run.yaml --out results");
  add_process(app_, input_, common_);
  add_diagnose(app_, input_, diagnose_, common_);
  add_simulate(app_, input_, seed_, common_);
  add_outage(app_, input_, common_);
  add_calibrate(app_, input_, common_);
  add_ppk(app_, input_, common_);
  add_synth(app_, input_, common_);
  add_fleet(app_, input_, common_);
  add_compare(app_, input_, other_, lever_arm_, common_);
  add_convert(app_, input_, other_, convert_, common_);
  add_inspect(app_, input_, gps_week_);
  add_campaign(app_, input_, campaign_, common_);
  add_report(app_, input_, common_);
  app_.parse_complete_callback([this] {
    if (common_.threads > 0)
      limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(common_.threads));
  });
}

void CommandLine::parse(int argc, char** argv) {
  if (argc > 1) require_subcommand(app_, argv[1]);
  app_.parse(argc, argv);
}

}  // namespace coast::cli
