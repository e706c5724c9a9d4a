// Section: processing steps and settings, so that they can be repeated.

#include <fmt/format.h>

#include <array>

#include "coast/geo/units.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

report::Table settings_table(const ProcessPage& page) {
  const estimate::FilterOptions& options = page.result.used.filter;
  report::Table table;
  table.id = "settings";
  table.title = "Settings";
  table.columns = {{"setting", "", false}, {"value", "", false}};
  const auto add = [&](const std::string& name, const std::string& value) { table.rows.push_back(cells({name, value})); };
  constexpr std::array kLosses{"squared loss", "Huber's loss", "Cauchy's loss", "Geman-McClure loss"};
  if (const auto& batch = page.result.used.batch)
    add("smoother", fmt::format("sparse batch, {}, scale {}", kLosses.at(static_cast<std::size_t>(batch->gnss.kind)),
                                number(batch->gnss.scale)));
  else if (page.config.combined)
    add("smoother", "none: forward and backward filter combined");
  else
    add("smoother", page.config.smooth ? "RTS (backward recursion)" : "none");
  add("passes of the filter",
      page.config.passes == 1 ? "1" : fmt::format("{}, carrying states and covariance", page.config.passes));
  add("states",
      fmt::format("{} (9 navigation, {} sensor and auxiliary)", 9 + page.result.states.size(), page.result.states.size()));
  add("lever arm, forward / right / down", triple(page.result.used.lever_arm_b, 4) + " m");
  add("GNSS time offset", number(1e3 * page.result.used.time_offset_s) + " ms");
  add("GNSS velocity", options.use_gnss_velocity ? "used where given" : "not used");
  add("gate", options.gate_probability > 0.0 ? fmt::format("refuses {:g} of good fixes", options.gate_probability) : "open");
  const estimate::GnssScale& scale = options.gnss_scale;
  add("factor on GNSS sigmas", fmt::format("horizontal {}, vertical {}, velocity {}", number(scale.horizontal),
                                           number(scale.vertical), number(scale.velocity)));
  const estimate::CorrelatedGnss& correlated = options.auxiliary.correlated_gnss;
  if (correlated.horizontal_m > 0.0 || correlated.vertical_m > 0.0)
    add("correlated GNSS error", fmt::format("horizontal {} m, vertical {} m, over {} s", number(correlated.horizontal_m),
                                             number(correlated.vertical_m), number(correlated.time_s)));
  if (options.vehicle.zero_velocity_sd_mps)
    add("zero-velocity updates", fmt::format("sigma {} m/s", number(*options.vehicle.zero_velocity_sd_mps)));
  if (options.vehicle.non_holonomic)
    add("non-holonomic updates",
        fmt::format("sigma lateral {} m/s, vertical {} m/s, every {} s", number(options.vehicle.non_holonomic->sd_lateral_mps),
                    number(options.vehicle.non_holonomic->sd_vertical_mps), number(options.vehicle.interval_s)));
  if (page.config.output.point_b != Eigen::Vector3d::Zero())
    add("files refer to the point", triple(page.config.output.point_b, 4) + " m from the IMU, forward / right / down");
  return table;
}

}  // namespace

report::Section processing_section(const ProcessPage& page) {
  report::Section section;
  section.id = "processing";
  section.title = "Processing";
  section.tables.push_back(settings_table(page));
  section.notes.push_back({report::Note::Kind::kInfo, "Files",
                           joined(page.result.files, ", ") + ", summary.json, innovations.csv, run.resolved.yaml"});
  section.notes.push_back({report::Note::Kind::kCode,
                           "Resolved configuration (run.resolved.yaml): gives the same numbers again", page.result.resolved});
  section.notes.push_back({report::Note::Kind::kCode, "IMU error model as used, SI units", page.result.used.model.yaml()});
  return section;
}

}  // namespace coast::jobs
