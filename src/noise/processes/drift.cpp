#include <fmt/format.h>

#include "entry.hpp"
#include "linear_ramp.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

/// error = slope (t - start), the slope known: a mean without variance, not changed by measurements.
class Drift final : public LinearRamp {
 public:
  Drift(double slope, std::string_view unit) : slope_(slope), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "drift"; }
  void initial_mean(Eigen::Ref<Eigen::VectorXd> mean) const override {
    mean(0) = 0.0;
    mean(1) = slope_;
  }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: drift, slope: {:.17g}, unit: {}}}", slope_, unit_);
  }

 protected:
  [[nodiscard]] double mean_square_slope() const override { return slope_ * slope_; }

 private:
  double slope_;  ///< [signal]/s
  std::string_view unit_;
};

}  // namespace

Registration drift() {
  return {"drift",
          "a known drift: error = `slope` x time since the start of the recording, the same at every start; the slope may be "
          "negative. A slope that is unknown is a rate_ramp",
          "{process: drift, slope: -0.4, unit: deg/h/h}", "{process: drift, slope: 15, unit: ug/h}",
          [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
            return {std::make_shared<Drift>(signed_value_with_unit(entry, "slope", kSignalRamp, context),
                                            si_unit(kSignalRamp.of(context.sensor)))};
          }};
}

}  // namespace coast::noise
