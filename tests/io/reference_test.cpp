#include "coast/io/reference.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/writers.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using geo::GpsTime;
using test::count_of;
using test::Files;
using test::refusal;

/// A random mission in the southern hemisphere, across the date line and a week rollover.
std::vector<record::TrajectoryEpoch> random_epochs(int n) {
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)); };
  const auto covariance = [&](double scale) {
    Eigen::Matrix3d a;
    a << vector(), vector(), vector();
    return Eigen::Matrix3d(scale * scale * (a * a.transpose() + 0.01 * Eigen::Matrix3d::Identity()));
  };
  std::vector<record::TrajectoryEpoch> epochs;
  for (int i = 0; i < n; ++i) {
    record::TrajectoryEpoch e;
    e.nav.t = GpsTime::from_week(2300, 604800.0 - 0.5) + i / 128.0;
    e.nav.r_eb_e = geo::ecef_from_geodetic(
        {-0.6 + 1e-4 * normal(generator), 3.1415926 + 1e-7 * normal(generator), 100.0 * normal(generator)});
    e.nav.v_eb_e = 20.0 * vector();
    e.nav.q_b_e = Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator)).normalized();
    e.cov = {covariance(0.1), covariance(0.01), covariance(1e-3)};
    e.motion = {0.1 * vector(), vector()};
    epochs.push_back(e);
  }
  return epochs;
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

void write_all(TrajectoryWriter& writer, const std::vector<record::TrajectoryEpoch>& epochs) {
  for (const auto& epoch : epochs) writer.write(epoch);
  writer.close();
}

void expect_same(const record::Trajectory& back, const std::vector<record::TrajectoryEpoch>& epochs, double position,
                 double velocity, double attitude) {
  ASSERT_EQ(back.states.size(), epochs.size());
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    const auto& a = epochs[i].nav;
    const auto& b = back.states[i];
    EXPECT_EQ(a.t, b.t);
    EXPECT_LT((a.r_eb_e - b.r_eb_e).norm(), position);
    EXPECT_LT((a.v_eb_e - b.v_eb_e).norm(), velocity);
    EXPECT_LT(angle_between(a.q_b_e, b.q_b_e), attitude);
  }
}

TEST(Nav, ReadsBackWithinTheDigitsPrinted) {
  const auto epochs = random_epochs(200);
  const Files files;
  write_all(*trajectory_format("nav").make(files.path("a.nav"), {}), epochs);
  const auto back = files.reference("a.nav");
  EXPECT_TRUE(back.has_attitude && back.has_velocity);
  // Half a digit: 1e-11 deg is 1.1 um, 1e-5 m, 1e-6 m/s; 1e-9 deg in three angles, sharpened near the vertical.
  expect_same(back, epochs, 1e-5, 2e-6, 1e-9);
}

TEST(Nav, WeekZeroMeansNotStated) {
  const Files files;
  const std::string row = " 30.5 114.3 20.0 1.0 2.0 3.0 10.0 -5.0 200.0\n";
  files.put("a.nav", "0 456300.000000000" + row + "0 456300.005" + row);
  EXPECT_EQ(files.reference("a.nav", "", GpsTime::from_week(2017, 456400.0)).states[0].t, GpsTime::from_week(2017, 456300.0));
  EXPECT_EQ(files.reference("a.nav", "gps_week: 2018").states[0].t, GpsTime::from_week(2018, 456300.0));
  EXPECT_NE(refusal([&] { (void)files.reference("a.nav"); }).find("a.nav:1: seconds of week without a GPS week"),
            std::string::npos);
  const auto state = files.reference("a.nav", "gps_week: 2018").states[0];
  const Eigen::Matrix3d C_n_e = geo::C_n_e({30.5 * geo::kDegree, 114.3 * geo::kDegree, 20.0});
  test::expect_near_matrix(state.v_eb_e, C_n_e * Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12, "velocity");
  // z-y-x by elementary rotations.
  const Eigen::Matrix3d C_b_n = (Eigen::AngleAxisd(200.0 * geo::kDegree, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(-5.0 * geo::kDegree, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(10.0 * geo::kDegree, Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix();
  test::expect_near_matrix(state.q_b_e.toRotationMatrix(), C_n_e * C_b_n, 1e-12, "attitude");
}

TEST(TrajectoryCsv, ReadsBackAndKeepsTheCovariance) {
  const auto epochs = random_epochs(50);
  const Files files;
  write_all(*trajectory_format("csv").make(files.path("a.csv"), {}), epochs);
  expect_same(files.reference("a.csv"), epochs, 1e-5, 2e-6, 1e-9);
  TableReader table(files.path("a.csv"));
  std::array<std::size_t, 6> slots{};
  const std::array<const char*, 6> names = {"sdn_m", "sde_m", "sdd_m", "corr_ne", "corr_nd", "corr_ed"};
  for (std::size_t i = 0; i < 6; ++i) slots[i] = table.number_slot(names[i], "covariance");
  const auto yaw = table.number_slot("sd_yaw_deg", "yaw");
  for (const auto& epoch : epochs) {
    ASSERT_TRUE(table.next());
    const Eigen::Matrix3d& P = epoch.cov.position;
    EXPECT_NEAR(table.number(slots[1]), std::sqrt(P(1, 1)), 1e-6);
    EXPECT_NEAR(table.number(slots[3]), P(0, 1) / std::sqrt(P(0, 0) * P(1, 1)), 1e-6);
    EXPECT_NEAR(table.number(slots[5]), P(1, 2) / std::sqrt(P(1, 1) * P(2, 2)), 1e-6);
    // Yaw by finite differences of the attitude about N, E, D: C(est) = (I + [psi x]) C(truth).
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(epoch.nav.r_eb_e));
    const Eigen::Matrix3d C_b_n = C_n_e.transpose() * epoch.nav.q_b_e.toRotationMatrix();
    const auto yaw_at = [&](const Eigen::Vector3d& psi) {
      const Eigen::Matrix3d C = Eigen::AngleAxisd(psi.norm(), psi.normalized()).toRotationMatrix() * C_b_n;
      return std::atan2(C(1, 0), C(0, 0));
    };
    constexpr double kStep = 1e-6;
    Eigen::Vector3d gradient;
    for (int j = 0; j < 3; ++j)
      gradient[j] =
          geo::wrap_angle(yaw_at(kStep * Eigen::Vector3d::Unit(j)) - yaw_at(-kStep * Eigen::Vector3d::Unit(j))) / (2.0 * kStep);
    const double expected = std::sqrt(gradient.dot(epoch.cov.attitude * gradient)) / geo::kDegree;
    EXPECT_NEAR(table.number(yaw), expected, 1e-7 + 1e-5 * expected);
  }
}

TEST(Sbet, ReadsBackExactlyWithItsUncertainty) {
  const auto epochs = random_epochs(40);
  const Files files;
  write_all(*trajectory_format("sbet").make(files.path("a.sbet"), {}), epochs);
  expect_same(files.reference("a.sbet", "", epochs[0].nav.t), epochs, 1e-7, 1e-11, 1e-11);
  const std::string sbet = files.get("a.sbet");
  const std::string smrmsg = files.get("a.smrmsg");
  ASSERT_EQ(sbet.size(), 40U * 136U);
  ASSERT_EQ(smrmsg.size(), 40U * 80U);
  // Wander angle; acceleration and angular rate about forward, right, down: bytes 80 to 136 of a record.
  std::array<double, 7> motion{};
  std::memcpy(motion.data(), sbet.data() + 7 * 136 + 80, 56);
  const record::BodyMotion& body = epochs[7].motion;
  const std::array<double, 7> expected = {
      0.0, body.a_eb_b.x(), body.a_eb_b.y(), body.a_eb_b.z(), body.omega_eb_b.x(), body.omega_eb_b.y(), body.omega_eb_b.z()};
  EXPECT_EQ(motion, expected);
  std::array<double, 10> record{};
  std::memcpy(record.data(), smrmsg.data() + 7 * 80, 80);
  EXPECT_EQ(record[0], epochs[7].nav.t.sow());
  EXPECT_DOUBLE_EQ(record[2], std::sqrt(epochs[7].cov.position(1, 1)));
  EXPECT_DOUBLE_EQ(record[6], std::sqrt(epochs[7].cov.velocity(2, 2)));
  // Heading sigma in minutes of arc: the CSV has the same in degrees, checked there against finite differences.
  write_all(*trajectory_format("csv").make(files.path("a.csv"), {}), epochs);
  TableReader table(files.path("a.csv"));
  const auto yaw = table.number_slot("sd_yaw_deg", "yaw");
  for (int i = 0; i <= 7; ++i) ASSERT_TRUE(table.next());
  EXPECT_NEAR(record[9], 60.0 * table.number(yaw), 60.0 * 1e-8);
}

TEST(Sbet, HeadingCountsFromTheWanderFrame) {
  std::array<double, 17> record{100.0, 0.5, 0.2, 30.0, 0, 0, 0, 0.01, 0.02, 1.5, 0.3};
  std::string bytes;
  for (int i = 0; i < 3; ++i) {
    record[0] += 0.01;
    bytes.append(reinterpret_cast<const char*>(record.data()), sizeof(record));  // little-endian machine, as the format
  }
  const Files files;
  files.put("a.out", bytes + "torn");
  const auto trajectory = files.reference("a.out", "gps_week: 2300");
  ASSERT_EQ(trajectory.states.size(), 3U);
  EXPECT_FALSE(trajectory.has_velocity);
  EXPECT_EQ(count_of(trajectory.events, "sbet_wander"), 1);
  EXPECT_EQ(count_of(trajectory.events, "trailing_garbage"), 1);
  const Eigen::Matrix3d C_b_n = geo::C_n_e({0.5, 0.2, 30.0}).transpose() * trajectory.states[0].q_b_e.toRotationMatrix();
  EXPECT_NEAR(std::atan2(C_b_n(1, 0), C_b_n(0, 0)), 1.2, 1e-12);
}

TEST(ReferenceTable, QuaternionOfForwardLeftUpInEastNorthUp) {
  // A forward-left-up body turned anticlockwise by 30 deg from east heads 60 deg; nose up by 10 deg is pitch +10 deg.
  const Eigen::Quaterniond q(Eigen::AngleAxisd(30.0 * geo::kDegree, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(-10.0 * geo::kDegree, Eigen::Vector3d::UnitY()));
  const Files files;
  std::string text;
  for (const int t : {0, 1})
    text += fmt::format("{} 630084 4833438 76 {:.12f} {:.12f} {:.12f} {:.12f}\n", 1536097411 + t, q.x(), q.y(), q.z(), q.w());
  files.put("pose.txt", text);
  const auto trajectory =
      files.reference("pose.txt",
                      "columns: {time: 1, position: [2, 3, 4], quaternion: [5, 6, 7, 8]}, attitude_to: enu, "
                      "body_axes: flu, frame: utm, utm_zone: 17N, time: {kind: unix}");
  EXPECT_FALSE(trajectory.has_velocity);
  const auto& state = trajectory.states.at(0);
  const Eigen::Matrix3d C_b_n = geo::C_n_e(geo::geodetic_from_ecef(state.r_eb_e)).transpose() * state.q_b_e.toRotationMatrix();
  const geo::Euler euler = geo::euler_from_dcm(C_b_n);
  EXPECT_NEAR(euler.yaw / geo::kDegree, 60.0, 1e-9);
  EXPECT_NEAR(euler.pitch / geo::kDegree, 10.0, 1e-9);
  EXPECT_NEAR(euler.roll / geo::kDegree, 0.0, 1e-9);
}

TEST(ReferenceTable, NormOfAQuaternionIsChecked) {
  const Files files;
  files.put("pose.txt", "1 35 139 76 1 1 1 1\n2 35 139 76 1 1 1 1\n");
  EXPECT_NE(refusal([&] {
              (void)files.reference("pose.txt",
                                    "columns: {time: 1, position: [2, 3, 4], quaternion: [5, 6, 7, 8]}, gps_week: 2300");
            }).find("pose.txt:1: a quaternion of norm 2"),
            std::string::npos);
}

}  // namespace
}  // namespace coast::io
