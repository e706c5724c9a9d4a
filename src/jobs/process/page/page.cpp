#include "process/page/page.hpp"

#include <fmt/format.h>

#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

/// The run file's name; its folder's, if the run file has the default name.
std::string name_of(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::string folder = std::filesystem::absolute(file).parent_path().filename().string();
  return stem == "run" && !folder.empty() ? folder : stem;
}

}  // namespace

report::Page make_page(const ProcessPage& page) {
  const ProcessResult& r = page.result;
  report::Page out;
  out.title = fmt::format("Trajectory of {}", name_of(page.config.file));
  const std::string& sensor = page.result.used.model.sensor_name();
  out.subtitle =
      fmt::format("{} trajectory over {:.0f} s: {} at {} Hz, {} GNSS epochs", page.config.smooth ? "Smoothed" : "Forward",
                  r.end - r.start, sensor.empty() ? "IMU" : sensor, number(r.imu_rate_hz, 3), r.gnss_epochs);
  out.start = r.start;
  out.tiles = acceptance_tiles(page);
  const auto add = [&](std::optional<report::Section> section) {
    if (section) out.sections.push_back(std::move(*section));
  };
  add(input_section(page));
  add(trajectory_section(page));
  add(accuracy_section(page));
  add(motion_section(page));
  add(separation_section(page));
  add(innovation_section(page));
  add(sensor_section(page));
  add(batch_section(page));
  add(body_section(page));
  add(outage_section(page));
  add(reference_section(page));
  add(processing_section(page));
  out.footer = fmt::format("coast {}: process {}", COAST_VERSION, page.config.file.filename().string());
  return out;
}

}  // namespace coast::jobs
