// SBET (smoothed best estimate of trajectory, Applanix): records of 17 doubles, little endian, no header: time (seconds of
// week), latitude, longitude [rad], altitude [m], x, y, z velocity [m/s], roll, pitch, platform heading, wander angle [rad],
// specific force [m/s^2] and angular rate [rad/s] of the body.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../binary.hpp"
#include "../repairs.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/input.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kFields = 17;
constexpr std::size_t kRecord = kFields * sizeof(double);

std::array<double, kFields> record_at(std::string_view bytes, std::size_t index) {
  std::array<double, kFields> f{};
  for (std::size_t i = 0; i < kFields; ++i) f[i] = number_at<double>(bytes, index * kRecord + i * sizeof(double));
  return f;
}

bool plausible(const std::array<double, kFields>& f) {
  const bool finite = std::all_of(f.begin(), f.end(), [](double x) { return std::isfinite(x); });
  return finite && f[0] >= -1.0 && f[0] < 1.3e6 && std::abs(f[1]) <= 0.5 * geo::kPi && std::abs(f[2]) <= 2.0 * geo::kPi &&
         std::abs(f[3]) < 1e6 && std::abs(f[4]) < 1e4 && std::abs(f[5]) < 1e4 && std::abs(f[6]) < 1e4 &&
         std::abs(f[7]) <= 2.0 * geo::kPi && std::abs(f[8]) <= geo::kPi && std::abs(f[9]) <= 4.0 * geo::kPi &&
         std::abs(f[10]) <= 4.0 * geo::kPi;
}

bool sniff_sbet(const FileHead& head) {
  if (head.text.size() < 2 * kRecord || head.text.find('\0') == std::string::npos) return false;
  const auto a = record_at(head.text, 0);
  const auto b = record_at(head.text, 1);
  return plausible(a) && plausible(b) && b[0] > a[0];
}

record::NavState state_from(const std::array<double, kFields>& f, double geoid_height) {
  record::NavState state;
  const geo::Geodetic p{f[1], geo::wrap_angle(f[2]), f[3] + geoid_height};
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  state.r_eb_e = geo::ecef_from_geodetic(p);
  state.v_eb_e = C_n_e * Eigen::Vector3d(f[4], f[5], f[6]);
  // The platform heading is relative to the wander frame's x axis; the wander angle refers it to north.
  const Eigen::Quaterniond q_b_n = geo::quaternion_from_euler({f[7], f[8], geo::wrap_angle(f[9] - f[10])});
  state.q_b_e = (Eigen::Quaterniond(C_n_e) * q_b_n).normalized();
  return state;
}

record::Trajectory read_sbet(const ReferenceFileOptions& options, Format::Near near) {
  const std::string bytes = read_all(options.file);
  const std::string name = options.file.string();
  std::size_t index = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError({name, 0, fmt::format("record {}: {}", index + 1, found), std::move(expected), std::move(what_to_do)});
  };
  record::Trajectory trajectory;
  trajectory.source = name;
  WeekClock clock(options.time, near, error);
  Repairs repairs;
  TimeOrder order(error, repairs);
  const std::size_t records = bytes.size() / kRecord;
  trajectory.states.reserve(records);
  bool wander = false;
  for (; index < records; ++index) {
    const auto f = record_at(bytes, index);
    if (!plausible(f)) throw error("not a position, velocity and attitude", "an SBET record of 17 doubles", "");
    wander |= f[10] != 0.0;
    record::NavState state =
        state_from(f, options.position.above_mean_sea_level ? options.position.geoid_height.value_or(0.0) : 0.0);
    state.t = clock.at(f[0] + options.time.offset_s);
    auto& states = trajectory.states;
    if (order.accept(state.t, !states.empty() && states.back().r_eb_e == state.r_eb_e)) states.push_back(state);
  }
  if (trajectory.states.empty())
    throw InputError({name, 0, fmt::format("{} bytes", bytes.size()), "SBET records of 136 bytes", ""});
  trajectory.events = clock.events();
  repairs.finish(static_cast<long>(records), trajectory.events);
  if (bytes.size() % kRecord != 0)
    trajectory.events.push_back(
        {record::Event::Severity::kWarning, "trailing_garbage",
         fmt::format("{}: the last {} bytes are no whole record; left out", name, bytes.size() % kRecord), std::nullopt, 1});
  if (wander) {
    // Programs differ in the sense of the wander frame's y and z axes, so its velocities are not used.
    trajectory.has_velocity = false;
    trajectory.events.push_back(
        {record::Event::Severity::kWarning, "sbet_wander",
         fmt::format("{}: wander angle in use: heading is platform heading minus wander angle; velocities "
                     "were left out",
                     name),
         std::nullopt, 1});
  }
  return trajectory;
}

}  // namespace

Format sbet_format() {
  return {"sbet", "SBET, 136-byte records", sniff_sbet, {}, {}, read_sbet};
}

}  // namespace coast::io
