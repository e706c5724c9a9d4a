// Output files and messages of `coast synth`.

#include <fmt/format.h>

#include "coast/array/extended.hpp"
#include "coast/io/member_blocks.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "synth/config.hpp"
#include "synth/page/page.hpp"
#include "synth/result.hpp"

namespace coast::jobs {

std::string synthetic_name(const ArrayConfig& config) {
  return fmt::format("synthetic IMU of {}, {}", config.imus.size(), merge_name(config.merge.merge));
}

std::vector<std::string> files_of(const ArrayConfig& config) {
  std::vector<std::string> files{"imu.csv",     "noise.csv",  "error_model.yaml", "synth.json", "array.resolved.yaml",
                                 "report.json", "report.html"};
  if (config.merge.merge == array::Merge::kExtended) files.emplace_back("members.csv");
  return files;
}

void write(const ArrayConfig& config, const SynthResult& result, const std::filesystem::path& folder) {
  const report::Page page = synth_page(config, result);
  io::begin_results(folder / "synth.json");
  io::write_imu_csv(folder / "imu.csv", synthetic_imu(result));
  io::write_text(folder / "noise.csv", noise_csv(result));
  io::write_text(folder / "error_model.yaml",
                 result.extended
                     ? result.extended->yaml()
                     : array::error_model_yaml(synthetic_name(config), 1.0 / result.assembly.signals.dt, result.remaining));
  if (result.extended) io::write_member_blocks(folder / "members.csv", array::member_blocks(result.assembly.signals));
  io::write_text(folder / "array.resolved.yaml", config.root.resolved_yaml());
  write_page(page, folder);
  io::write_text(folder / "synth.json", synth_json(config, result));
}

std::string told(const ArrayConfig& config, const SynthResult& result, const std::filesystem::path& folder) {
  std::string text;
  for (const std::string& sentence : synth_sentences(config, result)) text += sentence + "\n";
  const std::string over_time = result.extended ? fmt::format("members: {}", (folder / "members.csv").string())
                                                : fmt::format("noise_levels: {}", (folder / "noise.csv").string());
  return text + fmt::format("in run.yaml: imu: {{file: {}, gps_week: {}, error_model: {}, {}}}\n",
                            (folder / "imu.csv").string(), result.assembly.signals.start.week(),
                            (folder / "error_model.yaml").string(), over_time);
}

}  // namespace coast::jobs
