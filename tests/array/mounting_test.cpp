#include "coast/array/mounting.hpp"

#include <gtest/gtest.h>

#include "array/analytic_array.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::array {
namespace {

using test::add_white_noise;
using test::analytic_array;
using test::four_frames;

/// True frames, and stated ones that differ by a few degrees and centimetres whose means over the sensors are zero: what all
/// have in common no residual shows.
struct RoughlyKnown {
  std::vector<SensorFrame> truth = four_frames();
  std::vector<SensorFrame> stated = truth;

  explicit RoughlyKnown(std::uint64_t seed, double angle = 0.05, double metres = 0.02) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<Eigen::Vector3d> turns(4), shifts(4);
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = turn;
    for (std::size_t k = 0; k < 4; ++k) {
      for (int i = 0; i < 3; ++i) turns[k](i) = angle * normal(generator), shifts[k](i) = metres * normal(generator);
      turn += turns[k] / 4.0;
      shift += shifts[k] / 4.0;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      stated[k].C_s_b = geo::rotation_matrix(turns[k] - turn) * truth[k].C_s_b;
      stated[k].r_b += shifts[k] - shift;
    }
  }
};

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a * b.transpose()).angle();
}

TEST(Mounting, IsFoundWithoutNoise) {
  const RoughlyKnown known(2);
  const Signals signals = analytic_array({.rate = 2.0, .force = 5.0, .frequency = 0.4}, known.truth, 0.01, 6000);
  const RefinedMounting refined = refine_mounting(signals, known.stated, {.block_s = 0.02});
  for (std::size_t k = 0; k < 4; ++k) {
    // The common rotation is kept to first order: what is left of second order is (0.1 rad)^2 / 2 times less than one.
    EXPECT_LT(angle_between(refined.sensors[k].frame.C_s_b, known.truth[k].C_s_b), 5e-3) << k;
    EXPECT_LT((refined.sensors[k].frame.r_b - known.truth[k].r_b).norm(), 2e-3) << k;
    // Against each other nothing is left but the prior's pull and the differentiator.
    const Eigen::Matrix3d between = refined.sensors[k].frame.C_s_b * refined.sensors[0].frame.C_s_b.transpose();
    EXPECT_LT(angle_between(between, known.truth[k].C_s_b * known.truth[0].C_s_b.transpose()), 2e-4) << k;
  }
  EXPECT_LT(refined.rates_after, 0.01 * refined.rates_before);
  EXPECT_LT(refined.forces_after, 0.01 * refined.forces_before);
}

TEST(Mounting, ErrorsAreThoseStated) {
  // Twenty noisy arrays: normalised squares of three rotations and three shifts of each sensor, 480 of each kind. The noise of
  // the mean is shared by the sensors and its bandwidth by blocks, so the bounds are wide: a factor of two either way.
  double turns = 0.0, shifts = 0.0, count = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RoughlyKnown known(seed, 0.02, 0.01);
    Signals signals = analytic_array({.rate = 2.0, .force = 5.0, .frequency = 0.4}, known.truth, 0.01, 3000);
    add_white_noise(signals, 0.01, 0.1, seed);
    const RefinedMounting refined = refine_mounting(signals, known.stated, {.block_s = 0.05});
    Eigen::Vector3d mean_turn = Eigen::Vector3d::Zero(), mean_shift = mean_turn;
    std::vector<Eigen::Vector3d> turn(4), shift(4);
    for (std::size_t k = 0; k < 4; ++k) {
      turn[k] = geo::rotation_vector(Eigen::Quaterniond(refined.sensors[k].frame.C_s_b * known.truth[k].C_s_b.transpose()));
      shift[k] = refined.sensors[k].frame.r_b - known.truth[k].r_b;
      mean_turn += turn[k] / 4.0;
      mean_shift += shift[k] / 4.0;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      turns += (turn[k] - mean_turn).cwiseQuotient(refined.sensors[k].rotation_sd).squaredNorm();
      shifts += (shift[k] - mean_shift).cwiseQuotient(refined.sensors[k].position_sd_m).squaredNorm();
      count += 3.0;
    }
  }
  EXPECT_GT(turns / count, 0.4);
  EXPECT_LT(turns / count, 2.0);
  EXPECT_GT(shifts / count, 0.4);
  EXPECT_LT(shifts / count, 2.0);
}

TEST(Mounting, PlacesDoNotDependOnTheBlocks) {
  // Within a block of 0.2 s these rates change by a quarter: with the squares of their means places differ by millimetres.
  const RoughlyKnown known(2);
  const Signals signals = analytic_array({.rate = 2.0, .force = 5.0, .frequency = 0.6}, known.truth, 0.01, 6000);
  const RefinedMounting fine = refine_mounting(signals, known.stated, {.block_s = 0.02});
  const RefinedMounting coarse = refine_mounting(signals, known.stated, {.block_s = 0.2});
  for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((coarse.sensors[k].frame.r_b - fine.sensors[k].frame.r_b).norm(), 5e-4) << k;
}

TEST(Mounting, PlacesStayWhereNothingTurns) {
  const RoughlyKnown known(4, 0.03, 0.02);
  Signals signals = analytic_array({.rate = 0.0, .force = 5.0, .frequency = 0.4}, known.truth, 0.01, 3000);
  add_white_noise(signals, 0.01, 0.1, 4);
  const RefinedMounting refined = refine_mounting(signals, known.stated);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((refined.sensors[k].frame.r_b - known.stated[k].r_b).norm(), 5e-3) << "moved by noise alone";
    EXPECT_NEAR(refined.sensors[k].position_sd_m.norm(), std::sqrt(3.0) * 0.05, 5e-3) << "no more is known than was stated";
  }
}

TEST(Mounting, RefusesWhatItCannotUse) {
  const std::vector<SensorFrame> frames = four_frames();
  const Signals signals = analytic_array({}, frames, 0.01, 500);
  EXPECT_THROW(static_cast<void>(refine_mounting(signals, {frames[0]})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(refine_mounting(signals, frames)), std::invalid_argument) << "50 blocks of 0.1 s";
}

}  // namespace
}  // namespace coast::array
