// Units of a campaign, what of them is merged, and statistics over them.

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "campaign/statistics.hpp"
#include "campaign/units.hpp"
#include "coast/io/writers.hpp"
#include "support/short_drive.hpp"
#include "support/support.hpp"

namespace coast::jobs {
namespace {

namespace fs = std::filesystem;

/// A plan with two scenarios, three seeds and two error models.
fs::path plan_in(const fs::path& folder, const std::string& more = "") {
  io::write_text(folder / "model.yaml", test::kTestModel);
  io::write_text(folder / "scenario.yaml", test::kShortDrive);
  io::write_text(folder / "plan.yaml",
                 "schema: coast.campaign/1\nscenarios: [{name: a, file: scenario.yaml}, {name: b, file: scenario.yaml}]\n"
                 "seeds: {first: 4, count: 3}\n"
                 "error_models: [{name: one, file: model.yaml}, {name: two, file: model.yaml}]\n" +
                     more);
  return folder / "plan.yaml";
}

TEST(Campaign, UnitsAreGroupByGroupAndEachCombinationStandsOnce) {
  const test::TemporaryDirectory folder;
  const CampaignConfig config = read_campaign(plan_in(folder.path(), "outages: [{name: none}, {name: x, list: []}]\n"));
  const Campaign campaign(config, folder.path() / "out");
  ASSERT_EQ(campaign.size(), 24U);
  ASSERT_EQ(campaign.groups(), 8U);
  std::set<std::array<std::size_t, 3>> seen;
  std::size_t unit = 0;
  for (std::size_t g = 0; g < campaign.groups(); ++g) {
    const CampaignGroup group = campaign.group(g);
    ASSERT_EQ(group.first, unit);
    for (std::size_t i = 0; i < group.count; ++i, ++unit) {
      const CampaignUnit its = campaign.unit(unit);
      EXPECT_EQ(its.kind, group.kind);
      EXPECT_EQ(its.error_model, group.error_model);
      EXPECT_EQ(its.outages, group.outages);
      EXPECT_EQ(campaign.mission(its).name, (group.kind == 0 ? "a/" : "b/") + std::to_string(4 + i));
      seen.insert({its.mission, its.error_model, its.outages});
    }
  }
  EXPECT_EQ(seen.size(), 24U);
}

TEST(Campaign, KeysFollowContentsAndNothingElse) {
  const test::TemporaryDirectory here, there;
  const CampaignConfig one = read_campaign(plan_in(here.path()));
  const CampaignConfig two = read_campaign(plan_in(there.path()));
  Campaign a(one, here.path() / "out"), b(two, there.path() / "elsewhere");
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a.key(a.unit(i)), b.key(b.unit(i)));
  EXPECT_EQ(a.key(a.unit(0)), a.key(a.unit(3)));  // the same model under another name
  EXPECT_NE(a.key(a.unit(0)), a.key(a.unit(1)));  // another seed
  std::string noisier = test::kTestModel;
  noisier.replace(noisier.find("0.1"), 3, "0.2");
  io::write_text(there.path() / "model.yaml", noisier);
  Campaign changed(two, there.path() / "elsewhere");
  EXPECT_NE(a.key(a.unit(0)), changed.key(changed.unit(0)));
}

TEST(Campaign, MessagesNameNoFolderOfThisMachine) {
  const test::TemporaryDirectory folder;
  const CampaignConfig config = read_campaign(plan_in(folder.path()));
  const Campaign campaign(config, folder.path() / "out");
  const std::string here = folder.path().string(), above = folder.path().parent_path().string();
  EXPECT_EQ(campaign.portable(here + "/rec/imu.csv:3: no", {}), "rec/imu.csv:3: no");
  EXPECT_EQ(campaign.portable("see '" + above + "/other/gnss.pos'", {}), "see '../other/gnss.pos'");
  EXPECT_EQ(campaign.portable(here + "/out/x/recording/imu.csv", folder.path() / "out" / "x"), "recording/imu.csv");
}

TEST(Campaign, ResultsReadBackToTheLastDigit) {
  UnitResult result;
  result.row["nis_mean"] = 0.1 + 0.2;
  result.outages = {"1,2,3"};
  result.estimates = {{"gyro_bias", "x", 1.0 / 3.0, 1e-300, "rad/s"}};
  result.imu = "a \"quoted\" name";
  const auto back = result_from(result_json(result, {1.5, 2e6}));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->row["nis_mean"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(back->estimates[0].value, 1.0 / 3.0);
  EXPECT_EQ(back->estimates[0].sigma, 1e-300);
  EXPECT_EQ(back->imu, result.imu);
  EXPECT_EQ(cost_from(result_json(result, {1.5, 2e6}))->seconds, 1.5);
  const std::string whole = result_json(result, {});
  for (std::size_t length = 0; length + 2 < whole.size(); length += 7) EXPECT_FALSE(result_from(whole.substr(0, length)));
  EXPECT_FALSE(result_from("{\"schema\": \"coast.campaign_unit/1\", \"row\": 3, \"outages\": 4}"));
}

TEST(Campaign, SumsOverOutagesAreThoseOfAStudy) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> error;
  std::vector<study::OutageResult> outages(57);
  DriftSums forward;
  GroupStatistics group;
  UnitResult unit;
  for (study::OutageResult& outage : outages) {
    outage.outage.duration_s = 20.0;
    for (Eigen::Vector3d* v :
         {&outage.forward.max_m, &outage.forward.end_m, &outage.forward.sigma_end_m, &outage.forward.sigma_max_m})
      for (double& value : *v) value = error(random) * (random() % 2 == 0 && v == &outage.forward.end_m ? -1.0 : 1.0);
    outage.forward.horizontal_max_m = error(random);
    outage.forward.tested = 600;
    outage.forward.inside_95 = 500 + random() % 100;
    outage.smoothed = outage.forward;
    unit.outages.push_back(outage_line(300.0, outage));
    forward.add(outage.forward);
  }
  group.add(unit);
  const study::Drift expected = study::drift_of(outages, false);
  for (const study::Drift& drift :
       {forward.drift(), group.durations.at(20.0).forward.drift(), group.durations.at(20.0).smoothed.drift()}) {
    EXPECT_EQ(drift.horizontal.median, expected.horizontal.median);
    EXPECT_EQ(drift.horizontal.rms, expected.horizontal.rms);
    EXPECT_EQ(drift.end[2].p95, expected.end[2].p95);
    EXPECT_EQ(drift.largest[0].max, expected.largest[0].max);
    EXPECT_EQ(drift.inside_95, expected.inside_95);
    EXPECT_FALSE(drift.against_gnss);
    // Sums of squares in another order of divisions: some rounding of 57 terms.
    EXPECT_NEAR(drift.predicted_end_rms_m.x(), expected.predicted_end_rms_m.x(), 1e-14 * expected.predicted_end_rms_m.x());
    EXPECT_NEAR(drift.predicted_largest_rms_m.z(), expected.predicted_largest_rms_m.z(),
                1e-14 * expected.predicted_largest_rms_m.z());
  }
}

struct SpoiledPlan {
  const char* text;
  const char* message;
};
class SpoiledPlans : public testing::TestWithParam<SpoiledPlan> {};

TEST_P(SpoiledPlans, AreRefusedWithTheirLine) {
  const test::TemporaryDirectory folder;
  io::write_text(folder.path() / "plan.yaml", GetParam().text);
  try {
    static_cast<void>(read_campaign(folder.path() / "plan.yaml"));
    FAIL() << GetParam().text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("plan.yaml:"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Campaign, SpoiledPlans,
    testing::Values(SpoiledPlan{"job: process\n", "no mission"}, SpoiledPlan{"missions: nowhere/*/run.yaml\n", "no run file"},
                    SpoiledPlan{"missions: run.yaml\njob: compare\n", "process"},
                    SpoiledPlan{"missions: run.yaml\nmodels: []\n", "unknown key"},
                    SpoiledPlan{"missions: run.yaml\nkeep: [imu.csv]\n", "trajectory.csv"},
                    SpoiledPlan{"missions: run.yaml\nshards: 0\n", "at least 1"},
                    SpoiledPlan{"missions: run.yaml\noutages: []\n", "at least one"},
                    SpoiledPlan{"missions: run.yaml\noutages: [{name: a}, {name: a}]\n", "second time"},
                    SpoiledPlan{"missions: run.yaml\njob: outage\noutages: [{name: a}]\n", "no outages"},
                    SpoiledPlan{"scenarios: [{name: a, file: s.yaml}]\n", "seeds"},
                    SpoiledPlan{"scenarios: [{name: a, file: s.yaml}]\nseeds: {first: -1, count: 2}\n", "at least 0"}),
    [](const testing::TestParamInfo<SpoiledPlan>& spoiled) { return "n" + std::to_string(spoiled.index); });

TEST(Campaign, ShardsAreANumberOfAnother) {
  EXPECT_EQ(shard_from("3/40").index, 3U);
  EXPECT_EQ(shard_from("3/40").count, 40U);
  for (const char* wrong : {"", "3", "0/4", "5/4", "a/4", "1/", "-1/4", "1/4/2"})
    EXPECT_THROW(static_cast<void>(shard_from(wrong)), InputError) << wrong;
}

}  // namespace
}  // namespace coast::jobs
