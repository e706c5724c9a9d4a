// Scores of hypotheses, and statistics of the largest of many.

#include "coast/diagnose/examination.hpp"

#include <gtest/gtest.h>

#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/study/solution.hpp"
#include "diagnose/concealed.hpp"

namespace coast {
namespace {

using namespace diagnose;

/// A mission filtered and smoothed, and what it says of the catalogue.
class Examined {
 public:
  explicit Examined(const MissionInput& input)
      : input_(input),
        mission_(input.imu, input.gnss, input.setup, {}),
        hypotheses_(mission_.mission(), Grade::kIndustrial, path_, {}) {
    study::SolutionOutputs outputs;
    outputs.smoothed = [this](const record::TrajectoryEpoch& epoch) { path_.push_back(epoch.nav); };
    solution_ = study::solve(mission_, mission_.options(), true, outputs, {});
    input_.setup.start = mission_.start();
  }
  [[nodiscard]] const Hypotheses& hypotheses() const { return hypotheses_; }
  [[nodiscard]] Eigen::Index find(std::string_view name, Eigen::Index axis) const {
    const auto at =
        std::ranges::find_if(hypotheses_.all(), [&](const Hypothesis& h) { return h.effect->name == name && h.axis == axis; });
    return at - hypotheses_.all().begin();
  }
  [[nodiscard]] Examination examine(Eigen::Index draws) const {
    return diagnose::examine(mission_.mission(), solution_.filter->layout(), solution_.knots, hypotheses_, {.draws = draws});
  }
  /// Of a filter that knows of the effect, from the same start.
  [[nodiscard]] double log_likelihood(Eigen::Index hypothesis, double value) const {
    const Taken taken{.hypothesis = hypothesis, .from = {}, .to = {}, .value = value};
    MissionInput with = without({taken}, input_, hypotheses_, path_, mission_.mission(), solution_.filter->layout());
    const study::PreparedMission mission(std::move(with.imu), std::move(with.gnss), std::move(with.setup), {});
    const estimate::ForwardFilter filter(mission.mission(), mission.model(), mission.options());
    return filter.run(mission.start_state(filter), {}).log_likelihood;
  }

 private:
  MissionInput input_;
  study::PreparedMission mission_;
  std::vector<record::NavState> path_;
  study::Solution solution_;
  Hypotheses hypotheses_;
};

/// An IMU that is believed to be much noisier than it is, and fixes whose errors last: the filter's velocity follows every fix.
MissionInput mission_led_by_fixes() {
  MissionInput input = test::honest_mission(11);
  for (record::GnssFix& fix : input.gnss.fixes) fix.velocity.reset();
  estimate::NoiseAdjustment noise;
  noise.gnss_scale = {.horizontal = 0.1, .vertical = 0.1, .velocity = 1.0};
  noise.correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.04, .time_s = 5.0};
  noise.gyro_factor = 3.0;
  noise.accel_factor = 100.0;
  input.setup.model = estimate::adjusted(input.setup.model, noise);
  input.setup.filter = estimate::adjusted(input.setup.filter, noise);
  return input;
}

// Against the log-likelihood of runs with the effect and without it, half a standard deviation to either side. Columns along
// the filter's own velocity have the last innovations in them: a shift of tags would be told wrong by tens of standard
// deviations.
TEST(Examination, ScoresAreSlopesOfTheLogLikelihood) {
  const Examined examined(mission_led_by_fixes());
  const Examination e = examined.examine(0);
  for (const auto& [name, axis] : {std::pair{"imu_timestamp_gap", 0},
                                   {"imu_clock_drift", 0},
                                   {"lever_arm_error", 0},
                                   {"lever_arm_error", 1},
                                   {"accel_scale_factor", 1}}) {
    const Eigen::Index i = examined.find(name, axis);
    const double sd = 1.0 / std::sqrt(e.information(i, i));
    const double slope = examined.log_likelihood(i, 0.5 * sd) - examined.log_likelihood(i, -0.5 * sd);
    // The smoothed velocity has a little of the innovations in it too: 0.4 standard deviations here, where the filter's has 23.
    EXPECT_NEAR(e.score(i) * sd, slope, 0.5 + 0.03 * std::abs(slope)) << name << " " << axis;
  }
}

TEST(Examination, DrawsHoldWhereCovariancesDo) {
  const MissionInput input = test::honest_mission(12);
  const Examination drawn = Examined(input).examine(20);
  MissionInput other = input;
  other.setup.lever_arm_b.y() += 0.05;
  Examination same = Examined(other).examine(0);
  ASSERT_TRUE(same.take_draws_of(drawn));
  EXPECT_EQ(same.null_score, drawn.null_score);
  ASSERT_EQ(same.tracks.size(), drawn.tracks.size());
  EXPECT_EQ(same.tracks.front().null_largest, drawn.tracks.front().null_largest);
  EXPECT_EQ(same.disturbances.score[0].bottomRows(20), drawn.disturbances.score[0].bottomRows(20));
  EXPECT_NE(same.disturbances.score[0].row(0), drawn.disturbances.score[0].row(0));
  other.setup.model = estimate::adjusted(other.setup.model, {.gnss_scale = {}, .correlated_gnss = {}, .gyro_factor = 2.0});
  Examination noisier = Examined(other).examine(0);
  EXPECT_FALSE(noisier.take_draws_of(drawn));
  EXPECT_EQ(noisier.null_score.cols(), 0);
}

// The largest of n independent squares: 1 - (1 - p)^n, p from the table of chi-square(1): P(X > 3.841) = 0.05.
TEST(LargestByChance, IsThatOfIndependentSquares) {
  const LargestByChance one{1.0};
  EXPECT_NEAR(one.p_value(3.8415), 0.05, 1e-4);
  const LargestByChance ten{10.0};
  EXPECT_NEAR(ten.p_value(3.8415), 1.0 - std::pow(0.95, 10.0), 1e-4);
  EXPECT_NEAR(ten.p_value(ten.quantile(0.05)), 0.05, 1e-12);
  EXPECT_NEAR(LargestByChance{57.0}.quantile(0.05), noise::chi2_upper_quantile(1.0, 1.0 - std::pow(0.95, 1.0 / 57.0)), 1e-9);
}

// The integral of Cauchy prior times likelihood, by the trapezoid rule over the angle: c = plausible tan(angle). The tolerance
// is the mixture's, 40 normal priors.
TEST(LogBayesFactor, IsTheIntegralOverACauchyPrior) {
  for (const double plausible : {0.1, 1.0, 30.0})
    for (const double sigmas : {0.0, 2.0, 8.0, 40.0})
      for (const double information : {0.04, 1.0, 25.0}) {
        constexpr int kSteps = 1'000'000;
        const double score = sigmas * std::sqrt(information);
        const double largest = 0.5 * score * score / information;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
          const double c = plausible * std::tan(geo::kPi * ((i + 0.5) / kSteps - 0.5));
          sum += std::exp(score * c - 0.5 * information * c * c - largest);
        }
        EXPECT_NEAR(log_bayes_factor(score, information, plausible), largest + std::log(sum / kSteps), 0.05)
            << plausible << " " << score << " " << information;
      }
}

// Geodesy: noncentrality 17.07 at alpha = 0.1 % and power 80 % (Baarda 1968).
TEST(MinimalDetectable, IsBaardas) {
  EXPECT_NEAR(minimal_detectable(1.0, noise::chi2_upper_quantile(1.0, 0.001)), std::sqrt(17.07), 2e-3);
  EXPECT_NEAR(minimal_detectable(3.0, 10.8), 3.0 * minimal_detectable(1.0, 10.8), 1e-12);
}

}  // namespace
}  // namespace coast
