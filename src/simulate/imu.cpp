#include "coast/simulate/imu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "parallel.hpp"
#include "quadrature.hpp"

namespace coast::simulate {
namespace {

constexpr double kLongestPanel = 0.010;  // s

void check(const ImuSampling& sampling, int threads) {
  if (!(sampling.rate_hz >= 0.1 && sampling.rate_hz <= 1e5))
    throw std::invalid_argument(fmt::format("ImuSampling::rate_hz is {}, expected 0.1 to 1e5", sampling.rate_hz));
  if (sampling.nodes && (*sampling.nodes < 1 || *sampling.nodes > 12))
    throw std::invalid_argument(fmt::format("ImuSampling::nodes is {}, expected 1 to 12", *sampling.nodes));
  if (threads < 1) throw std::invalid_argument(fmt::format("threads is {}, expected at least 1", threads));
}

int nodes(const ImuSampling& sampling) {
  return sampling.nodes.value_or(sampling.rate_hz < 200.0 ? 5 : 4);
}

std::int64_t epoch_ns(std::size_t k, double rate_hz) {
  return static_cast<std::int64_t>(std::llround(static_cast<double>(k) * 1e9 / rate_hz));
}

class IncrementIntegral {
 public:
  IncrementIntegral(const AnalyticTrajectory& motion, const ImuInstallation& installation, int node_count)
      : motion_(motion), installation_(installation), rule_(node_count) {}

  void operator()(double from, double to, record::ImuSample& sample) const {
    const int panels = std::max(1, static_cast<int>(std::ceil((to - from) / kLongestPanel - 1e-6)));
    const double width = (to - from) / panels;
    Eigen::Vector3d dtheta = Eigen::Vector3d::Zero();
    Eigen::Vector3d dv = Eigen::Vector3d::Zero();
    for (int panel = 0; panel < panels; ++panel) {
      for (std::size_t i = 0; i < rule_.node.size(); ++i) {
        const Kinematics imu = at_point(motion_.at(from + (panel + rule_.node[i]) * width), installation_.lever_arm_b);
        dtheta += rule_.weight[i] * width * omega_ib_b(imu);
        dv += rule_.weight[i] * width * f_ib_b(imu);
      }
    }
    sample.dtheta = installation_.C_b_s * dtheta;
    sample.dv = installation_.C_b_s * dv;
  }

 private:
  const AnalyticTrajectory& motion_;
  const ImuInstallation& installation_;
  GaussLegendre rule_;
};

}  // namespace

record::ImuRecording true_increments(const AnalyticTrajectory& motion, const ImuSampling& sampling,
                                     const ImuInstallation& installation, int threads) {
  check(sampling, threads);
  const auto count = static_cast<std::size_t>(std::floor(motion.duration() * sampling.rate_hz * (1.0 + 1e-15)));
  record::ImuRecording recording;
  recording.source = "simulated";
  recording.rate_hz = sampling.rate_hz;
  recording.samples.resize(count);
  const IncrementIntegral integrate(motion, installation, nodes(sampling));
  in_parts(count, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::int64_t from = epoch_ns(k, sampling.rate_hz);
      const std::int64_t to = epoch_ns(k + 1, sampling.rate_hz);
      record::ImuSample& sample = recording.samples[k];
      sample.t = geo::GpsTime::from_nanoseconds(sampling.start.nanoseconds() + to);
      sample.dt = static_cast<double>(to - from) * 1e-9;
      integrate(static_cast<double>(from) * 1e-9, static_cast<double>(to) * 1e-9, sample);
    }
  });
  return recording;
}

record::Trajectory true_states(const AnalyticTrajectory& motion, const record::ImuRecording& recording, geo::GpsTime start,
                               int threads) {
  record::Trajectory truth;
  truth.source = "simulated";
  truth.states.resize(recording.samples.size() + 1);
  in_parts(truth.states.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const geo::GpsTime t = k == 0 ? start : recording.samples[k - 1].t;
      truth.states[k] = motion.nav_state(start, t - start);
      truth.states[k].t = t;
    }
  });
  return truth;
}

}  // namespace coast::simulate
