// The page of `coast process`, made of a small hand-made result: sections, ids, nothing empty, and the figures of the tiles.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include <cmath>
#include <set>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "coast/report/render.hpp"
#include "common/page_parts.hpp"
#include "process/page/curves.hpp"
#include "process/page/page.hpp"
#include "process/page/separation.hpp"

namespace coast::jobs {
namespace {

constexpr double kSpan = 100.0;  // s
const geo::GpsTime kStart = geo::GpsTime::from_week(2374, 243261.0);
const geo::Geodetic kOrigin{40.0 * geo::kDegree, -105.0 * geo::kDegree, 1600.0};

record::NavState nav_at(double t, const geo::Geodetic& place, const Eigen::Vector3d& v_n, const geo::Euler& euler) {
  const Eigen::Matrix3d C_n_e = geo::C_n_e(place);
  return {kStart + t, geo::ecef_from_geodetic(place), C_n_e * v_n,
          Eigen::Quaterniond(C_n_e) * geo::quaternion_from_euler(euler)};
}

/// Ten fixes at one place, the last three of them float.
std::vector<record::GnssFix> fixes() {
  std::vector<record::GnssFix> list;
  for (int i = 1; i <= 10; ++i) {
    record::GnssFix fix;
    fix.t = kStart + i;
    fix.r_ea_e = geo::ecef_from_geodetic(kOrigin);
    fix.position_cov_n = 1e-4 * Eigen::Matrix3d::Identity();
    fix.quality = i < 8 ? record::FixQuality::kFixed : record::FixQuality::kFloat;
    list.push_back(fix);
  }
  return list;
}

/// North at 10 m/s along the meridian, at constant height, with a heading 3 deg left of the course.
record::TrajectoryEpoch drive(double t) {
  const double radius = geo::radii_of_curvature(kOrigin.latitude).meridian + kOrigin.height;
  const geo::Geodetic here{kOrigin.latitude + 10.0 * t / radius, kOrigin.longitude, kOrigin.height};
  record::TrajectoryEpoch epoch;
  epoch.nav = nav_at(t, here, {10.0, 0.0, 0.0}, {0.0, 0.0, -3.0 * geo::kDegree});
  epoch.cov.position = 4e-4 * Eigen::Matrix3d::Identity();
  epoch.cov.velocity = 1e-4 * Eigen::Matrix3d::Identity();
  epoch.cov.attitude = 1e-6 * Eigen::Matrix3d::Identity();
  return epoch;
}

study::OutageErrors outage_errors(geo::GpsTime start, double duration, double size) {
  study::OutageErrors e;
  for (double t = -5.0; t <= duration + 5.0; t += 0.5) {
    study::ErrorSample s;
    s.t = start + t;
    s.position_n = Eigen::Vector3d::Constant(t > 0.0 && t < duration ? size * t : 0.0);
    s.sd_position = Eigen::Vector3d::Constant(size * duration);
    e.series.push_back(s);
  }
  e.max_m = e.rms_m = e.end_m = e.sigma_end_m = e.sigma_max_m = Eigen::Vector3d::Constant(size * duration);
  e.horizontal_max_m = size * duration;
  e.tested = 100;
  e.inside_95 = 95;
  e.gnss_horizontal_max_m = 1.1 * size * duration;
  return e;
}

study::OutageResult outage(double at, double duration, double size) {
  const geo::GpsTime start = kStart + at;
  return {{start, duration}, outage_errors(start, duration, 10.0 * size), outage_errors(start, duration, size)};
}

StateTrack track(const std::string& name, double value) {
  StateTrack t;
  t.name = name;
  for (int i = 0; i <= 20; ++i) {
    t.seconds.push_back(5.0 * i);
    t.forward.push_back(value);
    t.forward_sd.push_back(value / (1.0 + i));
    t.smoothed.push_back(value);
    t.smoothed_sd.push_back(0.05 * value);
  }
  return t;
}

void add_reference(ProcessResult& r) {
  AgainstReference reference{ReferenceErrors(kStart), ReferenceErrors(kStart), true, true};
  for (int i = 0; i <= 100; ++i) {
    study::ErrorSample s;
    s.t = kStart + i;
    s.position_n = {0.01, -0.02, 0.03};
    s.sd_position = Eigen::Vector3d::Constant(0.03);
    s.sd_attitude = Eigen::Vector3d::Constant(1e-3);
    reference.forward.add(s);
    reference.smoothed->add(s);
    r.separations.push_back(
        {kStart + i, {0.3, 0.4, -0.1}, {1e-4, 2e-4, 3e-4}, Eigen::Vector3d::Constant(0.2), Eigen::Vector3d::Constant(1e-4)});
  }
  r.reference = reference;
}

/// Everything that a run can find out.
ProcessResult full_result() {
  ProcessResult r;
  r.start = kStart;
  r.end = kStart + kSpan;
  r.imu_samples = 10000;
  r.imu_rate_hz = 100.0;
  r.gnss_epochs = 100;
  r.gnss_used = 99;
  r.gnss_rejected = 1;
  r.qualities = {{record::FixQuality::kFixed, 70}, {record::FixQuality::kFloat, 30}};
  r.inspection = {"IMU: 100 s at 100 Hz.", "GNSS: 100 fixes at 1 Hz."};
  r.alignment = "levelled over 10 s standing still";
  r.nis = {12.0, 3.0, 99};
  r.smallest_refusable_m = 0.3;
  for (int i = 1; i <= 100; ++i)
    for (const auto kind :
         {estimate::UpdateKind::kGnssPosition, estimate::UpdateKind::kGnssVelocity, estimate::UpdateKind::kNonHolonomic,
          estimate::UpdateKind::kZeroVelocity, estimate::UpdateKind::kHeadingHold, estimate::UpdateKind::kAid}) {
      estimate::InnovationRecord record;
      record.t = kStart + i;
      record.kind = kind;
      record.used = i != 50;
      record.nu = Eigen::Vector3d::Constant(0.02 * std::sin(1.7 * i));
      record.sd = Eigen::Vector3d::Constant(0.02);
      record.nis = 3.0;
      r.innovations.push_back(record);
    }
  r.aids = {{"odometer", 99, 1, {1.0, 1.0, 99}}};
  record::MarkedState event;
  event.mark.id = "image_1";
  event.nav = drive(50.0).nav;
  event.cov = drive(50.0).cov;
  r.marked = EventResults{{event}, {}, {}};
  add_reference(r);
  r.compared_with = "reference";
  r.outages = {outage(20.0, 10.0, 0.01)};
  for (int i = 0; i < 20; ++i) r.sweep.push_back(outage(4.0 * i, i % 2 == 0 ? 5.0 : 10.0, 0.01 + 0.001 * i));
  r.lever_arm = study::LeverArmCheck{{0.01, -0.02, 0.0}, {0.01, 0.01, 0.02}};
  estimate::NoiseFit fit;
  fit.adjustment.gyro_factors.x() = 38.0;
  fit.names = {"gnss_scale_horizontal", "gyro_factor_x"};
  fit.log_sd = {0.05, 0.1};
  r.noise_fit = fit;
  for (const std::string axis : {"x", "y", "z"}) {
    r.states.push_back(track("gyro_" + axis + " random_constant", 1e-4));
    r.states.push_back(track("gyro_" + axis + " gauss_markov", 1e-5));
    r.states.push_back(track("gyro_" + axis + " gauss_markov", 2e-5));
    r.states.push_back(track("gyro_" + axis + " misalignment", 1e-3));
    r.states.push_back(track("gyro_" + axis + " misalignment", 2e-3));
    r.states.push_back(track("accel_" + axis + " scale_factor", 5e-4));
  }
  for (const char* name : {"lever_arm_0", "lever_arm_1", "lever_arm_2", "gnss_time_offset", "vehicle_mounting_0",
                           "vehicle_mounting_1", "gnss_error_horizontal_0", "gnss_error_horizontal_1", "gnss_error_vertical"})
    r.states.push_back(track(name, 0.01));
  r.events = {{record::Event::Severity::kWarning, "imu_gap", "3 samples are missing", kStart, 1},
              {record::Event::Severity::kInfo, "repeated", "12 samples repeat the one before", std::nullopt, 12}};
  return r;
}

/// A result with what every run has: setup, fixes, curves.
class PageTest : public ::testing::Test {
 protected:
  PageTest() {
    used_.model = noise::ImuErrorModel::from(io::load_yaml(std::string(COAST_SOURCE_DIR) + "/configs/imu/adis16465.yaml"));
    for (double t = 0.0; t <= kSpan + 1e-9; t += 0.1) {
      curves_->add_forward(drive(t));
      curves_->add_smoothed(drive(t));
    }
    config_.file = "run.yaml";
  }
  [[nodiscard]] report::Page make(ProcessResult result) const {
    result.used = used_;
    result.fixes = fixes();
    result.curves = curves_;
    result.resolved = "imu:\n  file: imu.csv\n";
    return make_page({config_, result});
  }

  RunConfig config_;
  study::Setup used_;
  std::shared_ptr<TrajectoryCurves> curves_ =
      std::make_shared<TrajectoryCurves>(nav_at(0.0, kOrigin, Eigen::Vector3d::Zero(), {}));
};

std::vector<std::string> section_ids(const report::Page& page) {
  std::vector<std::string> ids;
  for (const report::Section& s : page.sections) ids.push_back(s.id);
  return ids;
}

const report::Section* section(const report::Page& page, const std::string& id) {
  for (const report::Section& s : page.sections)
    if (s.id == id) return &s;
  return nullptr;
}

const report::Table* table(const report::Page& page, const std::string& id) {
  for (const report::Section& s : page.sections)
    for (const report::Table& t : s.tables)
      if (t.id == id) return &t;
  return nullptr;
}

const report::Tile* tile(const report::Page& page, const std::string& label) {
  for (const report::Tile& t : page.tiles)
    if (t.label == label) return &t;
  return nullptr;
}

bool draws(const report::Plot& plot) {
  const auto full = [](const auto& list) {
    return std::ranges::any_of(list, [](const auto& item) { return !item.series.x.empty(); });
  };
  return full(plot.lines) || full(plot.points) ||
         std::ranges::any_of(plot.bars, [](const auto& b) { return !b.heights.empty(); });
}

/// Ids unique, links lead somewhere, nothing drawn is empty, rows as wide as their heads; and the page can be rendered.
void expect_sound(const report::Page& page) {
  std::set<std::string> ids;
  const auto add = [&](const std::string& id) {
    EXPECT_FALSE(id.empty());
    EXPECT_TRUE(ids.insert(id).second) << id << " twice";
  };
  for (const report::Section& s : page.sections) {
    add(s.id);
    EXPECT_FALSE(s.panels.empty() && s.tables.empty() && s.notes.empty()) << s.id;
    for (const report::Table& t : s.tables) {
      add(t.id);
      EXPECT_FALSE(t.rows.empty()) << t.id;
      for (const auto& row : t.rows) EXPECT_EQ(row.size(), t.columns.size()) << t.id;
    }
    for (const report::Panel& p : s.panels) {
      add(p.id);
      EXPECT_FALSE(p.plots.empty()) << p.id;
      EXPECT_FALSE(p.caption.empty()) << p.id;
      for (const report::Plot& plot : p.plots) EXPECT_TRUE(draws(plot)) << p.id << " " << plot.title;
    }
  }
  for (const report::Tile& t : page.tiles) EXPECT_TRUE(t.section.empty() || ids.contains(t.section)) << t.label;
  EXPECT_NO_THROW(static_cast<void>(report::render(page)));
}

TEST_F(PageTest, FullResultHasEverySectionInOrder) {
  const report::Page page = make(full_result());
  expect_sound(page);
  EXPECT_EQ(section_ids(page),
            (std::vector<std::string>{"input", "trajectory", "accuracy", "motion", "separation", "innovations", "sensors",
                                      "body", "outages", "reference", "processing"}));
  EXPECT_EQ(page.tiles.size(), 8U);
}

TEST_F(PageTest, WhatARunDidNotFindOutIsLeftOut) {
  ProcessResult bare;
  bare.start = kStart;
  bare.end = kStart + kSpan;
  const report::Page page = make(bare);
  expect_sound(page);
  EXPECT_EQ(section_ids(page),
            (std::vector<std::string>{"input", "trajectory", "accuracy", "motion", "sensors", "body", "processing"}));
  EXPECT_EQ(tile(page, "Lever-arm misclosure"), nullptr);
  EXPECT_EQ(tile(page, "Innovations over sigma"), nullptr);
}

TEST_F(PageTest, EveryOptionalPartMayBeAbsentAlone) {
  const std::vector<std::function<void(ProcessResult&)>> removals{
      [](ProcessResult& r) { r.reference.reset(); },
      [](ProcessResult& r) { r.reference->smoothed.reset(); },
      [](ProcessResult& r) { r.outages.clear(); },
      [](ProcessResult& r) { r.sweep.clear(); },
      [](ProcessResult& r) { r.lever_arm.reset(); },
      [](ProcessResult& r) { r.separations.clear(); },
      [](ProcessResult& r) { r.noise_fit.reset(); },
      [](ProcessResult& r) { r.states.clear(); },
      [](ProcessResult& r) { r.events.clear(); },
      [](ProcessResult& r) { r.innovations.clear(); },
      [](ProcessResult& r) { r.inspection.clear(); },
      [](ProcessResult& r) { r.qualities.clear(); },
      [](ProcessResult& r) { r.reference->has_velocity = r.reference->has_attitude = false; },
      [](ProcessResult& r) { std::erase_if(r.innovations, [](const auto& i) { return i.used; }); }};
  for (std::size_t i = 0; i < removals.size(); ++i) {
    SCOPED_TRACE(i);
    ProcessResult result = full_result();
    removals[i](result);
    expect_sound(make(result));
  }
}

TEST_F(PageTest, WithoutSmootherNothingIsCalledSmoothed) {
  config_.smooth = false;
  ProcessResult result = full_result();
  result.sweep.clear();
  result.reference->smoothed.reset();
  for (auto& o : result.outages) o.smoothed.reset();
  for (auto& s : result.states) {
    s.smoothed.clear();
    s.smoothed_sd.clear();
  }
  const report::Page page = make(result);
  expect_sound(page);
  for (const report::Section& s : page.sections)
    for (const report::Panel& p : s.panels)
      for (const report::Plot& plot : p.plots)
        for (const report::Line& line : plot.lines) EXPECT_EQ(line.label.find("smoothed"), std::string::npos) << p.id;
}

TEST_F(PageTest, TilesJudgeByTheirStatedThresholds) {
  ProcessResult result = full_result();
  // rms of innovations over sigma: sqrt(12/3) = 2, beyond 1.4
  EXPECT_EQ(tile(make(result), "Innovations over sigma")->value, "2.00");
  EXPECT_EQ(tile(make(result), "Innovations over sigma")->verdict, report::Verdict::kBad);
  result.nis.mean = 3.2;
  EXPECT_EQ(tile(make(result), "Innovations over sigma")->verdict, report::Verdict::kGood);

  const auto lever_arm = [&](const Eigen::Vector3d& difference, const Eigen::Vector3d& sd) {
    result.lever_arm = study::LeverArmCheck{difference, sd};
    return tile(make(result), "Lever-arm misclosure")->verdict;
  };
  EXPECT_EQ(lever_arm({0.01, 0.0, 0.0}, {0.01, 0.01, 0.01}), report::Verdict::kGood);
  EXPECT_EQ(lever_arm({0.04, 0.0, 0.0}, {0.01, 0.01, 0.01}), report::Verdict::kWarn);   // small, but 4 sigma
  EXPECT_EQ(lever_arm({0.06, 0.0, 0.0}, {0.03, 0.01, 0.01}), report::Verdict::kWarn);   // large, but 2 sigma
  EXPECT_EQ(lever_arm({0.00, 0.0, 0.06}, {0.01, 0.01, 0.01}), report::Verdict::kWarn);  // to be looked at, but no check failed
  result.events.push_back({record::Event::Severity::kWarning, "lever_arm_contradicted", "it is elsewhere", std::nullopt, 1});
  EXPECT_EQ(lever_arm({0.00, 0.0, 0.3}, {0.01, 0.01, 0.01}), report::Verdict::kBad);
  EXPECT_EQ(lever_arm({0.00, 0.0, 0.3}, {0.01, 0.01, 0.40}), report::Verdict::kGood);  // down is not known: not judged
  EXPECT_EQ(lever_arm({0.30, 0.3, 0.3}, {0.40, 0.40, 0.40}), report::Verdict::kNone);

  config_.setup.filter.auxiliary.lever_arm_sd_m = 0.3;  // an arm to be found is as far off as it was said it may be
  EXPECT_EQ(lever_arm({0.00, 0.0, 0.5}, {0.01, 0.01, 0.01}), report::Verdict::kGood);
  EXPECT_EQ(lever_arm({0.00, 0.0, 1.0}, {0.01, 0.01, 0.01}), report::Verdict::kWarn);

  EXPECT_EQ(tile(make(result), "Warnings")->value, "2");
  EXPECT_EQ(tile(make(result), "GNSS quality")->value, "70.0 / 30.0");
  EXPECT_EQ(tile(make(result), "GNSS quality")->verdict, report::Verdict::kWarn);
  // The worst of all outages is the last swept one: 10 s at 0.029 m/s.
  EXPECT_EQ(tile(make(result), "Worst outage")->value, "0.290");
  result.outages.clear();
  result.sweep.clear();
  EXPECT_EQ(tile(make(result), "Longest time without GNSS")->value, "2.00");  // the refused fix at 50 s leaves 49 to 51
}

TEST(Separation, SummaryLeavesOutWhatHasNotSettled) {
  std::vector<Separation> list;
  for (int i = 0; i < 100; ++i)
    list.push_back(
        {kStart + i, {0.3, -0.4, 0.1}, {1e-4, 2e-4, -3e-4}, Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(1e-4)});
  for (int i = 0; i < 10; ++i)  // the far end of one filter: large, and known to be
    list.push_back({kStart + 100 + i, Eigen::Vector3d::Constant(50.0), Eigen::Vector3d::Constant(0.5),
                    Eigen::Vector3d::Constant(20.0), Eigen::Vector3d::Constant(0.2)});
  const auto s = summarise(list);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->horizontal_rms_m, 0.5, 1e-12);
  EXPECT_NEAR(s->horizontal_95_m, 0.5, 1e-12);
  EXPECT_NEAR(s->vertical_rms_m, 0.1, 1e-12);
  EXPECT_NEAR(s->attitude_rms.z(), 3e-4, 1e-15);
  EXPECT_NEAR(s->settled, 100.0 / 110.0, 1e-12);
  EXPECT_NEAR(s->position_over_sigma, std::sqrt((9.0 + 16.0 + 1.0) / 3.0), 1e-9);
  EXPECT_NEAR(s->attitude_over_sigma, std::sqrt((1.0 + 4.0 + 9.0) / 3.0), 1e-9);
  EXPECT_FALSE(summarise({}));
}

TEST_F(PageTest, CurvesFollowTheEarthAndTheBody) {
  const TrajectoryCurves::Curves& c = curves_->curves();
  const double far = 10.0 * kSpan;
  // Constant height: D is 0 although the tangent plane of the start lies far^2 / 2R = 0.079 m above.
  const report::Series down = c.smoothed.position[2].finish();
  EXPECT_NEAR(down.y.back(), 0.0, 1e-4);  // of the frame renewed every 20 m: 20^2 / 2R = 3e-5 m
  EXPECT_NEAR(c.smoothed.position[0].finish().y.back(), far, 1e-3);
  EXPECT_NEAR(c.track.finish().y.back(), far, 1e-3);
  EXPECT_NEAR(c.distance.finish().y.back(), far, 1e-6);
  // Heading 3 deg left of the course: the body slides to its right.
  constexpr double kFrame = 1e-3;  // deg, m/s: 20 m on the Earth are 2e-4 deg
  EXPECT_NEAR(c.slip.finish().y.back(), 3.0, kFrame);
  EXPECT_NEAR(c.body_velocity[0].finish().y.back(), 10.0 * std::cos(3.0 * geo::kDegree), kFrame);
  EXPECT_NEAR(c.body_velocity[1].finish().y.back(), 10.0 * std::sin(3.0 * geo::kDegree), kFrame);
  EXPECT_NEAR(c.smoothed.sd_position[0].finish().y.back(), 0.02, 1e-12);
  EXPECT_NEAR(c.smoothed.sd_attitude[2].finish().y.back(), 1e-3 / geo::kDegree, 1e-9);
}

TEST(TrajectoryCurvesTest, YawIsUnwrappedFromOneStartForBothSolutions) {
  TrajectoryCurves curves(nav_at(0.0, kOrigin, Eigen::Vector3d::Zero(), {0.0, 0.0, 179.0 * geo::kDegree}));
  for (int i = 0; i <= 72; ++i) {  // two turns to the right, forward one degree ahead
    const double yaw = 179.0 + 10.0 * i;
    record::TrajectoryEpoch epoch;
    epoch.nav = nav_at(i, kOrigin, Eigen::Vector3d::Zero(), {0.0, 0.0, geo::wrap_angle((yaw + 2.0) * geo::kDegree)});
    curves.add_forward(epoch);
    epoch.nav = nav_at(i, kOrigin, Eigen::Vector3d::Zero(), {0.0, 0.0, geo::wrap_angle(yaw * geo::kDegree)});
    curves.add_smoothed(epoch);
  }
  EXPECT_NEAR(curves.curves().forward.attitude[2].finish().y.front(), 181.0, 1e-9);
  EXPECT_NEAR(curves.curves().forward.attitude[2].finish().y.back(), 901.0, 1e-9);
  EXPECT_NEAR(curves.curves().smoothed.attitude[2].finish().y.back(), 899.0, 1e-9);
}

TEST_F(PageTest, OutageTableStatesTheShareOfTheWay) {
  const report::Page page = make(full_result());
  const report::Table* outages = table(page, "outage-table");
  ASSERT_NE(outages, nullptr);
  ASSERT_EQ(outages->rows.size(), 21U);
  EXPECT_EQ(outages->rows[0][3].text, "100");   // 10 s at 10 m/s
  EXPECT_EQ(outages->rows[0][4].text, "1.00");  // forward, m
  EXPECT_EQ(outages->rows[0][6].text, "1.0");   // of 100 m, %
  EXPECT_EQ(outages->rows[0][7].text, "0.10");
  EXPECT_EQ(outages->rows[0][9].text, "95.0");
  // The one that was withheld, then of each of the two durations the five worst; errors grow with the number.
  std::set<std::string> drawn;
  for (const report::Panel& p : section(page, "outages")->panels)
    if (p.id.starts_with("outage-")) drawn.insert(p.id);
  std::set<std::string> expected{"outage-1"};
  for (int i = 12; i <= 21; ++i) expected.insert("outage-" + std::to_string(i));
  EXPECT_EQ(drawn, expected);
}

TEST_F(PageTest, ReferenceTableHasRmsMaximumAndShare) {
  ProcessResult result = full_result();
  // N of forward: 101 times 0.01 m and once 0.1 m, which alone is beyond 1.96 sigma of 0.03 m.
  study::ErrorSample beyond;
  beyond.t = kStart + 101.0;
  beyond.position_n = {-0.1, 0.0, 0.0};
  beyond.sd_position = Eigen::Vector3d::Constant(0.03);
  result.reference->forward.add(beyond);
  const report::Page page = make(result);
  const auto& rows = table(page, "reference-table")->rows;
  ASSERT_EQ(rows.size(), 9U);
  EXPECT_EQ(rows[0][2].text, number(std::sqrt((101.0 * 1e-4 + 1e-2) / 102.0)));
  EXPECT_EQ(rows[0][3].text, "0.100");
  EXPECT_EQ(rows[0][6].text, "99.0");
  EXPECT_EQ(rows[1][4].text, "0.0200");  // E, smoothed
  EXPECT_EQ(rows[1][7].text, "100.0");
}

TEST_F(PageTest, NoiseFitIsSaidInASentence) {
  const report::Page page = make(full_result());
  const auto& notes = section(page, "innovations")->notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].text, "For this recording the white noise of gyro x is 38 times too small.");
}

TEST_F(PageTest, TwoProcessesOfOneKindAndMisalignmentsAreToldApart) {
  const report::Page page = make(full_result());
  std::map<std::string, std::vector<std::string>> labels;
  for (const report::Panel& p : section(page, "sensors")->panels)
    for (const report::Plot& plot : p.plots) labels[p.title].push_back(plot.y.label);
  EXPECT_EQ(labels["Gyro bias, Gauss-Markov part"], (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_EQ(labels["Gyro bias, Gauss-Markov part 2"], (std::vector<std::string>{"x", "y", "z"}));
  // noise::misalignment gives the next axis first, then the previous one
  EXPECT_EQ(labels["Gyro misalignment"], (std::vector<std::string>{"xy", "xz", "yz", "yx", "zx", "zy"}));
  EXPECT_EQ(labels["Vehicle against body"], (std::vector<std::string>{"pitch", "yaw"}));
}

TEST(PageParts, NumbersHaveThreeDigitsAndNoExponent) {
  EXPECT_EQ(number(0.0123456), "0.0123");
  EXPECT_EQ(number(4.5678), "4.57");
  EXPECT_EQ(number(-1234.6), "-1235");
  EXPECT_EQ(number(0.0), "0");
  EXPECT_EQ(number(12.0, 2), "12");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "not determined");
}

TEST(PageParts, StartTransientDoesNotFlattenThePanel) {
  report::Panel panel = report::time_panel("p", "p", "m", "Caption.");
  std::vector<double> t;
  std::vector<double> y;
  for (int i = 0; i < 1000; ++i) {
    t.push_back(i);
    y.push_back(i < 5 ? 1000.0 : std::sin(0.1 * i));
  }
  report::add_line(panel.plot(), "y", curve(t, y));
  show_bulk(panel);
  ASSERT_TRUE(panel.plot().y.range);
  EXPECT_LT(panel.plot().y.range->second, 3.0);
  EXPECT_GE(panel.plot().y.range->second, 1.0);
  EXPECT_LE(panel.plot().y.range->first, -1.0);
  EXPECT_GT(panel.caption.size(), 20U);  // and the caption says so

  report::Panel whole = report::time_panel("q", "q", "m", "Caption.");
  y.assign(1000, 0.0);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = std::sin(0.1 * static_cast<double>(i));
  report::add_line(whole.plot(), "y", curve(t, y));
  show_bulk(whole);
  EXPECT_FALSE(whole.plot().y.range);
}

}  // namespace
}  // namespace coast::jobs
