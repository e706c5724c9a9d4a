#include "coast/array/defect_study.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "coast/parallel.hpp"

namespace coast::array {

namespace {

struct StudiedKind {
  DefectKind kind;
  std::vector<double> strengths;
};

std::vector<StudiedKind> studied_kinds() {
  return {{DefectKind::kBiasJump, {0.3, 1.0, 3.0}},
          {DefectKind::kScaleChange, {0.02, 0.05, 0.2}},
          {DefectKind::kStuck, {1.0}},
          {DefectKind::kNoiseBurst, {1.5, 2.0, 5.0}},
          {DefectKind::kDropout, {0.0, 1.0}},
          {DefectKind::kSwappedAxis, {1.0}}};
}

struct InjectionResult {
  bool detected = false, wrong_sensor = false, right_kind = false;
  double delay_s = 0.0, onset_error_s = 0.0;
};

Injection draw_injection(const DefectStudyOptions& options, const StudiedKind& kind, double strength, std::size_t samples,
                         std::mt19937_64& random) {
  Injection injection;
  injection.kind = kind.kind;
  injection.sensor = std::uniform_int_distribution<std::size_t>(0, options.simulation.sensors - 1)(random);
  injection.channel = std::uniform_int_distribution<int>(0, kChannels - 1)(random);
  const double share = std::uniform_real_distribution<double>(0.3, 0.6)(random);
  injection.from = static_cast<std::size_t>(share * static_cast<double>(samples));
  injection.to = std::min(samples, injection.from + static_cast<std::size_t>(options.defect_s / options.simulation.dt));
  const double sd = injection.channel < 3 ? options.simulation.gyro_sd : options.simulation.accelerometer_sd;
  const double sign = std::bernoulli_distribution(0.5)(random) ? 1.0 : -1.0;
  switch (kind.kind) {
    case DefectKind::kBiasJump:
      injection.size = sign * strength * sd;
      break;
    case DefectKind::kScaleChange:
      injection.size = 1.0 + sign * strength;
      break;
    case DefectKind::kNoiseBurst:
      injection.size = sd * std::sqrt(strength * strength - 1.0);
      break;
    default:
      injection.size = strength;
      break;
  }
  return injection;
}

bool concerns(const Defect& defect, const Injection& injection) {
  return defect.sensor == injection.sensor && (defect.channels >> injection.channel & 1) != 0;
}

InjectionResult judge(const DefectReport& report, const Injection& injection, double dt) {
  InjectionResult result;
  for (const Defect& defect : report.defects) {
    if (defect.sensor != injection.sensor) result.wrong_sensor = true;
    if (result.detected || !concerns(defect, injection)) continue;
    if (defect.found < injection.from || defect.found >= injection.to) continue;
    result.detected = true;
    result.right_kind = defect.kind == injection.kind;
    result.delay_s = static_cast<double>(defect.found - injection.from) * dt;
    result.onset_error_s = std::abs(static_cast<double>(defect.from) - static_cast<double>(injection.from)) * dt;
  }
  return result;
}

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

DefectStudyRow summary_of(DefectKind kind, double strength, const std::vector<InjectionResult>& results) {
  DefectStudyRow row;
  row.kind = kind;
  row.strength = strength;
  row.injections = results.size();
  std::vector<double> delays, onsets;
  for (const InjectionResult& result : results) {
    row.wrong_sensor += result.wrong_sensor ? 1 : 0;
    if (!result.detected) continue;
    ++row.detected;
    row.right_kind += result.right_kind ? 1 : 0;
    delays.push_back(result.delay_s);
    onsets.push_back(result.onset_error_s);
  }
  row.median_delay_s = quantile_of(delays, 0.5);
  row.delay_95_s = quantile_of(delays, 0.95);
  row.median_onset_error_s = quantile_of(onsets, 0.5);
  return row;
}

std::vector<DefectStudyRow> rows_of(const DefectStudyOptions& options, const StudiedKind& kind, std::size_t injections,
                                    std::uint64_t first_seed, const std::function<void()>& done) {
  std::vector<InjectionResult> results(injections);
  coast::parallel_for(std::size_t{0}, injections, [&](std::size_t i) {
    // Kinds use the same records, but each injection has its own place.
    std::mt19937_64 random((first_seed + i) * 16 + static_cast<std::uint64_t>(kind.kind));
    Signals signals = simulate_array(options.simulation, first_seed + i);
    const Injection injection =
        draw_injection(options, kind, kind.strengths[i % kind.strengths.size()], signals.samples(), random);
    inject(signals, injection, first_seed + i);
    results[i] = judge(find_defects(signals, options.detection), injection, signals.dt);
    done();
  });
  std::vector<DefectStudyRow> rows;
  for (std::size_t s = 0; s < kind.strengths.size(); ++s) {
    std::vector<InjectionResult> of_strength;
    for (std::size_t i = s; i < injections; i += kind.strengths.size()) of_strength.push_back(results[i]);
    rows.push_back(summary_of(kind.kind, kind.strengths[s], of_strength));
  }
  return rows;
}

}  // namespace

DefectStudyResult run_defect_study(const DefectStudyOptions& options, std::size_t injections_per_kind, std::uint64_t first_seed,
                                   const std::function<void(double)>& progress) {
  DefectStudyResult result;
  const std::vector<StudiedKind> kinds = studied_kinds();
  const auto pieces = static_cast<std::size_t>(std::ceil(options.clean_hours * 3600.0 / options.clean_piece_s));
  // A clean piece takes as much time as several injections.
  const double weight = options.clean_piece_s / options.simulation.duration_s;
  const double all = static_cast<double>(kinds.size() * injections_per_kind) + weight * static_cast<double>(pieces);
  std::atomic<std::size_t> injected = 0, cleaned = 0;
  const auto report = [&] {
    if (progress) progress((static_cast<double>(injected) + weight * static_cast<double>(cleaned)) / all);
  };
  for (const StudiedKind& kind : kinds) {
    const std::vector<DefectStudyRow> rows = rows_of(options, kind, injections_per_kind, first_seed, [&] {
      ++injected;
      report();
    });
    result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  }
  ArraySimulation clean = options.simulation;
  clean.duration_s = options.clean_piece_s;
  std::atomic<std::size_t> alarms = 0;
  coast::parallel_for(std::size_t{0}, pieces, [&](std::size_t i) {
    alarms += find_defects(simulate_array(clean, first_seed + 1000000 + i), options.detection).defects.size();
    ++cleaned;
    report();
  });
  result.clean_hours = static_cast<double>(pieces) * options.clean_piece_s / 3600.0;
  result.false_alarms = alarms;
  result.stated_false_alarms = options.detection.false_alarms_per_hour * result.clean_hours;
  return result;
}

}  // namespace coast::array
