#include "coast/noise/share.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "coast/config/quoted.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

/// One member's error process as it acts in the sum: the states are the member's own, the output is weighted.
class SharedProcess final : public Process {
 public:
  SharedProcess(ProcessPtr own, std::string member, double weight) : own_(std::move(own)), share_{std::move(member), weight} {}
  [[nodiscard]] std::string_view name() const override { return own_->name(); }
  [[nodiscard]] Input input() const override { return own_->input(); }
  [[nodiscard]] int states() const override { return own_->states(); }
  void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const override { own_->transition(dt, Phi); }
  void driving_noise(double dt, Eigen::Ref<Eigen::MatrixXd> Q_d) const override { own_->driving_noise(dt, Q_d); }
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const override {
    own_->output(h);
    h *= share_.weight;
  }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override { own_->initial_covariance(P); }
  void initial_mean(Eigen::Ref<Eigen::VectorXd> mean) const override { own_->initial_mean(mean); }
  void reversal(Eigen::Ref<Eigen::VectorXd> sign) const override { own_->reversal(sign); }
  [[nodiscard]] std::optional<double> sample_interval() const override { return own_->sample_interval(); }
  [[nodiscard]] geo::Psd white_density() const override { return {squared_weight() * own_->white_density().value}; }
  [[nodiscard]] std::optional<geo::Psd> as_white() const override {
    const std::optional<geo::Psd> own = own_->as_white();
    if (!own) return {};
    return geo::Psd{squared_weight() * own->value};
  }
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override { return weighted(own_->allan_variance(tau)); }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override {
    return weighted(own_->hadamard_variance(tau));
  }
  [[nodiscard]] std::optional<Share> share() const override { return share_; }
  [[nodiscard]] std::string in_words() const override {
    return fmt::format("of {}, which has the weight {:.3g}", share_.member, share_.weight);
  }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: share, of: {}, weight: {:.17g}, own: {}}}", config::quoted(share_.member), share_.weight,
                       own_->yaml());
  }

 private:
  [[nodiscard]] double squared_weight() const { return share_.weight * share_.weight; }
  [[nodiscard]] std::optional<double> weighted(std::optional<double> variance) const {
    return variance ? std::optional(squared_weight() * *variance) : std::nullopt;
  }

  ProcessPtr own_;
  Share share_;
};

std::vector<ProcessPtr> make_shared(const config::Node& entry, const EntryContext& context) {
  const std::string member = entry.at("of").text();
  const config::Node weight = entry.at("weight");
  if (!(std::abs(weight.number()) > 0.0 && std::abs(weight.number()) <= 1.0))
    throw weight.error(weight.text(), "a weight of at most 1, not 0; below 0 for an axis that points the other way");
  const config::Node own = entry.at("own");
  if (own.at("process").text() == "share") throw own.error("a share of a share", "a process of the member itself");
  std::vector<ProcessPtr> processes;
  for (ProcessPtr& process : make_processes(own, context))
    processes.push_back(make_share(std::move(process), member, weight.number(), context.sensor));
  return processes;
}

}  // namespace

ProcessPtr make_share(ProcessPtr own, const std::string& member, double weight, Sensor sensor) {
  if (own->rounding() && own->white_density().value > 0.0)  // the sum does not round, and has another rate
    own = make_white_noise(std::sqrt(own->white_density().value), sensor);
  return std::make_shared<SharedProcess>(std::move(own), member, weight);
}

Registration share() {
  return {"share",
          "for a recording that is the weighted sum of several IMUs, its members: `own` is an error of member `of` by itself, "
          "`weight` what the member counts in the sum. With block means of the members (`imu.members` of a run) a filter tells "
          "their errors apart",
          "{process: share, of: left, weight: 0.4, own: {process: random_constant, sigma: 0.1, unit: deg/s}}",
          "{process: share, of: left, weight: 0.4, own: {process: white_noise, density: 100, unit: ug/sqrt(Hz)}}",
          &make_shared};
}

}  // namespace coast::noise
