#include "coast/jobs/file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "coast/io/yaml.hpp"
#include "coast/record/error.hpp"

namespace coast::jobs {

namespace {

struct ConfigurationFile {
  std::string_view schema;
  std::string_view is;
  std::string_view command;                 ///< whose file it is; empty: none
  std::vector<std::string_view> keys;       ///< at its root, only in this kind; for files without schema
  std::vector<std::string_view> also = {};  ///< commands that read it too

  [[nodiscard]] bool is_read_by(std::string_view other) const {
    return command == other || std::ranges::find(also, other) != also.end();
  }
};

const std::vector<ConfigurationFile>& kinds() {
  static const std::vector<ConfigurationFile> all{
      {"coast.run/", "a run", "process", {"imu", "gnss"}, {"diagnose", "ppk"}},
      {"coast.scenario/", "a scenario", "simulate", {"trajectory"}},
      {"coast.study/", "a study of outages", "outage", {"sweep"}},
      {"coast.calibration_run/", "a calibration", "calibrate", {"records"}},
      {"coast.tumble/", "a multi-position calibration", "calibrate", {}},
      {"coast.imu_calibration/", "a calibration of scale, misalignment and bias", "", {"covariance"}},
      {"coast.estimator_study/", "a study of estimators", "calibrate", {}},
      {"coast.array/", "an array of IMUs", "synth", {"imus"}},
      {"coast.array_study/", "a study of arrays", "synth", {}},
      {"coast.campaign/", "a campaign", "campaign", {"missions"}},
      {"coast.fleet/", "a fleet", "fleet", {"estimates"}},
      {"coast.ppk/", "a solution of RINEX", "ppk", {"rover", "base"}},
      {"coast.imu_error_model/", "an error model", "", {"gyro", "accel"}},
  };
  return all;
}

const ConfigurationFile* kind_of(const config::Node& root) {
  const auto schema = root.find("schema");
  const bool named = schema && schema->is_scalar();
  const auto known = std::ranges::find_if(kinds(), [&](const ConfigurationFile& kind) {
    if (named) return schema->text().starts_with(kind.schema);
    return !kind.keys.empty() &&
           std::ranges::all_of(kind.keys, [&](std::string_view key) { return root.find(key).has_value(); });
  });
  return known == kinds().end() ? nullptr : &*known;
}

}  // namespace

void require_kind(const std::filesystem::path& file, std::string_view command) {
  require_kind(io::load_yaml(file), command);
}

void require_kind(const config::Node& root, std::string_view command) {
  if (!root.is_map()) return;  // left to the reader of the file
  const ConfigurationFile* kind = kind_of(root);
  if (kind == nullptr || kind->is_read_by(command)) return;
  auto own = std::ranges::find(kinds(), command, &ConfigurationFile::command);
  if (own == kinds().end())
    own = std::ranges::find_if(kinds(), [&](const ConfigurationFile& one) { return one.is_read_by(command); });
  throw root.error(fmt::format("this file is {} (`schema: {}1`)", kind->is, kind->schema),
                   fmt::format("a file for coast {} (`schema: {}1`)", command, own->schema),
                   kind->command.empty()
                       ? "It is named in a run.yaml, as imu.error_model or imu.calibration."
                       : fmt::format("The subcommand for it is: coast {} {}", kind->command, root.file().string()));
}

bool names_schema(const std::filesystem::path& file, std::string_view schema) {
  const std::string extension = file.extension().string();
  if (extension != ".yaml" && extension != ".yml") return false;
  return names_schema(io::load_yaml(file), schema);
}

bool names_schema(const config::Node& root, std::string_view schema) {
  const auto named = root.find("schema");
  return named && named->is_scalar() && named->text().starts_with(schema);
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  return config::nearest(word, known);
}

}  // namespace coast::jobs
