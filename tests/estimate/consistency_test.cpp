// Many seeded runs with errors drawn from the very model that the filter uses: errors must have the size that it says.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <map>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/smoother.hpp"
#include "coast/geo/earth.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr double kDuration = 120.0;
constexpr double kRate = 100.0;
constexpr double kOutage = 60.0;  // s, start; 20 s long
constexpr int kRuns = 60;

/// Sensor errors drawn here, apart from the room that simulates, because their true states are wanted at every second.
struct DrawnImu {
  record::ImuRecording imu;
  std::vector<Eigen::VectorXd> states;  ///< at 0, 1, 2 .. s
};

DrawnImu draw_imu(const record::ImuRecording& truth, const StateLayout& layout, std::mt19937_64& random) {
  DrawnImu drawn{truth, {}};
  Eigen::VectorXd x =
      layout.initial_covariance().diagonal().cwiseSqrt().cwiseProduct(test::normal_vector(layout.size(), random));
  drawn.states.push_back(x);
  const double dt = 1.0 / kRate;
  Eigen::VectorXd phi = Eigen::VectorXd::Ones(layout.size()), q = Eigen::VectorXd::Zero(layout.size());
  for (const auto& b : layout.sensors()) {
    b.process->transition(dt, Eigen::Map<Eigen::MatrixXd>(&phi(b.offset), 1, 1));
    b.process->driving_noise(dt, Eigen::Map<Eigen::MatrixXd>(&q(b.offset), 1, 1));
  }
  const Eigen::VectorXd drive = q.cwiseSqrt();
  const Eigen::Vector3d gyro_white = layout.gyro_noise_b().diagonal() * std::sqrt(dt);
  const Eigen::Vector3d accel_white = layout.accel_noise_b().diagonal() * std::sqrt(dt);
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    const Eigen::VectorXd before = x;
    x = phi.cwiseProduct(x) + drive.cwiseProduct(test::normal_vector(layout.size(), random));
    record::ImuSample& sample = drawn.imu.samples[k];
    for (const auto& b : layout.sensors()) {
      const bool gyro = b.sensor == noise::Sensor::kGyro;
      const Eigen::Vector3d& increment = gyro ? truth.samples[k].dtheta : truth.samples[k].dv;
      const double error = 0.5 * (before(b.offset) + x(b.offset)) * (b.signal_b ? b.signal_b->dot(increment) : dt);
      (gyro ? sample.dtheta : sample.dv) += error * b.response_b;
    }
    sample.dtheta += gyro_white.cwiseProduct(test::normal_vector(3, random));
    sample.dv += accel_white.cwiseProduct(test::normal_vector(3, random));
    if ((k + 1) % static_cast<std::size_t>(kRate) == 0) drawn.states.push_back(x);
  }
  return drawn;
}

/// Sums over the runs, by what was tested: "forward position at 40 s".
class Nees {
 public:
  void add(const std::string& what, const Eigen::VectorXd& error, const Eigen::MatrixXd& P) {
    Sum& sum = sums_[what];
    sum.total += error.dot(P.ldlt().solve(error));
    sum.dof = static_cast<double>(error.size());
    ++sum.count;
  }
  void check() const {
    for (const auto& [what, sum] : sums_) {
      const test::Chi2Bounds bounds = test::chi2_mean_bounds(sum.dof, sum.count);
      const double mean = sum.total / sum.count;
      EXPECT_TRUE(mean > bounds.lower && mean < bounds.upper)
          << what << ": " << mean << " outside [" << bounds.lower << ", " << bounds.upper << "] of " << sum.dof;
    }
  }

 private:
  struct Sum {
    double total = 0.0;
    double dof = 0.0;
    double count = 0.0;
  };
  std::map<std::string, Sum> sums_;
};

class Consistency : public testing::Test {
 protected:
  Consistency() : model_(test::error_model(test::kIndustrialModel)) {
    simulate::GnssOptions& gnss = recording_options_.gnss;
    gnss.rate_hz = 2.0;
    gnss.lever_arm_b = {0.5, 0.2, -1.0};
    gnss.sd = {0.02, 0.02, 0.04};
    recording_options_.duration = kDuration;
    options_.gate_probability = 0.0;
    options_.withheld.push_back({test::mission_start() + kOutage, test::mission_start() + (kOutage + 20.0)});
  }

  void run(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    test::Recording recording = test::make_recording(recording_options_, nullptr, seed);
    const StateLayout layout(model_, Eigen::Matrix3d::Identity(), options_.auxiliary);
    const DrawnImu drawn = draw_imu(recording.imu, layout, random);
    recording.imu = drawn.imu;
    const ForwardFilter filter(recording.mission(), model_, options_);
    const FilterState start = test::drawn_start(filter, recording.truth(test::mission_start()), {}, random);

    KnotStore knots;
    FilterOutputs outputs;
    outputs.knots = &knots;
    outputs.at_knots = [&](const FilterState& state) {
      if (const auto second = checked(state.nav.t))
        compare("forward", *second, state.nav, state.x, state.P, recording, drawn.states[*second]);
    };
    const FilterResult result = filter.run(start, outputs);
    for (const InnovationRecord& innovation : result.innovations) {
      nis_ += innovation.nis;
      nis_dof_ += innovation.dof;
    }
    const auto smoothed = smooth(knots, layout);
    for (const SmoothedKnot& knot : smoothed) {
      compare_outage(knot, recording);
      if (const auto second = checked(knot.nav.t)) compare_smoothed(*second, knot, recording, drawn.states[*second]);
    }
  }

  // The instants at which errors are looked at: far enough apart, before, in and after the outage.
  static std::optional<std::size_t> checked(geo::GpsTime t) {
    for (const std::size_t second : {20u, 55u, 70u, 79u, 85u, 110u})
      if (std::abs(t - (test::mission_start() + static_cast<double>(second))) < 1e-6) return second;
    return std::nullopt;
  }

  void compare(const std::string& pass, std::size_t second, const record::NavState& nav, const Eigen::VectorXd& x,
               const Eigen::MatrixXd& P, const test::Recording& recording, const Eigen::VectorXd& true_x) {
    Eigen::VectorXd d = x - true_x;
    d.head<kNav>() = error_between(nav, recording.truth(nav.t));
    const auto add = [&](const char* what, Eigen::Index first, Eigen::Index size) {
      nees_.add(pass + " " + what + " at " + std::to_string(second) + " s", d.segment(first, size),
                P.block(first, first, size, size));
    };
    add("position", kPos, 3);
    add("velocity", kVel, 3);
    add("attitude", kPsi, 3);
    add("gyro", kNav, (x.size() - kNav) / 2);
    add("accelerometer", kNav + (x.size() - kNav) / 2, (x.size() - kNav) / 2);
    add("state", 0, x.size());
  }

  void compare_smoothed(std::size_t second, const SmoothedKnot& knot, const test::Recording& recording,
                        const Eigen::VectorXd& true_x) {
    const record::NavState truth = recording.truth(knot.nav.t);
    const Eigen::Matrix<double, kNav, 1> d = error_between(knot.nav, truth);
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(truth.r_eb_e)).transpose();
    const std::string at = " at " + std::to_string(second) + " s";
    nees_.add("smoothed position" + at, C_e_n * d.segment<3>(kPos), knot.cov.position);
    nees_.add("smoothed velocity" + at, C_e_n * d.segment<3>(kVel), knot.cov.velocity);
    nees_.add("smoothed attitude" + at, C_e_n * d.segment<3>(kPsi), knot.cov.attitude);
    for (Eigen::Index i = kNav; i < knot.x.size(); ++i) {
      const double ratio = (knot.x(i) - true_x(i)) / knot.sd(i);
      const std::string sensor = i < kNav + (knot.x.size() - kNav) / 2 ? "gyro" : "accelerometer";
      if (i % 4 == 0)
        nees_.add("smoothed " + sensor + " state " + std::to_string(i) + at, Eigen::VectorXd::Constant(1, ratio),
                  Eigen::MatrixXd::Ones(1, 1));
    }
  }

  void compare_outage(const SmoothedKnot& knot, const test::Recording& recording) {
    const double elapsed = knot.nav.t - test::mission_start();
    if (std::abs(elapsed - (kOutage + 5.0)) > 1e-6 && std::abs(elapsed - (kOutage + 13.0)) > 1e-6) return;
    const record::NavState truth = recording.truth(knot.nav.t);
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(truth.r_eb_e)).transpose();
    const Eigen::Vector3d error = C_e_n * (knot.nav.r_eb_e - truth.r_eb_e);
    for (int i = 0; i < 3; ++i) {
      ++outage_errors_;
      if (std::abs(error(i)) < 1.96 * std::sqrt(knot.cov.position(i, i))) ++inside_;
    }
  }

  noise::ImuErrorModel model_;
  test::RecordingOptions recording_options_;
  FilterOptions options_;
  Nees nees_;
  double nis_ = 0.0;
  double nis_dof_ = 0.0;
  int outage_errors_ = 0;
  int inside_ = 0;
};

TEST_F(Consistency, ErrorsHaveTheSizeThatFilterAndSmootherSay) {
  for (int seed = 1; seed <= kRuns; ++seed) run(static_cast<std::uint64_t>(seed));
  nees_.check();
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(nis_dof_, 1.0);
  EXPECT_GT(nis_, bounds.lower) << nis_dof_;
  EXPECT_LT(nis_, bounds.upper) << nis_dof_;
  // Errors in the middle of 20 s without GNSS against their 95 % bounds.
  const double share = static_cast<double>(inside_) / outage_errors_;
  EXPECT_GE(share, 0.90);
  EXPECT_LE(share, 0.98);
}

}  // namespace
}  // namespace coast
