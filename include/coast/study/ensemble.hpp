#pragma once
// One scenario simulated with many seeds, each recording processed with several error models: paired outages with known truth.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "coast/simulate/scenario.hpp"
#include "coast/study/outage.hpp"
#include "coast/study/paired.hpp"

namespace coast::study {

struct NamedModel {
  std::string name;
  noise::ImuErrorModel model;
};

/// Sensors that err by `truth`, and what the filter believes of them, one run each.
struct EnsembleCase {
  NamedModel truth;
  std::vector<NamedModel> filters;
};

/// An outage in the scenario's time.
struct ElapsedOutage {
  double start_s = 0.0;  ///< since the start of the mission
  double duration_s = 0.0;
};

struct EnsemblePlan {
  simulate::Scenario scenario;  ///< its own error model and seed are not used
  std::uint64_t first_seed = 1;
  std::size_t seeds = 1;
  std::vector<ElapsedOutage> outages;  ///< each by itself; empty: the scenario's own
  std::vector<EnsembleCase> cases;
};

/// One error model on the recordings of one truth.
struct EnsembleRun {
  std::string truth;
  std::string filter;
  std::vector<std::vector<OutageResult>> outages;  ///< [outage][seed]; series (for figures) are kept of the first seed only
};

struct EnsembleResult {
  std::vector<ElapsedOutage> outages;
  std::vector<EnsembleRun> runs;  ///< case by case, in the order of its filters
};

/// Simulates and processes every seed of every case.
///
/// Seed k of two cases has the same motion, the same GNSS errors, and the same draw of each process that stands at the same
/// place of both error models; the filters of one case get the same recording. A recording is processed as `coast process`
/// does it, by alignment, refined start and filter with GNSS positions and velocities, once for each outage. The fixes of the
/// outage are withheld from all of it, the recording ends `kTail` after it, and the errors are against the simulated truth. On
/// all threads; the same numbers for any number of them. A thread holds one recording and its knots at a time, some 150 MB for
/// 10 minutes with GNSS at 10 Hz and 40 states.
///
/// @param progress  fraction of the recordings; called one at a time
/// @throws InputError      an outage does not lie within the scenario, or begins before the filter does
/// @throws NumericalError  a recording cannot be processed; names its seed
[[nodiscard]] EnsembleResult run_ensemble(const EnsemblePlan& plan, const std::function<void(double)>& progress = {});
/// GNSS after an outage that the smoother sees, s: with 60 s the smoothed drift of 130 s differed by 5 % from that with 200 s.
inline constexpr double kTail = 180.0;

// --- what an ensemble says

enum class DriftMeasure { kNorth, kEast, kDown, kHorizontal };

/// Largest absolute error inside each outage, m, in the order of the seeds.
[[nodiscard]] std::vector<double> drifts(std::span<const OutageResult> outages, DriftMeasure measure, bool smoothed);

/// Of absolute errors over the seeds, m.
struct Spread {
  double median = 0.0;
  double rms = 0.0;
  double p95 = 0.0;
};
[[nodiscard]] Spread spread_of(const std::vector<double>& absolute_errors);

/// One solution in one outage over the seeds.
struct EnsembleDrift {
  std::array<Spread, 3> largest;                                  ///< N, E, D: largest absolute error
  std::array<Spread, 3> end;                                      ///< N, E, D: at the last epoch before the next used fix
  Eigen::Vector3d predicted_end_rms_m = Eigen::Vector3d::Zero();  ///< of the sigma that the filter states there
  Spread horizontal;                                              ///< largest horizontal error
  double inside_95 = 0.0;                                         ///< share of errors within 1.96 stated sigma
};
[[nodiscard]] EnsembleDrift ensemble_drift(std::span<const OutageResult> outages, bool smoothed);

/// Horizontal drift that white gyro noise alone sets, per axis: what remains where position, velocity, attitude and every other
/// sensor error are known at the start of a gap in level, unaccelerated motion.
///
///     sigma(T)^2 = Q g^2 integral over s of ((T - s)^2 / 2)^2 = Q g^2 T^5 / 20
///
/// @param gyro_density  Q, rad^2/s  @param duration_s  T, s  @return m
[[nodiscard]] double gyro_noise_drift(geo::Psd gyro_density, double duration_s);

}  // namespace coast::study
