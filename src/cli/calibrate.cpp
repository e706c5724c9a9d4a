#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>

#include "calibration_page.hpp"
#include "calibration_result.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/noise/rest.hpp"
#include "coast/record/error.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "load.hpp"
#include "progress.hpp"

namespace coast::cli {

namespace {

ReadRecord summary_of(const noise::StaticRecording& recording) {
  const noise::StaticSignal& first = recording.axes.front();
  return {recording.source, first.duration(), first.length(), first.values.size(), first.runs.size() - 1, recording.remarks};
}

std::string stretches(const std::vector<noise::Rest::Stretch>& places, double begin) {
  std::vector<std::string> words;
  for (const noise::Rest::Stretch& place : places)
    words.push_back(fmt::format("{:.0f} to {:.0f} s", begin + place.from, begin + place.to));
  return fmt::format("{}", fmt::join(words, ", "));
}

// What is moved shows the motion and not the sensor. A touch of the table is told; outliers are dealt with behind this.
void require_rest(noise::StaticRecording& recording, const CalibrationRecord& file) {
  const noise::Rest rest = noise::rest_of(recording);
  if (rest.moved == 0.0) return;
  const double begin = file.part.from_s.value_or(0.0);
  const std::string found = fmt::format("the IMU is moved in {:.0f} of {:.0f} s", rest.moved, rest.duration);
  if (rest.at_rest()) {
    recording.remarks.push_back(found + ".");
    return;
  }
  if (rest.places.empty())
    throw InputError({recording.source, 0, found + " and never at rest for a minute", "a recording at rest", ""});
  const noise::Rest::Stretch& longest = *std::ranges::max_element(rest.places, {}, &noise::Rest::Stretch::length);
  throw InputError(
      {recording.source, 0, fmt::format("{}; at rest from {}", found, stretches(rest.places, begin)), "a recording at rest",
       fmt::format("In calibration.yaml: `records: [{{file: {}, from_s: {:.0f}, to_s: {:.0f}}}]` takes the longest rest.",
                   recording.source, std::ceil(begin + longest.from), std::floor(begin + longest.to))});
}

// Reads one recording after the other, so that the raw samples of one only are in memory: those to estimate from, then those to
// test on.
std::vector<noise::StaticRecording> read_records(const CalibrationConfig& config, CalibrationResult& result,
                                                 ProgressLine& line) {
  // Calibration needs intervals only; any week will do where none is stated.
  constexpr geo::GpsTime kAnyWeek;
  std::vector<CalibrationRecord> files = config.records;
  files.insert(files.end(), config.tested_on.begin(), config.tested_on.end());
  std::vector<noise::StaticRecording> records;
  for (const CalibrationRecord& file : files) {
    line.show("reading", static_cast<double>(records.size()) / static_cast<double>(files.size()));
    const record::ImuRecording imu = io::read_imu(file.file, kAnyWeek);
    for (const record::Event& event : imu.events)
      if (event.kind != "imu_gap")
        result.events.push_back(event);  // no gap is bridged here: the remarks say what becomes of it
    records.push_back(noise::static_recording(imu, file.part));
    if (records.size() <= config.records.size()) require_rest(records.back(), file);
  }
  noise::share_interval(records);
  for (std::size_t i = 0; i < records.size(); ++i)
    (i < config.records.size() ? result.records : result.tested_on).push_back(summary_of(records[i]));
  result.interval = records.front().interval;
  return records;
}

/// How far all axes together are, for one line on the terminal.
class JointProgress {
 public:
  JointProgress(ProgressLine& line, std::size_t axes) : line_(line), done_(axes, 0.0) {}
  void set(std::size_t axis, double fraction) {
    const std::scoped_lock lock(mutex_);
    done_[axis] = std::max(done_[axis], fraction);
    line_.show("estimating", std::accumulate(done_.begin(), done_.end(), 0.0) / static_cast<double>(done_.size()));
  }

 private:
  std::mutex mutex_;
  ProgressLine& line_;
  std::vector<double> done_;
};

// Each record's own estimate of the sum that was chosen for all, with its Cramer-Rao bound.
std::vector<OwnEstimate> own_estimates(const noise::AxisCalibration& result, const std::vector<noise::StaticSignal>& signals) {
  std::vector<OwnEstimate> own;
  const noise::SumModel& model = result.best().model;
  for (std::size_t r = 0; r < result.own.size(); ++r) {
    const std::vector<double>& u = result.own[r].u;
    const Eigen::MatrixXd covariance =
        noise::cramer_rao(noise::expected_information(model, u, signals[r].interval, signals[r].length()));
    OwnEstimate& estimate = own.emplace_back(OwnEstimate{u, {}});
    for (Eigen::Index i = 0; i < covariance.rows(); ++i) estimate.sd.push_back(std::sqrt(covariance(i, i)));
  }
  return own;
}

void estimate(const CalibrationConfig& config, const std::vector<noise::StaticRecording>& records, CalibrationResult& result,
              ProgressLine& line) {
  constexpr double kSearch = 0.6;  // share of the time that the search of models takes, about
  result.axes.resize(config.axes.size());
  JointProgress progress(line, config.axes.size());
  tbb::parallel_for(std::size_t{0}, config.axes.size(), [&](std::size_t i) {
    CalibratedAxis& axis = result.axes[i];
    axis.axis = config.axes[i];
    std::vector<noise::StaticSignal> others;
    for (std::size_t r = 0; r < records.size(); ++r)
      (r < config.records.size() ? axis.signals : others).push_back(records[r].of(axis.axis.sensor, axis.axis.axis));
    noise::CalibrationOptions options = config.options(axis.axis.sensor);
    options.progress = [&](const char*, double fraction) { progress.set(i, kSearch * fraction); };
    try {
      axis.result = noise::calibrate(axis.signals, options);
      for (const noise::StaticSignal& record : others)
        axis.tests.push_back(
            {record.source, noise::test_on(record, axis.result.best().model, axis.result.best().fit.u, options)});
    } catch (const NumericalError& error) {
      throw NumericalError(axis.axis.title(), "", error.what());
    }
    axis.own = own_estimates(axis.result, axis.signals);
    progress.set(i, 1.0);
  });
}

void print_warnings(const CalibrationResult& result) {
  for (const record::Event& event : result.events)
    if (event.severity == record::Event::Severity::kWarning) fmt::print(stderr, "warning: {}\n", event.text);
  for (const auto* records : {&result.records, &result.tested_on})
    for (const ReadRecord& record : *records)
      for (const std::string& remark : record.remarks) fmt::print(stderr, "warning: {}: {}\n", record.source, remark);
}

}  // namespace

void calibrate(const std::filesystem::path& input, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const CalibrationConfig config = read_calibration(input);
  for (const auto* records : {&config.records, &config.tested_on})
    for (const CalibrationRecord& record : *records) io::note_read(record.file.file);
  const std::filesystem::path out =
      output_folder(input, options.out, {"error_model.yaml", "calibration.json", "report.json", "report.html"});
  CalibrationResult result;
  const std::vector<noise::StaticRecording> records = read_records(config, result, line);
  line.clear();
  print_warnings(result);
  estimate(config, records, result, line);
  line.show("writing", 0.0);
  const report::Page page = calibration_page(config, result);
  io::begin_results(out / "calibration.json");
  io::write_text(out / "error_model.yaml", error_model_yaml(config, result));
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "calibration.json", calibration_json(config, result));
  line.clear();
  if (!options.quiet) fmt::print("{}error model: {}\n", calibration_text(result), (out / "error_model.yaml").string());
}

}  // namespace coast::cli
