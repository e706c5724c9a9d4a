#pragma once
// A run of the mission with an explanation, and the runs made by a diagnosis; private to the room.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "evidence/mission_run.hpp"
#include "evidence/selected_effects.hpp"
#include "search/explanation.hpp"

namespace coast::diagnose {

/// Sensor errors about which the filter is linearised. With biases at their prior mean tilts are wrong by mrad until
/// the first manoeuvres, and the square of a tilt looks like a vertical bias that ends there. It is not updated by every run: a
/// prior that is would be an additional fit, and likelihoods are compared under one prior. It is updated if a run estimates the
/// sensors two sigmas from it.
struct SensorsAtStart {
  estimate::StateLayout layout;
  Eigen::VectorXd x;
};

/// What threads ask of a run that several searches share. Each thread that asks before it is known computes it: a thread that
/// waited for another one's loops could be given work that waits for it.
template <class T>
class Remembered {
 public:
  template <class Compute>
  const T& value(const Compute& compute) const {
    {
      const std::lock_guard lock(mutex_);
      if (value_) return *value_;
    }
    T computed = compute();
    const std::lock_guard lock(mutex_);
    if (!value_) value_ = std::move(computed);
    return *value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
};

/// The mission filtered and smoothed, corrected for all effects of an explanation.
class ExplainedRun {
 public:
  /// @param sensors  none: the run begins with those of the alignment
  /// @param key      of the explanation and of the run about which it is linearised
  /// @throws NumericalError  the filter fails
  ExplainedRun(Explanation explanation, MissionInput input, std::optional<SensorsAtStart> sensors, std::size_t key, Grade grade,
               const study::Progress& progress);
  ExplainedRun(const ExplainedRun&) = delete;
  ExplainedRun& operator=(const ExplainedRun&) = delete;

  [[nodiscard]] const Explanation& explanation() const { return explanation_; }
  [[nodiscard]] const MissionInput& input() const { return input_; }
  [[nodiscard]] const std::optional<SensorsAtStart>& sensors() const { return sensors_; }
  [[nodiscard]] std::size_t key() const { return key_; }
  [[nodiscard]] const MissionRun& mission() const { return run_; }
  [[nodiscard]] const Hypotheses& hypotheses() const { return run_.hypotheses(); }
  /// With the error model's prior for shared biases, and without what its effects gain by making the noise of a sensor smaller.
  [[nodiscard]] double log_likelihood() const { return log_likelihood_; }
  /// What some of its effects gain by making the noise of a sensor smaller; to first order in their sizes.
  [[nodiscard]] double gain_by_own_noise(std::size_t first, std::size_t count) const;
  /// Whether the estimated sensor errors are far from those at its start.
  [[nodiscard]] bool found_sensors_elsewhere() const;
  /// Scores and information, without draws. Computed when first asked for.
  [[nodiscard]] const Examination& scores() const;
  [[nodiscard]] Examination examined(ExaminationOptions options) const;
  /// Of the sizes of its own effects. Likewise.
  [[nodiscard]] const SizeEvidence& sizes() const;
  /// Sizes from some of the innovations.
  [[nodiscard]] SizeEvidence sizes_where(const std::function<bool(geo::GpsTime)>& counts) const;

 private:
  Explanation explanation_;
  MissionInput input_;
  std::optional<SensorsAtStart> sensors_;
  std::size_t key_;
  const study::Progress& progress_;
  MissionRun run_;
  double log_likelihood_ = 0.0;
  Remembered<Examination> scores_;
  Remembered<SizeEvidence> sizes_;
};
using RunPtr = std::shared_ptr<const ExplainedRun>;

/// Makes the runs of a search. The last few are cached, so that repeated proposals need no new run. Not for several threads.
class Runs {
 public:
  /// @param recorded  input of the diagnosis; @param progress  must outlive it
  Runs(MissionInput recorded, Grade grade, const study::Progress& progress);
  /// For a search beside that of others: with the runs that they made last.
  [[nodiscard]] Runs beside() const;

  /// From the start in the setup or from the alignment.
  [[nodiscard]] RunPtr first(const Explanation& explanation);
  /// Linearised about another run: effects are corrected along its trajectory, and its start is the prior mean, with larger
  /// sigmas.
  /// @throws NumericalError  the filter fails
  [[nodiscard]] RunPtr about(const Explanation& explanation, const RunPtr& other);
  /// Likewise; null if the filter fails.
  [[nodiscard]] RunPtr try_about(const Explanation& explanation, const RunPtr& other);
  struct Request {
    Explanation explanation;
    RunPtr about;
  };
  /// Likewise, several at a time on all threads.
  [[nodiscard]] std::vector<RunPtr> try_all(const std::vector<Request>& requests);
  /// The mission with other sizes of the effects of a run, its start and its noise.
  [[nodiscard]] MissionInput with_sizes(const std::vector<SelectedEffect>& effects, const ExplainedRun& run) const;

  [[nodiscard]] const MissionInput& recorded() const { return recorded_; }
  [[nodiscard]] Grade grade() const { return grade_; }
  [[nodiscard]] const study::Progress& progress() const { return progress_; }
  [[nodiscard]] std::size_t made() const { return made_; }
  /// Adds runs that others made for the same outcome.
  void count(std::size_t others) { made_ += others; }

 private:
  Runs(const Runs& other, std::vector<RunPtr> last);
  [[nodiscard]] MissionInput explained(const Explanation& explanation, const MissionRun& along) const;
  [[nodiscard]] SensorsAtStart sensors_for(const Explanation& explanation, const MissionInput& input,
                                           const ExplainedRun& other);
  [[nodiscard]] RunPtr make(const Explanation& explanation, const ExplainedRun& other);
  [[nodiscard]] RunPtr remembered(const Explanation& explanation, const ExplainedRun& other) const;
  void remember(const RunPtr& run);

  MissionInput recorded_;
  Grade grade_;
  const study::Progress& progress_;
  std::vector<RunPtr> last_;
  std::atomic<std::size_t> made_ = 0;
};

}  // namespace coast::diagnose
