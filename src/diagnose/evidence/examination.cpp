#include "coast/diagnose/examination.hpp"

#include <algorithm>
#include <array>

#include "coast/simulate/random.hpp"
#include "evidence/observable.hpp"
#include "evidence/selected_effects.hpp"

namespace coast::diagnose {

namespace {

/// A disturbance within an interval is a bias step at its beginning and an opposite one at its end.
class DisturbanceRecorder {
 public:
  DisturbanceRecorder(const Hypotheses& hypotheses, const ExaminationOptions& options, std::size_t intervals,
                      Disturbances& into)
      : rows_(1 + std::min(options.draws, options.draws_of_disturbances)), into_(into) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      step_[axis] = hypotheses.bias_step(axis < 3 ? Site::kGyro : Site::kAccel, static_cast<Eigen::Index>(axis % 3));
      into_.score[axis].resize(rows_, static_cast<Eigen::Index>(intervals));
      behind_[axis] = Eigen::VectorXd::Zero(rows_);
    }
    into_.t.resize(intervals);
    into_.length.resize(intervals);
    left_ = intervals;
  }
  void add(const estimate::Evidence& e) {
    const bool is_interval = end_.has_value() && left_ > 0;
    if (is_interval) --left_;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      Eigen::VectorXd now(rows_);
      now << -e.r_effects(step_[axis]), -e.null_r_effects.row(step_[axis]).head(rows_ - 1).transpose();
      if (is_interval) into_.score[axis].col(static_cast<Eigen::Index>(left_)) = (now - behind_[axis]).cast<float>();
      behind_[axis] = std::move(now);
    }
    if (is_interval) {
      into_.t[left_] = e.t;
      into_.length[left_] = *end_ - e.t;
    }
    end_ = e.t;
  }

 private:
  Eigen::Index rows_;
  Disturbances& into_;
  std::array<Eigen::Index, kAxes> step_{};
  std::array<Eigen::VectorXd, kAxes> behind_;
  std::optional<geo::GpsTime> end_;
  std::size_t left_ = 0;
};

class Recorder {
 public:
  Recorder(const Hypotheses& hypotheses, const ExaminationOptions& options, const estimate::KnotStore& knots, Examination& into)
      : hypotheses_(hypotheses),
        into_(into),
        left_(knots.size()),
        disturbances_(hypotheses, options, knots.size() > 0 ? knots.size() - 1 : 0, into.disturbances) {
    if (knots.size() > 0) earliest_ = knots.at(0).post.nav.t + kEpisode;
    for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
      if (hypotheses[i].begins_at_some_time()) into.tracks.push_back({i, {}, {}, {}, Eigen::VectorXd::Zero(options.draws)});
  }
  void add(const estimate::Evidence& e) {
    if (--left_ == 0) {
      into_.score = -e.r_effects;
      into_.information = e.N_effects.selfadjointView<Eigen::Lower>();
      into_.null_score = -e.null_r_effects;
    }
    disturbances_.add(e);
    for (Examination::Track& track : into_.tracks) {
      const Eigen::Index i = track.hypothesis;
      const double information = e.N_effects(i, i);
      if (e.t < earliest_ || !is_observable(hypotheses_[i], information)) continue;
      track.t.push_back(e.t);
      track.score.push_back(-e.r_effects(i));
      track.information.push_back(information);
      track.null_largest = track.null_largest.cwiseMax(e.null_r_effects.row(i).transpose().cwiseAbs2() / information);
    }
  }
  void finish() {  // the pass went backward
    for (Examination::Track& track : into_.tracks) {
      std::ranges::reverse(track.t);
      std::ranges::reverse(track.score);
      std::ranges::reverse(track.information);
    }
  }

 private:
  const Hypotheses& hypotheses_;
  Examination& into_;
  std::size_t left_;  ///< knots
  DisturbanceRecorder disturbances_;
  geo::GpsTime earliest_;  ///< of an onset: earlier effects act from the start on
};

}  // namespace

Examination examine(const estimate::Mission& mission, const estimate::StateLayout& layout, const estimate::KnotStore& knots,
                    const Hypotheses& hypotheses, const ExaminationOptions& options,
                    const std::function<void(double)>& progress) {
  Examination result;
  result.started = options.started;
  std::vector<SelectedEffect> started;
  for (const Examination::Started& one : options.started) started.push_back({.hypothesis = one.hypothesis, .from = one.from});
  const WithSelected effects(hypotheses, std::move(started));
  Recorder recorder(hypotheses, options, knots, result);
  simulate::Normal normal(simulate::stream_seed(options.seed, {1}));
  estimate::EffectPassOptions pass;
  pass.draws = options.draws;
  pass.draw = [&normal](geo::GpsTime, const Eigen::VectorXd&, Eigen::Ref<Eigen::MatrixXd> values) {
    for (double& value : values.reshaped()) value = normal();
  };
  pass.progress = progress;
  estimate::effect_pass(mission, layout, knots, effects, pass, [&](const estimate::Evidence& e) { recorder.add(e); });
  recorder.finish();
  return result;
}

bool Examination::take_draws_of(const Examination& other) {
  constexpr double kSame = 0.05;  // of the variance of the score of each one that lasts the mission
  const Disturbances& theirs = other.disturbances;
  if (information.rows() != other.information.rows() || disturbances.t.size() != theirs.t.size() || started != other.started)
    return false;
  Eigen::ArrayXd change =
      (information - other.information).diagonal().array().abs() - kSame * other.information.diagonal().array();
  for (const Track& track : tracks) change(track.hypothesis) = 0.0;
  if ((change > 0.0).any()) return false;
  null_score = other.null_score;
  for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i].null_largest = other.tracks[i].null_largest;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    Eigen::MatrixXf rows = theirs.score[axis];
    rows.row(0) = disturbances.score[axis].row(0);
    disturbances.score[axis] = std::move(rows);
  }
  return true;
}

}  // namespace coast::diagnose
