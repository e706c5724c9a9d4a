#include "synth/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "coast/array/extended.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/yaml.hpp"
#include "common/indented.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/array.schema.json; a test holds them together.
constexpr std::string_view kArrayExample = R"(schema: coast.array/1
imus:
  - {name: left, file: left.csv, gps_week: 2190, position_m: [0.05, -0.10, 0.0]}
  - {name: right, file: right.csv, gps_week: 2190, axes: [x, -y, -z], mounting_deg: [0, 0, 1.5], position_m: [0.05, 0.10, 0.0]}
  - {name: top, file: top.csv.gz, gps_week: 2190, position_m: [0.0, 0.0, -0.08]}
time: {by: tags, signals: true}
mounting: {refine: true, rotation_sd_deg: 5, position_sd_m: 0.02}
defects: {find: true, false_alarms_per_hour: 0.1, recovery_s: 5}
merge: {method: corrected, orders: [3, 2, 1, 1]}
)";

constexpr std::array<std::string_view, 5> kMerges{"mean", "weighted", "garch", "corrected", "extended"};

using config::Node;

array::SensorFrame frame_from(const Node& imu) {
  array::SensorFrame frame;
  frame.C_s_b = ins::C_s_b(ins::MountingOptions::from(imu));
  frame.r_b = imu.vector3("position_m", Eigen::Vector3d::Zero());
  return frame;
}

array::Counting counting_from(const Node& imu) {
  array::Counting counting;
  const Node map = imu.at("counter");
  counting.interval_s = map.number_within("interval_s", 0.01, 1e-5, 10.0);
  if (map.find("modulus")) {
    const long modulus = map.integer("modulus", 0);
    if (modulus < 2) throw map.at("modulus").error(fmt::format("{}", modulus), "2 or more: the counter goes up to one less");
    counting.modulus = modulus;
  }
  return counting;
}

ArrayImu imu_from(const Node& node, TimeSource time, std::size_t index) {
  ArrayImu imu;
  imu.name = node.text("name", fmt::format("imu{}", index + 1));
  if (time == TimeSource::kTags) {
    imu.file = io::ImuFileOptions::from(node);
  } else {
    imu.file = io::PacketFileOptions::from(node);
    imu.counting = counting_from(node);
  }
  imu.frame = frame_from(node);
  if (const auto model = node.find("error_model")) imu.model = noise::ImuErrorModel::from(io::load_yaml(model->path()));
  return imu;
}

void read_time(const Node& root, ArrayConfig& config) {
  const Node time = root.section("time");
  config.time = static_cast<TimeSource>(time.choice("by", {"tags", "packets", "pulses"}, 0));
  if (!time.flag("signals", true)) {
    config.assembly.lags.reset();
  } else {
    config.assembly.lags->max_lag_s = time.number_within("max_lag_s", config.assembly.lags->max_lag_s, 1e-3, 10.0);
    config.assembly.lags->window_s = time.number_within("window_s", config.assembly.lags->window_s, 5.0, 1e5);
  }
  if (config.time == TimeSource::kTags) return;
  config.week = static_cast<int>(time.at("gps_week").integer());
  if (config.week < 0 || config.week > 9999) throw time.at("gps_week").error(fmt::format("{}", config.week), "a GPS week");
  if (config.time == TimeSource::kPulses) {
    const Node pulses = time.at("pulses");
    config.pulses.first_s = pulses.at("first_s").number();
    config.pulses.period_s = pulses.number_within("period_s", 1.0, 1e-4, 1e5);
  }
}

void read_master(const Node& root, ArrayConfig& config) {
  if (config.time != TimeSource::kPackets) return;
  const Node master = root.at("time").at("master");
  const std::string name = master.text();
  const auto found = std::ranges::find(config.imus, name, &ArrayImu::name);
  if (found == config.imus.end()) throw master.error(name, "the name of one of the imus");
  config.master = static_cast<std::size_t>(found - config.imus.begin());
  if (std::get<io::PacketFileOptions>(found->file).gps.empty())
    throw master.error(fmt::format("{} has no column `gps`", name), "an IMU whose packets carry GPS time");
}

void read_imus(const Node& root, ArrayConfig& config) {
  const Node list = root.at("imus");
  for (const Node& item : list.items()) {
    config.imus.push_back(imu_from(item, config.time, config.imus.size()));
    const std::string& name = config.imus.back().name;
    if (name.empty() || name.find_first_of(",;\t\"") != std::string::npos || name.front() == ' ' || name.back() == ' ')
      throw item.at("name").error("'" + name + "'",
                                  "a name without commas, semicolons, tabs and double quotes: it stands in tables");
    if (std::ranges::count(config.imus, name, &ArrayImu::name) > 1) throw item.error(name, "a name of its own for each IMU");
  }
  if (config.imus.size() < 2) throw list.error(fmt::format("{} IMUs", config.imus.size()), "two or more");
}

void read_mounting(const Node& root, ArrayConfig& config) {
  const Node mounting = root.section("mounting");
  if (!mounting.flag("refine", false)) return;
  array::MountingOptions options;
  options.rotation_sd =
      geo::kDegree * mounting.number_within("rotation_sd_deg", options.rotation_sd / geo::kDegree, 1e-6, 90.0);
  options.position_sd_m = mounting.number_within("position_sd_m", options.position_sd_m, 1e-6, 100.0);
  options.block_s = mounting.number_within("block_s", options.block_s, 1e-3, 10.0);
  config.assembly.mounting = options;
}

void read_defects(const Node& root, ArrayConfig& config) {
  const Node defects = root.section("defects");
  if (!defects.flag("find", true)) {
    config.assembly.defects.reset();
    return;
  }
  array::DefectOptions& options = *config.assembly.defects;
  options.false_alarms_per_hour = defects.number_within("false_alarms_per_hour", options.false_alarms_per_hour, 1e-6, 100.0);
  options.recovery_s = defects.number_within("recovery_s", options.recovery_s, 0.5, 1e5);
}

void read_orders(const Node& merge, array::MergeOptions& options) {
  const auto orders = merge.find("orders");
  if (!orders) return;
  options.choose_orders = orders->is_scalar();
  if (options.choose_orders)
    static_cast<void>(orders->choice({"auto"}));
  else
    options.orders = arma_garch_orders(*orders);
}

void check_models(const Node& method, const ArrayConfig& config) {
  std::vector<array::ModelledSensor> sensors;
  for (const ArrayImu& imu : config.imus) {
    if (!imu.model)
      throw method.error(fmt::format("extended, and no error_model of {}", imu.name),
                         "`error_model` of every IMU: its own error states are made of it");
    sensors.push_back({imu.name, &*imu.model, imu.frame.C_s_b});
  }
  try {
    static_cast<void>(array::extended_error_model("", 1.0, sensors));
  } catch (const std::invalid_argument& error) {
    throw method.error(error.what(), "IMUs that can have error states of their own", "`corrected` and `weighted` take any.");
  }
}

void read_merge(const Node& root, ArrayConfig& config) {
  const Node merge = root.section("merge");
  const std::vector<std::string_view> names(kMerges.begin(), kMerges.end());
  config.merge.merge = static_cast<array::Merge>(merge.choice("method", names, 1));
  if (config.merge.merge == array::Merge::kExtended) check_models(merge.at("method"), config);
  read_orders(merge, config.merge);
  config.merge.window_s = merge.number_within("window_s", config.merge.window_s, 0.1, 1e5);
  config.assembly.offset_window_s = merge.number_within("offset_window_s", config.assembly.offset_window_s, 1.0, 1e6);
}

}  // namespace

noise::ArmaGarchOrders arma_garch_orders(const Node& list) {
  constexpr long kHighest = 9;
  std::array<int, 4> values{};
  const std::vector<Node> items = list.items();
  if (items.size() != values.size()) throw list.error(fmt::format("{} numbers", items.size()), "four orders: d, h, p, q");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const long value = items[i].integer();
    if (value < 0 || value > kHighest) throw items[i].error(fmt::format("{}", value), "an order from 0 to 9");
    values[i] = static_cast<int>(value);
  }
  if (values[3] > 0 && values[2] == 0) throw list.error("q without p", "a GARCH(p,q) with p of 1 or more");
  return {values[0], values[1], values[2], values[3]};
}

std::string_view merge_name(array::Merge merge) {
  return kMerges[static_cast<std::size_t>(merge)];
}

std::string array_example(const std::string& indent) {
  return indented(kArrayExample, indent);
}

ArrayConfig read_synth(const std::filesystem::path& file) {
  return read_synth(io::load_yaml(file));
}

ArrayConfig read_synth(const Node& root) {
  ArrayConfig config;
  config.file = root.file();
  config.root = root;
  static_cast<void>(root.choice("schema", {"coast.array/1"}, 0));
  read_time(root, config);
  read_imus(root, config);
  read_master(root, config);
  read_mounting(root, config);
  read_defects(root, config);
  read_merge(root, config);
  if (root.find("rate_hz")) config.assembly.rate_hz = root.number_within("rate_hz", 100.0, 0.1, 1e5);
  if (const auto reference = root.find("reference")) config.reference = io::ImuFileOptions::from(*reference);
  root.refuse_unasked();
  for (const ArrayImu& imu : config.imus)  // also those of an earlier coast job are not to be overwritten
    std::visit([](const auto& recording) { io::note_read(recording.file); }, imu.file);
  return config;
}

}  // namespace coast::jobs
