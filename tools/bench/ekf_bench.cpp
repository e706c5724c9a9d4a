// Forward filter and smoother from memory, one core, beside the naive filter on the same recording.

#include <benchmark/benchmark.h>

#include "bench/mission.hpp"
#include "bench/naive_ekf.hpp"
#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/smoother.hpp"
#include "coast/geo/units.hpp"

namespace {

using namespace coast;  // NOLINT(google-build-using-namespace): one program, no header

constexpr double kPositionSd = 0.02;
constexpr double kVelocitySd = 0.02;
constexpr double kAttitudeSd = 0.2 * geo::kDegree;

void count(benchmark::State& state, const simulate::SimulatedMission& mission, const Eigen::Vector3d& end) {
  const auto samples = static_cast<std::int64_t>(mission.imu.samples.size());
  state.SetItemsProcessed(state.iterations() * samples);
  // So that nobody compares with a filter that does something else.
  state.counters["end_error_mm"] = 1e3 * (end - mission.truth.states.back().r_eb_e).norm();
}

void naive_21(benchmark::State& state) {
  const auto& mission = bench::car_mission(static_cast<int>(state.range(0)));
  const double hour = geo::kHour;
  const bench::NaiveModel model{.angle_random_walk = 0.1 * geo::kDegree / std::sqrt(hour),
                                .velocity_random_walk = 0.1 / std::sqrt(hour),
                                .gyro_bias_sd = 25.0 * geo::kDegree / hour,
                                .accel_bias_sd = 200.0 * geo::kMilliGal,
                                .gyro_scale_sd = 300e-6,
                                .accel_scale_sd = 300e-6,
                                .correlation_time = hour};
  const bench::NaiveStart start{mission.truth.states.front(), kPositionSd, kVelocitySd, kAttitudeSd};
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  for (auto _ : state) {
    bench::NaiveEkf filter(model, start, bench::lever_arm());
    auto fix = mission.gnss.fixes.begin();
    for (const record::ImuSample& sample : mission.imu.samples) {
      filter.propagate(sample);
      while (fix != mission.gnss.fixes.end() && fix->t <= sample.t) filter.update(*fix++);
    }
    end = filter.nav().r_eb_e;
  }
  count(state, mission, end);
}

struct Filtering {
  const simulate::SimulatedMission& recording;
  estimate::Mission mission;
  estimate::ForwardFilter filter;
  estimate::FilterState start;

  Filtering(int gnss_rate_hz, const noise::ImuErrorModel& model, const estimate::FilterOptions& options)
      : recording(bench::car_mission(gnss_rate_hz)),
        mission{.imu = recording.imu, .gnss = recording.gnss, .lever_arm_b = bench::lever_arm()},
        filter(mission, model, options),
        start(filter.initial_state(recording.truth.states.front(), Eigen::Vector3d::Constant(kPositionSd),
                                   Eigen::Vector3d::Constant(kVelocitySd), Eigen::Vector3d::Constant(kAttitudeSd))) {}
};

void forward(benchmark::State& state, const noise::ImuErrorModel& model, const estimate::FilterOptions& options) {
  const Filtering f(static_cast<int>(state.range(0)), model, options);
  estimate::FilterResult result;
  for (auto _ : state) result = f.filter.run(f.start, {});
  count(state, f.recording, result.last.nav.r_eb_e);
  state.counters["states"] = f.filter.layout().size();
}

void forward_21(benchmark::State& state) {
  forward(state, bench::model_21(), {});
}

void forward_40(benchmark::State& state) {
  estimate::FilterOptions options;
  options.auxiliary.lever_arm_sd_m = 0.05;
  options.auxiliary.time_offset_sd_s = 0.001;
  forward(state, bench::model_36(), options);
}

// Forward, backward, and the smoothed trajectory at every IMU epoch.
void smoothed_21(benchmark::State& state) {
  const Filtering f(static_cast<int>(state.range(0)), bench::model_21(), {});
  record::NavState last;
  for (auto _ : state) {
    estimate::KnotStore knots;
    estimate::FilterOutputs outputs;
    outputs.knots = &knots;
    (void)f.filter.run(f.start, outputs);
    const auto smoothed = estimate::smooth(knots, f.filter.layout());
    estimate::emit_smoothed(f.mission, f.filter.layout(), knots, smoothed,
                            [&last](const record::TrajectoryEpoch& epoch) { last = epoch.nav; });
  }
  count(state, f.recording, last.r_eb_e);
}

// Argument: rate of the GNSS fixes, Hz.
BENCHMARK(naive_21)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(forward_21)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(forward_40)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(smoothed_21)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
