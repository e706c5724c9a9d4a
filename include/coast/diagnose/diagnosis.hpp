#pragma once
// The search for what the configured model leaves out.

#include <optional>
#include <string>
#include <vector>

#include "coast/diagnose/correction.hpp"
#include "coast/diagnose/examination.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/diagnose/sample_effect.hpp"

namespace coast::diagnose {

/// An explanation that the data cannot exclude beside the one given.
struct Alternative {
  std::string name;
  std::string sensor;
  std::string axis;
  double log_odds = 0.0;  ///< natural logarithm, for the effect found against this one
};

/// An effect found.
struct Finding {
  Hypothesis hypothesis;
  std::optional<geo::GpsTime> from;  ///< the whole mission where absent
  std::optional<geo::GpsTime> to;
  double from_sd_s = 0.0;  ///< of `from`
  double value = 0.0;
  double sd = 0.0;
  double delta_log_likelihood = 0.0;  ///< realised: runs with and without it, all others as they are
  double p_value = 1.0;
  double price = 0.0;  ///< what of the log-likelihood its size and onset cost: 0.5 likelihood ratio - log Bayes factor
  /// Logarithm of the likelihood ratio on blocks that its size was not estimated from, all others in.
  std::optional<double> held_out_gain;
  std::vector<Alternative> alternatives;
  std::optional<double> stability;  ///< of a relation without a name: share of random halves of the mission that show it
};

/// What would have been found of an effect that was not.
struct Detectable {
  Hypothesis hypothesis;
  double minimal = 0.0;
};
struct NotObservable {
  Hypothesis hypothesis;
  std::string reason;
};

/// Noise that differs from what is stated, or what a converter does to the samples.
struct NoiseFinding {
  /// Where run.yaml takes it: `noise` of IMU and GNSS, the error model, or `effects`.
  enum class Place { kNoise, kErrorModel, kEffects };
  std::string name;  ///< gnss_sd_optimistic, gnss_correlated_error, imu_white_noise, or of the tables
  std::string sensor;
  std::string axis;
  std::string parameter;
  std::string unit;
  double value = 0.0;
  double sd = 0.0;
  double delta_log_likelihood = 0.0;
  double p_value = 1.0;
  Place place = Place::kNoise;
  double time_s = 0.0;     ///< correlation time; 0: it has none
  double time_sd_s = 0.0;  ///< 0: not known
  std::string meaning = {};
  std::string equation = {};
  std::string separating_manoeuvre = {};
  std::vector<Alternative> alternatives = {};
};

/// Fit of one run.
struct Fit {
  double log_likelihood_per_epoch = 0.0;  ///< with what biases at the start cost beyond the error model
  double nis = 0.0;                       ///< mean over degrees of freedom
  double outage_rms_m = 0.0;              ///< horizontal maxima of forward outages, against the run's own smoothed trajectory
  std::vector<double> outages_m = {};     ///< one by one
};

/// A part of a mission, in seconds since its start.
struct Stretch {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// A figure of the recording beside those of its twins.
struct TwinStatistic {
  std::string name;
  std::optional<Stretch> stretch;  ///< where it is of a part of the mission
  double real = 0.0;
  double q05 = 0.0, q50 = 0.0, q95 = 0.0;  ///< of the twins
  double p_adjusted = 1.0;  ///< that any of the figures of a twin lies as far out among the other twins as this one
};

/// Effects with sizes from one half of the mission, in alternating blocks, on the other half, and the other way round.
struct HeldOut {
  int blocks = 0;
  double gain = 0.0;                                     ///< logarithm of the likelihood ratio, all blocks together
  double gain_sd = 0.0;                                  ///< by the spread from block to block
  double better = 0.0;                                   ///< share of blocks
  double before_per_epoch = 0.0, after_per_epoch = 0.0;  ///< log-likelihood of an epoch but for a constant
};

/// Of artificial outages, one by one: drift with what was found less that without it.
struct PairedDifference {
  int count = 0;
  double mean = 0.0;
  double sd = 0.0;  ///< of the mean
};
/// Nothing compared where the outages are not the same ones, or less than two.
[[nodiscard]] PairedDifference outage_difference(const Fit& before, const Fit& after);
/// Whether outages drift farther with `after`: by half, and by more than chance has it of their differences (1 %).
[[nodiscard]] bool drifts_farther(const Fit& before, const Fit& after);

/// An effect that was found, and given up.
struct Rejected {
  enum class Reason {
    kHeldOut,  ///< its size from one half of the mission does not explain the other half
    kOutages,  ///< artificial outages drift farther with it
  };
  std::string effect;  ///< its name, sensor and axis
  Reason reason = Reason::kHeldOut;
};

/// A trajectory that is known otherwise. It serves for what nothing in the recording can show: an offset of the base.
struct Reference {
  const record::Trajectory* trajectory = nullptr;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU to its point
};

struct Diagnosis {
  std::vector<Finding> findings;
  std::vector<NoiseFinding> noise;
  std::vector<Detectable> detectable_not_found;
  std::vector<NotObservable> not_observable;
  Grade grade = Grade::kIndustrial;
  /// Of the likelihood ratio: 3 % of clean recordings exceed it, the catalogue's share of false alarms.
  double threshold = 0.0;
  Fit before;
  Fit after;
  PairedDifference outage_change;
  std::vector<TwinStatistic> twins;        ///< of the configured model
  std::vector<TwinStatistic> twins_after;  ///< of the model with what was found
  std::optional<HeldOut> held_out;         ///< where mean effects were found
  bool reference_used = false;
  std::vector<Rejected> rejected;
  std::size_t runs = 0;
  std::vector<estimate::InnovationRecord> innovations_before;
  std::vector<estimate::InnovationRecord> innovations_after;
  MissionInput modelled;             ///< with what was found taken out
  std::vector<EffectPtr> suggested;  ///< effects found that are not of the catalogue
};

struct DiagnosisOptions {
  double false_alarm_probability = 0.05;  ///< of a recording in which nothing is missing
  int most_effects = 6;                   ///< mean effects; one more for each exchange for one from the start on, or of a bias
  std::uint64_t seed = 1;
  int twins = 20;  ///< of each model; 0: none
  /// `gnss.time_offset_s` by which turns of GNSS and IMU match best (io::inspect). Where it is far from the configured one, the
  /// search begins with a run there: no score that is linear about the configured one tells of it.
  std::optional<double> time_offset_s = {};
  std::optional<Reference> reference = {};  ///< looked at when all else is found, for base_coordinate_offset alone
};

/// Stepwise: the mission is run; of all hypotheses beside those taken the likeliest, by Bayes factor and by runs where there
/// are several, is taken where the largest likelihood ratio exceeds what chance allows; coefficients of all taken follow
/// (Gauss-Newton, as far as the likelihood rises), and the mission is run again without them, until nothing more exceeds.
/// Random effects are taken where their evidence is larger: likelihood less what sizes, onsets and choices cost. Then the
/// search is made once more with mean effects first; the outcome with the larger evidence is kept and the other one told beside
/// it where the difference is small. Every effect is put to the test again beside the others. Then what was found is held
/// against blocks that its sizes were not estimated from, and given up where it explains nothing there; likewise, the worst
/// first, where with all of it artificial outages drift farther than with nothing. What begins at some time is then put to the
/// test as there from the start on, and a bias at the start that the error model does not have as an effect that is a constant
/// during the mission, each with all of the search behind it. In the end the recording is held against twins of its mission
/// (twin.hpp) by the configured model and by the new one.
/// @param simulations  the user's own, in place of the twins of the configured model
[[nodiscard]] Diagnosis diagnose(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& progress,
                                 const std::vector<MissionInput>& simulations = {});

}  // namespace coast::diagnose
