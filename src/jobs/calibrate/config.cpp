#include "coast/jobs/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/geo/units.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/yaml.hpp"
#include "common/indented.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/calibration_run.schema.json; a test holds them together.
constexpr std::string_view kCalibrationExample = R"(schema: coast.calibration_run/1
sensor: Analog Devices ADIS16405
records:
  - {file: static1.csv, from_s: 60}
  - {file: static2.csv.gz, columns: {time: 1, gyro: [2, 3, 4], accel: [5, 6, 7]}, units: {gyro: deg/s, accel: g}}
tested_on:
  - {file: static3.csv}
processes: {accel: {sum: [white_noise, gauss_markov, random_walk], drift: false}}
turn_on_bias: {gyro: {sigma: 3, unit: deg/s}}
)";

using config::Node;
using noise::Sensor;

std::vector<SensorAxis> all_axes() {
  std::vector<SensorAxis> axes;
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel})
    for (int axis = 0; axis < 3; ++axis) axes.push_back({sensor, axis});
  return axes;
}

std::vector<SensorAxis> axes_from(const Node& root) {
  const auto list = root.find("axes");
  if (!list) return all_axes();
  std::array<bool, 6> named{};
  for (const Node& item : list->items())
    named[item.choice({"gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"})] = true;
  std::vector<SensorAxis> axes = all_axes();
  std::erase_if(axes, [&](const SensorAxis& a) {
    return !named[static_cast<std::size_t>(a.axis) + (a.sensor == Sensor::kGyro ? 0U : 3U)];
  });
  if (axes.empty()) throw list->error("an empty list", "some of gyro_x, gyro_y, gyro_z, accel_x, accel_y, accel_z");
  return axes;
}

CalibrationRecord record_from(const Node& node) {
  CalibrationRecord record{io::ImuFileOptions::from(node), {}};
  if (node.find("from_s")) record.part.from_s = node.number_within("from_s", 0.0, 0.0, 1e9);
  if (const auto to = node.find("to_s")) {
    record.part.to_s = node.number_within("to_s", 0.0, 0.0, 1e9);
    if (*record.part.to_s <= record.part.from_s.value_or(0.0)) throw to->error(to->text(), "a time after from_s");
  }
  return record;
}

std::vector<std::string> estimable_names() {
  std::vector<std::string> names;
  for (const noise::Registration& r : noise::registry()) {
    if (r.estimable == nullptr) continue;
    if (r.name == "ar")  // has an order
      for (int order = 1; order <= 4; ++order) names.push_back(fmt::format("ar({})", order));
    else
      names.emplace_back(r.name);
  }
  return names;
}

// A stated sum instead of the model search.
void read_sum(const Node& node, CalibrationConfig::PerSensor& sensor) {
  const std::vector<std::string> names = estimable_names();
  const std::vector<std::string_view> known(names.begin(), names.end());
  const Node sum = node.at("sum");
  for (const Node& item : sum.items()) sensor.processes.push_back(names[item.choice(known)]);
  if (sensor.processes.empty()) throw sum.error("an empty list", "names of processes: white_noise, gauss_markov, ...");
  sensor.mean = node.flag("drift", true) ? noise::Mean::kLevelAndDrift : noise::Mean::kLevel;
}

double sigma_from(const Node& node, Sensor sensor) {
  const Node sigma = node.at("sigma");
  const Node unit = node.at("unit");
  const auto dimension = sensor == Sensor::kGyro ? geo::Dimension::kAngularRate : geo::Dimension::kSpecificForce;
  if (!(sigma.number() > 0.0)) throw sigma.error(sigma.text(), "a standard deviation above zero");
  try {
    return geo::to_si(sigma.number(), unit.text(), dimension);
  } catch (const std::invalid_argument& error) {
    throw unit.error(error.what(), sensor == Sensor::kGyro ? "a unit like deg/s" : "a unit like mg");
  }
}

int count_within(const Node& root, std::string_view key, long fallback, long low, long high) {
  const long value = root.integer(key, fallback);
  if (value < low || value > high)
    throw root.at(key).error(fmt::format("{}", value), fmt::format("a whole number from {} to {}", low, high));
  return static_cast<int>(value);
}

noise::CalibrationOptions options_from(const Node& root) {
  noise::CalibrationOptions options;
  options.most_gauss_markov = count_within(root, "most_gauss_markov", options.most_gauss_markov, 0, 6);
  options.criterion = static_cast<noise::Criterion>(root.choice("criterion", {"bic", "aicc", "held_out"}, 0));
  options.held_out = root.flag("held_out", false);
  options.outliers = static_cast<noise::Outliers>(root.choice("outliers", {"where_they_matter", "keep", "exclude"}, 0));
  options.realisations = count_within(root, "realisations", options.realisations, 0, 100000);
  options.bootstrap = count_within(root, "bootstrap", 0, 0, 100000);
  options.seed = static_cast<std::uint64_t>(count_within(root, "seed", 1, 0, 2147483647));
  return options;
}

}  // namespace

CalibrationConfig read_calibrate(const Node& root) {
  CalibrationConfig config;
  config.file = root.file();
  static_cast<void>(root.choice("schema", {"coast.calibration_run/1"}, 0));
  const Node records = root.at("records");
  for (const Node& item : records.items()) config.records.push_back(record_from(item));
  if (config.records.empty()) throw records.error("an empty list", "at least one {file: ..}");
  if (const auto others = root.find("tested_on"))
    for (const Node& item : others->items()) config.tested_on.push_back(record_from(item));
  config.sensor = root.text("sensor", config.file.stem().string());
  config.axes = axes_from(root);
  config.common = options_from(root);
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel}) {
    CalibrationConfig::PerSensor& own = config.sensors[sensor == Sensor::kGyro ? 0 : 1];
    const char* name = sensor == Sensor::kGyro ? "gyro" : "accel";
    if (const auto processes = root.find("processes"))
      if (const auto stated = processes->find(name)) read_sum(*stated, own);
    if (const auto bias = root.find("turn_on_bias"))
      if (const auto stated = bias->find(name)) own.turn_on_bias = sigma_from(*stated, sensor);
  }
  root.refuse_unasked();
  for (const auto* list : {&config.records, &config.tested_on})
    for (const CalibrationRecord& record : *list) io::note_read(record.file.file);
  return config;
}

std::string calibration_example(const std::string& indent) {
  return indented(kCalibrationExample, indent);
}

std::string SensorAxis::title() const {
  return fmt::format("{} {}", sensor == Sensor::kGyro ? "Gyro" : "Accelerometer", axis_name());
}

noise::CalibrationOptions CalibrationConfig::options(Sensor which) const {
  noise::CalibrationOptions options = common;
  options.sensor = which;
  options.processes = of(which).processes;
  options.mean = of(which).mean;
  return options;
}

CalibrationConfig read_calibrate(const std::filesystem::path& input) {
  const std::string extension = input.extension().string();
  if (extension == ".yaml" || extension == ".yml" || std::filesystem::is_directory(input))
    return read_calibrate(io::load_yaml(input));
  CalibrationConfig config;
  config.file = input;
  config.sensor = input.stem().string();
  config.axes = all_axes();
  config.records.emplace_back().file.file = input;
  io::note_read(input);
  return config;
}

}  // namespace coast::jobs
