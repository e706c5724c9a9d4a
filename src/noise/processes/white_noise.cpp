#include <fmt/format.h>

#include <cmath>

#include "entry.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

/// No state: white noise of the rate or specific force is a random walk of its integral.
class WhiteNoise final : public Process {
 public:
  WhiteNoise(geo::Psd density, std::string_view unit) : density_(density), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "white_noise"; }
  [[nodiscard]] int states() const override { return 0; }
  void transition(double, Eigen::Ref<Eigen::MatrixXd>) const override {}
  void driving_noise(double, Eigen::Ref<Eigen::MatrixXd>) const override {}
  void output(Eigen::Ref<Eigen::RowVectorXd>) const override {}
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd>) const override {}
  [[nodiscard]] geo::Psd white_density() const override { return density_; }
  /// IEEE Std 952-1997 annex C: N^2/tau; averages are independent, so Hadamard's is the same.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override { return density_.value / tau; }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override { return density_.value / tau; }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: white_noise, density: {:.17g}, unit: {}}}", std::sqrt(density_.value), unit_);
  }

 private:
  geo::Psd density_;
  std::string_view unit_;
};

std::vector<ProcessPtr> make_white_noise(const config::Node& entry, const EntryContext& context) {
  if (entry.find("density"))
    return {make_white_noise(value_with_unit(entry, "density", kSignalNoise, context), context.sensor)};
  if (!(context.rate_hz > 0.0))
    throw entry.at("variance_per_sample").error("a variance per sample, but the model states no rate_hz", "rate_hz > 0");
  const geo::Cov variance{value_with_unit(entry, "variance_per_sample", kSignalVariance, context)};
  return {make_white_noise(std::sqrt(geo::density_of_samples(variance, context.rate_hz).value), context.sensor)};
}

}  // namespace

ProcessPtr make_white_noise(double density, Sensor sensor) {
  return std::make_shared<WhiteNoise>(geo::Psd{density * density}, si_unit(kSignalNoise.of(sensor)));
}

Registration white_noise() {
  return {"white_noise",
          "white noise of the signal: `density` (per square root of Hz), or `variance_per_sample` at the model's rate_hz",
          "{process: white_noise, density: 0.15, unit: deg/sqrt(h)}", "{process: white_noise, density: 50, unit: ug/sqrt(Hz)}",
          make_white_noise};
}

}  // namespace coast::noise
