#include "coast/estimate/observability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/geo/earth.hpp"

namespace coast::estimate {

namespace {

constexpr std::array kNed{"north", "east", "down"};
constexpr std::array kBody{"forward", "right", "down"};

std::string sensor_state_name(const StateLayout::SensorBlock& block, int index) {
  std::string name = block.name;
  if (block.signal_axis && *block.signal_axis != block.axis)
    name += fmt::format(" to {}", static_cast<char>('x' + *block.signal_axis));
  return block.size > 1 ? fmt::format("{} {}", name, index + 1) : name;
}

/// Rows of the states resolved in e, rotated to n.
Eigen::MatrixXd resolution_in_n(const StateLayout& layout, const Eigen::Vector3d& r_eb_e) {
  const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(r_eb_e)).transpose();
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(layout.size(), layout.size());
  for (const int first : {kPos, kVel, kPsi}) T.block<3, 3>(first, first) = C_e_n;
  if (layout.base_offset()) T.block<3, 3>(*layout.base_offset(), *layout.base_offset()) = C_e_n;
  return T;
}

}  // namespace

std::string_view name(Observability observability) {
  switch (observability) {
    case Observability::kSeen:
      return "seen";
    case Observability::kWeaklySeen:
      return "weakly seen";
    case Observability::kNotSeen:
      return "not seen";
    case Observability::kTogether:
      return "seen together";
  }
  return "";
}

Observability MissionUnknown::observability() const {
  if (!(ratio() <= kWeaklySeenRatio)) return Observability::kNotSeen;
  if (std::abs(correlation) > kTogetherCorrelation) return Observability::kTogether;
  return ratio() <= kSeenRatio ? Observability::kSeen : Observability::kWeaklySeen;
}

std::vector<std::string> state_names(const StateLayout& layout) {
  std::vector<std::string> names(static_cast<std::size_t>(layout.size()));
  const auto set = [&](int first, const std::string& what, const auto& components) {
    auto at = names.begin() + first;
    for (const char* component : components) *at++ = fmt::format("{} {}", what, component);
  };
  set(kPos, "position", kNed);
  set(kVel, "velocity", kNed);
  set(kPsi, "attitude", kNed);
  for (const StateLayout::SensorBlock& block : layout.sensors())
    for (int i = 0; i < block.size; ++i) {
      const std::string name = sensor_state_name(block, i);
      const auto at = names.begin() + block.offset + i;
      const auto earlier = std::ranges::count_if(names.begin(), at,
                                                 [&](const std::string& n) { return n == name || n.starts_with(name + " #"); });
      *at = earlier > 0 ? fmt::format("{} #{}", name, earlier + 1) : name;  // a second process of the same kind on an axis
    }
  for (const StateLayout::Block& block : layout.auxiliaries()) names[static_cast<std::size_t>(block.offset)] = block.name;
  if (layout.lever_arm()) set(*layout.lever_arm(), "lever_arm", kBody);
  if (layout.mounting()) set(*layout.mounting(), "vehicle_mounting", std::array{"pitch", "yaw"});
  if (layout.base_offset()) set(*layout.base_offset(), "base_offset", kNed);
  if (layout.gnss_error()) set(*layout.gnss_error(), "gnss_error", kNed);
  return names;
}

std::vector<MissionUnknown> mission_unknowns(const StateLayout& layout, const std::vector<int>& which,
                                             const Eigen::MatrixXd& prior, const FilterState& state) {
  const Eigen::MatrixXd T = resolution_in_n(layout, state.nav.r_eb_e);
  const Eigen::VectorXd prior_sd = (T * prior * T.transpose()).diagonal().cwiseSqrt();
  const Eigen::MatrixXd P = T * state.P * T.transpose();
  const Eigen::VectorXd sd = P.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd x = T * state.x;
  const std::vector<std::string> names = state_names(layout);
  std::vector<MissionUnknown> unknowns;
  for (const int i : which) {
    MissionUnknown unknown{names[static_cast<std::size_t>(i)], x(i), prior_sd(i), sd(i), "", 0.0};
    for (int j = 0; j < layout.size(); ++j) {
      const double correlation = j != i && sd(i) > 0.0 && sd(j) > 0.0 ? P(i, j) / (sd(i) * sd(j)) : 0.0;
      if (std::abs(correlation) <= std::abs(unknown.correlation)) continue;
      unknown.correlation = correlation;
      unknown.with = names[static_cast<std::size_t>(j)];
    }
    unknowns.push_back(std::move(unknown));
  }
  return unknowns;
}

}  // namespace coast::estimate
