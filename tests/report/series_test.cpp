#include "coast/report/series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace coast::report {
namespace {

struct Record {
  std::vector<double> x, y;
};

/// Noise on a ramp with single-sample spikes, at uneven steps.
Record noisy(std::size_t n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> step(0.5, 1.5);
  Record out;
  double x = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    out.x.push_back(x += step(engine));
    out.y.push_back(1e-3 * x + normal(engine) + (engine() % 1000 == 0 ? 50.0 * normal(engine) : 0.0));
  }
  return out;
}

Series run(const Record& record, const DecimationOptions& options) {
  Decimator decimator(options);
  for (std::size_t i = 0; i < record.x.size(); ++i) decimator.add(record.x[i], record.y[i]);
  return decimator.finish();
}

class EveryLength : public testing::TestWithParam<std::size_t> {};

// Brute force over every window of buckets: whatever stretch is looked at, the kept points reach at least as far as the
// samples do, once the stretch is widened by one bucket (4 n / max_points samples) at each end.
TEST_P(EveryLength, NoPeakIsHiddenInAnyWindow) {
  const std::size_t n = GetParam();
  const DecimationOptions options{64, 1e9};
  const Record record = noisy(n, 5);
  const Series kept = run(record, options);
  const std::size_t bucket = std::max<std::size_t>(1, 4 * n / 62 + 1);  // 62: two points are set aside for the ends
  for (std::size_t from = 0; from < n; from += std::max<std::size_t>(1, n / 97)) {
    for (const std::size_t length : {std::size_t{1}, bucket, 3 * bucket}) {
      const std::size_t to = std::min(n, from + length);
      const auto [least, greatest] =
          std::minmax_element(record.y.begin() + static_cast<long>(from), record.y.begin() + static_cast<long>(to));
      const double low = record.x[from > bucket ? from - bucket : 0];
      const double high = record.x[std::min(n - 1, to - 1 + bucket)];
      double kept_least = 1e300;
      double kept_greatest = -1e300;
      for (std::size_t i = 0; i < kept.x.size(); ++i) {
        if (kept.x[i] < low || kept.x[i] > high) continue;
        kept_least = std::min(kept_least, kept.y[i]);
        kept_greatest = std::max(kept_greatest, kept.y[i]);
      }
      ASSERT_LE(kept_least, *least) << "window " << from << " to " << to;
      ASSERT_GE(kept_greatest, *greatest) << "window " << from << " to " << to;
    }
  }
}

TEST_P(EveryLength, KeptPointsAreSamplesInOrderWithinTheLimit) {
  const std::size_t n = GetParam();
  const Record record = noisy(n, 9);
  const Series kept = run(record, {64, 1e9});
  ASSERT_EQ(kept.x.size(), kept.y.size());
  EXPECT_LE(kept.x.size(), 64U);
  EXPECT_EQ(kept.x.front(), record.x.front());
  EXPECT_EQ(kept.x.back(), record.x.back());
  EXPECT_EQ(kept.y.back(), record.y.back());
  std::size_t at = 0;
  for (std::size_t i = 0; i < kept.x.size(); ++i) {
    while (at < n && (record.x[at] != kept.x[i] || record.y[at] != kept.y[i])) ++at;
    ASSERT_LT(at, n) << "point " << i << " is no sample, or out of order";
    ++at;
  }
  if (n <= 62) {
    EXPECT_EQ(kept.y, record.y);
  }
}

TEST_P(EveryLength, BandIsNowhereNarrowedBelowItsExtremes) {
  const std::size_t n = GetParam();
  const Record record = noisy(n, 13);
  Decimator decimator({64, 1e9});
  for (std::size_t i = 0; i < n; ++i) decimator.add(record.x[i], 0.0, -std::abs(record.y[i]), 2.0 * std::abs(record.y[i]));
  const Series kept = decimator.finish();
  ASSERT_TRUE(kept.band.has_value());
  double peak = 0.0;
  for (const double y : record.y) peak = std::max(peak, std::abs(y));
  EXPECT_EQ(*std::max_element(kept.band->upper.begin(), kept.band->upper.end()), 2.0 * peak);
  EXPECT_EQ(*std::min_element(kept.band->lower.begin(), kept.band->lower.end()), -peak);
  EXPECT_TRUE(std::is_sorted(kept.band->x.begin(), kept.band->x.end()));
  EXPECT_EQ(kept.band->x.front(), record.x.front());
  EXPECT_EQ(kept.band->x.back(), record.x.back());
}

// y = x and a half width of 1 + x: every kept sample must have its own, whatever the envelope around it is.
TEST_P(EveryLength, KeptSamplesHaveTheHalfWidthTheyCameWith) {
  Decimator decimator({64, 1e9});
  for (std::size_t i = 0; i < GetParam(); ++i) {
    const auto x = static_cast<double>(i);
    decimator.add(x, x, -1.0, 1.0 + 2.0 * x);
  }
  const Series kept = decimator.finish();
  ASSERT_EQ(kept.half_width.size(), kept.x.size());
  for (std::size_t i = 0; i < kept.x.size(); ++i) EXPECT_EQ(kept.half_width[i], 1.0 + kept.x[i]);
  const Series again = decimate(kept, {32, 1e9});
  ASSERT_EQ(again.half_width.size(), again.x.size());
  for (std::size_t i = 0; i < again.x.size(); ++i) EXPECT_EQ(again.half_width[i], 1.0 + again.x[i]);
}

// 62 and 63: the last length without loss and the first with; 4097: one over a power of two.
INSTANTIATE_TEST_SUITE_P(Decimator, EveryLength, testing::Values(1, 2, 3, 62, 63, 64, 127, 1000, 4096, 4097, 54321));

// On a ramp a bucket keeps its first and its last sample, so the kept numbers show where buckets begin.
TEST(Decimator, BucketsHoldOneAndTheSamePowerOfTwoOfSamples) {
  Decimator decimator({64, 1e9});
  for (int i = 0; i < 54321; ++i) decimator.add(i, i);
  const Series kept = decimator.finish();
  const double size = kept.x.at(2);
  EXPECT_EQ(std::exp2(std::round(std::log2(size))), size);
  double bucket = 0.0;
  for (std::size_t i = 0; i + 2 < kept.x.size(); i += 2, bucket += 1.0) {
    EXPECT_EQ(kept.x[i], size * bucket);
    EXPECT_EQ(kept.x[i + 1], kept.x[i] + size - 1.0);
  }
}

TEST(Decimator, TrackKeepsItsExtremesInBothDirections) {
  Decimator decimator({64, 1e9});
  double east = -1e9;
  double west = 1e9;
  double north = -1e9;
  for (int i = 0; i < 10000; ++i) {
    const double u = 1e-3 * i;
    const double x = (i == 4321 ? 90.0 : 30.0) * std::cos(7.0 * u);
    const double y = (i == 8765 ? 90.0 : 30.0) * std::sin(5.0 * u);
    east = std::max(east, x);
    west = std::min(west, x);
    north = std::max(north, y);
    decimator.add_track(0.005 * i, x, y);
  }
  const Series kept = decimator.finish();
  EXPECT_LE(kept.x.size(), 64U);
  EXPECT_EQ(kept.t.size(), kept.x.size());
  EXPECT_TRUE(std::is_sorted(kept.t.begin(), kept.t.end()));
  EXPECT_EQ(*std::max_element(kept.x.begin(), kept.x.end()), east);
  EXPECT_EQ(*std::min_element(kept.x.begin(), kept.x.end()), west);
  EXPECT_EQ(*std::max_element(kept.y.begin(), kept.y.end()), north);
}

TEST(Decimator, GapsInterruptTheCurveAndAreNeverMergedOver) {
  Decimator decimator({16, 1.5});
  std::vector<double> expected;
  for (int i = 0; i < 1000; ++i) {
    const double x = i + (i >= 300 ? 10.0 : 0.0) + (i >= 900 ? 10.0 : 0.0);
    decimator.add(x, i % 7);
  }
  const Series kept = decimator.finish();
  ASSERT_EQ(kept.breaks.size(), 2U);
  EXPECT_EQ(kept.x[kept.breaks[0] - 1], 299.0);  // both ends of every piece are kept
  EXPECT_EQ(kept.x[kept.breaks[0]], 310.0);
  EXPECT_EQ(kept.x[kept.breaks[1] - 1], 909.0);
  EXPECT_EQ(kept.x[kept.breaks[1]], 920.0);
}

TEST(Decimator, MoreGapsThanPointsKeepsEveryPiece) {
  Decimator decimator({16, 1.5});
  for (int i = 0; i < 500; ++i) decimator.add(2.0 * i, i);  // each sample stands alone
  const Series kept = decimator.finish();
  EXPECT_EQ(kept.x.size(), 500U);
  EXPECT_EQ(kept.breaks.size(), 499U);
}

TEST(Decimator, ValuesThatAreNotFiniteAreCountedAndInterrupt) {
  Decimator decimator;
  for (int i = 0; i < 10; ++i) decimator.add(i, i == 4 ? std::nan("") : i);
  const Series kept = decimator.finish();
  EXPECT_EQ(kept.not_finite, 1U);
  EXPECT_EQ(kept.x.size(), 9U);
  ASSERT_EQ(kept.breaks.size(), 1U);
  EXPECT_EQ(kept.x[kept.breaks[0]], 5.0);
}

TEST(Decimator, RefusesALimitThatCannotHoldAPieceAndArraysOfTwoLengths) {
  EXPECT_THROW(Decimator({15, 1.0}), std::invalid_argument);
  Series series;
  series.x = {1.0, 2.0};
  series.y = {1.0};
  EXPECT_THROW((void)decimate(series), std::invalid_argument);
}

TEST(Decimate, EqualsTheStream) {
  const Record record = noisy(5000, 21);
  Series whole;
  whole.x = record.x;
  whole.y = record.y;
  whole.breaks = {2000};
  const Series from_arrays = decimate(whole, {100, 1e9});
  Decimator stream({100, 1e9});
  for (std::size_t i = 0; i < record.x.size(); ++i) {
    if (i == 2000) stream.interrupt();
    stream.add(record.x[i], record.y[i]);
  }
  const Series streamed = stream.finish();
  EXPECT_EQ(from_arrays.x, streamed.x);
  EXPECT_EQ(from_arrays.y, streamed.y);
  EXPECT_EQ(from_arrays.breaks, streamed.breaks);
  EXPECT_EQ(from_arrays.breaks.size(), 1U);
}

}  // namespace
}  // namespace coast::report
