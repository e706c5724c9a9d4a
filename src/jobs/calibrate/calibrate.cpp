#include "coast/jobs/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

#include "coast/noise/rest.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "common/tell.hpp"

namespace coast::jobs {

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

// Motion is not sensor error. A touch of the table is reported; outliers are treated later.
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

/// Returns a recording by its number.
using Source = std::function<record::ImuRecording(std::size_t)>;

// Reads the recordings one at a time, so that the raw samples of only one are in memory: first those for estimation, then those
// for testing.
std::vector<noise::StaticRecording> read_records(const CalibrationConfig& config, const Source& source,
                                                 CalibrationResult& result, const Progress& progress) {
  std::vector<CalibrationRecord> files = config.records;
  files.insert(files.end(), config.tested_on.begin(), config.tested_on.end());
  std::vector<noise::StaticRecording> records;
  for (const CalibrationRecord& file : files) {
    progress("reading", static_cast<double>(records.size()) / static_cast<double>(files.size()));
    const record::ImuRecording imu = source(records.size());
    for (const record::Event& event : imu.events)
      if (event.kind != "imu_gap")
        result.events.push_back(event);  // no gap is bridged here: the remarks describe its treatment
    records.push_back(noise::static_recording(imu, file.part));
    if (records.size() <= config.records.size()) require_rest(records.back(), file);
  }
  noise::share_interval(records);
  for (std::size_t i = 0; i < records.size(); ++i)
    (i < config.records.size() ? result.records : result.tested_on).push_back(summary_of(records[i]));
  result.interval = records.front().interval;
  return records;
}

/// Progress of all axes together, for one line on the terminal.
class JointProgress {
 public:
  JointProgress(const Progress& progress, std::size_t axes) : progress_(progress), done_(axes, 0.0) {}
  void set(std::size_t axis, double fraction) {
    const std::scoped_lock lock(mutex_);
    done_[axis] = std::max(done_[axis], fraction);
    progress_("estimating", std::accumulate(done_.begin(), done_.end(), 0.0) / static_cast<double>(done_.size()));
  }

 private:
  std::mutex mutex_;
  const Progress& progress_;
  std::vector<double> done_;
};

// Estimate of the chosen common sum from each record alone, with its Cramer-Rao bound.
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
              const Progress& progress) {
  constexpr double kTest = 0.3;  // work of a test on another record, of that of an estimation
  const auto tests = static_cast<double>(records.size() - config.records.size());
  const double whole = 1.0 + kTest * tests;
  result.axes.resize(config.axes.size());
  JointProgress joint(progress, config.axes.size());
  coast::parallel_for(std::size_t{0}, config.axes.size(), [&](std::size_t i) {
    CalibratedAxis& axis = result.axes[i];
    axis.axis = config.axes[i];
    std::vector<noise::StaticSignal> others;
    for (std::size_t r = 0; r < records.size(); ++r)
      (r < config.records.size() ? axis.signals : others).push_back(records[r].of(axis.axis.sensor, axis.axis.axis));
    noise::CalibrationOptions options = config.options(axis.axis.sensor);
    double before = 0.0;
    double work = 1.0;
    options.progress = [&](const char*, double fraction) { joint.set(i, (before + work * fraction) / whole); };
    try {
      axis.result = noise::calibrate(axis.signals, options);
      axis.signals = noise::without_warm_ups(std::move(axis.signals), axis.result.warm_ups);
      before = std::exchange(work, kTest);
      for (const noise::StaticSignal& record : others) {
        axis.tests.push_back(
            {record.source, noise::test_on(record, axis.result.best().model, axis.result.best().fit.u, options)});
        before += kTest;
      }
    } catch (const NumericalError& error) {
      throw NumericalError(axis.axis.title(), "", error.what());
    }
    axis.own = own_estimates(axis.result, axis.signals);
    joint.set(i, 1.0);
  });
}

void tell_warnings(const CalibrationResult& result, const Progress& progress) {
  jobs::tell_warnings(result.events, progress);
  if (!progress.warn) return;
  for (const auto* records : {&result.records, &result.tested_on})
    for (const ReadRecord& record : *records)
      for (const std::string& remark : record.remarks) progress.warn(fmt::format("{}: {}", record.source, remark));
}

CalibrationResult calibrate_from(const CalibrationConfig& config, const Source& source, const Progress& progress) {
  CalibrationResult result;
  const std::vector<noise::StaticRecording> records = read_records(config, source, result, progress);
  tell_warnings(result, progress);
  estimate(config, records, result, progress);
  return result;
}

}  // namespace

CalibrationResult calibrate(const CalibrationConfig& config, const Progress& progress) {
  // Calibration needs only intervals; if no week is stated, any will do.
  constexpr geo::GpsTime kAnyWeek;
  const std::size_t own = config.records.size();
  const auto file = [&](std::size_t i) { return i < own ? config.records[i].file : config.tested_on[i - own].file; };
  return calibrate_from(
      config, [&](std::size_t i) { return io::read_imu(file(i), kAnyWeek); }, progress);
}

CalibrationResult calibrate(const CalibrationConfig& config, const std::vector<record::ImuRecording>& recordings,
                            const Progress& progress) {
  return calibrate_from(
      config, [&](std::size_t i) { return recordings.at(i); }, progress);
}

}  // namespace coast::jobs
