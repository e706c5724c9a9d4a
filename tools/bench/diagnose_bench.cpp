// The pass that judges all effects of the catalogue, beside a forward pass of the filter: ten minutes and an hour of a car in a
// city, IMU 100 Hz, GNSS 1 Hz.

#include <benchmark/benchmark.h>

#include "bench/mission.hpp"
#include "coast/diagnose/examination.hpp"
#include "coast/geo/units.hpp"

namespace {

using namespace coast;  // NOLINT(google-build-using-namespace): one program, no header

struct Filtered {
  explicit Filtered(int seconds)
      : recording(bench::city_mission(seconds)),
        mission{.imu = recording.imu, .gnss = recording.gnss, .lever_arm_b = bench::lever_arm()},
        filter(mission, bench::model_21(), options),
        start(filter.initial_state(recording.truth.states.front(), Eigen::Vector3d::Constant(0.02),
                                   Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.2 * geo::kDegree))) {
    estimate::FilterOutputs outputs;
    outputs.knots = &knots;
    (void)filter.run(start, outputs);
  }
  const simulate::SimulatedMission& recording;
  estimate::Mission mission;
  estimate::FilterOptions options;
  estimate::ForwardFilter filter;
  estimate::FilterState start;
  estimate::KnotStore knots;
};

void forward_21(benchmark::State& state) {
  const Filtered f(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(f.filter.run(f.start, {}).log_likelihood);
}

void judged(benchmark::State& state, Eigen::Index draws) {
  const Filtered f(static_cast<int>(state.range(0)));
  const diagnose::Hypotheses hypotheses(f.mission, f.options, diagnose::Grade::kIndustrial, f.recording.truth.states, {});
  for (auto _ : state)
    benchmark::DoNotOptimize(diagnose::examine(f.mission, f.filter.layout(), f.knots, hypotheses, {.draws = draws}).score);
  state.counters["coefficients"] = static_cast<double>(hypotheses.size());
}
void effects(benchmark::State& state) {
  judged(state, 0);
}
void effects_with_draws(benchmark::State& state) {
  judged(state, 400);
}

BENCHMARK(forward_21)->Arg(600)->Arg(3600)->Unit(benchmark::kMillisecond);
BENCHMARK(effects)->Arg(600)->Arg(3600)->Unit(benchmark::kMillisecond);
BENCHMARK(effects_with_draws)->Arg(600)->Arg(3600)->Unit(benchmark::kMillisecond);

}  // namespace
