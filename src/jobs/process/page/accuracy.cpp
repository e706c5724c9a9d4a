// Section: what the accuracy is, minute by minute and event by event, for those who read nothing else.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "process/page/curves.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

constexpr std::size_t kMostRows = 120;

std::vector<report::Table::Column> sigma_columns() {
  return {{"sigma N", "m"},      {"sigma E", "m"},       {"sigma D", "m"},
          {"sigma roll", "deg"}, {"sigma pitch", "deg"}, {"sigma yaw", "deg"}};
}

std::vector<report::Cell> row_of(std::vector<std::string> first, const Eigen::Vector3d& position,
                                 const Eigen::Vector3d& degrees) {
  std::vector<report::Cell> row;
  for (std::string& text : first) row.push_back({std::move(text)});
  for (const double sd : position) row.push_back({number(sd, 2)});
  for (const double sd : degrees) row.push_back({number(sd, 2)});
  return row;
}

/// Neighbouring minutes together, so that a long mission has no more rows than can be read.
std::vector<MinuteAccuracy> merged(const std::vector<MinuteAccuracy>& minutes, std::size_t together) {
  std::vector<MinuteAccuracy> rows;
  for (std::size_t i = 0; i < minutes.size(); ++i) {
    if (i % together == 0) {
      rows.push_back(minutes[i]);
      continue;
    }
    rows.back().sd_position = rows.back().sd_position.cwiseMax(minutes[i].sd_position);
    rows.back().sd_attitude = rows.back().sd_attitude.cwiseMax(minutes[i].sd_attitude);
  }
  return rows;
}

report::Table minute_table(const ProcessPage& page) {
  const std::vector<MinuteAccuracy>& minutes = page.result.curves->curves().smoothed.minutes;
  const std::size_t together = (minutes.size() + kMostRows - 1) / kMostRows;
  report::Table table;
  table.id = "accuracy-minutes";
  table.title = together > 1 ? fmt::format("Accuracy, {} minutes each", together) : "Accuracy by minute";
  table.caption = "The largest sigma of each stretch, of the delivered trajectory at the IMU's point.";
  table.columns = {{"from", "s"}};
  std::ranges::move(sigma_columns(), std::back_inserter(table.columns));
  for (const MinuteAccuracy& minute : merged(minutes, std::max<std::size_t>(together, 1)))
    table.rows.push_back(row_of({fmt::format("{:.0f}", minute.from_s)}, minute.sd_position, minute.sd_attitude));
  return table;
}

report::Table events_table(const ProcessPage& page) {
  const std::vector<record::MarkedState>& states = page.result.marked->states;
  report::Table table;
  table.id = "accuracy-events";
  table.title = "Accuracy by event";
  table.caption = states.size() > kMostRows
                      ? fmt::format("The first {} of {}; all are in events.csv.", kMostRows, states.size())
                      : "With their positions and attitudes in events.csv.";
  table.columns = {{"event", "", false}, {"at", "s"}};
  std::ranges::move(sigma_columns(), std::back_inserter(table.columns));
  for (std::size_t i = 0; i < std::min(states.size(), kMostRows); ++i) {
    const record::MarkedState& state = states[i];
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(state.nav.r_eb_e)).transpose();
    const Eigen::Matrix3d J = geo::euler_jacobian(geo::euler_from_dcm(C_e_n * state.nav.q_b_e.toRotationMatrix()));
    const Eigen::Matrix3d attitude = J * state.cov.attitude * J.transpose();
    table.rows.push_back(row_of({state.mark.id, fmt::format("{:.3f}", seconds_since_start(page, state.nav.t))},
                                state.cov.position.diagonal().cwiseSqrt(), attitude.diagonal().cwiseSqrt() / geo::kDegree));
  }
  return table;
}

}  // namespace

report::Section accuracy_section(const ProcessPage& page) {
  report::Section section;
  section.id = "accuracy";
  section.title = "Accuracy";
  const auto& minutes = page.result.curves->curves().smoothed.minutes;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), attitude = Eigen::Vector3d::Zero();
  for (const MinuteAccuracy& minute : minutes) {
    position = position.cwiseMax(minute.sd_position);
    attitude = attitude.cwiseMax(minute.sd_attitude);
  }
  section.lead = fmt::format("Nowhere worse than {} m (north / east / down) and {} deg (roll / pitch / yaw), one sigma.",
                             triple(position), triple(attitude));
  section.tables.push_back(minute_table(page));
  if (page.result.marked && !page.result.marked->states.empty()) section.tables.push_back(events_table(page));
  return section;
}

}  // namespace coast::jobs
