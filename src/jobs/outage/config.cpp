#include "coast/jobs/outage.hpp"

#include <fmt/format.h>

#include "coast/io/yaml.hpp"
#include "run_file/run_config.hpp"

namespace coast::jobs {

namespace {

using config::Node;

study::NamedModel named_model(const Node& item) {
  return {item.at("name").text(), noise::ImuErrorModel::from(io::load_yaml(item.at("file").path()))};
}

/// @param read  one entry of the list
template <class Read>
auto models_of(const Node& root, std::string_view key, Read read) {
  std::vector<decltype(read(root))> models;
  const auto list = root.find(key);
  if (!list) return models;
  for (const Node& item : list->items()) models.push_back(read(item));
  if (models.empty()) throw list->error("an empty list", "at least one {name: .., file: ..}");
  return models;
}

SweepStudy sweep_study(const Node& root) {
  SweepStudy study;
  study.run = read_run_config(root.at("run").path());
  study.sweep = sweep_from(root.at("sweep"), study.run);
  study.models = models_of(root, "error_models", [](const Node& item) {
    SweepStudy::Model model{named_model(item), {}};
    if (item.find("noise")) model.noise_estimated = item.choice("noise", {"stated", "estimated"}, 0) == 1;
    return model;
  });
  if (study.models.empty()) study.models.push_back({{study.run.setup.model.sensor_name(), study.run.setup.model}, {}});
  return study;
}

long at_least(const Node& seeds, std::string_view key, long low) {
  const Node node = seeds.at(key);
  const long value = node.integer();
  if (value < low) throw node.error(fmt::format("{}", value), fmt::format("a whole number of at least {}", low));
  return value;
}

std::vector<study::OutageGroup> outages_from(const Node& list, double mission_s) {
  std::vector<study::OutageGroup> groups;
  for (const Node& item : list.items()) {
    const double start = item.at("start_s").number();
    const double duration = item.at("duration_s").number();
    if (!(duration > 0.0)) throw item.at("duration_s").error("a duration of zero or less", "seconds above zero");
    if (!(start > 0.0 && start + duration < mission_s))
      throw item.at("start_s").error(fmt::format("{:g} s to {:g} s", start, start + duration),
                                     fmt::format("an outage within the scenario's {:g} s", mission_s),
                                     "start_s counts from the start of the scenario.");
    groups.push_back({duration, {start}});
  }
  return groups;
}

std::vector<study::OutageGroup> groups_from(const Node& root, double mission_s) {
  const auto list = root.find("outages");
  const auto sweep = root.find("sweep");
  if (list && sweep) throw sweep->error("a sweep beside a list of outages", "one of the two");
  if (list) return outages_from(*list, mission_s);
  if (!sweep) return {};
  return study_groups(*sweep, mission_s);
}

study::NamedModel smoothed_model(const Node& item) {
  study::NamedModel model = named_model(item);
  if (item.choice("smoother", {"rts", "batch"}, 0) == 1) model.batch = estimate::BatchOptions{};
  return model;
}

EnsembleStudy ensemble_study(const Node& root) {
  EnsembleStudy study;
  const Node scenario = root.at("scenario");
  study.scenario = scenario.path();
  study::EnsemblePlan& plan = study.plan;
  plan.scenario = simulate::Scenario::from(io::load_yaml(study.scenario),
                                           [](const std::filesystem::path& file) { return io::load_yaml(file); });
  const Node seeds = root.at("seeds");
  plan.first_seed = static_cast<std::uint64_t>(at_least(seeds, "first", 0));
  plan.seeds = static_cast<std::size_t>(at_least(seeds, "count", 2));
  plan.groups = groups_from(root, plan.scenario.motion.duration);
  if (plan.groups.empty() && plan.scenario.outages.empty())
    throw root.error("no outage, neither here nor in the scenario", "outages: [{start_s: 200, duration_s: 20}]");

  std::vector<study::NamedModel> truths = models_of(root, "truths", named_model);
  if (truths.empty()) {
    if (!plan.scenario.error_model)
      throw scenario.error("a scenario without imu.error_model", "truths: [{name: .., file: ..}]");
    truths.push_back({plan.scenario.error_model->sensor_name(), *plan.scenario.error_model});
  }
  const std::vector<study::NamedModel> filters = models_of(root, "error_models", smoothed_model);
  for (const study::NamedModel& truth : truths) plan.cases.push_back({truth, filters.empty() ? std::vector{truth} : filters});
  study.truths = truths.size();
  study.filters = plan.cases.front().filters.size();
  for (const study::NamedModel& floor : models_of(root, "floors", named_model)) plan.cases.push_back({floor, {floor}});
  return study;
}

}  // namespace

std::vector<study::OutageGroup> study_groups(const Node& set, double mission_s) {
  if (set.is_list()) return outages_from(set, mission_s);
  std::vector<study::OutageGroup> groups = study::grouped(sweep_from(set), mission_s);
  if (groups.empty())
    throw set.error("no outage fits into the scenario", "durations of at most a quarter of it",
                    "Shorten durations_s or first_s.");
  return groups;
}

StudyConfig read_outage(const std::filesystem::path& file) {
  return read_outage(io::load_yaml(file));
}

StudyConfig read_outage(const Node& root) {
  static_cast<void>(root.text("schema", "coast.study/1"));
  StudyConfig study;
  if (root.find("scenario"))
    study = ensemble_study(root);
  else
    study = sweep_study(root);
  root.refuse_unasked();
  std::visit([&root](auto& config) { config.file = root.file(); }, study);
  return study;
}

const std::filesystem::path& file_of(const StudyConfig& config) {
  return std::visit([](const auto& of) -> const std::filesystem::path& { return of.file; }, config);
}

}  // namespace coast::jobs
