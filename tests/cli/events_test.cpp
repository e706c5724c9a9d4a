// Events of a run, and trajectories in other formats, as a user has them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/rinex.hpp"
#include "coast/study/interpolation.hpp"
#include "io/ubx_messages.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kDelay = 0.037;  // s
const Eigen::Vector3d kLeverArm(0.4, -0.1, 0.6);

/// A simulated drive with its truth, made once.
const fs::path& drive() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  return made;
}

record::Trajectory trajectory_of(const fs::path& file) {
  return io::read_reference(io::ReferenceFileOptions::of_file(file));
}

/// Where the camera of the simulated drive was.
Eigen::Vector3d camera_at(const record::Trajectory& truth, geo::GpsTime t) {
  const auto nav = study::state_at(truth, t);
  if (!nav) return Eigen::Vector3d::Zero();
  return nav->r_eb_e + nav->q_b_e * kLeverArm;
}

/// Images each 1.7 s whose times are early by the delay; their positions are those of the exposures, to a decimetre.
std::string images(const record::Trajectory& truth) {
  std::string text = "image,sow,lat,lon,h\n";
  int number = 0;
  for (double s = -3.0; s < 230.0; s += 1.7) {
    const geo::GpsTime t = truth.states.front().t + s;
    const Eigen::Vector3d r_e = camera_at(truth, t + kDelay);
    const geo::Geodetic p = r_e.isZero() ? geo::Geodetic{0.8, 0.1, 400.0} : geo::geodetic_from_ecef(r_e);
    text += fmt::format("IMG_{:04}.JPG,{:.6f},{:.6f},{:.6f},{:.1f}\n", ++number, t.sow(), p.latitude / geo::kDegree,
                        p.longitude / geo::kDegree, p.height);
  }
  return text;
}

std::string run_with(const std::string& events) {
  return text_of(drive() / "run.yaml") +
         "events:\n  file: images.csv\n  columns: {time: sow, id: image, position: [lat, lon, h]}\n" + events;
}

std::vector<std::vector<std::string>> csv_rows(const fs::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text_of(file));
  std::string line;
  while (std::getline(lines, line)) {
    std::vector<std::string>& row = rows.emplace_back();
    std::istringstream fields(line);
    std::string field;
    while (std::getline(fields, field, ',')) row.push_back(field);
  }
  return rows;
}

double at(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(rows[0], column);
  return found == rows[0].end() ? NAN : std::stod(rows[row].at(static_cast<std::size_t>(found - rows[0].begin())));
}

nlohmann::json event_of(const nlohmann::json& summary, const std::string& kind) {
  for (const auto& event : summary["events"])
    if (event["kind"] == kind) return event;
  return {};
}

/// Ways between events are on the grid what they are on the ground, times the combined scale, and turned by the convergence.
void expect_on_the_grid(const std::vector<std::vector<std::string>>& rows, const std::vector<std::vector<std::string>>& grid,
                        const nlohmann::json& start) {
  ASSERT_EQ(grid.size(), rows.size());
  const double convergence = start["convergence_deg"].get<double>() * geo::kDegree;
  for (std::size_t i = 2; i < rows.size(); ++i) {
    const auto place = [&](std::size_t row) {
      return Eigen::Vector3d(at(rows, row, "x_m"), at(rows, row, "y_m"), at(rows, row, "z_m"));
    };
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(place(i))).transpose();
    const Eigen::Vector3d way_n = C_e_n * (place(i) - place(i - 1));
    const Eigen::Vector2d way(at(grid, i, "easting_m") - at(grid, i - 1, "easting_m"),
                              at(grid, i, "northing_m") - at(grid, i - 1, "northing_m"));
    if (way.norm() < 5.0) continue;
    // Printed to 0.01 mm of 5 m at least; the datums of Switzerland and WGS 84 are inclined by 3e-5 rad to each other.
    EXPECT_NEAR(way.norm() / way_n.head<2>().norm(), start["combined_scale"].get<double>(), 2e-5) << i;
    const double turned = std::atan2(way_n.y(), way_n.x()) - std::atan2(way.x(), way.y());
    EXPECT_NEAR(std::remainder(turned - convergence, 2.0 * geo::kPi), 0.0, 3e-4) << i;  // 2 km to the east turn it by 2e-4
    EXPECT_NEAR(std::remainder(
                    at(grid, i, "heading_true_deg") - at(grid, i, "heading_grid_deg") - at(grid, i, "convergence_deg"), 360.0),
                0.0, 1e-8);
  }
}

TEST(Events, OfARunAreWhereTheCameraWas) {
  const record::Trajectory truth = trajectory_of(drive() / "truth.nav");
  write(drive() / "images.csv", images(truth));
  write(drive() / "events.yaml",
        run_with(fmt::format("  delay_s: {}\n  camera: {{lever_arm_m: [0.4, -0.1, 0.6], boresight_deg: [1, 30, -2]}}\n"
                             "output: {{projection: {{crs: EPSG:2056}}, formats: [nav, csv, grid, gpkg]}}\n",
                             kDelay)));
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", (drive() / "events.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto rows = csv_rows(out / "events.csv");
  ASSERT_GT(rows.size(), 120U);
  const Eigen::Matrix3d C_s_b = geo::dcm_from_euler({1.0 * geo::kDegree, 30.0 * geo::kDegree, -2.0 * geo::kDegree});
  double squares = 0.0, normalised = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const geo::GpsTime t = geo::GpsTime::from_week(static_cast<int>(at(rows, i, "gps_week")), at(rows, i, "sow_s"));
    const Eigen::Vector3d r_e(at(rows, i, "x_m"), at(rows, i, "y_m"), at(rows, i, "z_m"));
    const auto nav = study::state_at(truth, t);
    ASSERT_TRUE(nav) << rows[i][0];
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(nav->r_eb_e)).transpose();
    const Eigen::Vector3d error_n = C_e_n * (r_e - camera_at(truth, t));
    const Eigen::Vector3d sd(at(rows, i, "sdn_m"), at(rows, i, "sde_m"), at(rows, i, "sdd_m"));
    squares += error_n.squaredNorm();
    normalised += error_n.cwiseQuotient(sd).squaredNorm();
    const geo::Euler attitude = geo::euler_from_dcm(C_e_n * nav->q_b_e.toRotationMatrix() * C_s_b);
    EXPECT_NEAR(at(rows, i, "pitch_deg"), attitude.pitch / geo::kDegree, 0.1) << rows[i][0];
    EXPECT_NEAR(geo::wrap_angle(at(rows, i, "yaw_deg") * geo::kDegree - attitude.yaw) / geo::kDegree, 0.0, 1.5) << rows[i][0];
  }
  const double n = static_cast<double>(rows.size() - 1);
  EXPECT_LT(std::sqrt(squares / n), 0.03);  // fixes of 1, 1 and 2 cm at 2 Hz; without the delay 0.037 s would be 40 cm
  EXPECT_GT(normalised / (3.0 * n), 0.2);   // errors are correlated over the drive: a chi-square of few degrees of freedom
  EXPECT_LT(normalised / (3.0 * n), 3.0);

  const auto summary = nlohmann::json::parse(text_of(out / "summary.json"));
  test::expect_valid("summary", summary);
  test::expect_valid("run", test::load_yaml_as_json(drive() / "events.yaml"));
  EXPECT_EQ(summary["time_marks"]["located"], rows.size() - 1);
  EXPECT_EQ(event_of(summary, "event_before_trajectory")["count"].get<long>() +
                event_of(summary, "event_after_trajectory")["count"].get<long>(),
            summary["time_marks"]["missed"].get<long>());
  const auto& delay = summary["time_marks"]["delay_found"];
  EXPECT_LT(std::abs(delay["beyond_stated_s"].get<double>()), 4.0 * delay["sd_s"].get<double>());
  EXPECT_EQ(csv_rows(out / "events_opk.csv").size(), rows.size());
  expect_on_the_grid(rows, csv_rows(out / "events_grid.csv"), summary["projection"]["start"]);
  EXPECT_EQ(csv_rows(out / "events_exif.csv").size(), rows.size());
  EXPECT_EQ(csv_rows(out / "trajectory.grid.csv").size(), csv_rows(out / "trajectory.csv").size());
  EXPECT_TRUE(text_of(out / "trajectory.gpkg").starts_with("SQLite format 3"));
  const std::string geo_txt = text_of(out / "geo.txt");
  EXPECT_EQ(std::ranges::count(geo_txt, '\n'), static_cast<long>(rows.size()));

  const fs::path again = folder.path() / "again";
  ASSERT_EQ(
      run(fmt::format("process '{}' --out '{}'", (out / "run.resolved.yaml").string(), again.string()), folder.path()).status,
      0);
  EXPECT_EQ(text_of(out / "events.csv"), text_of(again / "events.csv"));
  EXPECT_EQ(text_of(out / "trajectory.grid.csv"), text_of(again / "trajectory.grid.csv"));
}

TEST(Events, ADelayThatIsNotStatedIsFoundAndToldWithTheLineToWrite) {
  write(drive() / "images.csv", images(trajectory_of(drive() / "truth.nav")));
  write(drive() / "late.yaml", run_with("  delay_s: 0.01\n  camera: {lever_arm_m: [0.4, -0.1, 0.6]}\n"));
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", (drive() / "late.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto summary = nlohmann::json::parse(text_of(out / "summary.json"));
  const auto& delay = summary["time_marks"]["delay_found"];
  // Positions are rounded to 1e-6 deg, some 3 cm of noise, with 10 m/s and 130 images: below a millisecond.
  EXPECT_LT(delay["sd_s"].get<double>(), 1e-3);
  EXPECT_NEAR(delay["beyond_stated_s"].get<double>(), kDelay - 0.01, 4.0 * delay["sd_s"].get<double>() + 1e-3);
  const auto event = event_of(summary, "event_delay");
  EXPECT_EQ(event["severity"], "warning");
  EXPECT_NE(event["text"].get<std::string>().find("write `events: {delay_s: 0.03"), std::string::npos) << event;
}

TEST(Events, KeysThatAreWrongNameTheirLine) {
  const test::TemporaryDirectory folder;
  write(drive() / "images.csv", "image,sow,lat,lon,h\na,1,2,3,4\n");
  for (const auto& [keys, says] : {std::pair<const char*, const char*>{"  delay: 0.1\n", "delay_s"},
                                   {"  delay_s: 12\n", "-10"},
                                   {"  delay_s: soon\n", "a finite number"},
                                   {"  camera: {lever_arm: [0, 0, 0]}\n", "lever_arm_m"},
                                   {"  camera: {lever_arm_m: [0, 0]}\n", "three"},
                                   {"  camera: {boresight_deg: [0, 100, 0]}\n", "pitch in [-90, 90]"},
                                   {"  edge: both\n", "rising"},
                                   {"  frame: utm\n", "utm_zone"}}) {
    write(drive() / "wrong.yaml", run_with(keys));
    const Outcome outcome =
        run(fmt::format("process '{}' --out '{}'", (drive() / "wrong.yaml").string(), (folder.path() / "out").string()),
            folder.path());
    EXPECT_EQ(outcome.status, 2) << keys;
    EXPECT_NE(outcome.error.find("wrong.yaml:"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find(says), std::string::npos) << keys << outcome.error;
  }
}

TEST(Convert, EveryFormatFromATrajectoryAndBack) {
  const test::TemporaryDirectory folder;
  const auto convert = [&](const std::string& arguments) { return run(fmt::format("convert {}", arguments), folder.path()); };
  const std::string truth = fmt::format("'{}'", (drive() / "truth.nav").string());
  const auto to = [&](const char* name) { return fmt::format("'{}'", (folder.path() / name).string()); };
  for (const char* format : {"nav", "csv", "sbet", "kml", "gpx", "geojson", "nmea", "tum", "kitti"}) {
    const Outcome outcome = convert(truth + " " + to(fmt::format("a.{}", format).c_str()));
    EXPECT_EQ(outcome.status, 0) << format << outcome.error;
    EXPECT_GT(fs::file_size(folder.path() / fmt::format("a.{}", format)), 1000U) << format;
  }
  EXPECT_FALSE(fs::exists(folder.path() / "a.smrmsg"));
  EXPECT_TRUE(fs::exists(folder.path() / "a.times"));
  // nav -> sbet -> csv -> nav: to the digits of the file.
  EXPECT_EQ(convert(to("a.sbet") + " " + to("b.csv") + " --gps-week 2374").status, 0);
  EXPECT_EQ(convert(to("b.csv") + " " + to("poses.txt") + " --to nav").status, 0);
  EXPECT_EQ(text_of(folder.path() / "poses.txt"), text_of(folder.path() / "a.nav"));
  EXPECT_EQ(convert(truth + " " + to("slow.nav") + " --rate 1").status, 0);
  const record::Trajectory slow = trajectory_of(folder.path() / "slow.nav"), all = trajectory_of(drive() / "truth.nav");
  EXPECT_NEAR(static_cast<double>(slow.states.size()), all.states.back().t - all.states.front().t, 1.5);
}

TEST(Convert, WritesWhatAReceiverRecorded) {
  const test::TemporaryDirectory folder;
  std::string log;
  for (unsigned i = 0; i < 5; ++i) log += test::rawx(2244, 36'000.0 + i, {{.sv = 5, .phase = 110'000'000.25 + i}});
  write(folder.path() / "rover.ubx", log);
  const auto convert = [&](const char* name, const char* options = "") {
    const std::string place = folder.path().string();
    return run(fmt::format("convert '{}/rover.ubx' '{}/{}' {}", place, place, name, options), folder.path());
  };
  const Outcome outcome = convert("out.obs");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find("out.obs: observations\n"), std::string::npos);
  EXPECT_EQ(io::read_observations(folder.path() / "out.obs").epochs.size(), 5U);
  EXPECT_EQ(convert("again", "--to rinex").status, 0);
  EXPECT_EQ(text_of(folder.path() / "again.obs"), text_of(folder.path() / "out.obs"));
  const Outcome refused = convert("out.pos");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.error.find("observations, nothing that pos files contain, expected --to rinex"), std::string::npos)
      << refused.error;
}

TEST(Convert, SaysWhatItCannotDo) {
  const test::TemporaryDirectory folder;
  write(folder.path() / "places.csv", "time_s,lat_deg,lon_deg,height_m\n1,46,7,400\n2,46,7.00001,400\n");
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = run(fmt::format("convert {}", arguments), folder.path());
    EXPECT_EQ(outcome.status, 2) << arguments;
    return outcome.error;
  };
  const std::string places = fmt::format("'{}'", (folder.path() / "places.csv").string());
  const auto to = [&](const char* name) { return fmt::format("'{}'", (folder.path() / name).string()); };
  EXPECT_NE(refused(places + " " + to("a.kmz")).find("Do you mean kml?"), std::string::npos);
  EXPECT_NE(refused(places + " " + to("a")).find("--to"), std::string::npos);
  EXPECT_NE(refused(places + " " + to("a.gpx")).find("GPS week"), std::string::npos);
  EXPECT_NE(refused(places + " " + to("a.tum") + " --gps-week 2374")
                .find("no attitude, which tum files contain, expected one of kml, gpx, geojson"),
            std::string::npos);
  EXPECT_NE(refused(places + " " + to("a.sbet") + " --gps-week 2374").find("no velocity"), std::string::npos);
  EXPECT_NE(refused(places + " " + places + " --gps-week 2374").find("the output is the input"), std::string::npos);
  EXPECT_NE(refused(fmt::format("'{}' {}", (drive() / "truth.nav").string(), to("a.pos"))).find("standard deviations"),
            std::string::npos);
  EXPECT_EQ(run(fmt::format("convert {} {} --gps-week 2374", places, to("a.gpx")), folder.path()).status, 0);
}

}  // namespace
}  // namespace coast::cli
