#include "estimate/mission.hpp"

#include <map>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "coast/simulate/imu.hpp"
#include "coast/simulate/sensor_errors.hpp"

namespace coast::test {

const char* const kFullModel = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.2, unit: deg/sqrt(h)}, {process: random_constant, sigma: 20, unit: deg/h},
        {process: gauss_markov, sigma: 10, unit: deg/h, correlation_time_s: 5}, {process: random_walk, density: 20, unit: deg/h/sqrt(h)},
        {process: scale_factor, sigma: 800, unit: ppm}, {process: misalignment, sigma: 0.8, unit: mrad}]
accel:
  all: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg},
        {process: gauss_markov, sigma: 0.3, unit: mg, correlation_time_s: 20}, {process: random_walk, density: 20, unit: ug/sqrt(s)},
        {process: scale_factor, sigma: 800, unit: ppm, correlation_time_s: 30}, {process: misalignment, sigma: 0.8, unit: mrad}]
)";

const char* const kIndustrialModel = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.2, unit: deg/sqrt(h)}, {process: random_constant, sigma: 30, unit: deg/h},
        {process: gauss_markov, sigma: 6, unit: deg/h, correlation_time_s: 100}, {process: scale_factor, sigma: 500, unit: ppm}]
accel:
  all: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg},
        {process: gauss_markov, sigma: 0.1, unit: mg, correlation_time_s: 100}, {process: scale_factor, sigma: 500, unit: ppm}]
)";

noise::ImuErrorModel error_model(const std::string& yaml) {
  return noise::ImuErrorModel::from(io::parse_yaml(yaml, "model.yaml"));
}

geo::GpsTime mission_start() {
  return geo::GpsTime::from_week(2300, 100000.0);
}

namespace {

simulate::AnalyticTrajectory make_weaving(double duration) {
  using geo::kDegree;
  using simulate::Signal;
  using simulate::Steps;
  const Steps always(1.0);
  simulate::MotionPlan plan;
  plan.origin = {46.5 * kDegree, 6.6 * kDegree, 420.0};
  plan.duration = duration;
  plan.speed = Signal(Steps(12.0), always, {{4.0, 0.031, 0.4}, {2.5, 0.067, 1.0}});
  plan.course = Signal(Steps(0.5), always, {{80.0 * kDegree, 0.021, 0.0}, {35.0 * kDegree, 0.053, 2.0}});
  plan.slope = Signal(Steps(0.0), always, {{3.0 * kDegree, 0.017, 0.3}});
  plan.roll = Signal(Steps(0.0), always, {{2.0 * kDegree, 0.11, 0.3}, {0.5 * kDegree, 1.4, 1.1}});
  plan.pitch = Signal(Steps(0.0), always, {{0.5 * kDegree, 1.6, 0.7}});
  plan.down = Signal(Steps(0.0), always, {{0.02, 1.5, 0.5}});
  plan.rule = {-0.06, 0.04};
  return simulate::AnalyticTrajectory(plan);
}

// Error-free increments are the same for every seed, and most of the cost of a recording.
const record::ImuRecording& true_increments(double duration, double rate_hz) {
  static std::map<std::pair<double, double>, record::ImuRecording> known;
  const auto [entry, is_new] = known.try_emplace({duration, rate_hz});
  if (is_new) entry->second = simulate::true_increments(weaving(duration), {mission_start(), rate_hz, 3});
  return entry->second;
}

}  // namespace

const simulate::AnalyticTrajectory& weaving(double duration) {
  static std::map<double, simulate::AnalyticTrajectory> known;
  const auto found = known.find(duration);
  return found != known.end() ? found->second : known.emplace(duration, make_weaving(duration)).first->second;
}

estimate::Mission Recording::mission() const {
  return {.imu = imu, .gnss = gnss, .lever_arm_b = lever_arm_b};
}

Recording make_recording(const RecordingOptions& options, const noise::ImuErrorModel* model, std::uint64_t seed) {
  Recording recording;
  recording.motion = &weaving(options.duration);
  const record::ImuRecording& truth = true_increments(options.duration, options.imu_rate_hz);
  recording.imu = model != nullptr ? simulate::with_errors(truth, *model, seed) : truth;
  recording.gnss = simulate::gnss_fixes(*recording.motion, mission_start(), options.gnss, seed);
  recording.lever_arm_b = options.gnss.lever_arm_b;
  return recording;
}

estimate::FilterState drawn_start(const estimate::ForwardFilter& filter, const record::NavState& truth, const StartSd& sd,
                                  std::mt19937_64& random) {
  estimate::FilterState start = filter.initial_state(truth, Eigen::Vector3d::Constant(sd.position),
                                                     Eigen::Vector3d::Constant(sd.velocity), sd.attitude());
  Eigen::VectorXd error = Eigen::VectorXd::Zero(start.P.rows());
  const Eigen::LLT<Eigen::MatrixXd> llt(start.P.topLeftCorner<estimate::kNav, estimate::kNav>());
  error.head<estimate::kNav>() = llt.matrixL() * normal_vector(estimate::kNav, random);
  estimate::remove_error(-error, start.nav, start.x);
  return start;
}

Eigen::Vector3d rate_at(const estimate::StateLayout& layout, const Eigen::Vector3d& omega, const Eigen::VectorXd& x0,
                        const estimate::FilterState& state) {
  Eigen::Vector3d rate = omega;
  for (const auto& block : layout.sensors())
    if (block.sensor == noise::Sensor::kGyro)
      rate -=
          (state.x(block.offset) - x0(block.offset)) * (block.signal_b ? block.signal_b->dot(omega) : 1.0) * block.response_b;
  return rate;
}

Eigen::VectorXd normal_vector(Eigen::Index size, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
}

Eigen::MatrixXd random_covariance(Eigen::Index size, std::mt19937_64& random) {
  const Eigen::MatrixXd A = normal_vector(size * size, random).reshaped(size, size);
  return Eigen::MatrixXd::Identity(size, size) + A * A.transpose() / static_cast<double>(size);
}

}  // namespace coast::test
