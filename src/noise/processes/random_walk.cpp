#include <fmt/format.h>

#include "entry.hpp"
#include "processes/processes.hpp"
#include "scalar_process.hpp"

namespace coast::noise {

namespace {

/// dx = sqrt(q) dW, x(0) = 0: what starts unknown is a random_constant beside it.
class RandomWalk final : public ScalarProcess {
 public:
  RandomWalk(double density, std::string_view unit) : density_(density), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "random_walk"; }
  /// IEEE Std 952-1997 annex C: K^2 tau/3; the Hadamard variance of it is half as large.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override { return density_ * density_ * tau / 3.0; }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override { return density_ * density_ * tau / 6.0; }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: random_walk, density: {:.17g}, unit: {}}}", density_, unit_);
  }

 protected:
  [[nodiscard]] double phi(double) const override { return 1.0; }
  [[nodiscard]] double q(double dt) const override { return density_ * density_ * dt; }
  [[nodiscard]] double initial_variance() const override { return 0.0; }

 private:
  double density_;  ///< [signal]/sqrt(s)
  std::string_view unit_;
};

}  // namespace

Registration random_walk() {
  return {"random_walk", "integrated white noise that starts at zero: `density` per square root of time",
          "{process: random_walk, density: 2, unit: deg/h/sqrt(h)}", "{process: random_walk, density: 1, unit: ug/sqrt(s)}",
          [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
            return {std::make_shared<RandomWalk>(value_with_unit(entry, "density", kSignalWalk, context),
                                                 si_unit(kSignalWalk.of(context.sensor)))};
          }};
}

}  // namespace coast::noise
