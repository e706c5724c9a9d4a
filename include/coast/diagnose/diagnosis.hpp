#pragma once
// Search for effects that are missing in the configured model.

#include <optional>
#include <string>
#include <vector>

#include "coast/diagnose/correction.hpp"
#include "coast/diagnose/examination.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/diagnose/sample_effect.hpp"

namespace coast::diagnose {

/// An alternative explanation that the data cannot exclude.
struct Alternative {
  std::string name;
  std::string sensor;
  std::string axis;
  double log_odds = 0.0;     ///< natural logarithm of the odds of the detected effect against this one
  bool implausible = false;  ///< of a size that a sensor of this grade hardly has
};

/// A detected effect.
struct Finding {
  Hypothesis hypothesis;
  std::optional<geo::GpsTime> from;  ///< the whole mission where absent
  std::optional<geo::GpsTime> to;
  double from_sd_s = 0.0;  ///< of `from`
  double value = 0.0;
  double sd = 0.0;
  double delta_log_likelihood = 0.0;  ///< from runs with and without it, all others unchanged
  double p_value = 1.0;
  double price = 0.0;  ///< penalty in log-likelihood for its size and onset: 0.5 likelihood ratio - log Bayes factor
  /// Logarithm of the likelihood ratio on blocks not used to estimate its size, with all other effects included.
  std::optional<double> held_out_gain;
  std::vector<Alternative> alternatives;
  std::optional<double> stability;  ///< for an unnamed relation: share of random halves of the mission in which it is detected
  /// Of an effect that repeats: the other times, each with its axis and size, and with no larger gain.
  std::vector<Finding> further = {};
};
/// A finding time by time, in their order; the finding alone if it has no further times.
[[nodiscard]] std::vector<Finding> times_of(const Finding& finding);

/// Smallest detectable size of an effect that was not detected.
struct Detectable {
  Hypothesis hypothesis;
  double minimal = 0.0;
};
struct NotObservable {
  Hypothesis hypothesis;
  std::string reason;
};

/// Noise that differs from the stated noise, or an effect of a converter on the samples.
struct NoiseFinding {
  /// Place of the correction in run.yaml: `noise` of IMU and GNSS, the error model, or `effects`.
  enum class Place { kNoise, kErrorModel, kEffects };
  std::string name;  ///< gnss_sd_optimistic, gnss_correlated_error, imu_white_noise, or a name of the tables
  std::string sensor;
  std::string axis = {};
  std::string parameter;
  std::string unit;
  double value = 0.0;
  double sd = 0.0;
  std::optional<Eigen::Vector3d> by_axis = {};  ///< x, y, z, if they differ; `value` is their weighted mean
  double delta_log_likelihood = 0.0;
  double p_value = 1.0;
  Place place = Place::kNoise;
  double time_s = 0.0;     ///< correlation time; 0: none
  double time_sd_s = 0.0;  ///< 0: not known
  std::string meaning = {};
  std::string equation = {};
  std::string separating_manoeuvre = {};
  std::vector<Alternative> alternatives = {};
};

/// Fit of one run.
struct Fit {
  double log_likelihood_per_epoch = 0.0;  ///< including the penalty of start biases beyond the error model
  double nis = 0.0;                       ///< mean over degrees of freedom
  double outage_rms_m = 0.0;           ///< horizontal maxima of forward outages, relative to the run's own smoothed trajectory
  std::vector<double> outages_m = {};  ///< one by one
};

/// A part of a mission, in seconds since its start.
struct Stretch {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// A statistic of the recording, compared with those of its twins.
struct TwinStatistic {
  std::string name;
  std::optional<Stretch> stretch;  ///< if it is of a part of the mission
  double real = 0.0;
  double q05 = 0.0, q50 = 0.0, q95 = 0.0;  ///< of the twins
  double p_adjusted = 1.0;  ///< probability that any statistic of a twin is as extreme among the other twins as this one
};

/// Held-out test: effects with sizes from one half of the mission, in alternating blocks, applied to the other half, and vice
/// versa.
struct HeldOut {
  int blocks = 0;
  double gain = 0.0;                                     ///< logarithm of the likelihood ratio, all blocks together
  double gain_sd = 0.0;                                  ///< from the scatter between blocks
  double better = 0.0;                                   ///< share of blocks with a gain
  double before_per_epoch = 0.0, after_per_epoch = 0.0;  ///< log-likelihood per epoch, up to a constant
};

/// Artificial outages, one by one: drift with the detected effects minus drift without them.
struct PairedDifference {
  int count = 0;
  double mean = 0.0;
  double sd = 0.0;  ///< of the mean
};
/// Compares nothing (count 0) if the outages differ, or are fewer than two.
[[nodiscard]] PairedDifference outage_difference(const Fit& before, const Fit& after);
/// Whether outages drift more with `after`: by half, and significantly (1 %) in view of the scatter of the differences.
[[nodiscard]] bool drifts_farther(const Fit& before, const Fit& after);

/// An effect that was detected, and then rejected.
struct Rejected {
  enum class Reason {
    kHeldOut,  ///< its size from one half of the mission does not explain the other half
    kOutages,  ///< artificial outages drift more with it
  };
  std::string effect;  ///< its name, sensor and axis
  Reason reason = Reason::kHeldOut;
};

/// An independent reference trajectory. It is used only for what the recording cannot show: an offset of the base.
struct Reference {
  const record::Trajectory* trajectory = nullptr;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU to the reference's point
};

struct Diagnosis {
  std::vector<Finding> findings;
  std::vector<NoiseFinding> noise;
  std::vector<Detectable> detectable_not_found;
  std::vector<NotObservable> not_observable;
  Grade grade = Grade::kIndustrial;
  /// For the likelihood ratio: exceeded by 3 % of clean recordings, the catalogue's share of false alarms.
  double threshold = 0.0;
  Fit before;
  Fit after;
  PairedDifference outage_change;
  std::vector<TwinStatistic> twins;        ///< of the configured model
  std::vector<TwinStatistic> twins_after;  ///< of the model with the detected effects
  std::optional<HeldOut> held_out;         ///< if mean effects were detected
  bool reference_used = false;
  std::vector<Rejected> rejected;
  std::size_t runs = 0;
  std::vector<estimate::InnovationRecord> innovations_before;
  std::vector<estimate::InnovationRecord> innovations_after;
  MissionInput modelled;             ///< corrected for the detected effects
  std::vector<EffectPtr> suggested;  ///< detected effects that are not in the catalogue
};

struct DiagnosisOptions {
  double false_alarm_probability = 0.05;  ///< for a recording without missing effects
  int most_effects = 6;  ///< mean effects; plus one for each replacement by one from the start on, or of a bias
  std::uint64_t seed = 1;
  int twins = 20;         ///< per model; 0: none
  bool exchanges = true;  ///< search again with mean effects first, and from exchanges that no single step leads to
  /// `gnss.time_offset_s` for which turns of GNSS and IMU match best (io::inspect). If it is far from the configured one, the
  /// search begins with a run there: a score linearised about the configured value does not detect it.
  std::optional<double> time_offset_s = {};
  std::optional<Reference> reference = {};  ///< used after the search, only for base_coordinate_offset
};

/// Stepwise. The mission is filtered; the candidate with the largest Bayes factor (decided by filter runs if there are several)
/// is selected if its likelihood ratio exceeds the threshold for chance. The sizes of all selected effects are estimated by
/// Gauss-Newton steps while the likelihood rises; the mission is corrected and filtered again, until no candidate is left.
/// Random effects are selected if their evidence is larger: log-likelihood minus the prior penalty for sizes, onsets and
/// choices. If noise was detected, the search is repeated with mean effects first; the result with the larger evidence is kept,
/// and the other one is reported as alternative if the difference is small. Every selected effect is tested again together with
/// the others, then on blocks not used to estimate its size, and is rejected if it explains nothing there; effects are also
/// rejected, the worst first, if artificial outages drift more with all of them than with none. An effect that begins at some
/// time is also tried from the start on, and a bias beyond the error model as an effect that is constant over the mission, each
/// with its own search. Finally the recording is compared with twins of its mission (twin.hpp) from the configured model and
/// from the new one.
/// @param simulations  the user's own, instead of the twins of the configured model
[[nodiscard]] Diagnosis diagnose(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& progress,
                                 const std::vector<MissionInput>& simulations = {});

}  // namespace coast::diagnose
