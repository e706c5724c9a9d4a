// The members of a synthetic IMU told apart by their differences: against all sensors' signals taken at once, and in a filter.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "coast/array/extended.hpp"
#include "coast/estimate/forward_filter.hpp"
#include "coast/ins/reversal.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"
#include "coast/simulate/sensor_errors.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;
using record::MemberBlocks;

constexpr double kSignalVariance = 1e-6;  // (rad/s)^2

constexpr const char* kGoodMember = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: random_constant, sigma: 30, unit: deg/h},
        {process: gauss_markov, sigma: 6, unit: deg/h, correlation_time_s: 100}, {process: scale_factor, sigma: 500, unit: ppm}]
accel:
  all: [{process: white_noise, density: 40, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg}]
)";
constexpr const char* kPoorMember = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.3, unit: deg/sqrt(h)}, {process: random_constant, sigma: 100, unit: deg/h}]
accel:
  all: [{process: white_noise, density: 100, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 5, unit: mg},
        {process: gauss_markov, sigma: 0.5, unit: mg, correlation_time_s: 50}]
)";

constexpr const char* kPlainMember = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.15, unit: deg/sqrt(h)}, {process: random_constant, sigma: 40, unit: deg/h}]
accel:
  all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 3, unit: mg}]
)";

struct Members {
  explicit Members(const std::vector<const char*>& texts = {kGoodMember, kPoorMember, kGoodMember}) {
    for (const char* text : texts) models.push_back(test::error_model(text));
    for (std::size_t k = 0; k < models.size(); ++k) sensors.push_back({std::string(1, "abc"[k]), &models[k]});
    sensors.back().C_s_b = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();  // mounted upside down
    weights = array::extended_weights(sensors);
    sum = array::extended_error_model("sum", 100.0, sensors);
  }
  Members(const Members&) = delete;
  Members& operator=(const Members&) = delete;

  std::vector<noise::ImuErrorModel> models;
  std::vector<array::ModelledSensor> sensors;
  Eigen::MatrixXd weights;
  noise::ImuErrorModel sum;
};

/// What a member's states add to the mean of each axis of a block.
Eigen::MatrixXd design_of(const Members& members, const StateLayout& layout, std::size_t member,
                          const Eigen::Vector3d& signal) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, layout.size());
  for (const auto& block : layout.sensors())
    if (block.member == member && block.sensor == noise::Sensor::kGyro)
      H(block.axis, block.offset) =
          block.signal_axis ? signal(*block.signal_axis) : members.sensors[member].C_s_b(block.axis, block.axis);
  return H;
}

FilterState some_state(const StateLayout& layout) {
  std::mt19937_64 random(4);
  FilterState state;
  state.nav.r_eb_e = {4.3e6, 5e5, 4.6e6};
  state.x = Eigen::VectorXd::Zero(layout.size());
  state.x.tail(layout.size() - kNav) = 1e-3 * test::normal_vector(layout.size() - kNav, random);
  state.P = 1e-6 * test::random_covariance(layout.size(), random);
  return state;
}

/// Information of a member's mean over a block.
double information_of(const Members& members, const MemberBlocks::Block& block, std::size_t member) {
  return (block.to - block.from) / members.models[member].white_density(noise::Sensor::kGyro, 0).value;
}

/// The sum of those that may be used, of a true signal that is known to kSignalVariance about zero.
Linearised measured_sum(const Members& members, const StateLayout& layout, const MemberBlocks::Block& block,
                        const FilterState& state) {
  Linearised sum{UpdateKind::kMemberDifference, Eigen::Vector3d::Zero(), Eigen::MatrixXd::Zero(3, layout.size()), {}};
  double information = 0.0;
  for (std::size_t k = 0; k < block.means.size(); ++k) {
    if (!block.means[k]) continue;
    const double own = information_of(members, block, k);
    information += own;
    sum.nu += own * block.means[k]->gyro;
    sum.H += own * design_of(members, layout, k, Eigen::Vector3d::Zero());
  }
  sum.H /= information;
  sum.nu = sum.nu / information - sum.H * state.x;
  sum.R = (1.0 / information + kSignalVariance) * Eigen::Matrix3d::Identity();
  return sum;
}

// The dense solution: every member's mean is the true signal, plus its errors, plus its noise. Differences and sum together
// must say the same.
void expect_as_dense(const Members& members, const MemberBlocks::Block& block) {
  const StateLayout layout(members.sum, Eigen::Matrix3d::Identity(), {});
  FilterState state = some_state(layout);
  const int unknowns = layout.size() + 3;  // and the true signal
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(unknowns, unknowns);
  information.topLeftCorner(layout.size(), layout.size()) = state.P.inverse();
  information.bottomRightCorner<3, 3>().diagonal().setConstant(1.0 / kSignalVariance);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  right.head(layout.size()) = information.topLeftCorner(layout.size(), layout.size()) * state.x;
  for (std::size_t k = 0; k < block.means.size(); ++k) {
    if (!block.means[k]) continue;
    Eigen::MatrixXd A(3, unknowns);
    A << design_of(members, layout, k, Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity();
    information += information_of(members, block, k) * A.transpose() * A;
    right += information_of(members, block, k) * A.transpose() * block.means[k]->gyro;
  }
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::VectorXd expected = covariance * right;

  for (std::size_t j = 1; j < block.means.size(); ++j)
    if (const auto difference = member_difference(state, layout, block, noise::Sensor::kGyro, j))
      (void)apply(*difference, innovation(state, *difference), state);
  const Linearised sum = measured_sum(members, layout, block, state);
  (void)apply(sum, innovation(state, sum), state);
  const int sensors = layout.size() - kNav;
  test::expect_near_matrix(state.x.tail(sensors), expected.segment(kNav, sensors), 1e-8, "x");
  test::expect_near_matrix(state.P.bottomRightCorner(sensors, sensors), covariance.block(kNav, kNav, sensors, sensors), 1e-10,
                           "P");
}

MemberBlocks::Block a_block() {
  const geo::GpsTime t = test::mission_start();
  MemberBlocks::Block block{t, t + 0.5, {}};
  // Rates of zero but for errors: what scale factors do is the next test's.
  block.means = {MemberBlocks::Means{{2e-3, -1e-3, 4e-3}, {0, 0, 0}}, MemberBlocks::Means{{-1e-3, 3e-3, 0}, {0, 0, 0}},
                 MemberBlocks::Means{{5e-4, 1e-3, -2e-3}, {0, 0, 0}}};
  return block;
}

TEST(MemberDifference, WithTheSumDifferencesSayWhatAllMembersSayAtOnce) {
  const Members members({kPlainMember, kPoorMember, kPoorMember});
  expect_as_dense(members, a_block());
  for (std::size_t missing = 0; missing < 3; ++missing) {
    MemberBlocks::Block block = a_block();
    block.means[missing].reset();
    expect_as_dense(members, block);
  }
}

TEST(MemberDifference, DesignIsThatOfTheMembersErrorsWithTheirScaleFactors) {
  const Members members;
  const StateLayout layout(members.sum, Eigen::Matrix3d::Identity(), {});
  std::mt19937_64 random(9);
  FilterState state;
  state.x = Eigen::VectorXd::Zero(layout.size());
  state.P = Eigen::MatrixXd::Identity(layout.size(), layout.size());
  MemberBlocks::Block block = a_block();
  const Eigen::Vector3d signal(0.3, -0.2, 0.5);
  for (auto& means : block.means) means->gyro = signal;
  const auto at_zero = member_difference(state, layout, block, noise::Sensor::kGyro, 2);
  EXPECT_LE(at_zero->nu.norm(), 1e-15);
  // The share of a and b in their mean is 9 : 1, c is told from it.
  const Eigen::MatrixXd expected = design_of(members, layout, 2, signal) - 0.9 * design_of(members, layout, 0, signal) -
                                   0.1 * design_of(members, layout, 1, signal);
  test::expect_near_matrix(at_zero->H, expected, 1e-12, "H");
  state.x.tail(layout.size() - kNav) = test::normal_vector(layout.size() - kNav, random);
  const auto shifted = member_difference(state, layout, block, noise::Sensor::kGyro, 2);
  test::expect_near_matrix(shifted->nu, -expected * state.x, 1e-12, "nu");
}

record::ImuRecording turned(record::ImuRecording imu, const Eigen::Matrix3d& C) {
  for (record::ImuSample& sample : imu.samples) {
    sample.dtheta = C * sample.dtheta;
    sample.dv = C * sample.dv;
  }
  return imu;
}

/// Three IMUs on one drive: their sum as a recording, and their block means.
test::Recording member_recording(const Members& members, double duration, std::uint64_t seed) {
  test::RecordingOptions options;
  options.duration = duration;
  test::Recording recording = test::make_recording(options, nullptr, seed);
  array::Signals signals{recording.imu.samples.front().t - recording.imu.samples.front().dt, 0.01, {}};
  for (std::size_t k = 0; k < members.models.size(); ++k) {
    const Eigen::Matrix3d& C_s_b = members.sensors[k].C_s_b;
    const record::ImuRecording own =
        turned(simulate::with_errors(turned(recording.imu, C_s_b.transpose()), members.models[k], 100 * seed + k), C_s_b);
    array::SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.name = members.sensors[k].name;
    sensor.usable.assign(own.samples.size(), array::kAllUsable);
    sensor.values.resize(array::kChannels, static_cast<Eigen::Index>(own.samples.size()));
    for (std::size_t n = 0; n < own.samples.size(); ++n)
      sensor.values.col(static_cast<Eigen::Index>(n)) << own.samples[n].dtheta / own.samples[n].dt,
          own.samples[n].dv / own.samples[n].dt;
  }
  for (std::size_t n = 0; n < recording.imu.samples.size(); ++n) {
    record::ImuSample& sample = recording.imu.samples[n];
    array::Channels sum = array::Channels::Zero();
    for (std::size_t k = 0; k < signals.sensors.size(); ++k)
      sum += members.weights.col(static_cast<Eigen::Index>(k))
                 .cwiseProduct(signals.sensors[k].values.col(static_cast<Eigen::Index>(n)));
    sample.dtheta = sample.dt * sum.head<3>();
    sample.dv = sample.dt * sum.tail<3>();
  }
  recording.imu.members = array::member_blocks(signals, 1.0);
  return recording;
}

/// Sum of the NIS of the differences inside the 1e-4 bounds of a chi-square variate of so many degrees of freedom.
void expect_white(const FilterResult& result, std::size_t expected_updates) {
  double nis = 0.0;
  std::size_t count = 0;
  for (const InnovationRecord& r : result.innovations)
    if (r.kind == UpdateKind::kMemberDifference) {
      nis += r.nis;
      ++count;
    }
  EXPECT_EQ(count, expected_updates);
  const auto dof = static_cast<double>(3 * count);  // so many that a normal variate is as good: 3.9 sigmas
  EXPECT_NEAR(nis / dof, 1.0, 3.9 * std::sqrt(2.0 / dof));
}

TEST(MemberDifference, InnovationsAreConsistentForwardAndBackward) {
  const Members members;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    test::Recording recording = member_recording(members, 120.0, seed);
    FilterOptions options;
    options.gate_probability = 0.0;
    const ForwardFilter filter(recording.mission(), members.sum, options);
    std::mt19937_64 random(seed);
    const FilterState start = test::drawn_start(filter, recording.truth(test::mission_start()), {}, random);
    expect_white(filter.run(start, {}), 120U * 2U * 2U);

    const geo::GpsTime end = recording.imu.samples.back().t;
    ins::reverse(recording.imu, end);
    ins::reverse(recording.gnss, end);
    Mission mission = recording.mission();
    mission.earth_rate = -geo::kEarthRate;
    const ForwardFilter backward(mission, members.sum, options);
    const FilterState far = test::drawn_start(backward, ins::reversed(recording.truth(end), end), {}, random);
    expect_white(backward.run(far, {}), 120U * 2U * 2U);
  }
}

TEST(MemberDifference, ARunGoesOnFromAKnotWithEachBlockOnce) {
  const Members members;
  const test::Recording recording = member_recording(members, 20.0, 5);
  const ForwardFilter filter(recording.mission(), members.sum, {});
  std::mt19937_64 random(5);
  KnotStore knots;
  FilterOutputs outputs;
  outputs.knots = &knots;
  const FilterResult whole = filter.run(test::drawn_start(filter, recording.truth(test::mission_start()), {}, random), outputs);
  for (const std::size_t at : {knots.size() / 3, knots.size() / 2}) {
    const FilterResult rest = filter.resume(knots.at(at), recording.imu.samples.back().t, {});
    test::expect_near_matrix(rest.last.x, whole.last.x, 1e-7, "x");
    test::expect_near_matrix(rest.last.P, whole.last.P, 1e-7, "P");
  }
}

TEST(MemberDifference, AMemberUnlikeItsModelIsReported) {
  const Members members;
  test::Recording recording = member_recording(members, 60.0, 6);
  for (MemberBlocks::Block& block : recording.imu.members.blocks) block.means[1]->gyro.x() += 0.1;
  const ForwardFilter filter(recording.mission(), members.sum, {});
  std::mt19937_64 random(6);
  const FilterResult result = filter.run(test::drawn_start(filter, recording.truth(test::mission_start()), {}, random), {});
  ASSERT_EQ(result.events.size(), 1U);  // of b alone: c is not compared with it
  EXPECT_NE(result.events.back().text.find("differences of b"), std::string::npos) << result.events.back().text;
}

TEST(MemberDifference, MembersThatTheModelDoesNotKnowAreRefused) {
  const Members members;
  test::Recording recording = member_recording(members, 10.0, 1);
  recording.imu.members.names[1] = "other";
  EXPECT_THROW(ForwardFilter(recording.mission(), members.sum, {}), InputError);
}

}  // namespace
}  // namespace coast
