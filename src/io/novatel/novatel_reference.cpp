// The trajectory of a SPAN receiver: INSPVA, INSPVAS, INSPVAX (OEM7 Commands and Logs Reference Manual). The attitude takes
// axes right, forward, up to east, north, up: roll right-handed about forward, pitch about right, azimuth clockwise from north.
// These are the angles of forward, right, down against north, east, down.

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "../counted.hpp"
#include "../receiver_positions.hpp"
#include "../repairs.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "novatel_log.hpp"
#include "novatel_positions.hpp"
#include "novatel_readers.hpp"

namespace coast::io {

namespace {

bool is_aligned(std::uint32_t status) {
  constexpr std::array kAligned = {2U, 3U, 6U, 7U};  // also where its variance is large
  return std::ranges::find(kAligned, status) != kAligned.end();
}

/// None where values are impossible.
std::optional<record::NavState> state_of(const geo::Geodetic& p, const Eigen::Vector3d& north_east_up,
                                         const Eigen::Vector3d& roll_pitch_azimuth) {
  constexpr double kFastest = 1e4, kLargestAngle = 360.0;  // m/s, deg
  const auto r_e = ecef_if_on_earth(p);
  // Comparisons that NaN does not pass.
  const bool possible = north_east_up.norm() < kFastest && roll_pitch_azimuth.cwiseAbs().maxCoeff() <= kLargestAngle &&
                        roll_pitch_azimuth.allFinite();
  if (!r_e || !possible) return std::nullopt;
  const Eigen::Matrix3d C_n_e = geo::C_n_e({p.latitude, geo::wrap_angle(p.longitude), p.height});
  const Eigen::Vector3d angles = geo::kDegree * roll_pitch_azimuth;
  record::NavState state;
  state.r_eb_e = *r_e;
  state.v_eb_e = C_n_e * Eigen::Vector3d(north_east_up.x(), north_east_up.y(), -north_east_up.z());
  state.q_b_e = (Eigen::Quaterniond(C_n_e) * geo::quaternion_from_euler({angles.x(), angles.y(), geo::wrap_angle(angles.z())}))
                    .normalized();
  return state;
}

class NovAtelTrajectoryReader {
 public:
  explicit NovAtelTrajectoryReader(const ReferenceFileOptions& options) : options_(options), stream_(options.file) {}

  record::Trajectory read() {
    NovAtelLog log;
    while (stream_.next(log)) take(log);
    const auto most = std::ranges::max_element(states_, {}, [](const auto& one) { return one.second.size(); });
    if (most == states_.end()) refuse();
    return trajectory_of(most->first, most->second);
  }

 private:
  void take(const NovAtelLog& log);
  [[nodiscard]] record::Trajectory trajectory_of(std::uint32_t id, const std::vector<record::NavState>& states);
  [[noreturn]] void refuse() const;

  const ReferenceFileOptions& options_;
  NovAtelStream stream_;
  std::map<std::uint32_t, std::vector<record::NavState>> states_;  ///< by log
  Counted spoiled_, not_aligned_, no_time_;
};

void NovAtelTrajectoryReader::take(const NovAtelLog& log) {
  const bool extended = log.id == novatel::kInsPvaX;
  if (!extended && log.id != novatel::kInsPva && log.id != novatel::kInsPvaS) return;
  NovAtelFields f = log.fields();
  std::uint32_t status = 0;
  std::optional<geo::GpsTime> t = log.time();
  if (extended) {
    status = f.word(kInsStatus);
    static_cast<void>(f.word(kPositionType));
  } else {
    const std::uint32_t week = f.u32();
    const auto of_body = novatel_time(week, f.f64());
    t = log.timed() ? of_body : std::nullopt;
  }
  const double latitude = geo::kDegree * f.f64(), longitude = geo::kDegree * f.f64();
  double height = f.f64();
  if (extended) height += f.f32();  // above mean sea level, and the undulation
  const Eigen::Vector3d velocity = f.vector(), angles = f.vector();
  if (!extended) status = f.word(kInsStatus);
  if (!f.good()) return spoiled_.add(log.time());
  if (!is_aligned(status)) return not_aligned_.add(t);
  if (!t) return no_time_.add();
  auto state = state_of({latitude, longitude, height}, velocity, angles);
  if (!state) return spoiled_.add(t);
  state->t = *t + options_.time.offset_s;
  states_[log.id].push_back(*state);
}

record::Trajectory NovAtelTrajectoryReader::trajectory_of(std::uint32_t id, const std::vector<record::NavState>& states) {
  record::Trajectory trajectory;
  trajectory.source = stream_.name();
  trajectory.events = stream_.events();
  long row = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError({stream_.name(), 0, fmt::format("{} {}: {}", novatel_log_name(id), row, found), std::move(expected),
                       std::move(what_to_do)});
  };
  Repairs repairs;
  TimeOrder order(error, repairs);
  for (const record::NavState& state : states) {
    ++row;
    auto& kept = trajectory.states;
    if (order.accept(state.t, !kept.empty() && kept.back().r_eb_e == state.r_eb_e)) kept.push_back(state);
  }
  repairs.finish(row, trajectory.events);
  using enum record::Event::Severity;
  const auto add = [&](const Counted& counted, const char* kind, const char* what, record::Event::Severity severity) {
    add_counted(trajectory.events, trajectory.source, counted, {kind, "INS solution", "INS solutions", what, severity});
  };
  add(not_aligned_, "ins_not_aligned", "before alignment left out", kInfo);
  add(no_time_, "ins_no_time", "before the receiver knew GPS time left out", kInfo);
  add(spoiled_, "ins_spoiled", "with impossible values left out", kWarning);
  return trajectory;
}

void NovAtelTrajectoryReader::refuse() const {
  if (not_aligned_.number + no_time_.number + spoiled_.number == 0)
    throw InputError({stream_.name(), 0, "NovAtel logs without INSPVA, INSPVAS and INSPVAX", "a trajectory", ""});
  throw InputError({stream_.name(), 0,
                    fmt::format("no INS solution: {} before alignment, {} without time, {} with impossible values",
                                not_aligned_.number, no_time_.number, spoiled_.number),
                    "at least one", ""});
}

}  // namespace

record::Trajectory read_novatel_reference(const ReferenceFileOptions& options, Format::Near) {
  return NovAtelTrajectoryReader(options).read();
}

}  // namespace coast::io
