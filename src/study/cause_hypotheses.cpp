#include "cause_hypotheses.hpp"

#include <fmt/format.h>

#include <array>

#include "coast/geo/units.hpp"

namespace coast::study {

namespace {

void change_gyro(Excerpt& excerpt, const Eigen::Matrix3d& M) {
  for (record::ImuSample& s : excerpt.imu.samples) s.dtheta = M * s.dtheta;
}

void change_accel(Excerpt& excerpt, double factor) {
  for (record::ImuSample& s : excerpt.imu.samples) s.dv *= factor;
}

void add_signs_and_axes(std::vector<CauseHypothesis>& all) {
  static constexpr std::array<const char*, 3> kAxis{"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
    turned(i, i) = -1.0;
    const char* axis = kAxis[static_cast<std::size_t>(i)];
    all.push_back({fmt::format("the sign of the gyro about body {} is reversed", axis),
                   "reverse that column in the file, or correct `columns` and `axes`",
                   [turned](Excerpt& excerpt, Setup&) { change_gyro(excerpt, turned); }});
    const Eigen::Index j = (i + 1) % 3;
    Eigen::Matrix3d exchanged = Eigen::Matrix3d::Identity();
    exchanged.row(i).swap(exchanged.row(j));
    all.push_back({fmt::format("the gyros about body {} and {} are exchanged", axis, kAxis[static_cast<std::size_t>(j)]),
                   "exchange them in `columns: {gyro: [..]}`",
                   [exchanged](Excerpt& excerpt, Setup&) { change_gyro(excerpt, exchanged); }});
    Eigen::Matrix3d others = -turned;
    all.push_back({fmt::format("the gyro's axes are turned by 180 deg about body {} against the accelerometer's", axis),
                   "correct `columns` and `axes`, which both share",
                   [others](Excerpt& excerpt, Setup&) { change_gyro(excerpt, others); }});
  }
  all.push_back({"all signs of the gyro are turned", "`scale: {gyro: -1}`",
                 [](Excerpt& excerpt, Setup&) { change_gyro(excerpt, -Eigen::Matrix3d::Identity()); }});
}

void add_units(std::vector<CauseHypothesis>& all) {
  const auto gyro = [&all](const char* what, const char* remedy, double factor) {
    all.push_back({what, remedy, [factor](Excerpt& e, Setup&) { change_gyro(e, factor * Eigen::Matrix3d::Identity()); }});
  };
  gyro("the gyro is in deg/s", "`units: {gyro: deg/s}`", geo::kDegree);
  gyro("the gyro is in rad/s", "`units: {gyro: rad/s}`", 1.0 / geo::kDegree);
  all.push_back(
      {"the accelerometer is in g", "`units: {accel: g}`", [](Excerpt& e, Setup&) { change_accel(e, geo::kStandardGravity); }});
  all.push_back({"the accelerometer is in m/s^2", "`units: {accel: m/s^2}`",
                 [](Excerpt& e, Setup&) { change_accel(e, 1.0 / geo::kStandardGravity); }});
}

void add_antenna(std::vector<CauseHypothesis>& all) {
  all.push_back(
      {"the lever arm is", "", [](Excerpt&, Setup& setup) { setup.filter.auxiliary.lever_arm_sd_m = kFreeArmSd; }, false});
  all.push_back(
      {"the time offset is", "", [](Excerpt&, Setup& setup) { setup.filter.auxiliary.time_offset_sd_s = kFreeTimeSd; }, false});
  for (const double shift : {-18.0, 18.0})
    all.push_back({"the time offset is", "",
                   [shift](Excerpt&, Setup& setup) {
                     setup.time_offset_s += shift;
                     setup.filter.auxiliary.time_offset_sd_s = kFreeTimeSd;
                   },
                   false});
}

}  // namespace

std::vector<CauseHypothesis> cause_hypotheses() {
  std::vector<CauseHypothesis> all;
  add_signs_and_axes(all);
  add_units(all);
  add_antenna(all);
  return all;
}

}  // namespace coast::study
