// The search's values: explanations, their runs, proposals and moves.

#include <gtest/gtest.h>

#include <limits>

#include "coast/geo/units.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "diagnose/concealed.hpp"
#include "noise_effects/noise_effects.hpp"
#include "search/begin.hpp"
#include "search/moves/moves.hpp"
#include "search/review.hpp"
#include "search/search.hpp"
#include "search/told.hpp"
#include "verdict/detectable.hpp"
#include "verdict/held_out.hpp"

namespace coast {
namespace {

using namespace diagnose;

/// A mission and what its search needs.
class Searching {
 public:
  explicit Searching(const MissionInput& input, const DiagnosisOptions& options = test::kWithoutTwins)
      : runs_(with_open_gate(input), grade_of(input.setup.model), progress_), context{options, {}, runs_} {}

 private:
  study::Progress progress_;
  Runs runs_;

 public:
  Context context;
};

Eigen::Index index_of(const State& state, std::string_view name, std::string_view axis) {
  const std::vector<Hypothesis>& all = state.run->hypotheses().all();
  const auto at =
      std::ranges::find_if(all, [&](const Hypothesis& h) { return h.effect->name == name && h.axis_name() == axis; });
  return at - all.begin();
}

TEST(Explanation, IsAValue) {
  Explanation a;
  a.effects = {{.hypothesis = 3, .value = 0.5}};
  Explanation b = a;
  EXPECT_TRUE(a == b);
  EXPECT_EQ(a.hash(), b.hash());
  b.effects.front().value = 0.25;
  EXPECT_FALSE(a == b);
  EXPECT_NE(a.hash(), b.hash());
  b = a;
  b.effects.front().from = geo::GpsTime::from_week(2374, 1000.0);
  EXPECT_FALSE(a == b);
  EXPECT_NE(a.hash(), b.hash());
  b = a;
  b.noise.emplace();
  EXPECT_FALSE(a == b);
  EXPECT_NE(a.hash(), b.hash());
  b.noise->gyro_factors.y() = 2.0;
  a.noise.emplace();
  EXPECT_FALSE(a == b);
  b = a;
  b.suggested.push_back(harmonic_disturbance(Site::kGyro, 0, 0.1, 0.0));
  EXPECT_FALSE(a == b);
  EXPECT_TRUE(b.is_suggested(*b.suggested.front()));
  EXPECT_TRUE(b.with({.hypothesis = 1}).without(1) == b);
}

TEST(Runs, RememberTheLastFew) {
  Searching search(test::honest_mission(1, 220.0));
  Runs& runs = search.context.runs;
  const State start = begin(search.context);
  const Explanation slower = start.explanation.with({.hypothesis = index_of(start, "lever_arm_error", "y"), .value = 0.01});
  const std::size_t made = runs.made();
  const std::weak_ptr<const ExplainedRun> first = runs.about(slower, start.run);
  EXPECT_EQ(runs.about(slower, start.run), first.lock());
  EXPECT_EQ(runs.made(), made + 1);
  // About another run it is another one.
  EXPECT_NE(runs.about(slower, first.lock()), first.lock());
  for (int i = 0; i < 8; ++i)
    static_cast<void>(runs.about(start.explanation.with({.hypothesis = 0, .value = 1e-3 * (i + 1)}), start.run));
  EXPECT_TRUE(first.expired());
}

// One about which the filter breaks down is missing, and the others are as if they were made alone.
TEST(Runs, SeveralAtATimeAreThoseMadeOneByOne) {
  const MissionInput input = test::honest_mission(1, 220.0);
  Searching search(input), alone(input);
  const State start = begin(search.context), other_start = begin(alone.context);
  const auto shifted = [](const State& state, double size) {
    return state.explanation.with({.hypothesis = index_of(state, "lever_arm_error", "y"), .value = size});
  };
  const double broken = std::numeric_limits<double>::quiet_NaN();
  const std::vector<RunPtr> runs = search.context.runs.try_all(
      {{shifted(start, 0.02), start.run}, {shifted(start, broken), start.run}, {shifted(start, 0.05), start.run}});
  ASSERT_EQ(runs.size(), 3U);
  ASSERT_TRUE(runs[0] && runs[2]);
  EXPECT_FALSE(runs[1]);
  for (const auto& [run, size] : {std::pair(runs[0], 0.02), std::pair(runs[2], 0.05)})
    EXPECT_EQ(run->log_likelihood(), alone.context.runs.about(shifted(other_start, size), other_start.run)->log_likelihood());
  const std::size_t made = search.context.runs.made();
  EXPECT_EQ(search.context.runs.try_all({{shifted(start, 0.05), start.run}}).front(), runs[2]);
  EXPECT_EQ(search.context.runs.made(), made);
}

// A rate that is mostly noise is better made smaller, which is no scale factor.
TEST(ExplainedRun, GainsNothingByASmallerNoise) {
  Searching search(test::honest_mission(1, 220.0));
  const State start = begin(search.context);
  EXPECT_EQ(start.run->log_likelihood(), start.run->mission().log_likelihood());
  constexpr double kScale = 0.01;
  const Explanation explanation = start.explanation.with({.hypothesis = index_of(start, "lever_arm_error", "y"), .value = 0.01})
                                      .with({.hypothesis = index_of(start, "gyro_scale_factor", "y"), .value = kScale});
  const RunPtr run = search.context.runs.about(explanation, start.run);
  const Eigen::VectorXd gain = run->sizes().own_noise;
  EXPECT_EQ(gain(0), 0.0);
  EXPECT_GT(gain(1), 0.0);
  EXPECT_EQ(run->log_likelihood(), run->mission().log_likelihood() - kScale * gain(1));
}

// Its prior is about what is stated, its linearisation about what was found: no run looks for it again.
TEST(ExplainedRun, BeginsWithTheAntennaFoundBefore) {
  MissionInput input = test::honest_mission(1, 220.0);
  input.setup.time_offset_s = 0.05;
  input.setup.filter.auxiliary.time_offset_sd_s = 0.1;
  Searching search(input);
  const State start = begin(search.context);
  const double found = start.run->mission().mission().time_offset_s;
  EXPECT_LT(std::abs(found), 0.01);
  const Explanation later = start.explanation.with({.hypothesis = index_of(start, "gnss_time_offset", ""), .value = 0.02});
  const RunPtr run = search.context.runs.about(later, start.run);
  ASSERT_TRUE(run->input().setup.antenna_found.has_value());
  EXPECT_NEAR(run->input().setup.antenna_found->time_offset_s, found + 0.02, 1e-12);
  EXPECT_EQ(run->input().setup.time_offset_s, 0.07);
  EXPECT_LT(std::abs(run->mission().mission().time_offset_s), 0.01);
}

// The pass of the whole catalogue is the reference: the same sums in another order, so only rounding differs.
TEST(ExplainedRun, SizesAreThoseOfTheWholeCatalogue) {
  Searching search(test::honest_mission(1, 220.0));
  const State start = begin(search.context);
  const geo::GpsTime middle = start.run->mission().path().front().t + 110.0;
  Explanation explanation = start.explanation.with({.hypothesis = index_of(start, "lever_arm_error", "y"), .value = 0.03});
  explanation = explanation.with({.hypothesis = index_of(start, "gnss_wrong_fix", "e"), .from = middle, .value = 0.05});
  explanation = explanation.with({.hypothesis = index_of(start, "accel_scale_factor", "x"), .value = 1e-3});
  explanation.shared.push_back({.sensor = noise::Sensor::kAccel, .axis = 1, .value = 0.05, .stated = 0.02});
  const RunPtr run = search.context.runs.about(explanation, start.run);
  const Examination& all = run->scores();
  const std::vector<Eigen::Index> rows = rows_of(explanation.effects, run->hypotheses().size());
  const Eigen::MatrixXd information = all.information(rows, rows);
  const Eigen::VectorXd scores = all.score(rows);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double sigma = 1.0 / std::sqrt(information(i, i));
    EXPECT_NEAR(run->sizes().score(i) * sigma, scores(i) * sigma, 1e-7);
    for (Eigen::Index j = 0; j < 3; ++j)
      EXPECT_NEAR(run->sizes().information(i, j), information(i, j), 1e-9 * std::sqrt(information(i, i) * information(j, j)));
  }
  EXPECT_GT(information(0, 0), 0.0);
  // From the first half alone nothing is known of what begins in the second.
  const SizeEvidence first_half = run->sizes_where([&](geo::GpsTime t) { return t < middle; });
  EXPECT_EQ(first_half.information(1, 1), 0.0);
  EXPECT_GT(first_half.information(0, 0), 0.0);
  EXPECT_LT(first_half.information(0, 0), information(0, 0));
}

// Alignment behind a gap takes longer than filtering the mission.
TEST(Runs, KeepRestartsUnlessTheAntennaIsElsewhere) {
  MissionInput input = test::honest_mission(1, 220.0);
  const geo::GpsTime start_of_gap = input.imu.samples.front().t + 120.0;
  std::erase_if(input.imu.samples, [&](const record::ImuSample& s) { return s.t > start_of_gap && s.t < start_of_gap + 3.0; });
  Searching search(input);
  const State start = begin(search.context);
  const std::vector<estimate::Restart>& found = start.run->mission().mission().restarts;
  ASSERT_FALSE(found.empty());
  const auto with = [&](const char* name, const char* axis, double value) {
    return search.context.runs.about(start.explanation.with({.hypothesis = index_of(start, name, axis), .value = value}),
                                     start.run);
  };
  const RunPtr scaled = with("gyro_scale_factor", "z", 1e-3), moved = with("lever_arm_error", "y", 0.2);
  const auto& kept = scaled->mission().mission().restarts;
  const auto& anew = moved->mission().mission().restarts;
  ASSERT_EQ(kept.size(), found.size());
  ASSERT_FALSE(anew.empty());
  EXPECT_EQ(kept.back().nav.r_eb_e, found.back().nav.r_eb_e);
  EXPECT_NEAR((anew.back().nav.r_eb_e - found.back().nav.r_eb_e).norm(), 0.2, 0.05);
}

// What happened before is likelier to happen again, of a size like that.
TEST(Candidates, KnowWhatHappenedBefore) {
  MissionInput input = test::honest_mission(1, 220.0);
  const geo::GpsTime jump = input.gnss.fixes.front().t + 120.0;
  for (record::GnssFix& fix : input.gnss.fixes)
    if (fix.t > jump) fix.r_ea_e.z() += 0.2;
  Searching search(input);
  const State start = with_draws(begin(search.context), search.context);
  const auto evidence_after = [&](const std::vector<double>& sizes) {
    Look look(start, search.context);
    static_cast<void>(look.examination());
    State state = look.state();
    for (const double size : sizes) {
      state.account.findings.push_back({});
      state.account.findings.back().hypothesis = state.run->hypotheses()[index_of(state, "gnss_wrong_fix", "n")];
      state.account.findings.back().value = size;
    }
    return Candidates(state, search.context).likeliest().log_bayes;
  };
  const double first = evidence_after({});
  EXPECT_NEAR(evidence_after({0.5, -0.5}) - first, std::log(5.0), 1e-9);  // 0.5 m is the catalogue's size
  EXPECT_GT(evidence_after({0.2, -0.2}) - first, std::log(5.0) + 0.3);
  EXPECT_LT(evidence_after({20.0, -20.0}), first);
}

// A signal that explains as much as the noise does is told beside it, and that a sensor hardly has so much of it.
TEST(Told, NoiseHidesNoImplausibleEffect) {
  Searching search(test::honest_mission(1, 220.0));
  State state = begin(search.context);
  const Eigen::Index scale = index_of(state, "accel_scale_factor", "x");
  const Hypothesis& h = state.run->hypotheses()[scale];
  const auto of_size = [&](double estimate, double ratio) {
    return Suspicion{.hypothesis = scale,
                     .from = {},
                     .estimate = estimate,
                     .sd = estimate / std::sqrt(ratio),
                     .likelihood_ratio = ratio,
                     .log_bayes = 0.5 * ratio - 8.0};
  };
  const auto& noise = noise_catalogue();
  const FittedEffect fit{.noise = {.effect = &noise.front(), .axis = 0, .root = 1e-3}, .log_sd = 0.1, .gain = 60.0};
  state.seen.suspicions.implausible = {of_size(100.0 * h.plausible, 130.0)};
  const NoiseFinding told = noise_finding_of({fit}, 1e-6, state);
  ASSERT_EQ(told.alternatives.size(), 1U);
  EXPECT_EQ(told.alternatives[0].name, "accel_scale_factor");
  EXPECT_TRUE(told.alternatives[0].implausible);
  EXPECT_GE(told.alternatives[0].log_odds, -5.0);  // by the data: 60 against 65; the prices of both
  EXPECT_LT(told.alternatives[0].log_odds, 0.0);
  state.seen.suspicions.implausible = {of_size(100.0 * h.plausible, 60.0)};
  EXPECT_TRUE(noise_finding_of({fit}, 1e-6, state).alternatives.empty());
  state.seen.suspicions.implausible.clear();
  state.seen.suspicions.all = {of_size(2.0 * h.plausible, 130.0)};
  ASSERT_EQ(noise_finding_of({fit}, 1e-6, state).alternatives.size(), 1U);
  EXPECT_FALSE(noise_finding_of({fit}, 1e-6, state).alternatives[0].implausible);
}

// What is likelier by less than a proposal asks for leaves no trace.
TEST(Proposal, InVainLeavesTheRunThatStands) {
  Searching search(test::honest_mission(1, 220.0));
  const State start = begin(search.context);
  Proposal proposal{
      .explanation = start.explanation.with({.hypothesis = index_of(start, "lever_arm_error", "y"), .value = 0.3}),
      .about = start.run,
      .before = start.run->log_likelihood(),
      .least_gain = 0.0};
  EXPECT_FALSE(accepted(proposal, start, search.context).has_value());
  proposal.least_gain = -1e6;
  double told = 0.0;
  proposal.accept = [&](State&, double gain) { told = gain; };
  const std::optional<State> next = accepted(proposal, start, search.context);
  ASSERT_TRUE(next.has_value());
  EXPECT_TRUE(next->explanation == proposal.explanation);
  EXPECT_LT(told, -10.0);
  EXPECT_DOUBLE_EQ(told, next->run->log_likelihood() - start.run->log_likelihood());
}

TEST(Proposal, IsNotAcceptedWhereWhatFollowsIsLessLikely) {
  Searching search(test::honest_mission(1, 220.0));
  const State start = begin(search.context);
  Proposal proposal{.explanation = start.explanation, .about = start.run};
  proposal.least_log_likelihood = start.run->log_likelihood() + 100.0;
  EXPECT_FALSE(accepted(proposal, start, search.context).has_value());
  proposal.least_log_likelihood = start.run->log_likelihood() - 100.0;
  EXPECT_TRUE(accepted(proposal, start, search.context).has_value());
}

// Turns that tell a wrong offset: it is tried once, in vain.
TEST(Search, AfterATimeOffsetInVainTheRunStands) {
  Searching search(test::honest_mission(1, 220.0), {.twins = 0, .time_offset_s = 0.5});
  const State start = begin(search.context);
  const Step next = step(start, search.context);
  EXPECT_FALSE(next.goes_on);
  EXPECT_EQ(next.state.run, start.run);
  EXPECT_TRUE(next.state.explanation == start.explanation);
  EXPECT_FALSE(next.state.limits.time_offset_s.has_value());
}

// Steps that are coarse beside the noise but as nothing to the mission: they are seen, and the run without noise for them
// stands.
TEST(Search, AfterAMarkInVainTheRunStands) {
  MissionInput input = test::honest_mission(1, 220.0);
  const double white_sd = axis_series(input, Site::kAccel, 1).white_sd;
  const double step = 0.55 * std::sqrt(12.0) * white_sd;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dv.y() = step * std::round(sample.dv.y() / sample.dt / step) * sample.dt;
  Searching search(input);
  const State start = begin(search.context);
  const State state = with_mended_samples(start, search.context);
  ASSERT_EQ(state.account.marks.size(), 1U);
  EXPECT_TRUE(state.account.converters.empty());
  EXPECT_EQ(state.run, start.run);
  EXPECT_EQ(state.explanation.imu, start.explanation.imu);
}

// What a saturated axis missed is mended with values that stand on no step.
TEST(Search, CoarseStepsOfASaturatedAxisAreSeen) {
  MissionInput input = test::honest_mission(11);
  constexpr double kStep = 0.02;
  double largest = 0.0;
  for (const record::ImuSample& sample : input.imu.samples)
    largest = std::max(largest, std::abs(sample.dtheta.z() / sample.dt));
  const double limit = kStep * std::round(0.7 * largest / kStep);
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.z() = std::clamp(kStep * std::round(sample.dtheta.z() / sample.dt / kStep), -limit, limit) * sample.dt;
  Searching search(input);
  const State state = with_mended_samples(begin(search.context), search.context);
  std::vector<std::string> marks;
  for (const Mark& mark : state.account.marks) marks.emplace_back(mark.effect->name);
  EXPECT_EQ(marks, (std::vector<std::string>{"saturation", "quantisation"}));
}

Finding finding_of_a(const Effect& effect, Eigen::Index axis) {
  Finding finding;
  finding.hypothesis = {&effect, axis, effect.plausible[2]};
  finding.price = 3.0;
  finding.sd = 1.0;
  return finding;
}

// Sine and cosine are one choice, of one place in the spectrum.
TEST(Evidence, ALineIsChargedOnce) {
  Searching search(test::honest_mission(1, 220.0));
  State none = begin(search.context);
  const EffectPtr line = harmonic_disturbance(Site::kGyro, 0, 0.1, 0.0);
  State both = none;
  both.account.findings = {finding_of_a(*line, 0), finding_of_a(*line, 1)};
  EXPECT_EQ(selected_together(both.account, 0), 2U);
  EXPECT_NEAR(evidence_of(none) - evidence_of(both), log_choices(none) + 3.0, 1e-9);
}

// Two coefficients as well, and each by itself.
TEST(State, WhatHasTwoAxesIsNotALine) {
  Searching search(test::honest_mission(1, 220.0));
  State state = begin(search.context);
  const Eigen::Index phase_centre = index_of(state, "antenna_phase_center_heading_dependent", "cos");
  state.explanation.effects = {{.hypothesis = phase_centre, .value = 1e-6}};
  state.account.findings = {finding_of_a(*state.run->hypotheses()[phase_centre].effect, 0)};
  EXPECT_FALSE(is_of_a_line(state.account.findings.front()));
  const State left = without_insignificant(state, search.context);
  EXPECT_TRUE(left.explanation.effects.empty());
  EXPECT_TRUE(left.account.findings.empty());
  EXPECT_TRUE(left.excluded.excludes(phase_centre));
}

// What is estimated beside another is known less well, and has to be larger to be found.
TEST(Detectable, SizesAreThoseBesideWhatWasFound) {
  Searching search(test::honest_mission(1, 220.0));
  const State none = begin(search.context);
  const Eigen::Index arm = index_of(none, "lever_arm_error", "y");
  const State one =
      with_run(none, search.context.runs.about(none.explanation.with({.hypothesis = arm, .value = 1e-4}), none.run));
  Diagnosis before, after;
  tell_what_was_not_found(none, 10.0, before);
  tell_what_was_not_found(one, 10.0, after);
  ASSERT_EQ(after.detectable_not_found.size() + 1, before.detectable_not_found.size());
  double largest = 0.0;
  for (const Detectable& d : after.detectable_not_found) {
    const auto same = std::ranges::find_if(before.detectable_not_found, [&](const Detectable& b) {
      return b.hypothesis.effect == d.hypothesis.effect && b.hypothesis.axis == d.hypothesis.axis;
    });
    ASSERT_NE(same, before.detectable_not_found.end());
    EXPECT_GT(d.minimal, 0.98 * same->minimal) << d.hypothesis.effect->name << d.hypothesis.axis_name();
    largest = std::max(largest, d.minimal / same->minimal);
  }
  EXPECT_GT(largest, 1.05);
}

TEST(HeldOut, SineAndCosineAreOne) {
  MissionInput input = test::honest_mission(9, 240.0);
  for (record::ImuSample& sample : input.imu.samples)
    sample.dv.y() += 0.05 * std::sin(2.0 * geo::kPi * 0.11 * (sample.t - input.imu.samples.front().t) + 0.7) * sample.dt;
  Searching search(input);
  State state = begin(search.context);
  const EffectPtr line = harmonic_disturbance(Site::kAccel, 1, 0.11, 0.0);
  Explanation explanation = state.explanation;
  explanation.suggested = {line};
  for (Eigen::Index i = 0; i < 2; ++i) explanation.effects.push_back({.hypothesis = state.run->hypotheses().size() + i});
  state = with_run(state, search.context.runs.about(explanation, state.run));
  state = with_run(state, search.context.runs.about(followed(*state.run), state.run));
  state.account.findings = {finding_of_a(*line, 0), finding_of_a(*line, 1)};
  const Verification verification = verify(state, search.context);
  ASSERT_EQ(verification.effects.size(), 1U);
  EXPECT_EQ(verification.effects.front().count, 2U);
  EXPECT_NEAR(verification.effects.front().gain, verification.all.gain, 1e-6);  // there is no other
  EXPECT_EQ(verification.worst(), nullptr);
  const State without = given_up(state, 0, search.context);
  EXPECT_TRUE(without.explanation.effects.empty());
  EXPECT_TRUE(without.excluded.excludes(*line));
}

// What one axis has no more leaves the states of the axes behind it.
TEST(SensorStates, KeepTheLaterAxesWhereAProcessIsGone) {
  MissionInput plain = test::honest_mission(1, 220.0);
  MissionInput more = plain;
  append({noise::make_gauss_markov({.name = "gauss_markov", .sigma = 1e-3, .beta = 0.1, .unit = "rad/s"})},
         noise::Sensor::kGyro, 0, more);
  const estimate::StateLayout from = layout_of(more), to = layout_of(plain);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(from.sensor_end(), 1.0, static_cast<double>(from.sensor_end()));
  const Eigen::VectorXd states = sensor_states_in(to, from, x);
  ASSERT_EQ(states.size(), to.sensor_end());
  EXPECT_TRUE((states.array() > 0.0).all());
  const Eigen::VectorXd back = sensor_states_in(from, to, states);
  EXPECT_EQ((back.array() == 0.0).count(), from.sensor_end() - to.sensor_end());
  EXPECT_TRUE(((back - x).array() == 0.0 || back.array() == 0.0).all());
}

// A wandering bias explains a ramp nearly as well as a ramp does, and comes first; the other order goes on without it.
TEST(Search, TellsWhereTheOrdersPart) {
  MissionInput input = test::honest_mission(12);
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.y() += 3e-6 * (sample.t - input.imu.samples.front().t) * sample.dt;
  input.setup.lever_arm_b.x() += 0.1;
  Searching search(input);
  std::optional<State> told;
  search.context.orders_part = [&](const State& state) { told = state; };
  const auto has_noise = [](const State& state) { return state.account.noise || !state.explanation.random.empty(); };
  State standing = with_draws(begin(search.context), search.context);
  Step next{standing, true};
  while (next.goes_on && !told) {
    standing = std::exchange(next.state, {});
    next = step(standing, search.context);
  }
  ASSERT_TRUE(told);
  EXPECT_EQ(told->run, standing.run);
  EXPECT_TRUE(has_noise(next.state));
  told->limits.order = Order::kMeansFirst;
  const Step other = step(*told, search.context);
  EXPECT_FALSE(has_noise(other.state));
  EXPECT_EQ(other.state.account.findings.size(), told->account.findings.size() + 1);
}

}  // namespace
}  // namespace coast
