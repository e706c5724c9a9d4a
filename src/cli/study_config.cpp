#include "study_config.hpp"

#include <fmt/format.h>

#include "coast/io/yaml.hpp"

namespace coast::cli {

namespace {

using config::Node;

std::vector<study::NamedModel> named_models(const Node& root, std::string_view key) {
  std::vector<study::NamedModel> models;
  const auto list = root.find(key);
  if (!list) return models;
  for (const Node& item : list->items())
    models.push_back({item.at("name").text(), noise::ImuErrorModel::from(io::load_yaml(item.at("file").path()))});
  if (models.empty()) throw list->error("an empty list", "at least one {name: .., file: ..}");
  return models;
}

SweepStudy sweep_study(const Node& root) {
  SweepStudy study;
  study.run = read_run_config(root.at("run").path());
  study.sweep = sweep_from(root.at("sweep"), study.run);
  study.models = named_models(root, "error_models");
  if (study.models.empty()) study.models.push_back({study.run.setup.model.sensor_name(), study.run.setup.model});
  return study;
}

long at_least(const Node& seeds, std::string_view key, long low) {
  const Node node = seeds.at(key);
  const long value = node.integer();
  if (value < low) throw node.error(fmt::format("{}", value), fmt::format("a whole number of at least {}", low));
  return value;
}

std::vector<study::ElapsedOutage> elapsed_outages(const Node& root, double mission_s) {
  std::vector<study::ElapsedOutage> outages;
  const auto list = root.find("outages");
  if (!list) return outages;
  for (const Node& item : list->items()) {
    const study::ElapsedOutage outage{item.at("start_s").number(), item.at("duration_s").number()};
    if (!(outage.duration_s > 0.0)) throw item.at("duration_s").error("a duration of zero or less", "seconds above zero");
    if (!(outage.start_s > 0.0 && outage.start_s + outage.duration_s < mission_s))
      throw item.at("start_s").error(fmt::format("{:g} s to {:g} s", outage.start_s, outage.start_s + outage.duration_s),
                                     fmt::format("an outage within the scenario's {:g} s", mission_s),
                                     "start_s counts from the start of the scenario.");
    outages.push_back(outage);
  }
  return outages;
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
  plan.outages = elapsed_outages(root, plan.scenario.motion.duration);
  if (plan.outages.empty() && plan.scenario.outages.empty())
    throw root.error("no outage, neither here nor in the scenario", "outages: [{start_s: 200, duration_s: 20}]");

  std::vector<study::NamedModel> truths = named_models(root, "truths");
  if (truths.empty()) {
    if (!plan.scenario.error_model)
      throw scenario.error("a scenario without imu.error_model", "truths: [{name: .., file: ..}]");
    truths.push_back({plan.scenario.error_model->sensor_name(), *plan.scenario.error_model});
  }
  study.filters = named_models(root, "error_models");
  if (study.filters.empty()) study.filters = truths;
  for (const study::NamedModel& truth : truths) plan.cases.push_back({truth, study.filters});
  study.truths = truths.size();
  for (const study::NamedModel& floor : named_models(root, "floors")) plan.cases.push_back({floor, {floor}});
  return study;
}

}  // namespace

StudyConfig read_study(const std::filesystem::path& file) {
  const Node root = io::load_yaml(file);
  static_cast<void>(root.text("schema", "coast.study/1"));
  StudyConfig study;
  if (root.find("scenario"))
    study = ensemble_study(root);
  else
    study = sweep_study(root);
  root.refuse_unasked();
  return study;
}

}  // namespace coast::cli
