// Differences without a reference satellite against the textbook's, which have one.

#include "double_differences.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "simulated.hpp"

namespace coast::carrier {
namespace {

class DoubleDifferencesTest : public testing::Test {
 protected:
  void SetUp() override {
    epochs_ = mission_.differences();
    state_.x.head<3>() = epochs_[100].alone->r_e;
    for (const SatelliteDifference& s : epochs_[100].satellites)
      for (const BandDifference& band : s.bands)
        state_.add({Unknown::Kind::kAmbiguity, s.satellite, band.band, band.arc}, 0.0, 1e4);
  }
  SimulatedBaseline mission_{"car_roundabout", 400.0, simulate::ObservationOptions{}};
  std::vector<DifferenceEpoch> epochs_;
  RelativeState state_;
};

/// Groups of rows that share a clock, by the rows' phase and band.
std::vector<std::vector<Eigen::Index>> groups_of(const DoubleDifferences& dd, const DifferenceEpoch& epoch) {
  std::map<std::tuple<Observable, record::SatelliteSystem, char>, std::vector<Eigen::Index>> groups;
  for (std::size_t i = 0; i < dd.rows.size(); ++i) {
    const SatelliteDifference& s = epoch.satellites[dd.rows[i].satellite];
    groups[{dd.rows[i].observable, s.satellite.system, s.bands[dd.rows[i].band].band}].push_back(static_cast<Eigen::Index>(i));
  }
  std::vector<std::vector<Eigen::Index>> all;
  for (const auto& [key, rows] : groups) all.push_back(rows);
  return all;
}

TEST_F(DoubleDifferencesTest, CarryTheInformationOfThoseWithAReference) {
  const DifferenceEpoch& epoch = epochs_[100];
  const DoubleDifferences dd = double_differences(epoch, state_, {}, {}, {});
  const auto rows = static_cast<Eigen::Index>(dd.rows.size());
  ASSERT_GT(rows, 40);
  // Textbook: unscaled rows, first of each group as the reference, correlated noise.
  Eigen::VectorXd sd(rows);
  for (Eigen::Index i = 0; i < rows; ++i) sd(i) = dd.rows[static_cast<std::size_t>(i)].sd;
  const Eigen::MatrixXd H = sd.asDiagonal() * dd.H;
  const Eigen::VectorXd y = sd.asDiagonal() * dd.residual;
  Eigen::MatrixXd D(0, rows);
  for (const auto& group : groups_of(dd, epoch))
    for (std::size_t k = 1; k < group.size(); ++k) {
      D.conservativeResize(D.rows() + 1, rows);
      D.row(D.rows() - 1).setZero();
      D(D.rows() - 1, group[k]) = 1.0;
      D(D.rows() - 1, group[0]) = -1.0;
    }
  ASSERT_EQ(D.rows(), dd.B.rows());
  const Eigen::LDLT<Eigen::MatrixXd> R(D * sd.cwiseAbs2().asDiagonal() * D.transpose());
  const Eigen::MatrixXd expected = (D * H).transpose() * R.solve(D * H);
  const Eigen::VectorXd expected_y = (D * H).transpose() * R.solve(D * y);
  const Eigen::MatrixXd found = (dd.B * dd.H).transpose() * (dd.B * dd.H);
  const Eigen::VectorXd found_y = (dd.B * dd.H).transpose() * (dd.B * dd.residual);
  // Rounding of 1e-16 times the condition of R, some 1e3.
  EXPECT_LT((found - expected).norm(), 1e-11 * expected.norm());
  EXPECT_LT((found_y - expected_y).norm(), 1e-9 * expected_y.norm());
}

TEST_F(DoubleDifferencesTest, AreBlindToClocksAndWhite) {
  const DifferenceEpoch& epoch = epochs_[100];
  const DoubleDifferences dd = double_differences(epoch, state_, {}, {}, {});
  EXPECT_LT((dd.B * dd.B.transpose() - Eigen::MatrixXd::Identity(dd.B.rows(), dd.B.rows())).norm(), 1e-12);
  for (const auto& group : groups_of(dd, epoch)) {
    Eigen::VectorXd clock = Eigen::VectorXd::Zero(dd.B.cols());
    for (const Eigen::Index i : group) clock(i) = 1.0 / dd.rows[static_cast<std::size_t>(i)].sd;
    EXPECT_LT((dd.B * clock).norm(), 1e-12 * clock.norm());
  }
}

TEST_F(DoubleDifferencesTest, RatesAreMeasuredWhereTheStateHasAVelocity) {
  const DifferenceEpoch& epoch = epochs_[100];
  const simulate::Kinematics truth = mission_.truth(epoch.t);
  Eigen::VectorXd x(6);
  x << truth.r_eb_e, truth.v_eb_e;
  RelativeState state({kVelocityUnknowns.begin(), kVelocityUnknowns.end()}, x, Eigen::MatrixXd::Identity(6, 6));
  const DoubleDifferences at = double_differences(epoch, state, {}, {}, {});
  std::vector<double> rates;  // m/s
  for (std::size_t i = 0; i < at.rows.size(); ++i)
    if (at.rows[i].observable == Observable::kRate) rates.push_back(at.residual(static_cast<Eigen::Index>(i)) * at.rows[i].sd);
  ASSERT_GT(rates.size(), 20U);
  // All share the clock; 0.02 Hz of two receivers on wavelengths of 19 to 26 cm.
  const Eigen::Map<const Eigen::VectorXd> all(rates.data(), static_cast<Eigen::Index>(rates.size()));
  const double rms = std::sqrt((all.array() - all.mean()).square().mean());
  EXPECT_GT(rms, 0.02 * std::sqrt(2.0) * 0.19 * 0.7);
  EXPECT_LT(rms, 0.02 * std::sqrt(2.0) * 0.26 * 1.3);
  constexpr double kStep = 1.0;  // m/s; linear
  for (Eigen::Index k = 3; k < 6; ++k) {
    RelativeState moved = state;
    moved.x(k) += kStep;
    const DoubleDifferences there = double_differences(epoch, moved, {}, {}, {});
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      // The Sagnac term of the velocity, 6e-6 at most, and the Earth's turn on the signal's way are left out of the design.
      EXPECT_NEAR((at.residual(row) - there.residual(row)) / kStep * at.rows[i].sd, at.H(row, k) * at.rows[i].sd, 2e-5);
    }
  }
}

TEST_F(DoubleDifferencesTest, DesignIsTheDerivative) {
  const DifferenceEpoch& epoch = epochs_[100];
  const DoubleDifferences at = double_differences(epoch, state_, {}, {}, {});
  constexpr double kStep = 1.0;  // m; second derivatives of ranges are 5e-8 /m
  for (Eigen::Index k = 0; k < 3; ++k) {
    RelativeState moved = state_;
    moved.x(k) += kStep;
    const DoubleDifferences there = double_differences(epoch, moved, {}, {}, {});
    // In metres: the sds change with the elevation.
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double slope = (at.residual(row) * at.rows[i].sd - there.residual(row) * there.rows[i].sd) / kStep;
      // The troposphere's slope is left out of the design: 2.5 m over 8 km of height, up to six times that at 10 degrees.
      EXPECT_NEAR(slope, at.H(row, k) * at.rows[i].sd, 1.9e-3);
    }
  }
}

/// Phases of an epoch less what the truth expects, m, without what its bands have in common.
std::map<std::pair<record::Satellite, char>, double> phases_apart(const DifferenceEpoch& epoch, const RelativeState& state) {
  Weighting coupled;
  coupled.one_phase_clock = true;
  const DoubleDifferences dd = double_differences(epoch, state, {}, {}, coupled);
  std::map<std::pair<record::Satellite, char>, double> all;
  std::map<char, std::pair<double, double>> sums;
  for (std::size_t i = 0; i < dd.rows.size(); ++i) {
    if (dd.rows[i].observable != Observable::kPhase) continue;
    const SatelliteDifference& s = epoch.satellites[dd.rows[i].satellite];
    const char band = s.bands[dd.rows[i].band].band;
    const double metres = dd.residual(static_cast<Eigen::Index>(i)) * dd.rows[i].sd;
    all[{s.satellite, band}] = metres;
    sums[band].first += metres;
    sums[band].second += 1.0;
  }
  for (auto& [signal, metres] : all) metres -= sums.at(signal.second).first / sums.at(signal.second).second;
  return all;
}

// An aircraft between level flight and a turn at 45 degrees of bank. Ambiguities are the same; what the phases differ by is
// rounding, 0.001 cycles of two receivers twice (0.15 mm), and the antenna's attitude.
TEST(DoubleDifferences, PhasesFollowATiltedAntenna) {
  const SimulatedBaseline mission("aircraft_lines", 900.0, error_free());
  const std::vector<DifferenceEpoch> epochs = mission.differences();
  const auto state_at = [&](const DifferenceEpoch& epoch, bool attitude_known) {
    const simulate::Kinematics truth = mission.truth(epoch.t - epoch.alone->clock_s);
    RelativeState state;
    state.x.head<3>() = truth.r_eb_e;
    for (const SatelliteDifference& s : epoch.satellites)
      for (const BandDifference& band : s.bands)
        state.add({Unknown::Kind::kAmbiguity, s.satellite, band.band, band.arc}, 0.0, 1e4);
    if (attitude_known) state.C_b_e = truth.C_b_e;
    return state;
  };
  const auto tilt = [&](const DifferenceEpoch& epoch) {
    const simulate::Kinematics truth = mission.truth(epoch.t);
    return std::acos(truth.C_b_e.col(2).dot(geo::C_n_e(geo::geodetic_from_ecef(truth.r_eb_e)).col(2)));
  };
  const DifferenceEpoch* level = nullptr;
  int banked = 0;
  for (const DifferenceEpoch& epoch : epochs) {
    if (tilt(epoch) < 1.0 * geo::kDegree) level = &epoch;
    if (level == nullptr || tilt(epoch) < 40.0 * geo::kDegree) continue;
    ++banked;
    for (const bool known : {true, false}) {
      const auto before = phases_apart(*level, state_at(*level, known)), now = phases_apart(epoch, state_at(epoch, known));
      ASSERT_EQ(before.size(), now.size());
      double squares = 0.0;
      for (const auto& [signal, metres] : now) squares += std::pow(metres - before.at(signal), 2);
      const double rms = std::sqrt(squares / static_cast<double>(now.size()));
      if (known) {
        EXPECT_LT(rms, 5e-4);
      } else {
        EXPECT_GT(rms, 4e-3);
      }
    }
  }
  EXPECT_GT(banked, 10);
}

TEST_F(DoubleDifferencesTest, PhasesWithOneClockAreBlindToATurnOfTheAntenna) {
  const DifferenceEpoch& epoch = epochs_[100];
  Weighting coupled;
  coupled.one_phase_clock = true;
  const DoubleDifferences dd = double_differences(epoch, state_, {}, {}, coupled);
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(dd.B.cols()), clock = turn;
  for (Eigen::Index i = 0; i < turn.size(); ++i) {
    const Row& row = dd.rows[static_cast<std::size_t>(i)];
    if (row.observable != Observable::kPhase) continue;
    clock(i) = 1.0 / row.sd;
    turn(i) = epoch.satellites[row.satellite].bands[row.band].wavelength() / row.sd;
  }
  EXPECT_LT((dd.B * turn).norm(), 1e-12 * turn.norm());
  EXPECT_LT((dd.B * clock).norm(), 1e-12 * clock.norm());
  EXPECT_LT((dd.B * dd.B.transpose() - Eigen::MatrixXd::Identity(dd.B.rows(), dd.B.rows())).norm(), 1e-12);
}

}  // namespace
}  // namespace coast::carrier
