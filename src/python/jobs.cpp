#include "jobs.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "background.hpp"
#include "coast/jobs/array_study.hpp"
#include "coast/jobs/calibrate.hpp"
#include "coast/jobs/compare.hpp"
#include "coast/jobs/diagnose.hpp"
#include "coast/jobs/estimator_study.hpp"
#include "coast/jobs/file_kind.hpp"
#include "coast/jobs/inspect.hpp"
#include "coast/jobs/outage.hpp"
#include "coast/jobs/ppk.hpp"
#include "coast/jobs/process.hpp"
#include "coast/jobs/simulate.hpp"
#include "coast/jobs/synth.hpp"
#include "coast/jobs/tumble.hpp"
#include "tree.hpp"

namespace coast::python {

namespace py = pybind11;
namespace fs = std::filesystem;

namespace {

/// What every call of a job has besides its configuration.
struct Call {
  py::object listener;  ///< of progress
  int threads = 0;      ///< 0: all
  fs::path out;         ///< folder of the results; empty: no files
};

/// A result with its configuration, whatever the job.
class Outcome {
 public:
  Outcome() = default;
  virtual ~Outcome() = default;
  Outcome(const Outcome&) = delete;
  Outcome& operator=(const Outcome&) = delete;
  [[nodiscard]] virtual std::vector<std::string> files() const = 0;
  virtual void write(const fs::path& folder) const = 0;
  [[nodiscard]] virtual std::string told(const fs::path& folder) const = 0;
};

template <class Config, class Result>
class OutcomeOf : public Outcome {
 public:
  OutcomeOf(Config of, Result what) : config(std::move(of)), result(std::move(what)) {}
  [[nodiscard]] std::vector<std::string> files() const override { return jobs::files_of(config); }
  void write(const fs::path& folder) const override { jobs::write(config, result, folder); }
  [[nodiscard]] std::string told(const fs::path& folder) const override { return jobs::told(config, result, folder); }

  Config config;
  Result result;
};

/// The files of a job are written where `out` is given, under the rules of the program.
template <class Config>
fs::path folder_for(const Config& config, const Call& call) {
  return call.out.empty() ? fs::path() : jobs::results_folder(call.out, call.out, jobs::files_of(config));
}

/// @param job  of the configuration and Progress
template <class Config, class Job>
auto run(Config config, const Call& call, Job job) {
  const fs::path folder = folder_for(config, call);
  auto result = in_background(call.listener, call.threads, [&](const jobs::Progress& progress) {
    auto done = job(config, progress);
    if (!folder.empty()) jobs::write(config, done, folder);
    return done;
  });
  return std::make_unique<OutcomeOf<Config, decltype(result)>>(std::move(config), std::move(result));
}

class Processed : public Outcome {
 public:
  Processed(jobs::RunConfig of, jobs::ProcessedMission what) : config(std::move(of)), mission(std::move(what)) {}
  [[nodiscard]] std::vector<std::string> files() const override { return jobs::files_of(config); }
  void write(const fs::path& folder) const override { jobs::write(config, mission.result, folder); }
  [[nodiscard]] std::string told(const fs::path& folder) const override { return jobs::told(config, mission.result, folder); }

  jobs::RunConfig config;
  jobs::ProcessedMission mission;
};

std::unique_ptr<Processed> process(const py::object& what, const std::string& folder, const Call& call) {
  const jobs::RunConfig config = jobs::read_run_config(tree_from(what, folder, "process"));
  const fs::path out = folder_for(config, call);
  jobs::ProcessedMission mission = in_background(call.listener, call.threads, [&](const jobs::Progress& progress) {
    jobs::Recordings recordings = jobs::load(config, progress);
    if (out.empty()) return jobs::process(config, std::move(recordings), progress);
    jobs::TrajectoryFiles files(config, out);
    jobs::ProcessedMission done = jobs::process(config, std::move(recordings), progress, files.sinks());
    files.close();
    jobs::write(config, done.result, out);
    return done;
  });
  return std::make_unique<Processed>(config, std::move(mission));
}

bool is_yaml(const py::object& what) {
  if (py::isinstance<py::dict>(what)) return true;
  const std::string extension = what.cast<fs::path>().extension().string();
  return extension == ".yaml" || extension == ".yml";
}

std::unique_ptr<Outcome> calibrate(const py::object& what, const std::string& folder, const Call& call) {
  const auto calibrated = [](const auto& config, const auto& progress) { return jobs::calibrate(config, progress); };
  if (!is_yaml(what)) return run(jobs::read_calibrate(what.cast<fs::path>()), call, calibrated);
  const config::Node root = tree_from(what, folder, "calibrate");
  if (jobs::names_schema(root, "coast.estimator_study/"))
    return run(jobs::read_estimator_study(root), call,
               [](const auto& config, const auto& progress) { return jobs::estimator_study(config, progress); });
  if (jobs::names_schema(root, "coast.tumble/"))
    return run(jobs::read_tumble(root), call,
               [](const auto& config, const auto& progress) { return jobs::tumble_calibration(config, progress); });
  return run(jobs::read_calibrate(root), call, calibrated);
}

std::unique_ptr<Outcome> synth(const py::object& what, const std::string& folder, const Call& call) {
  const config::Node root = tree_from(what, folder, "synth");
  if (jobs::names_schema(root, "coast.array_study/"))
    return run(jobs::read_array_study(root), call,
               [](const auto& config, const auto& progress) { return jobs::array_study(config, progress); });
  return run(jobs::read_synth(root), call,
             [](const auto& config, const auto& progress) { return jobs::synth(config, progress); });
}

using Solved = OutcomeOf<jobs::PpkConfig, jobs::PpkResult>;

std::unique_ptr<Solved> ppk(const py::object& what, const std::string& folder, const Call& call) {
  return run(jobs::read_ppk(tree_from(what, folder, "ppk")), call,
             [](const auto& config, const auto& progress) { return jobs::ppk(config, progress); });
}

std::unique_ptr<Outcome> outage(const py::object& what, const std::string& folder, const Call& call) {
  return run(jobs::read_outage(tree_from(what, folder, "outage")), call,
             [&call](const auto& config, const auto& progress) { return jobs::outage(config, progress, call.out); });
}

using Simulated = OutcomeOf<jobs::SimulationConfig, jobs::SimulationResult>;

std::unique_ptr<Simulated> simulate(const py::object& what, const std::string& folder, const Call& call,
                                    std::optional<std::uint64_t> seed) {
  return run(jobs::read_simulate(tree_from(what, folder, "simulate"), seed), call,
             [](const auto& config, const auto& progress) { return jobs::simulate(config, progress); });
}

std::unique_ptr<Outcome> diagnose(const py::object& what, const std::string& folder, const Call& call, int twins, bool quick,
                                  const fs::path& simulation) {
  jobs::DiagnosisConfig config = jobs::read_diagnose(tree_from(what, folder, "diagnose"));
  config.twins = twins;
  config.quick = quick;
  config.simulation = simulation;
  return run(std::move(config), call,
             [](const auto& of, const auto& progress) { return jobs::diagnose(of, jobs::load(of.run, progress), progress); });
}

std::unique_ptr<Outcome> compare(const fs::path& first, const fs::path& second, const Call& call,
                                 const std::array<double, 3>& lever_arm) {
  return run(jobs::ComparisonConfig{first, second, Eigen::Vector3d(lever_arm[0], lever_arm[1], lever_arm[2])}, call,
             [](const auto& config, const auto& progress) { return jobs::compare(config, progress); });
}

std::string inspect(const fs::path& file, std::optional<int> gps_week, const Call& call) {
  const jobs::InspectConfig config{file, gps_week};
  return in_background(call.listener, call.threads, [&config](const jobs::Progress& progress) {
    return jobs::told(config, jobs::inspect(config, progress));
  });
}

void register_results(py::module_& module) {
  py::class_<Call>(module, "Call")
      .def(py::init([](py::object listener, int threads, const std::optional<fs::path>& out) {
             return Call{std::move(listener), threads, out.value_or(fs::path())};
           }),
           py::arg("listener"), py::arg("threads"), py::arg("out"));
  py::class_<Outcome>(module, "Outcome")
      .def_property_readonly("files", &Outcome::files)
      .def("write", &Outcome::write, py::arg("folder"), py::call_guard<py::gil_scoped_release>())
      .def("told", &Outcome::told, py::arg("folder"));
  py::class_<Simulated, Outcome>(module, "Simulated")
      .def("imu", [](const Simulated& s) { return imu_arrays(s.result.mission.imu); })
      .def("gnss", [](const Simulated& s) { return fix_arrays(s.result.mission.gnss); })
      .def("truth", [](const Simulated& s) { return state_arrays(s.result.mission.truth.states); });
  py::class_<Solved, Outcome>(module, "Solved").def("positions", [](const Solved& s) { return fix_arrays(s.result.fixes); });
  const auto of = [](auto member) { return [member](const Processed& p) { return member(p.mission.result); }; };
  py::class_<Processed, Outcome>(module, "Processed")
      .def_property_readonly("verdict", of([](const jobs::ProcessResult& r) { return jobs::name(r.verdict.standing()); }))
      .def_property_readonly("verdict_line", of([](const jobs::ProcessResult& r) { return r.verdict.line(); }))
      .def_property_readonly("accepted", [](const Processed& p) { return p.config.accept; })
      .def_property_readonly("resolved", of([](const jobs::ProcessResult& r) { return r.resolved; }))
      .def("trajectory", [](const Processed& p) { return trajectory_arrays(p.mission.delivered); })
      .def("forward", [](const Processed& p) { return trajectory_arrays(p.mission.forward); })
      .def("innovations", of([](const jobs::ProcessResult& r) { return innovation_arrays(r.innovations); }))
      .def("states", of([](const jobs::ProcessResult& r) { return track_arrays(r.states); }));
}

}  // namespace

void register_jobs(py::module_& module) {
  register_results(module);
  const auto what = py::arg("config");
  const auto folder = py::arg("folder");
  const auto call = py::arg("call");
  module.def("process", &process, what, folder, call);
  module.def("calibrate", &calibrate, what, folder, call);
  module.def("synth", &synth, what, folder, call);
  module.def("ppk", &ppk, what, folder, call);
  module.def("outage", &outage, what, folder, call);
  module.def("simulate", &simulate, what, folder, call, py::arg("seed"));
  module.def("diagnose", &diagnose, what, folder, call, py::arg("twins"), py::arg("quick"), py::arg("simulation"));
  module.def("compare", &compare, py::arg("first"), py::arg("second"), call, py::arg("lever_arm"));
  module.def("inspect", &inspect, py::arg("file"), py::arg("gps_week"), call);
}

}  // namespace coast::python
