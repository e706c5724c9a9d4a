#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/fleet.hpp"
#include "common/indented.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/fleet.schema.json; a test holds them together.
constexpr std::string_view kFleetExample = R"(schema: coast.fleet/1
estimates: [2024/estimates.csv, 2025/estimates.csv]
groups: [firmware]
false_alarm_probability: 0.05
)";

using config::Node;

}  // namespace

std::string fleet_example(const std::string& indent) {
  return indented(kFleetExample, indent);
}

FleetConfig read_fleet(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".yaml" || extension == ".yml") return read_fleet(io::load_yaml(file));
  FleetConfig config;
  config.file = file;
  config.estimates = {file};
  io::note_read(file);
  return config;
}

FleetConfig read_fleet(const Node& root) {
  FleetConfig config;
  config.file = root.file();
  static_cast<void>(root.choice("schema", {"coast.fleet/1"}, 0));
  const Node estimates = root.at("estimates");
  if (estimates.is_list())
    for (const Node& item : estimates.items()) config.estimates.push_back(item.path());
  else
    config.estimates.push_back(estimates.path());
  if (config.estimates.empty()) throw estimates.error("an empty list", "the name of a table of estimates, or several");
  if (const auto groups = root.find("groups"))
    for (const Node& item : groups->items()) config.groups.push_back(item.text());
  config.options.false_alarm_probability = root.number_within("false_alarm_probability", 0.05, 0.001, 0.5);
  // A threshold of probability p / 2 needs at least some drawn fleets beyond it.
  config.options.simulations = static_cast<int>(root.number_within("simulations", 999, 99, 100000));
  root.refuse_unasked();
  for (const std::filesystem::path& file : config.estimates) io::note_read(file);
  return config;
}

}  // namespace coast::jobs
