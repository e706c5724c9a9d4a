#pragma once
// The recordings that a run.yaml names.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"
#include "run_config.hpp"

namespace coast::cli {

struct Recordings {
  record::ImuRecording imu;  ///< body axes
  record::GnssRecording gnss;
  std::optional<record::Trajectory> reference;
  std::shared_ptr<const estimate::CarrierObservations> carrier;  ///< for tight coupling
  std::vector<std::string> inspection;                           ///< what was understood, sentence by sentence
  std::optional<double> time_shift_s;                            ///< of GNSS to IMU, where turns match best
  record::Events inspection_events;
};

/// Reads all files; a week that one of them does not state comes from the other.
[[nodiscard]] Recordings load(const RunConfig& config, const study::Progress& progress);
/// First thing on the terminal: what was understood, and the warnings.
void print_inspection(const Recordings& recordings, bool quiet);
/// Nothing sensible follows where gravity points the wrong way at rest.
/// @throws NumericalError  axes that contradict gravity or the course, and nothing says `accept: true`
void refuse_wrong_axes(const RunConfig& config, const Recordings& recordings);
/// Where the size of gravity or of turns is out by a unit, a search would explain the unit by many effects.
/// @throws NumericalError  likewise
void refuse_wrong_units(const RunConfig& config, const Recordings& recordings);
/// The setup of run.yaml with what depends on the recordings: a given start in their week, and where the first outage begins.
[[nodiscard]] study::Setup setup_of(const RunConfig& config, const Recordings& recordings,
                                    const std::optional<study::OutageSweep>& sweep);
/// Takes the effects that run.yaml names out of the recordings and the setup; nothing where it names none.
void take_out_effects(const RunConfig& config, Recordings& recordings, study::Setup& setup, const study::Progress& progress);
/// `--out`, or the yaml's name + ".out"; made where it is missing, and marked as coast's (io/results_folder.hpp).
/// @param files  names that will be written: refused now, and not after the work, where they are another's
/// @throws OutputError, InputError
[[nodiscard]] std::filesystem::path output_folder(const std::filesystem::path& input, const std::filesystem::path& out,
                                                  std::vector<std::string> files = {});

}  // namespace coast::cli
