#include "coast/jobs/array_study.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coast/io/yaml.hpp"
#include "common/indented.hpp"
#include "synth/config.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/array_study.schema.json; a test holds them together.
constexpr std::string_view kArrayStudyExample = R"(schema: coast.array_study/1
kind: merges
runs: 100
samples: 20000
orders: [3, 2, 1, 1]
sensors:
  - {alpha: [0.6], gamma0: 2.0e-6, gamma: [0.1], delta: [0.85]}
  - {alpha: [0.5, 0.2], beta: [0.3], gamma0: 4.0e-6, gamma: [0.1], delta: [0.85]}
  - {alpha: [0.6], gamma0: 1.0e-5}
motion_rms: [0, 1.0]
scale_sd: 0.003
)";

using config::Node;

std::vector<double> numbers_at(const Node& node, std::string_view key) {
  const auto list = node.find(key);
  return list ? list->numbers() : std::vector<double>{};
}

noise::ArmaGarch model_from(const Node& node) {
  noise::ArmaGarch model;
  model.alpha = numbers_at(node, "alpha");
  model.beta = numbers_at(node, "beta");
  model.gamma0 = node.at("gamma0").number();
  model.gamma = numbers_at(node, "gamma");
  model.delta = numbers_at(node, "delta");
  if (const std::string defect = model.defect(); !defect.empty())
    throw node.error(defect, "a stationary, invertible model with a variance");
  return model;
}

std::vector<noise::ArmaGarch> models_from(const Node& list) {
  std::vector<noise::ArmaGarch> models;
  for (const Node& item : list.items()) models.push_back(model_from(item));
  if (models.size() < 2) throw list.error(fmt::format("{} sensors", models.size()), "two or more");
  return models;
}

noise::ArmaGarchOrders orders_from(const Node& root) {
  const auto list = root.find("orders");
  return list ? arma_garch_orders(*list) : noise::ArmaGarchOrders{3, 2, 1, 1};
}

std::size_t count_at(const Node& root, std::string_view key, long fallback, long low, long high) {
  const long value = root.integer(key, fallback);
  if (value < low || value > high)
    throw root.at(key).error(fmt::format("{}", value), fmt::format("a whole number from {} to {}", low, high));
  return static_cast<std::size_t>(value);
}

void read_merges(const Node& root, ArrayStudyConfig& config) {
  config.merges.sensors = models_from(root.at("sensors"));
  config.merges.scale_sd = root.number_within("scale_sd", 0.0, 0.0, 1.0);
  config.merges.dt = root.number_within("dt_s", 0.01, 1e-6, 1e3);
  config.merges.orders = orders_from(root);
  config.motions = numbers_at(root, "motion_rms");
  if (config.motions.empty()) config.motions.push_back(0.0);
  for (const double count : numbers_at(root, "use")) {
    if (count < 2.0 || count > static_cast<double>(config.merges.sensors.size()) || count != std::floor(count))
      throw root.at("use").error(fmt::format("{}", count), "numbers of sensors, from 2 to all of them");
    config.counts.push_back(static_cast<std::size_t>(count));
  }
  if (config.counts.empty()) config.counts.push_back(config.merges.sensors.size());
}

void read_outages(const Node& root, ArrayStudyConfig& config) {
  const auto tree = [](const std::filesystem::path& file) { return io::load_yaml(file); };
  study::ArrayOutagePlan& plan = config.outages.emplace();
  plan.scenario = simulate::Scenario::from(io::load_yaml(root.at("scenario").path()), tree);
  plan.slow = noise::ImuErrorModel::from(io::load_yaml(root.at("slow_errors").path()));
  plan.gyro = models_from(root.at("gyro"));
  plan.accel = models_from(root.at("accel"));
  plan.orders = orders_from(root);
  plan.first_seed = config.first_seed;
  plan.seeds = config.runs;
}

void read_defect_study(const Node& root, ArrayStudyConfig& config) {
  config.injections = count_at(root, "injections", 500, 1, 100000);
  config.defects.clean_hours = root.number_within("clean_hours", config.defects.clean_hours, 0.1, 1e4);
  config.defects.simulation.sensors = count_at(root, "sensor_count", 4, 3, 20);
  config.defects.detection.false_alarms_per_hour =
      root.number_within("false_alarms_per_hour", config.defects.detection.false_alarms_per_hour, 1e-6, 100.0);
}

}  // namespace

std::string array_study_example(const std::string& indent) {
  return indented(kArrayStudyExample, indent);
}

ArrayStudyConfig read_array_study(const std::filesystem::path& file) {
  return read_array_study(io::load_yaml(file));
}

ArrayStudyConfig read_array_study(const Node& root) {
  ArrayStudyConfig config;
  config.file = root.file();
  config.root = root;
  static_cast<void>(root.choice("schema", {"coast.array_study/1"}, 0));
  config.kind = static_cast<ArrayStudyKind>(root.at("kind").choice({"models", "merges", "outages", "defects"}));
  config.runs = count_at(root, "runs", 100, 1, 100000);
  config.first_seed = count_at(root, "first_seed", 1, 0, 2147483647);
  config.samples = count_at(root, "samples", 20000, 500, 10000000);
  switch (config.kind) {
    case ArrayStudyKind::kModels:
      config.model = model_from(root.at("model"));
      break;
    case ArrayStudyKind::kMerges:
      read_merges(root, config);
      break;
    case ArrayStudyKind::kOutages:
      read_outages(root, config);
      break;
    case ArrayStudyKind::kDefects:
      read_defect_study(root, config);
      break;
  }
  root.refuse_unasked();
  return config;
}

}  // namespace coast::jobs
