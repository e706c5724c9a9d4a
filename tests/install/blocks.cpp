// The building blocks of the jobs, one example each, for a program of one's own. docs/python.md has them from Python.
#include <coast/carrier/differences.hpp>
#include <coast/carrier/integer_least_squares.hpp>
#include <coast/estimate/transition.hpp>
#include <coast/ins/strapdown.hpp>
#include <coast/jobs/simulate.hpp>
#include <coast/noise/allan.hpp>
#include <coast/noise/arma_garch.hpp>
#include <coast/noise/likelihood.hpp>
#include <cstdio>
#include <random>

namespace {

using namespace coast;

int failures = 0;

void show(const char* block, const char* what, double value, bool is_right) {
  std::printf("%-24s %s: %.4g%s\n", block, what, value, is_right ? "" : "   WRONG");
  failures += is_right ? 0 : 1;
}

std::vector<double> white_noise(std::size_t n, double sd) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal(0.0, sd);
  std::vector<double> values(n);
  for (double& value : values) value = normal(engine);
  return values;
}

/// A trajectory and its sensors: here without errors, and navigated again by strapdown alone.
void simulate_and_navigate(const char* scenario_file) {
  jobs::SimulationConfig config = jobs::read_simulate(scenario_file);
  config.scenario.error_model.reset();
  const simulate::SimulatedMission mission = simulate::simulate(config.scenario);
  ins::Strapdown navigator(mission.truth.states.front());
  const estimate::StateLayout layout(noise::ImuErrorModel{}, Eigen::Matrix3d::Identity(), {});
  estimate::TransitionAccumulator transition(layout, geo::kEarthRate);
  ins::RawIncrement previous;
  constexpr std::size_t kSamples = 9000;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const record::ImuSample& sample = mission.imu.samples[i];
    const ins::RawIncrement current{sample.dt, sample.dtheta, sample.dv};
    const ins::BodyIncrement increment = ins::compensate_two_sample(previous, current);
    const Eigen::Matrix3d before = navigator.state().q_b_e.toRotationMatrix();
    navigator.step(increment);
    transition.add({.dt = increment.dt,
                    .C_b_e = 0.5 * (before + navigator.C_b_e()),
                    .dv_e = navigator.last_dv_e(),
                    .dtheta_b = increment.phi,
                    .dv_b = increment.u});
    if (transition.substep_due()) transition.fold(navigator.gravity_gradient());
    previous = current;
  }
  const double error = (navigator.state().r_eb_e - mission.truth.states[kSamples].r_eb_e).norm();
  show("ins::Strapdown", "m from the truth after 90 s", error, error < 0.01);
  const double seconds = transition.Phi_n()(estimate::kPos, estimate::kVel);
  show("estimate::Transition..", "position by velocity at the start, s", seconds, seconds > 80.0 && seconds < 100.0);
}

void observe(const char* scenario_file) {
  const jobs::SimulationResult simulated = jobs::simulate(jobs::read_simulate(scenario_file), {});
  const record::ObservationRecording& rover = simulated.observations->rover;
  const record::ObservationRecording& base = simulated.observations->base;
  const carrier::BroadcastOrbits orbits(simulated.observations->navigation);
  carrier::DifferenceOptions options;
  options.air.ionosphere = simulated.observations->navigation.gps_ionosphere;
  const auto alone = carrier::single_points(base, orbits, options);
  const double error = (alone.front()->r_e - *base.approximate_r_e).norm();
  show("carrier::single_points", "m from the base", error, error < 20.0);
  const auto at_base = [&](geo::GpsTime) { return base.approximate_r_e; };
  const auto differences =
      carrier::form_differences(rover, base, carrier::choose_signals(rover, base, options.systems), orbits, at_base, options);
  const auto satellites = static_cast<double>(differences.front().satellites.size());
  show("carrier::form_diff..", "satellites of both receivers", satellites, satellites > 5.0);
}

void integers() {
  const Eigen::Vector2d a(5.1, 2.9);
  const Eigen::Matrix2d Q{{0.04, 0.03}, {0.03, 0.04}};
  const carrier::IntegerSolutions found = carrier::integer_least_squares(a, Q);
  show("carrier::integer_le..", "first integer", found.candidates(0, 0), found.candidates(0, 0) == 5.0 && found.ratio() > 3.0);
}

void noise_of_a_record() {
  constexpr double kInterval = 0.01, kSd = 1e-3;
  const std::vector<double> record = white_noise(100000, kSd);
  noise::AllanAccumulator accumulator(kInterval);
  accumulator.add(record);
  const noise::AllanCurve curve = accumulator.finish();
  show("noise::Allan..", "deviation of one sample", curve.front().allan.value,
       curve.front().allan.interval_95.lower < kSd && kSd < curve.front().allan.interval_95.upper);

  const noise::SumModel sum({&noise::estimable("white_noise")}, noise::Mean::kLevel);
  const noise::Likelihood likelihood({noise::StaticSignal::regular(record, kInterval)}, sum);
  const auto at = [&](double density) {
    return likelihood.value({sum.terms().front().process->parameters().front().inverse(density)});
  };
  const double truth = kSd * kSd * kInterval;
  const double gain = at(truth).log_likelihood - at(1.1 * truth).log_likelihood;
  show("noise::Likelihood", "gain of the true density over 1.1 times it", gain, gain > 0.0);

  const noise::ArmaGarchFit fit = noise::fit_arma_garch({.y = std::span(record).first(5000)}, {.ar = 1});
  show("noise::fit_arma_garch", "alpha 1 of white noise", fit.model.alpha.front(), std::abs(fit.model.alpha.front()) < 0.06);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;  // a scenario, and one with observations
  simulate_and_navigate(argv[1]);
  observe(argv[2]);
  integers();
  noise_of_a_record();
  return failures;
}
