#include "coast/jobs/tumble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/geo/units.hpp"
#include "coast/io/imu_calibration.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "common/tell.hpp"
#include "tumble/result.hpp"

namespace coast::jobs {

namespace {

using record::ImuCalibration;

template <class List, class Residual>
double rms_of(const List& list, Residual residual) {
  double sum = 0.0;
  double count = 0.0;
  for (const auto& item : list)
    if (item.used) sum += residual(item).squaredNorm(), count += 1.0;
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

// Raw counts may be far off their unit; anything else that is has another one.
void tell_scales(const ImuCalibration& calibration, const Progress& progress) {
  constexpr double kFar = 0.3;
  for (const auto& [name, gain] :
       {std::pair("accelerometers", calibration.accel.gain), std::pair("gyros", calibration.gyro.gain)})
    if (gain.diagonal().cwiseAbs().maxCoeff() > kFar)
      progress.warn(fmt::format("the {} read {:.4g} times the truth: if these are not raw counts, check `units` and `scale`",
                                name, 1.0 + gain.diagonal().mean()));
}

// What the user should do about the experiment itself.
void tell_doubts(const TumbleResult& result, const Progress& progress) {
  if (!progress.warn) return;
  const tumble::Result& found = result.calibration;
  tell_scales(found.calibration, progress);
  for (std::size_t i = 0; i < found.rests.size(); ++i)
    if (!found.rests[i].used)
      progress.warn(fmt::format(
          "the rest at {:.0f} s contradicts all others by {:.3f} m/s^2 and is left out: touched, or on a surface that moves",
          found.rests[i].rest.from, found.rests[i].accel_residual.norm()));
  const auto left_out = std::ranges::count(found.turns, false, &tumble::TurnFit::used);
  if (left_out > 0)
    progress.warn(
        fmt::format("{} of {} turns are not used: longer than a minute, samples missing, or at odds with the others (beyond "
                    "the gyros' range?)",
                    left_out, found.turns.size()));
  if (const double sd = largest_gain_sd(found.calibration, ImuCalibration::kAccel); sd > 0.005)
    progress.warn(fmt::format("the poses determine the accelerometers' gain to {:.2g} only; add rests with {}", sd,
                              result.next.empty() ? "other sides up" : direction_text(result.next.front().up)));
  if (const double sd = largest_gain_sd(found.calibration, ImuCalibration::kGyro); sd > 0.01)
    progress.warn(fmt::format(
        "the turns determine the gyros' gain to {:.2g} only: turn by more than a right angle about every axis", sd));
}

}  // namespace

double largest_gain_sd(const ImuCalibration& calibration, int triad) {
  double largest = 0.0;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) largest = std::max(largest, calibration.gain_sd(triad, row, column));
  return largest;
}

double force_rms(const tumble::Result& result) {
  return rms_of(result.rests, [](const tumble::RestFit& rest) { return rest.accel_residual; });
}

double turn_rms(const tumble::Result& result) {
  return rms_of(result.turns, [](const tumble::TurnFit& turn) { return turn.residual; });
}

std::string direction_text(const Eigen::Vector3d& up) {
  Eigen::Index first = 0;
  up.cwiseAbs().maxCoeff(&first);
  Eigen::Vector3d rest = up;
  rest[first] = 0.0;
  Eigen::Index second = 0;
  rest.cwiseAbs().maxCoeff(&second);
  std::string text = fmt::format("{} {}", "xyz"[first], up[first] > 0.0 ? "up" : "down");
  const double angle = std::atan2(rest.norm(), std::abs(up[first])) / geo::kDegree;
  if (angle > 10.0) text += fmt::format(", {:.0f} deg towards {}{}", angle, rest[second] < 0.0 ? "-" : "", "xyz"[second]);
  return text;
}

TumbleResult tumble_calibration(const TumbleConfig& config, const record::ImuRecording& sensor, const Progress& progress) {
  TumbleResult result;
  result.source = sensor.source;
  result.rate_hz = sensor.rate_hz;
  result.duration = sensor.samples.back().t - sensor.samples.front().t;
  result.events = sensor.events;
  tell_warnings(result.events, progress);
  result.calibration =
      tumble::calibrate(sensor, config.options, [&](double share) { progress("adjusting rests and turns", share); });
  result.calibration.calibration.sensor = config.sensor;
  result.next = tumble::proposals(result.calibration, 3);
  tell_doubts(result, progress);
  return result;
}

TumbleResult tumble_calibration(const TumbleConfig& config, const Progress& progress) {
  constexpr geo::GpsTime kAnyWeek;  // only intervals matter
  progress("reading", 0.0);
  return tumble_calibration(config, io::read_imu(config.imu, kAnyWeek), progress);
}

std::vector<std::string> files_of(const TumbleConfig&) {
  return {"imu_calibration.yaml", "tumble.json", "report.json", "report.html"};
}

void write(const TumbleConfig& config, const TumbleResult& result, const std::filesystem::path& folder) {
  const report::Page page = tumble_page(config, result);
  io::begin_results(folder / "tumble.json");
  const std::string comment = fmt::format("# Made by coast {} calibrate {}: {} rests, {} turns; gravity {:.5f} m/s^2 ({}).\n",
                                          COAST_VERSION, config.file.filename().string(), result.calibration.rests.size(),
                                          result.calibration.turns.size(), result.calibration.gravity, config.gravity_from);
  io::write_text(folder / "imu_calibration.yaml", io::imu_calibration_yaml(result.calibration.calibration, comment));
  write_page(page, folder);
  io::write_text(folder / "tumble.json", tumble_json(config, result));
}

std::string told(const TumbleConfig&, const TumbleResult& result, const std::filesystem::path& folder) {
  const tumble::Result& found = result.calibration;
  const auto triad = [&](const char* name, const record::TriadErrors& errors, int at, double unit, const char* unit_name) {
    return fmt::format("{}: scale {:+.0f} {:+.0f} {:+.0f} ppm, bias {:+.4g} {:+.4g} {:+.4g} {}, gain to {:.0f} ppm\n", name,
                       1e6 * errors.gain(0, 0), 1e6 * errors.gain(1, 1), 1e6 * errors.gain(2, 2), errors.bias.x() / unit,
                       errors.bias.y() / unit, errors.bias.z() / unit, unit_name, 1e6 * largest_gain_sd(found.calibration, at));
  };
  return fmt::format(
      "{} rests, {} turns; residuals {:.4f} m/s^2 per rest, {:.2f} deg per turn\n{}{}calibration: {}\nreport: {}\n",
      found.rests.size(), found.turns.size(), force_rms(found), turn_rms(found) / geo::kDegree,
      triad("Accelerometer", found.calibration.accel, ImuCalibration::kAccel, geo::unit("mg").to_si, "mg"),
      triad("Gyro", found.calibration.gyro, ImuCalibration::kGyro, geo::kDegree, "deg/s"),
      (folder / "imu_calibration.yaml").string(), (folder / "report.html").string());
}

}  // namespace coast::jobs
