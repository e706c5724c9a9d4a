// Aiding sensors through the jobs: simulated into files, read by a run file, used by the solution, told in the results.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "coast/io/writers.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/process.hpp"
#include "coast/jobs/simulate.hpp"
#include "process/summary.hpp"
#include "support/short_drive.hpp"
#include "support/support.hpp"

namespace coast::jobs {
namespace {

/// The short drive with aids, simulated into a folder.
class SimulatedAids : public testing::Test {
 protected:
  SimulatedAids() {
    io::write_text(folder_.path() / "model.yaml", test::kTestModel);
    io::write_text(folder_.path() / "scenario.yaml",
                   std::string(test::kShortDrive) +
                       "aids:\n"
                       "  - {kind: odometer, rate_hz: 20, sd_mps: 0.03, scale: 1.02, delay_s: 0.1, point_m: [-1.2, 0, 0.5]}\n"
                       "  - {kind: odometer, rate_hz: 20, metres_per_pulse: 0.04, point_m: [-1.2, 0, 0.5]}\n"
                       "  - {kind: heading, rate_hz: 2, sd_deg: 0.3, baseline_m: [0, 1, 0], offset_deg: 1.5}\n"
                       "  - {kind: height, rate_hz: 5, sd_m: 0.2, offset_m: -30}\n");
    const SimulationConfig config = read_simulate(folder_.path() / "scenario.yaml");
    write(config, simulate(config, {}), folder_.path());
  }
  [[nodiscard]] RunConfig run_with(const std::string& more) const {
    std::ifstream file(folder_.path() / "run.yaml");
    const std::string run{std::istreambuf_iterator<char>(file), {}};
    io::write_text(folder_.path() / "more.yaml", run + more);
    return read_run_config(folder_.path() / "more.yaml");
  }
  [[nodiscard]] static double state_at_end(const ProcessResult& result, const std::string& name) {
    const auto track = std::ranges::find(result.states, name, &StateTrack::name);
    return track == result.states.end() ? std::nan("") : track->smoothed.back();
  }

  test::TemporaryDirectory folder_;
};

TEST_F(SimulatedAids, AreUsedAndTheirErrorsFound) {
  const RunConfig run = run_with("vehicle: car\n");
  ASSERT_EQ(run.aids.size(), 4U);
  EXPECT_EQ(run.aids[1].name, "odometer_2");
  const ProcessResult result = process(run, load(run, Progress{}), TrajectorySinks{}, Progress{});
  ASSERT_EQ(result.aids.size(), 4U);
  for (const AidUse& aid : result.aids) {
    EXPECT_GT(aid.used, 150U) << aid.name;
    EXPECT_LT(aid.refused, aid.used / 50) << aid.name;
  }
  EXPECT_EQ(std::ranges::count(result.events, "odometer_found", &record::Event::kind), 2);
  EXPECT_EQ(std::ranges::count(result.events, "height_zero_found", &record::Event::kind), 1);
  // Four hundred headings of 0.3 deg determine the offset to 0.015 deg, and the filter's own heading is as good.
  EXPECT_NEAR(state_at_end(result, "heading_offset") * 180.0 / M_PI, 1.5, 0.15);
  EXPECT_TRUE(
      std::ranges::any_of(result.innovations, [](const auto& r) { return r.kind == estimate::UpdateKind::kHeadingHold; }));
  const std::string summary = summary_json(result);
  EXPECT_NE(summary.find("\"odometer_2\""), std::string::npos);
  EXPECT_NE(innovations_csv(result).find(",odometer_2,1,"), std::string::npos);
  EXPECT_EQ(result.verdict.standing(), Standing::kGood) << result.verdict.line();
}

TEST_F(SimulatedAids, OneThatContradictsTheOthersMakesTheResultDoubtful) {
  RunConfig run = run_with("");
  const config::Node wrong =
      io::parse_yaml("{point_m: [-1.2, 0, 0.5], scale: 1.4, delay_s: 0.1}", (folder_.path() / "wrong.yaml").string());
  run.aids.resize(1);
  run.aids.front().aid = estimate::aid_kinds().front().from(wrong);
  const ProcessResult result = process(run, load(run, Progress{}), TrajectorySinks{}, Progress{});
  EXPECT_EQ(result.verdict.standing(), Standing::kDoubtful);
  EXPECT_NE(result.verdict.line().find("samples of the odometer contradict the filter"), std::string::npos)
      << result.verdict.line();
  EXPECT_LT(result.reference->summary(*result.reference->smoothed).position.rms.norm(), 0.02);  // it does no harm
}

TEST_F(SimulatedAids, BridgeAnOutageInEverySmoother) {
  const std::string outage = "outages: [{start_s: 208920, duration_s: 60}]\nvehicle: car\nsmoother: ";
  for (const char* smoother : {"rts", "batch", "combined"}) {
    RunConfig aided = run_with(outage + smoother + "\n");
    const ProcessResult with = process(aided, load(aided, Progress{}), TrajectorySinks{}, Progress{});
    RunConfig plain = aided;
    plain.aids.clear();
    const ProcessResult without = process(plain, load(plain, Progress{}), TrajectorySinks{}, Progress{});
    EXPECT_LT(with.outages[0].smoothed->horizontal_max_m, 0.25) << smoother;
    EXPECT_LT(with.outages[0].forward.horizontal_max_m, 0.5 * without.outages[0].forward.horizontal_max_m) << smoother;
  }
}

TEST_F(SimulatedAids, WhatIsWrongInTheRunFileIsNamed) {
  const auto refusal = [this](const std::string& aids) {
    std::ifstream file(folder_.path() / "run.yaml");
    std::string run{std::istreambuf_iterator<char>(file), {}};
    run.erase(run.find("aids:"));
    io::write_text(folder_.path() / "wrong.yaml", run + aids);
    try {
      const RunConfig config = read_run_config(folder_.path() / "wrong.yaml");
      static_cast<void>(process(config, load(config, Progress{}), TrajectorySinks{}, Progress{}));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("not refused");
  };
  EXPECT_NE(refusal("aids: [{kind: odometr, file: odometer_1.csv}]\n").find("odometer"), std::string::npos);
  EXPECT_NE(refusal("aids: [{kind: odometer, file: odometer_1.csv, unit: kmh}]\n").find("km/h"), std::string::npos);
  EXPECT_NE(refusal("aids: [{kind: odometer, file: odometer_1.csv, sigma: 3}]\n").find("sigma"), std::string::npos);
  EXPECT_NE(refusal("aids: [{kind: odometer, file: none.csv}]\n").find("none.csv"), std::string::npos);
  EXPECT_NE(refusal("aids: [{kind: baseline, file: odometer_1.csv}]\n").find("baseline_m"), std::string::npos);
  io::write_text(folder_.path() / "high.csv", "gps_week,sow_s,height_m\n2374,208850,1500\n");
  EXPECT_NE(refusal("aids: [{kind: height, file: high.csv, unit: hPa}]\n").find("1500 hPa"), std::string::npos);
  // Samples of another day.
  io::write_text(folder_.path() / "later.csv", "gps_week,sow_s,speed_mps\n2374,300000,5\n2374,300001,5\n");
  EXPECT_NE(refusal("aids: [{kind: odometer, file: later.csv}]\n").find("no sample of the odometer"), std::string::npos);
}

}  // namespace
}  // namespace coast::jobs
