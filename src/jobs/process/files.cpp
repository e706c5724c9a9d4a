// Output files and messages of `coast process`.

#include <fmt/format.h>

#include <algorithm>

#include "coast/io/event_writers.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "process/page/page.hpp"
#include "process/summary.hpp"
#include "process/trajectory_output.hpp"

namespace coast::jobs {

std::vector<std::string> files_of(const RunConfig& config) {
  std::vector<std::string> files = trajectory_files(config.output);
  for (const char* file : {"run.resolved.yaml", "summary.json", "innovations.csv", "report.json", "report.html"})
    files.emplace_back(file);
  if (config.events) files.insert(files.end(), {"events.csv", "events_opk.csv", "events_exif.csv", "geo.txt"});
  if (config.events && config.output.projection) files.emplace_back("events_grid.csv");
  return files;
}

namespace {

// Heights above mean sea level that were not converted are also those of the trajectory.
std::optional<double> geoid_height(const RunConfig& config) {
  if (config.ppk) return std::nullopt;
  const io::PositionOptions& position = config.gnss.position;
  if (position.above_mean_sea_level && !position.geoid_height) return 0.0;
  return position.geoid_height;
}

using Writers = std::vector<std::unique_ptr<io::TrajectoryWriter>>;

record::EpochSink to(const Writers& writers) {
  return [&writers](const record::TrajectoryEpoch& epoch) {
    for (const auto& writer : writers) writer->write(epoch);
  };
}

}  // namespace

namespace {

void write_events(const RunConfig& config, const std::vector<record::MarkedState>& states,
                  const std::filesystem::path& folder) {
  const io::Projection* projection = config.output.projection.get();
  io::write_events_csv(folder / "events.csv", states);
  io::write_events_opk(folder / "events_opk.csv", states, projection);
  io::write_events_exif(folder / "events_exif.csv", states, projection, geoid_height(config).value_or(0.0));
  io::write_odm_geo(folder / "geo.txt", states);
  if (projection != nullptr) io::write_events_grid(folder / "events_grid.csv", states, *projection);
}

}  // namespace

struct TrajectoryFiles::Files {
  explicit Files(const OutputOptions& options) : forward(options, to(forward_writers)), delivered(options, to(writers)) {}
  std::filesystem::path folder;
  Writers forward_writers, writers;
  TrajectoryOutput forward, delivered;
};

TrajectoryFiles::TrajectoryFiles(const RunConfig& config, const std::filesystem::path& folder)
    : files_(std::make_unique<Files>(config.output)) {
  files_->folder = folder;
  io::WriterOptions options;
  options.geoid_height_m = geoid_height(config);
  options.projection = config.output.projection;
  for (const std::string& format : config.output.formats) {
    const io::TrajectoryFormat& how = io::trajectory_format(format);
    if (format == "nav") files_->forward_writers.push_back(how.make(folder / "forward.nav", options));
    files_->writers.push_back(how.make(folder / io::file_of("trajectory", how), options));
  }
}

TrajectoryFiles::~TrajectoryFiles() = default;

TrajectorySinks TrajectoryFiles::sinks() {
  return {[this](const record::TrajectoryEpoch& epoch) { files_->forward.add(epoch); },
          [this](const record::TrajectoryEpoch& epoch) { files_->delivered.add(epoch); }};
}

void TrajectoryFiles::close() {
  io::begin_results(files_->folder / "summary.json");
  for (const auto* writers : {&files_->forward_writers, &files_->writers})
    for (const auto& writer : *writers) writer->close();
}

void write(const RunConfig& config, const ProcessResult& result, const std::filesystem::path& folder) {
  io::write_text(folder / "run.resolved.yaml", result.resolved);
  io::write_text(folder / "innovations.csv", innovations_csv(result));
  if (result.marked) write_events(config, result.marked->states, folder);
  if (std::ranges::find(config.output.formats, "gpkg") != config.output.formats.end())
    io::add_to_geopackage(folder / "trajectory.gpkg", result.fixes, result.marked ? &result.marked->states : nullptr,
                          config.output.projection.get());
  write_page(make_page({config, result}), folder);
  io::write_text(folder / "summary.json", summary_json(result));
}

std::string told(const RunConfig&, const ProcessResult& result, const std::filesystem::path& folder) {
  return fmt::format("{}\n{}report: {}\n", result.verdict.line(), summary_text(result), (folder / "report.html").string());
}

void require_usable(const RunConfig& config, const ProcessResult& result) {
  if (config.accept || result.verdict.standing() != Standing::kUnusable) return;
  throw NumericalError(
      "the result contradicts its input", "",
      result.verdict.line() + ". All files were written and are marked as unusable; `accept: true` accepts the result");
}

}  // namespace coast::jobs
