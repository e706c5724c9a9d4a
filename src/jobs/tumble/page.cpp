// The page of a multi-position calibration: values, what remains of every rest and turn, and where a further pose would help.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coast/geo/units.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "tumble/result.hpp"

namespace coast::jobs {

namespace {

using record::ImuCalibration;
using report::Tone;
using report::Verdict;

Verdict better_than(double value, double good, double poor) {
  return value <= good ? Verdict::kGood : value <= poor ? Verdict::kWarn : Verdict::kBad;
}

std::vector<report::Tile> tiles_of(const TumbleResult& result) {
  const tumble::Result& found = result.calibration;
  const auto scale = [](const record::TriadErrors& triad) { return triple(100.0 * triad.gain.diagonal(), 3); };
  const double accel_sd = 1e6 * largest_gain_sd(found.calibration, ImuCalibration::kAccel);
  const double gyro_sd = 1e6 * largest_gain_sd(found.calibration, ImuCalibration::kGyro);
  std::vector<report::Tile> tiles;
  const auto tile = [&tiles](std::string label, std::string value, std::string unit, std::string explanation, Verdict verdict,
                             std::string section) {
    report::Tile& t = tiles.emplace_back();
    t.label = std::move(label);
    t.value = std::move(value);
    t.unit = std::move(unit);
    t.explanation = std::move(explanation);
    t.verdict = verdict;
    t.section = std::move(section);
  };
  tile("Accelerometer scale", scale(found.calibration.accel), "%", "Scale errors of x, y, z: measured minus true.",
       Verdict::kNone, "values");
  tile("Gyro scale", scale(found.calibration.gyro), "%", "Scale errors of x, y, z: measured minus true.", Verdict::kNone,
       "values");
  tile("Accelerometer gain known to", number(accel_sd), "ppm",
       "Largest standard deviation of scale and misalignment; below 1000 is good for a MEMS.",
       better_than(accel_sd, 1000.0, 5000.0), "cover");
  tile("Gyro gain known to", number(gyro_sd), "ppm",
       "Largest standard deviation of scale and misalignment; below 2000 is good for a MEMS.",
       better_than(gyro_sd, 2000.0, 10000.0), "turns");
  tile("Rests", fmt::format("{} of {}", std::ranges::count(found.rests, true, &tumble::RestFit::used), found.rests.size()),
       "used", "Rests that do not contradict all others; twenty and more are good.",
       found.rests.size() >= 18 ? Verdict::kGood : Verdict::kWarn, "rests");
  tile("What remains", fmt::format("{} / {}", number(force_rms(found), 2), number(turn_rms(found) / geo::kDegree, 2)),
       "m/s^2 / deg", "Root mean square residual of a rest and of a turn.", Verdict::kNone, "rests");
  return tiles;
}

report::Table value_table(const char* id, const char* title, const record::TriadErrors& triad,
                          const ImuCalibration& calibration, int at, double unit, const char* unit_name) {
  report::Table table;
  table.id = id;
  table.title = title;
  table.caption = "measured = (I + gain) true + bias; +- one standard deviation.";
  table.columns = {{"axis", "", false},     {"bias", unit_name, true}, {"+-", unit_name, true},
                   {"gain x", "ppm", true}, {"+-", "ppm", true},       {"gain y", "ppm", true},
                   {"+-", "ppm", true},     {"gain z", "ppm", true},   {"+-", "ppm", true}};
  for (int row = 0; row < 3; ++row) {
    std::vector<report::Cell> line;
    line.push_back({std::string(1, "xyz"[row]), {}});
    line.push_back({number(triad.bias[row] / unit, 4), {}});
    line.push_back({number(calibration.bias_sd(at, row) / unit, 2), {}});
    for (int column = 0; column < 3; ++column) {
      line.push_back({decimals(1e6 * triad.gain(row, column), 0), {}});
      line.push_back({decimals(1e6 * calibration.gain_sd(at, row, column), 0), {}});
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

report::Section values_section(const TumbleConfig& config, const TumbleResult& result) {
  const tumble::Result& found = result.calibration;
  report::Section section;
  section.id = "values";
  section.title = "Errors of the sensors";
  section.lead = fmt::format(
      "In the orthogonal axes nearest to those of the three accelerometers. Gravity {:.5f} +- {:.2g} m/s^2, {}. To use it, "
      "write imu: {{calibration: imu_calibration.yaml}} in a run file.",
      found.gravity, found.gravity_sd, config.gravity_from);
  section.tables.push_back(value_table("accel-values", "Accelerometers", found.calibration.accel, found.calibration,
                                       ImuCalibration::kAccel, geo::unit("mg").to_si, "mg"));
  section.tables.push_back(value_table("gyro-values", "Gyros", found.calibration.gyro, found.calibration, ImuCalibration::kGyro,
                                       geo::kDegree, "deg/s"));
  std::string heading = "The Earth's rate was not used: no place is stated; it is part of the gyros' bias.";
  if (found.heading_sd)
    heading = *found.heading_sd < 0.3 ? fmt::format("The Earth's rate is seen: heading of the poses to {:.1f} deg.",
                                                    *found.heading_sd / geo::kDegree)
                                      : "The Earth's rate is lost in the wander of the gyros' biases.";
  section.notes.push_back({report::Note::Kind::kInfo, "Earth rate", heading});
  return section;
}

report::Panel residual_panel(const char* id, const char* title, const char* unit, const std::vector<double>& x,
                             const std::vector<Eigen::Vector3d>& values, report::Axis along) {
  report::Panel panel = report::xy_panel(id, title, std::move(along), {"residual", unit, report::Axis::Scale::kLinear, {}, {}},
                                         "Without a trend and of one size.");
  constexpr std::array<Tone, 3> kTones{Tone::kX, Tone::kY, Tone::kZ};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    report::Series series;
    series.x = x;
    for (const Eigen::Vector3d& value : values) series.y.push_back(value[axis]);
    report::add_points(panel.plot(), std::string(1, "xyz"[axis]), std::move(series), kTones[static_cast<std::size_t>(axis)])
        .radius_px = 3.0;
  }
  return panel;
}

report::Section rests_section(const TumbleResult& result) {
  const tumble::Result& found = result.calibration;
  report::Section section;
  section.id = "rests";
  section.title = "Rests";
  section.lead = fmt::format("Beyond its white noise the mean of a rest scatters by {} m/s^2.", number(found.levels.accel, 2));
  std::vector<double> number_of;
  std::vector<Eigen::Vector3d> residuals;
  report::Table table;
  table.id = "rests-table";
  table.title = "Every rest";
  table.columns = {
      {"rest", "", true},      {"from", "s", true}, {"to", "s", true}, {"pose", "", false}, {"residual x / y / z", "mg", false},
      {"chi-square", "", true}};
  for (std::size_t i = 0; i < found.rests.size(); ++i) {
    const tumble::RestFit& rest = found.rests[i];
    number_of.push_back(static_cast<double>(i + 1));
    residuals.push_back(rest.accel_residual / geo::unit("mg").to_si);
    table.rows.push_back({{fmt::format("{}", i + 1), {}},
                          {decimals(rest.rest.from, 1), {}},
                          {decimals(rest.rest.to, 1), {}},
                          {direction_text(rest.up), {}},
                          {triple(residuals.back(), 2), {}},
                          {decimals(rest.chi_square, 1), rest.used ? Verdict::kNone : Verdict::kBad}});
  }
  section.panels.push_back(residual_panel("rests-residuals", "Specific force of each rest, observed minus adjusted", "mg",
                                          number_of, residuals, {"rest", "", report::Axis::Scale::kLinear, {}, {}}));
  section.tables.push_back(std::move(table));
  return section;
}

report::Section turns_section(const TumbleResult& result) {
  const tumble::Result& found = result.calibration;
  report::Section section;
  section.id = "turns";
  section.title = "Turns";
  section.lead = fmt::format(
      "The rotation of the gyros between two rests against that of the poses. Beyond angle random walk they differ by {} % of "
      "the angle "
      "turned; the gyros' biases wander by {} deg/s/sqrt(s).",
      number(100.0 * found.levels.turn, 2), number(found.levels.gyro_walk / geo::kDegree, 2));
  std::vector<double> turned;
  std::vector<Eigen::Vector3d> residuals;
  report::Table table;
  table.id = "turns-table";
  table.title = "Every turn";
  table.columns = {{"after rest", "", true},
                   {"duration", "s", true},
                   {"turned", "deg", true},
                   {"residual x / y / z", "deg", false},
                   {"chi-square", "", true}};
  for (const tumble::TurnFit& turn : found.turns) {
    const Eigen::Vector3d degrees = turn.residual / geo::kDegree;
    if (turn.used) {
      turned.push_back(turn.turned / geo::kDegree);
      residuals.push_back(degrees);
    }
    table.rows.push_back({{fmt::format("{}", turn.rest + 1), {}},
                          {decimals(turn.duration, 1), {}},
                          {decimals(turn.turned / geo::kDegree, 0), {}},
                          {triple(degrees, 2), {}},
                          {decimals(turn.chi_square, 1), turn.used ? Verdict::kNone : Verdict::kBad}});
  }
  section.panels.push_back(residual_panel("turns-residuals", "Rotation of each turn, gyros minus poses", "deg", turned,
                                          residuals, {"turned", "deg", report::Axis::Scale::kLinear, {}, {}}));
  section.tables.push_back(std::move(table));
  return section;
}

/// Half a sphere seen from above its pole, distance from the middle the angle from the pole.
report::Plot& add_half(report::Panel& panel, const char* title) {
  report::Plot& plot = report::add_cell(panel, title, "towards y", "towards x", "deg");
  plot.x.unit = "deg";
  plot.x.range = {-95.0, 95.0};
  plot.y.range = {-95.0, 95.0};
  plot.equal_aspect = false;
  plot.link.clear();
  plot.height_px = 420;
  return plot;
}

void put(report::Series& series, const Eigen::Vector3d& up, double sign) {
  const double angle = std::atan2(up.head<2>().norm(), sign * up.z()) / geo::kDegree;
  const double r = up.head<2>().norm();
  series.x.push_back(r > 0.0 ? angle * up.y() / r : 0.0);
  series.y.push_back(r > 0.0 ? angle * up.x() / r : 0.0);
}

report::Section cover_section(const TumbleResult& result) {
  const tumble::Result& found = result.calibration;
  report::Section section;
  section.id = "cover";
  section.title = "Poses";
  section.lead =
      "Which way was up, in axes of the sensor, and how much one more rest in each direction would tell about the "
      "accelerometers.";
  report::Panel panel = report::grid_panel("cover-poses", "Cover of the sphere", 2,
                                           "Large dots: directions that would add most. Good: small dots everywhere.");
  const std::vector<Eigen::Vector3d> grid = tumble::directions(600);
  constexpr std::array<double, 4> kFrom{0.0, 0.05, 0.15, 0.35};  // nats
  constexpr std::array kLabels{"adds below 0.05", "0.05 to 0.15", "0.15 to 0.35", "0.35 nats and more"};
  constexpr std::array kTones{Tone::kFaint, Tone::kMuted, Tone::kWarn, Tone::kBad};
  for (const double sign : {1.0, -1.0}) {
    report::Plot& plot = add_half(panel, sign > 0.0 ? "z up" : "z down");
    std::array<report::Series, 4> classes;
    for (const Eigen::Vector3d& up : grid) {
      if (sign * up.z() < 0.0) continue;
      const double nats = tumble::information(found, up);
      const auto above = std::ranges::upper_bound(kFrom, nats) - kFrom.begin();
      put(classes[static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, above) - 1)], up, sign);
    }
    for (std::size_t k = 0; k < classes.size(); ++k)
      if (!classes[k].x.empty())
        report::add_points(plot, kLabels[k], std::move(classes[k]), kTones[k]).radius_px = 1.5 + 1.2 * static_cast<double>(k);
    report::Series poses;
    for (const tumble::RestFit& rest : found.rests)
      if (sign * rest.up.z() >= 0.0) put(poses, rest.up, sign);
    report::add_points(plot, "rests", std::move(poses), Tone::kReference).radius_px = 4.5;
  }
  section.panels.push_back(std::move(panel));
  report::Table table;
  table.id = "next-poses";
  table.title = "What to add next";
  table.columns = {{"pose", "", false}, {"adds", "nats", true}, {"then the gain is known to", "ppm", true}};
  for (const tumble::Proposal& next : result.next)
    table.rows.push_back(
        {{direction_text(next.up), {}}, {decimals(next.information, 2), {}}, {decimals(1e6 * next.largest_gain_sd, 0), {}}});
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace

report::Page tumble_page(const TumbleConfig& config, const TumbleResult& result) {
  report::Page page;
  page.title = fmt::format("Multi-position calibration of {}", config.sensor);
  page.subtitle = fmt::format("{}, {:.0f} s at {:.4g} Hz", std::filesystem::path(result.source).filename().string(),
                              result.duration, result.rate_hz);
  page.tiles = tiles_of(result);
  page.sections = {values_section(config, result), cover_section(result), rests_section(result), turns_section(result)};
  if (!result.events.empty()) page.sections.back().tables.push_back(event_table(result.events));
  page.footer = fmt::format("coast {}: calibrate {}", COAST_VERSION, config.file.filename().string());
  return page;
}

}  // namespace coast::jobs
