#include <fmt/format.h>

#include "entry.hpp"
#include "linear_ramp.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

/// error = slope (t - start), the slope unknown and constant: drawn once per run with standard deviation R.
class RateRamp final : public LinearRamp {
 public:
  RateRamp(double coefficient, std::string_view unit) : coefficient_(coefficient), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "rate_ramp"; }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override {
    P.setZero();
    P(1, 1) = coefficient_ * coefficient_;
  }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: rate_ramp, coefficient: {:.17g}, unit: {}}}", coefficient_, unit_);
  }

 protected:
  [[nodiscard]] double mean_square_slope() const override { return coefficient_ * coefficient_; }

 private:
  double coefficient_;  ///< R, [signal]/s
  std::string_view unit_;
};

}  // namespace

Registration rate_ramp() {
  return {
      "rate_ramp",
      "a drift whose slope is unknown: `coefficient` is R of IEEE 952, the standard deviation of a slope that is drawn once "
      "per simulated run and estimated by the filter. A slope that is known is a drift",
      "{process: rate_ramp, coefficient: 0.3, unit: deg/h/h}", "{process: rate_ramp, coefficient: 20, unit: ug/h}",
      [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
        return {std::make_shared<RateRamp>(value_with_unit(entry, "coefficient", kSignalRamp, context),
                                           si_unit(kSignalRamp.of(context.sensor)))};
      }};
}

}  // namespace coast::noise
