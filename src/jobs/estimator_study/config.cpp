#include "coast/jobs/estimator_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/io/yaml.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "coast/noise/partial_autocorrelation.hpp"
#include "common/indented.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/estimator_study.schema.json; a test holds them together.
constexpr std::string_view kStudyExample = R"(schema: coast.estimator_study/1
truth:
  processes: [{process: white_noise, density: 0.09}, {process: gauss_markov, beta: 0.008, sigma2: 0.25}]
  slope: 1e-4
interval_s: 1
samples: 6000
runs: 200
estimators:
  - {name: default, kind: default, intervals: true}
  - {name: EM, kind: em, start: [{process: white_noise, density: 0.5}, {process: gauss_markov, beta: 0.1, sigma2: 0.1}]}
choices: [{sum: [white_noise, gauss_markov]}, {sum: [white_noise, gauss_markov, random_walk]}]
)";

using config::Node;
using noise::Estimable;
using noise::Mean;

/// Processes with their parameters, for the truth and for starts.
struct ValuedProcesses {
  std::vector<const Estimable*> processes;
  std::vector<double> u;
};

std::size_t known_process(const Node& node) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const noise::Registration& r : noise::registry())
      if (r.estimable != nullptr) all.emplace_back(r.name);
    return all;
  }();
  const std::size_t which = node.choice(std::vector<std::string_view>(names.begin(), names.end()));
  const auto found = std::ranges::find(noise::registry(), std::string_view(names[which]), &noise::Registration::name);
  return static_cast<std::size_t>(found - noise::registry().begin());
}

double positive(const Node& node) {
  if (!(node.number() > 0.0)) throw node.error(node.text(), "a number above zero");
  return node.number();
}

/// The coefficients of an autoregression instead of its partial autocorrelations.
const Estimable& autoregression(const Node& entry, std::vector<double>& u) {
  constexpr std::size_t kHighest = 4;
  const Node node = entry.at("coefficients");
  const std::vector<double> coefficients = node.numbers();
  if (coefficients.empty() || coefficients.size() > kHighest)
    throw node.error(fmt::format("{} coefficients", coefficients.size()), fmt::format("1 to {}", kHighest));
  const auto partial = noise::partial_autocorrelations(coefficients);
  if (!partial) throw node.error("a series that is not stationary", "poles inside the unit circle");
  for (const double value : *partial) u.push_back(std::atanh(value));
  u.push_back(std::log(positive(entry.at("innovation2"))));
  return noise::estimable(fmt::format("ar({})", coefficients.size()));
}

ValuedProcesses valued_processes(const Node& list, double interval) {
  ValuedProcesses sum;
  for (const Node& entry : list.items()) {
    const noise::Registration& found = noise::registry()[known_process(entry.at("process"))];
    if (found.name == "ar") {
      sum.processes.push_back(&autoregression(entry, sum.u));
      continue;
    }
    const auto first = static_cast<std::ptrdiff_t>(sum.u.size());
    sum.processes.push_back(found.estimable);
    for (const noise::ParameterInfo& info : found.estimable->parameters())
      sum.u.push_back(info.inverse(positive(entry.at(info.name))));
    const auto form = found.name == "gauss_markov" ? entry.find("first_order") : std::nullopt;
    if (!form) continue;
    const auto which = static_cast<noise::FirstOrderForm>(form->choice({"table1", "section2e"}));
    double& beta = *(sum.u.begin() + first);
    double& sigma2 = *(sum.u.begin() + first + 1);
    if (!(std::exp(beta) * interval < 1.0)) throw form->error("a first-order form", "an interval below 1/beta");
    const noise::GaussMarkovValues exact = noise::exact_equivalent({std::exp(beta), std::exp(sigma2)}, which, interval);
    beta = std::log(exact.beta);
    sigma2 = std::log(exact.sigma2);
  }
  if (sum.processes.empty()) throw list.error("an empty list", "at least one {process: .., ..}");
  return sum;
}

std::vector<const Estimable*> named_processes(const Node& list) {
  std::vector<const Estimable*> processes;
  for (const Node& item : list.items()) processes.push_back(noise::registry()[known_process(item)].estimable);
  if (processes.empty()) throw list.error("an empty list", "names of processes: white_noise, gauss_markov, ...");
  return processes;
}

Mean mean_from(const Node& node, Mean fallback) {
  return static_cast<Mean>(node.choice("mean", {"zero", "level", "level_and_drift"}, static_cast<std::size_t>(fallback)));
}

long whole_within(const Node& root, std::string_view key, long fallback, long low, long high) {
  const long value = root.integer(key, fallback);
  if (value < low || value > high)
    throw root.at(key).error(fmt::format("{}", value), fmt::format("a whole number from {} to {}", low, high));
  return value;
}

std::size_t count_of(const Node& root, std::string_view key, long low, long high) {
  static_cast<void>(root.at(key));  // it has no default
  return static_cast<std::size_t>(whole_within(root, key, low, low, high));
}

noise::StudiedEstimator estimator_from(const Node& node, const noise::EstimatorStudy& study, Mean mean) {
  noise::StudiedEstimator estimator;
  estimator.kind =
      static_cast<noise::Estimator>(node.at("kind").choice({"em", "default", "best_of_starts", "wavelet_moments", "allan"}));
  estimator.name = node.text("name", node.at("kind").text());
  std::vector<const Estimable*> processes;
  for (const noise::SumModel::Term& term : study.truth.model.terms()) processes.push_back(term.process);
  if (estimator.kind == noise::Estimator::kEm) {
    const ValuedProcesses start = valued_processes(node.at("start"), study.interval);
    processes = start.processes;
    estimator.start = start.u;
    estimator.iterations = static_cast<int>(whole_within(node, "iterations", estimator.iterations, 1, 1000000));
  } else if (const auto sum = node.find("sum")) {
    processes = named_processes(*sum);
  }
  if (estimator.kind == noise::Estimator::kBestOfStarts)
    estimator.starts = static_cast<int>(whole_within(node, "starts", estimator.starts, 1, 1000));
  estimator.intervals = node.flag("intervals", false);
  estimator.model = noise::SumModel(processes, mean_from(node, mean));
  return estimator;
}

noise::RestitutionPlan restitution_from(const Node& node, const noise::EstimatorStudy& study) {
  noise::RestitutionPlan plan;
  plan.runs = static_cast<std::size_t>(whole_within(node, "runs", 3, 1, static_cast<long>(study.runs)));
  plan.realisations = static_cast<std::size_t>(whole_within(node, "realisations", 20, 1, 1000));
  const Node name = node.at("estimator");
  const auto found = std::ranges::find(study.estimators, name.text(), &noise::StudiedEstimator::name);
  if (found == study.estimators.end()) throw name.error(name.text(), "the name of one of the estimators");
  plan.estimator = static_cast<std::size_t>(found - study.estimators.begin());
  return plan;
}

noise::EstimatorStudy study_from(const Node& root) {
  noise::EstimatorStudy study;
  study.interval = positive(root.at("interval_s"));
  study.samples = count_of(root, "samples", 100, 100000000);
  study.runs = count_of(root, "runs", 1, 1000000);
  study.first_seed = static_cast<std::uint64_t>(whole_within(root, "seed", 1, 0, 2147483647));
  const Node truth = root.at("truth");
  ValuedProcesses sum = valued_processes(truth.at("processes"), study.interval);
  const Mean mean = mean_from(root, Mean::kLevelAndDrift);
  study.truth.model = noise::SumModel(sum.processes, mean);
  study.truth.u = std::move(sum.u);
  study.truth.level = truth.number("level", 0.0);
  study.truth.slope = truth.number("slope", 0.0);
  const Node estimators = root.at("estimators");
  for (const Node& item : estimators.items()) {
    noise::StudiedEstimator estimator = estimator_from(item, study, mean);
    if (std::ranges::find(study.estimators, estimator.name, &noise::StudiedEstimator::name) != study.estimators.end())
      throw item.error(fmt::format("a second estimator {}", estimator.name), "names that differ");
    study.estimators.push_back(std::move(estimator));
  }
  if (study.estimators.empty()) throw estimators.error("an empty list", "at least one {kind: ..}");
  if (const auto choices = root.find("choices"))
    for (const Node& item : choices->items())
      study.choices.emplace_back(named_processes(item.at("sum")), mean_from(item, mean));
  if (const auto restitution = root.find("restitution")) study.restitution = restitution_from(*restitution, study);
  return study;
}

}  // namespace

std::string EstimatorStudyConfig::unit(const std::string& of_parameter) const {
  constexpr std::string_view kSignal = "signal";
  std::string text = of_parameter;
  const std::size_t at = text.find(kSignal);
  if (at == std::string::npos || signal_unit.empty()) return text;
  const bool whole = text.size() == at + kSignal.size();
  return text.replace(at, kSignal.size(), whole ? signal_unit : fmt::format("({})", signal_unit));
}

EstimatorStudyConfig read_estimator_study(const std::filesystem::path& file) {
  return read_estimator_study(io::load_yaml(file));
}

EstimatorStudyConfig read_estimator_study(const Node& root) {
  EstimatorStudyConfig config;
  config.file = root.file();
  static_cast<void>(root.choice("schema", {"coast.estimator_study/1"}, 0));
  config.title = root.text("title", config.file.stem().string());
  config.signal_unit = root.text("signal_unit", "");
  config.study = study_from(root);
  if (const auto readings = root.find("readings"))
    for (const Node& item : readings->items()) {
      ValuedProcesses sum = valued_processes(item.at("processes"), config.study.interval);
      StudyReading& reading = config.readings.emplace_back();
      reading.name = item.at("name").text();
      reading.truth = config.study.truth;
      reading.truth.model = noise::SumModel(sum.processes, config.study.truth.model.mean());
      reading.truth.u = std::move(sum.u);
    }
  root.refuse_unasked();
  return config;
}

std::string estimator_study_example(const std::string& indent) {
  return indented(kStudyExample, indent);
}

}  // namespace coast::jobs
