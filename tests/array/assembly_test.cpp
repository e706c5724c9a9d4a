// From recordings that differ in clock, place and axes to signals that agree, and what the whole way makes of a sensor that
// fails.

#include "coast/array/assembly.hpp"

#include <gtest/gtest.h>

#include "array/analytic_array.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/simulate/imu.hpp"
#include "coast/simulate/motions.hpp"

namespace coast::array {
namespace {

const geo::GpsTime kMissionStart = geo::GpsTime::from_week(2300, 1000.0);

/// Three IMUs on a simulated car, free of errors but for what the test adds.
struct CarArray {
  std::vector<SensorFrame> frames = test::four_frames();
  std::vector<record::ImuRecording> recordings;

  explicit CarArray(double rate_sd = 0.002, double force_sd = 0.02) {
    frames.pop_back();
    simulate::MotionParameters parameters;
    parameters.duration = 330.0;
    parameters.static_start = 10.0;
    parameters.origin = {0.8, 0.1, 400.0};
    const simulate::AnalyticTrajectory motion = simulate::make_motion("car_roundabout", parameters);
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal;
    for (const SensorFrame& frame : frames) {
      recordings.push_back(simulate::true_increments(motion, {kMissionStart, 100.0, {}}, {frame.r_b, frame.C_s_b.transpose()}));
      for (record::ImuSample& sample : recordings.back().samples)
        for (int i = 0; i < 3; ++i) {
          sample.dtheta(i) += rate_sd * normal(generator) * sample.dt;
          sample.dv(i) += force_sd * normal(generator) * sample.dt;
        }
    }
  }
  void shift_clock(std::size_t k, double offset, double ppm) {
    for (record::ImuSample& sample : recordings[k].samples)
      sample.t = kMissionStart + (offset + (1.0 + 1e-6 * ppm) * (sample.t - kMissionStart));
  }
  [[nodiscard]] std::vector<ArrayMember> members() const {
    std::vector<ArrayMember> list;
    for (std::size_t k = 0; k < frames.size(); ++k) list.push_back({fmt::format("imu{}", k + 1), &recordings[k], frames[k]});
    return list;
  }
};

double rms_between(const Signals& signals, std::size_t a, std::size_t b, int first) {
  const auto difference = (signals.sensors[a].values - signals.sensors[b].values).middleRows<3>(first);
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t n = 0; n < signals.samples(); ++n) {
    if (signals.sensors[a].usable[n] != kAllUsable || signals.sensors[b].usable[n] != kAllUsable) continue;
    squares += difference.col(static_cast<Eigen::Index>(n)).squaredNorm();
    count += 3.0;
  }
  return std::sqrt(squares / count);
}

TEST(Assembly, BringsClocksPlacesAndAxesTogether) {
  CarArray car;
  car.shift_clock(1, 0.0123, 0.0);
  car.shift_clock(2, -0.0041, 40.0);
  const Assembly assembly = assemble(car.members(), {});
  const double middle = 0.5 * static_cast<double>(assembly.signals.samples()) * 0.01;
  ASSERT_TRUE(assembly.lags[1] && assembly.lags[2]);
  EXPECT_NEAR(assembly.lags[1]->offset_s, 0.0123, 1e-4);
  EXPECT_NEAR(assembly.lags[2]->offset_s, -0.0041 + 40e-6 * middle, 1e-4);
  EXPECT_NEAR(assembly.lags[2]->drift_ppm, 40.0, 5.0 * assembly.lags[2]->drift_sigma_ppm + 0.5);
  // Two sensors' white noise and no more: resampling lowers it a little, never raises it.
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_LT(rms_between(assembly.signals, 0, k, 0), 1.03 * std::sqrt(2.0) * 0.002);
    EXPECT_LT(rms_between(assembly.signals, 0, k, 3), 1.03 * std::sqrt(2.0) * 0.02);
  }
  EXPECT_TRUE(assembly.defects.defects.empty());
  // Without lags taken out it would not.
  AssemblyOptions tags;
  tags.lags.reset();
  tags.defects.reset();
  EXPECT_GT(rms_between(assemble(car.members(), tags).signals, 0, 1, 0), 1.5 * std::sqrt(2.0) * 0.002);
}

TEST(Assembly, LeavesOutASensorThatJumpsAndTakesItBack) {
  CarArray car;
  auto& samples = car.recordings[1].samples;
  for (std::size_t n = 12000; n < samples.size(); ++n) samples[n].dtheta.z() += 0.05 * samples[n].dt;
  const Assembly assembly = assemble(car.members(), {});
  ASSERT_EQ(assembly.defects.defects.size(), 1U);
  const Defect& defect = assembly.defects.defects.front();
  EXPECT_EQ(defect.sensor, 1U);
  EXPECT_EQ(defect.kind, DefectKind::kBiasJump);
  EXPECT_NEAR(static_cast<double>(defect.from), 12000.0, 20.0);  // two blocks of 0.1 s
  EXPECT_LT(defect.to, 13500U);                                  // recovery_s and the test's own time
  // Used again, with the bias that it had: against the first sensor nothing has moved.
  const auto bias = [&](Eigen::Index from) {
    return (assembly.signals.sensors[1].values - assembly.signals.sensors[0].values)
        .middleCols(from, 8000)
        .rowwise()
        .mean()
        .eval();
  };
  EXPECT_LT((bias(15000) - bias(3000)).head<3>().cwiseAbs().maxCoeff(), 5e-4);
  EXPECT_EQ(assembly.signals.sensors[1].usable[20000], kAllUsable);
}

TEST(Assembly, RefinesFramesThatAreRoughlyStated) {
  CarArray car;
  std::vector<ArrayMember> members = car.members();
  members[1].frame.C_s_b = geo::rotation_matrix({0.02, -0.03, 0.05}) * members[1].frame.C_s_b;
  AssemblyOptions options;
  options.mounting = MountingOptions{};
  const Assembly refined = assemble(members, options);
  const double as_stated = rms_between(assemble(members, {}).signals, 0, 1, 3);
  EXPECT_LT(rms_between(refined.signals, 0, 1, 3), 0.3 * as_stated);
  ASSERT_TRUE(refined.mounting);
  EXPECT_LT(refined.mounting->forces_after, refined.mounting->forces_before);
}

TEST(Assembly, MatchesTimesByTheAttitudesThatItRefined) {
  CarArray car(2e-4, 2e-3);
  car.shift_clock(1, 0.0123, 0.0);
  std::vector<ArrayMember> members = car.members();
  const Assembly truly_stated = assemble(members, {});
  members[1].frame.C_s_b = geo::rotation_matrix({0.026, -0.018, 0.022}) * members[1].frame.C_s_b;  // 1.5, 1, 1.3 deg
  const auto lag_error = [](const Assembly& assembly) { return std::abs(assembly.lags[1]->offset_s - 0.0123); };
  AssemblyOptions options;
  const double as_stated = lag_error(assemble(members, options));
  options.mounting = MountingOptions{};
  const double refined = lag_error(assemble(members, options));
  EXPECT_LT(refined, lag_error(truly_stated) + 2e-6);  // as if nobody had been wrong, to 2 us
  EXPECT_GT(as_stated, 5e-6);                          // which is not so without
}

TEST(Assembly, RefusesWhatItCannotUse) {
  CarArray car;
  EXPECT_THROW(static_cast<void>(assemble({car.members().front()}, {})), std::invalid_argument);
  for (record::ImuSample& sample : car.recordings[1].samples) sample.t = sample.t + 320.0;  // 10 s in common
  EXPECT_THROW(static_cast<void>(assemble(car.members(), {})), std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
