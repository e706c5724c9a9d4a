// The backward recursion and the sparse batch on the same filtered mission: time over its length. One benchmark a process, and
// its peak memory is the solver's (tools/bench/measure).

#include <benchmark/benchmark.h>

#include "bench/mission.hpp"
#include "coast/estimate/batch_smoother.hpp"
#include "coast/geo/units.hpp"

namespace {

using namespace coast;  // NOLINT(google-build-using-namespace): one program, no header

/// A city drive filtered with 40 states, lever arm and time offset among them: IMU 100 Hz, GNSS 1 Hz, knots every 0.5 s.
struct Filtered {
  explicit Filtered(int seconds)
      : recording(bench::city_mission(seconds)),
        mission{.imu = recording.imu, .gnss = recording.gnss, .lever_arm_b = bench::lever_arm()},
        filter(mission, bench::model_36(), options()),
        start(filter.initial_state(recording.truth.states.front(), Eigen::Vector3d::Constant(0.02),
                                   Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.2 * geo::kDegree))) {
    estimate::FilterOutputs outputs;
    outputs.knots = &knots;
    outputs.measurements = [this](const estimate::Measurement& what, bool used) {
      measurements.push_back({knots.size(), what, used});
    };
    (void)filter.run(start, outputs);
  }
  static estimate::FilterOptions options() {
    estimate::FilterOptions options;
    options.auxiliary.lever_arm_sd_m = 0.05;
    options.auxiliary.time_offset_sd_s = 0.001;
    return options;
  }
  const simulate::SimulatedMission& recording;
  estimate::Mission mission;
  estimate::ForwardFilter filter;
  estimate::FilterState start;
  estimate::KnotStore knots;
  std::vector<estimate::KnotMeasurement> measurements;
};

/// Sensor states at as many knots as the page of a run shows.
estimate::KnotSampling sampled(const benchmark::State& state) {
  return estimate::KnotSampling(static_cast<double>(state.range(0)) / 20000.0);
}

void rts_40(benchmark::State& state) {
  const Filtered f(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(estimate::smooth(f.knots, f.filter.layout(), {}, sampled(state)));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(f.knots.size()));
}

void batch_40(benchmark::State& state) {
  const Filtered f(static_cast<int>(state.range(0)));
  estimate::BatchReport report;
  for (auto _ : state)
    report = estimate::smooth_batch(f.mission, f.filter.layout(), Filtered::options(), f.start, f.knots, f.measurements, {}, {},
                                    sampled(state))
                 .report;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(f.knots.size()));
  state.counters["iterations"] = static_cast<double>(report.cost.size());
}

// Argument: length of the mission, s.
BENCHMARK(rts_40)->Arg(900)->Arg(3600)->Arg(14400)->Arg(36000)->Unit(benchmark::kMillisecond);
BENCHMARK(batch_40)->Arg(900)->Arg(3600)->Arg(14400)->Arg(36000)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
