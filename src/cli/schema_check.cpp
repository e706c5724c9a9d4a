#include "schema_check.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

#include "coast/io/yaml.hpp"
#include "coast/record/error.hpp"

namespace coast::cli {

namespace {

struct ConfigurationFile {
  std::string_view schema;
  std::string_view is;
  std::string_view command;  ///< that reads it; empty: none
};

constexpr std::array kFiles = {
    ConfigurationFile{"coast.run/", "a run", "process"},
    ConfigurationFile{"coast.scenario/", "a scenario", "simulate"},
    ConfigurationFile{"coast.study/", "a study of outages", "outage"},
    ConfigurationFile{"coast.calibration_run/", "a calibration", "calibrate"},
    ConfigurationFile{"coast.estimator_study/", "a study of estimators", "calibrate"},
    ConfigurationFile{"coast.array/", "an array of IMUs", "synth"},
    ConfigurationFile{"coast.array_study/", "a study of arrays", "synth"},
    ConfigurationFile{"coast.ppk/", "a solution of RINEX", "ppk"},
    ConfigurationFile{"coast.imu_error_model/", "an error model", ""},
};

}  // namespace

void require_schema(const std::filesystem::path& file, std::string_view expected) {
  const auto schema = io::load_yaml(file).find("schema");
  if (!schema || !schema->is_scalar()) return;  // whoever reads the file judges it
  const std::string found = schema->text();
  for (const ConfigurationFile& known : kFiles)
    if (found.starts_with(known.schema) && !expected.starts_with(known.schema))
      throw schema->error(fmt::format("this file is {} (`schema: {}`)", known.is, found), fmt::format("`schema: {}`", expected),
                          known.command.empty()
                              ? "It is named in a run.yaml, as imu.error_model."
                              : fmt::format("The subcommand for it is: coast {} {}", known.command, file.string()));
}

}  // namespace coast::cli
