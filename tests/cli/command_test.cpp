// The program as a user runs it: exit status, messages, files.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coast/jobs/run_file.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;

constexpr const char* kScenario = R"(
schema: coast.scenario/1
trajectory: {kind: car_roundabout, duration_s: 360, static_s: 30, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 5, sd_m: [0.01, 0.01, 0.02]}
outages: [{elapsed_s: 150, duration_s: 20}]
start_gps: {week: 2374, sow: 208800}
seed: 4
)";

/// A simulated recording, made once for the tests of this file.
const fs::path& recording() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(kScenario, folder.path());
  return made;
}

TEST(Commands, OffersGnssNoiseWhereTheStatedSigmasDoNotFit) {
  const test::TemporaryDirectory folder;
  std::string yaml = text_of(recording() / "run.yaml");
  const std::string gnss = "gnss: {";
  const auto at = yaml.find(gnss);
  ASSERT_NE(at, std::string::npos) << yaml;
  yaml.insert(at + gnss.size(), "noise: {scale_horizontal: 3, scale_vertical: 3}, ");
  write(recording() / "pessimistic.yaml", yaml);
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", (recording() / "pessimistic.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto summary = nlohmann::json::parse(text_of(out / "summary.json"));
  const auto& events = summary["events"];
  const auto offer = std::find_if(events.begin(), events.end(),
                                  [](const nlohmann::json& event) { return event["kind"] == "gnss_sigmas_do_not_fit"; });
  ASSERT_NE(offer, events.end()) << events;
  // The sigmas were right before they were trebled; 1350 epochs know a scale to 2 %.
  EXPECT_NE((*offer)["text"].get<std::string>().find("times 1 horizontally"), std::string::npos) << *offer;
}

TEST(Commands, ProcessesWhatSimulateWroteAndRepeatsItFromTheResolvedFile) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const Outcome first =
      run(fmt::format("process '{}' --out '{}'", (recording() / "run.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(first.status, 0) << first.error;
  for (const char* name :
       {"trajectory.nav", "forward.nav", "trajectory.csv", "summary.json", "report.html", "run.resolved.yaml"})
    EXPECT_TRUE(fs::exists(out / name)) << name;
  const auto summary = nlohmann::json::parse(text_of(out / "summary.json"));
  test::expect_valid("summary", summary);
  test::expect_valid("run", test::load_yaml_as_json(recording() / "run.yaml"));
  test::expect_valid("run", test::load_yaml_as_json(out / "run.resolved.yaml"));

  // White GNSS noise of 1 and 2 cm at 5 Hz: smoothed within a centimetre outside the outage, decimetres inside.
  const auto& smoothed = summary["reference"]["smoothed"];
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(smoothed["position_rms_m"][i].get<double>(), 0.03) << i;
  // 3 degrees of freedom, 1000 epochs: the mean of NIS lies within 3.9 sqrt(6 / 1000) of 3 but once in ten thousand.
  EXPECT_NEAR(summary["nis"]["mean"].get<double>(), summary["nis"]["expected"].get<double>(), 0.3);
  ASSERT_EQ(summary["outages"].size(), 1U);
  EXPECT_LT(summary["outages"][0]["smoothed"]["horizontal_max_m"].get<double>(),
            summary["outages"][0]["forward"]["horizontal_max_m"].get<double>());

  const fs::path again = folder.path() / "again";
  const Outcome second =
      run(fmt::format("process '{}' --out '{}'", (out / "run.resolved.yaml").string(), again.string()), folder.path());
  ASSERT_EQ(second.status, 0) << second.error;
  EXPECT_EQ(text_of(out / "trajectory.nav"), text_of(again / "trajectory.nav"));

  const Outcome compared = run(fmt::format("compare '{}' '{}' --out '{}'", (out / "trajectory.nav").string(),
                                           (recording() / "truth.nav").string(), (folder.path() / "cmp").string()),
                               folder.path());
  ASSERT_EQ(compared.status, 0) << compared.error;
  const auto comparison = nlohmann::json::parse(text_of(folder.path() / "cmp" / "comparison.json"));
  for (std::size_t i = 0; i < 3; ++i)  // 1 um and 10 um steps of the .nav file's digits
    EXPECT_NEAR(comparison["position_rms_m"][i].get<double>(), smoothed["position_rms_m"][i].get<double>(), 2e-5) << i;

  fs::remove(out / "report.html");
  EXPECT_EQ(run(fmt::format("report '{}'", out.string()), folder.path()).status, 0);
  EXPECT_GT(fs::file_size(out / "report.html"), 100000U);
}

TEST(Commands, RepeatsAFitOfNoiseAndTimeOffsetFromTheResolvedFile) {
  const test::TemporaryDirectory folder;
  const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  std::string text = text_of(made / "run.yaml");
  const auto insert_after = [&text](const std::string& key, const std::string& inserted) {
    const auto at = text.find(key);
    ASSERT_NE(at, std::string::npos) << text;
    text.insert(at + key.size(), inserted);
  };
  insert_after("imu:\n", "  noise: estimated\n");
  insert_after("gnss: {", "noise: estimated, time_offset_sd_s: 0.1, ");
  insert_after("time_offset_s: 0", ".05");
  write(made / "fitted.yaml", text);
  const auto process = [&](const fs::path& file, const char* out) {
    const Outcome outcome =
        run(fmt::format("process '{}' --out '{}'", file.string(), (folder.path() / out).string()), folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
  };
  process(made / "fitted.yaml", "first");
  process(folder.path() / "first" / "run.resolved.yaml", "again");
  const std::string resolved = text_of(folder.path() / "first" / "run.resolved.yaml");
  for (const char* estimated : {"gyro_factor", "scale_horizontal", "# time_offset_s: "})
    EXPECT_NE(resolved.find(estimated), std::string::npos) << resolved;
  EXPECT_EQ(text_of(folder.path() / "first" / "trajectory.nav"), text_of(folder.path() / "again" / "trajectory.nav"));
  const auto gnss = nlohmann::json::parse(text_of(folder.path() / "first" / "summary.json"))["gnss"];
  const double sd = gnss["time_offset_sd_s"];
  EXPECT_LT(sd, 0.01);
  EXPECT_NEAR(gnss["time_offset_s"].get<double>(), 0.0, 4.0 * sd);  // begun 0.05 s off
  EXPECT_LE(gnss["used"].get<long>() + gnss["rejected"].get<long>(), gnss["epochs"].get<long>()) << gnss;
}

// An outage is withheld from 150 to 170 s after the start; fixes come each 0.2 s.
TEST(Commands, WritesTheListedFormatsAloneAndSaysInPosWhereGnssWasMissing) {
  const test::TemporaryDirectory folder;
  write(recording() / "formats.yaml", text_of(recording() / "run.yaml") + "\noutput: {formats: [pos, kml], rate_hz: 10}\n");
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", (recording() / "formats.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  for (const char* name : {"trajectory.pos", "trajectory.kml"}) EXPECT_TRUE(fs::exists(out / name)) << name;
  for (const char* name : {"trajectory.nav", "forward.nav", "trajectory.csv", "trajectory.sbet"})
    EXPECT_FALSE(fs::exists(out / name)) << name;
  const auto summary = nlohmann::json::parse(text_of(out / "summary.json"));
  test::expect_valid("summary", summary);
  EXPECT_EQ(summary["files"]["trajectory"], "trajectory.pos");
  EXPECT_FALSE(summary["files"].contains("forward"));
  std::istringstream rows(text_of(out / "trajectory.pos"));
  long without = 0, fixed = 0, other = 0;
  for (std::string row; std::getline(rows, row);) {
    if (row.starts_with('%')) continue;
    std::istringstream words(row);
    std::string date, time, latitude, longitude, height, quality;
    words >> date >> time >> latitude >> longitude >> height >> quality;
    ++(quality == "7" ? without : quality == "1" ? fixed : other);
  }
  EXPECT_NEAR(static_cast<double>(without), 200.0, 8.0);  // up to 0.3 s at either end rest on a fix
  EXPECT_GT(fixed, 3000);
  EXPECT_EQ(other, 0);
}

/// What `process` says of a run of the recording. @param name  of run.yaml beside the recording, and of the result in `folder`
nlohmann::json summary_of(const std::string& run_yaml, const std::string& name, const fs::path& folder) {
  const fs::path file = recording() / (name + ".yaml");
  write(file, run_yaml);
  test::expect_valid("run", test::load_yaml_as_json(file));
  const Outcome outcome = run(fmt::format("process '{}' --out '{}'", file.string(), (folder / name).string()), folder);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  return nlohmann::json::parse(text_of(folder / name / "summary.json"));
}

TEST(Commands, BatchIsAsGoodAsTheSmootherAndSaysWhatItDoubts) {
  const test::TemporaryDirectory folder;
  const auto solve = [&](const std::string& name, const std::string& keys_of_gnss, const std::string& keys) {
    std::string text = text_of(recording() / "run.yaml") + keys;
    text.insert(text.find("gnss: {") + 7, keys_of_gnss);
    return summary_of(text, name, folder.path());
  };
  const auto rts = solve("rts", "", "");
  const auto batch = solve("batch", "base_offset_sd_m: 0.3, ", "smoother: batch\nrobust: {loss: cauchy, scale: 3}\n");
  test::expect_valid("summary", batch);
  for (std::size_t i = 0; i < 3; ++i) {
    const double of_rts = rts["reference"]["smoothed"]["position_rms_m"][i].get<double>();
    EXPECT_LT(batch["reference"]["smoothed"]["position_rms_m"][i].get<double>(), 1.1 * of_rts + 1e-3) << i;
  }
  const auto& events = batch["events"];
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const nlohmann::json& event) { return event["kind"] == "batch"; }));
  EXPECT_TRUE(std::none_of(events.begin(), events.end(),
                           [](const nlohmann::json& event) { return event["kind"] == "batch_not_converged"; }));
  // Alignment took the position from fixes: it knows nothing of what all of them are off by.
  EXPECT_TRUE(std::any_of(events.begin(), events.end(),
                          [](const nlohmann::json& event) { return event["kind"] == "base_offset_not_seen"; }));
  int offsets = 0;
  for (const auto& unknown : batch["batch"]["unknowns"]) {
    if (!unknown["name"].get<std::string>().starts_with("base_offset")) continue;
    ++offsets;
    EXPECT_EQ(unknown["observability"], "not seen") << unknown;
    EXPECT_NEAR(unknown["posterior_sd"].get<double>(), 0.3, 1e-3);
  }
  EXPECT_EQ(offsets, 3);
  EXPECT_NE(text_of(folder.path() / "batch" / "report.html").find("Unknowns of the whole mission"), std::string::npos);
}

// Away from outages both filters know the fixes; what it leaves out against the smoother may cost a tenth (docs/solutions.md).
TEST(Commands, CombinedIsDeliveredInPlaceOfTheSmoothed) {
  const test::TemporaryDirectory folder;
  const auto rts = summary_of(text_of(recording() / "run.yaml"), "smoothed", folder.path());
  const auto combined = summary_of(text_of(recording() / "run.yaml") + "smoother: combined\n", "combined", folder.path());
  test::expect_valid("summary", combined);
  for (std::size_t i = 0; i < 3; ++i) {
    const double of_rts = rts["reference"]["smoothed"]["position_rms_m"][i].get<double>();
    EXPECT_LT(combined["reference"]["smoothed"]["position_rms_m"][i].get<double>(), 1.1 * of_rts + 2e-3) << i;
  }
  EXPECT_NE(text_of(folder.path() / "smoothed" / "trajectory.nav"), text_of(folder.path() / "combined" / "trajectory.nav"));
  EXPECT_NE(text_of(folder.path() / "combined" / "report.html").find("forward and backward filter combined"),
            std::string::npos);
}

TEST(Commands, ThreePassesRepeatFromTheResolvedFileAndKeepTheSweepBlind) {
  const test::TemporaryDirectory folder;
  std::string text = text_of(recording() / "run.yaml");
  const auto outages = text.find("outages:");  // the last key, a list
  ASSERT_NE(outages, std::string::npos);
  text.replace(outages, std::string::npos, "outages: {every_s: 60, first_s: 120, durations_s: [20]}\n");
  write(recording() / "sweep1.yaml", text);
  write(recording() / "sweep3.yaml", text + "filter: {passes: 3}\n");
  for (const char* name : {"sweep1", "sweep3"}) {
    const Outcome outcome =
        run(fmt::format("process '{}.yaml' --out '{}'", (recording() / name).string(), (folder.path() / name).string()),
            folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.error;
  }
  const auto summary = [&](const char* name) { return nlohmann::json::parse(text_of(folder.path() / name / "summary.json")); };
  // Scored against the simulated truth, so the sweeps are one and the same.
  EXPECT_EQ(summary("sweep1").at("outage_sweep"), summary("sweep3").at("outage_sweep"));
  EXPECT_NE(text_of(folder.path() / "sweep1" / "forward.nav"), text_of(folder.path() / "sweep3" / "forward.nav"));
  const fs::path again = folder.path() / "again";
  ASSERT_EQ(
      run(fmt::format("process '{}' --out '{}'", (folder.path() / "sweep3" / "run.resolved.yaml").string(), again.string()),
          folder.path())
          .status,
      0);
  EXPECT_EQ(text_of(folder.path() / "sweep3" / "trajectory.nav"), text_of(again / "trajectory.nav"));
}

struct Spoiled {
  const char* what;
  const char* from;  ///< replaced in a good run.yaml
  const char* to;
  const char* message;  ///< must be part of standard error
};

class SpoiledRun : public testing::TestWithParam<Spoiled> {};

TEST_P(SpoiledRun, EndsWithStatusTwoAndNamesFileAndLine) {
  const test::TemporaryDirectory folder;
  std::string text = text_of(recording() / "run.yaml");
  for (const char* name : {"imu.csv", "gnss.pos", "truth.nav", "error_model.yaml"}) {
    const auto at = text.find(std::string(" ") + name);
    ASSERT_NE(at, std::string::npos) << name;
    text.replace(at + 1, std::string(name).size(), (recording() / name).string());
  }
  const auto at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos) << text;
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  write(folder.path() / "spoiled.yaml", text);
  const Outcome outcome = run(fmt::format("process '{}'", (folder.path() / "spoiled.yaml").string()), folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_NE(outcome.error.find("spoiled.yaml:"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "spoiled.out" / "summary.json"));
}

INSTANTIATE_TEST_SUITE_P(
    Runs, SpoiledRun,
    testing::Values(Spoiled{"unknown key", "lever_arm_m:", "leverarm_m:", "lever_arm_m"},
                    Spoiled{"a word for a number", "gps_week: 2374", "gps_week: soon", "soon"},
                    Spoiled{"two of three numbers", "mounting_deg: [0, 0, 0]", "mounting_deg: [0, 0]", "mounting_deg"},
                    Spoiled{"left-handed axes", "axes: [x, y, z]", "axes: [x, y, -z]", "axes"},
                    Spoiled{"smoother", "reference:", "smoother: best\nreference:", "batch"},
                    Spoiled{"a forward pass too few", "reference:", "filter: {passes: 2}\nreference:", "passes"},
                    Spoiled{"what both filters would know", "reference:", "filter: {passes: 3}\nsmoother: combined\nreference:",
                            "a combined solution after 3 passes"},
                    Spoiled{"a vehicle that does not exist", "reference:", "vehicle: tram\nreference:", "tram"},
                    Spoiled{"an outage without end", "duration_s: 20", "duration_s: 0", "duration_s"},
                    Spoiled{"a start without its time",
                            "reference:", "start: {position_deg_m: [1, 2, 3]}\nreference:", "time_s"}),
    [](const testing::TestParamInfo<Spoiled>& spoiled) { return fmt::format("n{}", spoiled.index); });

TEST(Commands, BadInputIsStatusTwoAndUnwritableOutputStatusOne) {
  const test::TemporaryDirectory folder;
  const std::string here = folder.path().string();
  EXPECT_EQ(run(fmt::format("process '{}/none.yaml'", here), folder.path()).status, 2);
  EXPECT_EQ(run(fmt::format("process '{}'", here), folder.path()).status, 2);
  write(folder.path() / "empty.yaml", "");
  EXPECT_EQ(run(fmt::format("process '{}/empty.yaml'", here), folder.path()).status, 2);
  EXPECT_EQ(run("process", folder.path()).status, 2);
  EXPECT_EQ(run("procces x.yaml", folder.path()).status, 2);
  EXPECT_EQ(run("--help", folder.path()).status, 0);
  write(folder.path() / "file", "");
  const Outcome unwritable =
      run(fmt::format("process '{}' --out '{}/file/out'", (recording() / "run.yaml").string(), here), folder.path());
  EXPECT_EQ(unwritable.status, 1) << unwritable.error;
  EXPECT_NE(unwritable.error.find(here + "/file/out"), std::string::npos) << unwritable.error;
}

std::vector<fs::path> yaml_files(const char* folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / folder))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Load, SaysThatLeapSecondsHaveExpired) {
  const test::TemporaryDirectory folder;
  // 2099-12-31 in GPS weeks and in POSIX seconds; no table reaches that far.
  std::string imu = "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";
  for (int i = 0; i < 200; ++i) imu += fmt::format("{:.2f},0,0,0,0,0,-9.8\n", 345600.0 + 0.01 * i);
  write(folder.path() / "imu.csv", imu);
  write(folder.path() / "model.yaml", test::kTestModel);
  const auto events_of = [&](std::int64_t unix_s) {
    std::string gnss;
    for (int i = 0; i < 3; ++i) gnss += fmt::format("{},46.5,6.5,400\n", unix_s + i);
    write(folder.path() / "gnss.csv", gnss);
    write(
        folder.path() / "run.yaml",
        "imu: {file: imu.csv, gps_week: 6260, error_model: model.yaml, lever_arm_m: [0, 0, 0]}\n"
        "gnss: {file: gnss.csv, format: csv, columns: {time: 1, position: [2, 3, 4]}, sd_m: [1, 1, 1], time: {kind: unix}}\n");
    return load(read_run_config(folder.path() / "run.yaml"), {}).inspection_events;
  };
  const auto expired = [](const record::Events& found) {
    return std::ranges::count_if(found, [](const record::Event& event) { return event.kind == "leap_seconds_expired"; });
  };
  EXPECT_EQ(expired(events_of(4102358400)), 1);
  EXPECT_EQ(expired(events_of(1577836800)), 0);  // 2020-01-01
}

TEST(Recordings, EveryShippedRunFileFitsItsRecording) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  for (const fs::path& file : yaml_files("recordings")) {
    if (file.stem().string().ends_with("-imu")) continue;  // error models
    const RunConfig config = read_run_config(file);
    const Recordings recordings = load(config, {});
    EXPECT_GT(recordings.imu.samples.size(), 10000U) << file;
    EXPECT_FALSE(recordings.inspection.empty()) << file;
  }
}

// A consumer receiver at 20 Hz steps by decimetres and back; its clock agrees with the IMU's to the 0.1 s to which the data's
// publishers say so. The search for the offset had gone to 4.5 s on these two minutes.
TEST(Recordings, StepsOfAReceiverAreNoTimeOffset) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  constexpr double kWidePrior = 0.5;  // s
  const test::TemporaryDirectory folder;
  const std::string data = (*test::data_dir() / "rover-cpet-run3").string();
  ASSERT_EQ(
      std::system(fmt::format("gzip -dc '{}/imu.csv.gz' | head -n 24002 > '{}/imu.csv'", data, folder.path().string()).c_str()),
      0);
  write(folder.path() / "run.yaml",
        fmt::format(
            "imu: {{file: imu.csv, format: csv, gps_week: 2017, columns: {{time: 1, accel: [2, 3, 4], gyro: [5, 6, 7]}},\n"
            "      units: {{accel: m/s^2, gyro: rad/s}}, time: {{kind: elapsed, offset_s: 251024.31}}, axes: [-y, x, z],\n"
            "      error_model: '{}/configs/imu/icm20602.yaml', lever_arm_m: [-0.511, -0.156, 0.004]}}\n"
            "gnss: {{file: '{}/gps-latlong.txt.gz', format: csv, columns: {{time: 1, position: [2, 3, 4]}},\n"
            "       time: {{kind: unix}}, sd_m: [0.5, 0.5, 1.0]}}\n",
            COAST_SOURCE_DIR, data));
  const std::string here = folder.path().string();
  const Outcome outcome = run(fmt::format("process '{}/run.yaml' --out '{}/out'", here, here), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto summary = nlohmann::json::parse(text_of(folder.path() / "out" / "summary.json"));
  EXPECT_NEAR(summary["gnss"]["time_offset_s"].get<double>(), 0.0, kWidePrior);
}

// Figures of the first real run, with room for another machine's rounding: reference_runs/car-drive-0708 holds the numbers.
TEST(Recordings, CarDriveIsConsistentAndCoasts) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  const test::TemporaryDirectory folder;
  const fs::path file = fs::path(COAST_SOURCE_DIR) / "configs" / "recordings" / "car-drive-0708.yaml";
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", file.string(), (folder.path() / "out").string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto summary = nlohmann::json::parse(text_of(folder.path() / "out" / "summary.json"));
  test::expect_valid("summary", summary);
  ASSERT_FALSE(summary["events"].empty());  // its heights are above mean sea level, and that is said
  const double nis = summary["nis"]["mean"].get<double>() / summary["nis"]["expected"].get<double>();
  EXPECT_NEAR(nis, 1.0, 0.1);  // the consistency asked of a real recording
  // An independent optimal smoother reaches 0.11, 0.42, 0.96, 6.0 m, KF-GINS forward 2.0, 11, 32, 207 m (METHODS, same gaps).
  const auto& sweep = summary["outage_sweep"];
  ASSERT_EQ(sweep.size(), 4U);
  const std::array<double, 4> smoothed_limit{0.15, 0.6, 1.6, 8.0};
  const std::array<double, 4> forward_limit{2.0, 11.0, 32.0, 207.0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(sweep[i]["smoothed_horizontal_max_against_gnss"]["median_m"].get<double>(), smoothed_limit[i]) << i;
    EXPECT_LT(sweep[i]["forward_horizontal_max_against_gnss"]["median_m"].get<double>(), forward_limit[i]) << i;
  }
}

TEST(Commands, InspectSaysWhatIsInAFile) {
  const test::TemporaryDirectory folder;
  const Outcome gnss = run(fmt::format("inspect '{}'", (recording() / "gnss.pos").string()), folder.path());
  EXPECT_EQ(gnss.status, 0) << gnss.error;
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find("fixes over"), std::string::npos);
  const std::string imu = (recording() / "imu.csv").string();
  EXPECT_EQ(run(fmt::format("inspect '{}' --gps-week 2374", imu), folder.path()).status, 0);
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find("IMU: "), std::string::npos);
  EXPECT_EQ(run(fmt::format("inspect '{}'", (recording() / "run.yaml").string()), folder.path()).status, 0);
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find("as `coast process` reads them"), std::string::npos);
  write(folder.path() / "notes.txt", "Dear reader\n");
  const Outcome neither = run(fmt::format("inspect '{}'", (folder.path() / "notes.txt").string()), folder.path());
  EXPECT_EQ(neither.status, 2) << neither.error;
}

}  // namespace
}  // namespace coast::cli
