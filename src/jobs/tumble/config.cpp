#include <fmt/format.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/tumble.hpp"
#include "common/indented.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/tumble.schema.json; a test holds them together.
constexpr std::string_view kTumbleExample = R"(schema: coast.tumble/1
sensor: Xsens MTi
imu: {file: tumble.csv, columns: {time: 1, accel: [2, 3, 4], gyro: [5, 6, 7]}, units: {gyro: deg/s, accel: g}, time: {kind: elapsed}}
place: {latitude_deg: 45.41, height_m: 60}
)";

using config::Node;

void read_place(const Node& root, TumbleConfig& config) {
  const auto stated = root.find("gravity_mps2");
  if (stated) {
    config.options.gravity = root.number_within("gravity_mps2", 9.80665, 9.7, 9.9);
    config.options.gravity_sd = 1e-5;
    config.gravity_from = "stated";
  }
  if (!root.find("place")) {
    if (!stated)
      config.gravity_from = "unknown place: that of 45 deg of latitude +- 0.015 m/s^2; state `place` or `gravity_mps2`";
    return;
  }
  const Node place = root.at("place");
  static_cast<void>(place.at("latitude_deg"));  // it has no default
  geo::Geodetic at;
  at.latitude = geo::kDegree * place.number_within("latitude_deg", 0.0, -90.0, 90.0);
  at.height = place.number_within("height_m", 0.0, -500.0, 10000.0);
  config.options.latitude = at.latitude;
  if (stated) return;
  config.options.gravity = geo::gravity_e(geo::ecef_from_geodetic(at)).norm();
  // Anomalies of the true field, and a height that is not told: 100 m are 3e-4 m/s^2.
  config.options.gravity_sd = place.find("height_m") ? 3e-4 : 1e-3;
  config.gravity_from = "normal gravity of the place";
}

}  // namespace

std::string tumble_example(const std::string& indent) {
  return indented(kTumbleExample, indent);
}

TumbleConfig read_tumble(const std::filesystem::path& file) {
  return read_tumble(io::load_yaml(file));
}

TumbleConfig read_tumble(const Node& root) {
  TumbleConfig config;
  config.file = root.file();
  static_cast<void>(root.choice("schema", {"coast.tumble/1"}, 0));
  config.sensor = root.text("sensor", config.file.stem().string());
  config.imu = io::ImuFileOptions::from(root.at("imu"));
  read_place(root, config);
  root.refuse_unasked();
  io::note_read(config.imu.file);
  return config;
}

}  // namespace coast::jobs
