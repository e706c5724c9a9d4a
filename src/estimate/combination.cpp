#include "coast/estimate/combination.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"

namespace coast::estimate {

namespace {

constexpr double kRefuse = 1e-6;  // fraction of knots of consistent filters
constexpr double kResume = 1e-3;
constexpr double kChange = 0.5;  // of the trace: only a filter better by this replaces the other

Eigen::LLT<Eigen::MatrixXd> factor(const FilterState& forward, const FilterState& backward, Eigen::Index size) {
  Eigen::LLT<Eigen::MatrixXd> llt(forward.P.topLeftCorner(size, size) + backward.P.topLeftCorner(size, size));
  if (llt.info() != Eigen::Success)
    throw NumericalError("covariances of forward and backward filter are not positive definite", geo::to_string(forward.nav.t),
                         "one of the two has diverged");
  return llt;
}

/// Selection of the filter to be delivered, knot after knot.
class Choice {
 public:
  enum class Of { kBoth, kForward, kBackward };
  Of next(const FilterState& forward, const FilterState& backward) {
    const double apart = contradiction(forward, backward);
    if (apart < resume_ || (of_ == Of::kBoth && apart <= refuse_)) return of_ = Of::kBoth;
    const double f = forward.P.topLeftCorner<3, 3>().trace();
    const double b = backward.P.topLeftCorner<3, 3>().trace();
    if (of_ == Of::kBoth) return of_ = f <= b ? Of::kForward : Of::kBackward;
    if (of_ == Of::kForward && b < kChange * f) return of_ = Of::kBackward;
    if (of_ == Of::kBackward && f < kChange * b) return of_ = Of::kForward;
    return of_;
  }

 private:
  double refuse_ = noise::chi2_upper_quantile(kNav, kRefuse);
  double resume_ = noise::chi2_upper_quantile(kNav, kResume);
  Of of_ = Of::kBoth;
};

/// Stretches of knots without averaging.
class Refusals {
 public:
  void add(geo::GpsTime t, bool refused) {
    ++knots_;
    if (refused) {
      ++refused_;
      if (!inside_) {
        ++stretches_;
        began_ = t;
      }
      if (!first_) first_ = t;
      if (t - began_ >= longest_) {
        longest_ = t - began_;
        longest_from_ = began_;
      }
    }
    inside_ = refused;
  }
  void note(record::Events& events) const {
    if (!first_) return;
    events.push_back(
        {record::Event::Severity::kWarning, "combination_refused",
         fmt::format(
             "forward and backward filter contradict each other at {} of {} knots, in {} stretches, the longest {:.1f} s "
             "from {}: there nothing is averaged, and the one with the smaller position sigma is delivered",
             refused_, knots_, stretches_, longest_, geo::to_string(longest_from_)),
         first_, refused_});
  }

 private:
  std::size_t knots_ = 0;
  long refused_ = 0;
  long stretches_ = 0;
  bool inside_ = false;
  geo::GpsTime began_;
  std::optional<geo::GpsTime> first_;
  geo::GpsTime longest_from_;
  double longest_ = 0.0;
};

/// The states of `of` in [0, kNav) and [first, first + count).
FilterState reduced(const FilterState& of, Eigen::Index first, Eigen::Index count) {
  FilterState s{of.nav, Eigen::VectorXd::Zero(kNav + count), Eigen::MatrixXd(kNav + count, kNav + count)};
  s.x.tail(count) = of.x.segment(first, count);
  s.P.topLeftCorner<kNav, kNav>() = of.P.topLeftCorner<kNav, kNav>();
  s.P.bottomRightCorner(count, count) = of.P.block(first, first, count, count);
  s.P.bottomLeftCorner(count, kNav) = of.P.block(first, 0, count, kNav);
  s.P.topRightCorner(kNav, count) = s.P.bottomLeftCorner(count, kNav).transpose();
  return s;
}

/// Sensor states, each separately: the information of the backward filter beyond its prior, combined with the forward one.
void weigh_sensors(const BackwardKnots::Sensors& backward, const Eigen::VectorXd& prior_variance, Eigen::Index end,
                   Eigen::VectorXd& x, Eigen::VectorXd& sd) {
  for (Eigen::Index i = kNav; i < end; ++i) {
    const double forward = sd(i) * sd(i);
    if (!(forward > 0.0) || !(backward.variance(i) > 0.0) || !(prior_variance(i) > 0.0)) continue;
    const double learned = std::max(0.0, 1.0 / backward.variance(i) - 1.0 / prior_variance(i));
    const double variance = 1.0 / (1.0 / forward + learned);
    x(i) += variance * learned * (backward.x(i) - x(i));
    sd(i) = std::sqrt(variance);
  }
}

}  // namespace

double contradiction(const FilterState& forward, const FilterState& backward) {
  const Eigen::Matrix<double, kNav, 1> d = error_between(forward.nav, backward.nav);
  return factor(forward, backward, kNav).matrixL().solve(d).squaredNorm();
}

FilterState weighted_mean(const FilterState& forward, const FilterState& backward, const Eigen::VectorXd& prior_variance) {
  const Eigen::Index m = forward.x.size();
  Eigen::VectorXd d = forward.x - backward.x;
  d.head<kNav>() = error_between(forward.nav, backward.nav);
  // States without variance would make P_f + P_b singular: their rows and columns are zero, and any pivot leaves them
  // unchanged.
  FilterState b = backward;
  for (Eigen::Index i = kNav; i < m; ++i)
    if (!(prior_variance(i - kNav) > 0.0)) b.P(i, i) = 1.0;
  const Eigen::MatrixXd W = factor(forward, b, m).solve(forward.P).transpose();
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(m, m) - W;
  FilterState both = forward;
  both.P = rest * forward.P * rest.transpose() + W * b.P * W.transpose();
  remove_error(W * d, both.nav, both.x);
  // A prior counted twice is one measurement too many; one of negative variance removes it. Together both filters have at least
  // twice the prior's information on the state, so the denominator is at least half the prior.
  for (Eigen::Index i = kNav; i < m; ++i) {
    const double prior = prior_variance(i - kNav);
    if (!(prior > 0.0)) continue;
    const Eigen::VectorXd with_others = both.P.col(i);
    const double left = std::max(prior - with_others(i), 0.5 * prior);
    remove_error(-with_others * (both.x(i) / left), both.nav, both.x);
    both.P += with_others * with_others.transpose() / left;
  }
  both.P = 0.5 * (both.P + both.P.transpose()).eval();
  return both;
}

BackwardKnots::BackwardKnots(const StateLayout& layout, std::vector<geo::GpsTime> at, const FilterState& begin,
                             const KnotSampling& states)
    : at_(std::move(at)),
      sampling_(states),
      first_auxiliary_(layout.sensor_end()),
      auxiliaries_(layout.carrier_slots() - layout.sensor_end()),
      prior_variance_(begin.P.diagonal()),
      left_(at_.size()),
      place_(at_.size()) {}

void BackwardKnots::add(const FilterState& state) {
  constexpr double kSame = 1e-5;  // s: both filters round the instants of their knots by some microseconds
  while (left_ > 0 && at_[left_ - 1] - state.nav.t > kSame) --left_;
  if (left_ == 0 || state.nav.t - at_[left_ - 1] > kSame) return;
  const std::size_t knot = --left_;
  const FilterState kept = reduced(state, first_auxiliary_, auxiliaries_);
  place_[knot] = store_.size();
  Knot stored;
  stored.post = {kept.nav, kept.x, {}};
  stored.P_post = kept.P;
  store_.append(stored);
  if (keeps_sensors(knot)) sensors_[knot] = {state.x, state.P.diagonal()};
}

bool BackwardKnots::keeps_sensors(std::size_t knot) const {
  return sampling_.takes(knot > 0 ? std::optional(at_[knot - 1]) : std::nullopt, at_[knot]);
}

std::optional<FilterState> BackwardKnots::at(std::size_t knot) const {
  if (!place_[knot]) return std::nullopt;
  const Knot stored = store_.at(*place_[knot]);
  return FilterState{stored.post.nav, stored.post.x, stored.P_post};
}

const BackwardKnots::Sensors* BackwardKnots::sensors(std::size_t knot) const {
  const auto found = sensors_.find(knot);
  return found != sensors_.end() ? &found->second : nullptr;
}

namespace {

/// A knot of the combined solution: `state` holds navigation and auxiliary states, x and sd the others if they are kept.
SmoothedKnot delivered(const FilterState& state, Eigen::VectorXd x, Eigen::VectorXd sd, Eigen::Index first_auxiliary) {
  SmoothedKnot knot;
  knot.nav = state.nav;
  knot.cov = nav_covariance_n(state.P.topLeftCorner<kNav, kNav>(), state.nav.r_eb_e);
  if (x.size() == 0) return knot;
  const Eigen::VectorXd sd_state = state.P.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Index auxiliaries = state.x.size() - kNav;
  x.segment(first_auxiliary, auxiliaries) = state.x.tail(auxiliaries);
  sd.head<kNav>() = sd_state.head<kNav>();
  sd.segment(first_auxiliary, auxiliaries) = sd_state.tail(auxiliaries);
  knot.x = std::move(x);
  knot.sd = std::move(sd);
  return knot;
}

}  // namespace

Combination combine(const KnotStore& forward, const BackwardKnots& backward, const StateLayout& layout,
                    const std::function<void(double)>& progress) {
  const Eigen::Index sensors = layout.sensor_end();
  const Eigen::Index auxiliaries = layout.carrier_slots() - sensors;
  const Eigen::VectorXd prior = backward.prior_variance().segment(sensors, auxiliaries);
  Combination result;
  Choice choice;
  Refusals refusals;
  Choice::Of before = Choice::Of::kBoth;
  for (std::size_t i = 0; i < forward.size(); ++i) {
    const Knot knot = forward.at(i);
    const FilterState all{knot.post.nav, knot.post.x, knot.P_post};
    const FilterState f = reduced(all, sensors, auxiliaries);
    const std::optional<FilterState> b = backward.at(i);
    const Choice::Of of = b ? choice.next(f, *b) : Choice::Of::kForward;
    refusals.add(f.nav.t, b && of != Choice::Of::kBoth);
    Eigen::VectorXd x;
    Eigen::VectorXd sd;
    if (backward.keeps_sensors(i)) {
      x = all.x;
      sd = all.P.diagonal().cwiseSqrt();
    }
    if (const BackwardKnots::Sensors* s = backward.sensors(i)) {
      if (of == Choice::Of::kBoth) weigh_sensors(*s, backward.prior_variance(), sensors, x, sd);
      if (of == Choice::Of::kBackward) {
        x.head(sensors) = s->x.head(sensors);
        sd.head(sensors) = s->variance.head(sensors).cwiseSqrt();
      }
    }
    const FilterState state = of == Choice::Of::kBoth ? weighted_mean(f, *b, prior) : of == Choice::Of::kForward ? f : *b;
    result.knots.push_back(delivered(state, std::move(x), std::move(sd), sensors));
    result.knots.back().jumps = i > 0 && of != before;
    before = of;
    if (progress && i % 256 == 0) progress(static_cast<double>(i) / static_cast<double>(forward.size()));
  }
  refusals.note(result.events);
  return result;
}

}  // namespace coast::estimate
