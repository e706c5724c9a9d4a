#include <fmt/format.h>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/io/writers.hpp"
#include "commands.hpp"
#include "diagnosis_json.hpp"
#include "load.hpp"
#include "progress.hpp"

namespace coast::cli {

void diagnose(const std::filesystem::path& run_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = [&line](const char* what, double fraction) { line.show(what, fraction); };
  const RunConfig config = read_run_config(run_yaml);
  if (config.tight)
    throw InputError({run_yaml.string(), 0, "tightly coupled observations", "positions: effects are sought in fixes", ""});
  Recordings recordings = load(config, [&line](double share) { line.show("solving GNSS positions", share); });
  const std::filesystem::path out = output_folder(run_yaml, options.out);
  line.clear();
  print_inspection(recordings, options.quiet);
  const study::Setup setup = setup_of(config, recordings, {});
  const diagnose::MissionInput input{std::move(recordings.imu), std::move(recordings.gnss), setup};
  const diagnose::Diagnosis diagnosis = diagnose::diagnose(input, {}, progress);
  line.clear();
  io::write_text(out / "diagnosis.json", diagnosis_json(diagnosis, input));
  if (!options.quiet) fmt::print("{}", diagnosis_text(diagnosis));
}

}  // namespace coast::cli
