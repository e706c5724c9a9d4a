#include "coast/tumble/rests.hpp"

#include <gtest/gtest.h>

#include "tumbled.hpp"

namespace coast::tumble {
namespace {

using test::drawn_errors;
using test::Tumble;
using test::tumbled;
using test::Tumbled;

TEST(Rests, AreThoseMade) {
  Tumble plan;
  const auto [accel, gyro] = drawn_errors(1);
  const Tumbled made = tumbled(plan, accel, gyro);
  const std::vector<Rest> rests = find_rests(made.sensor);
  ASSERT_EQ(rests.size(), made.rests.size());
  for (std::size_t i = 0; i < rests.size(); ++i) {
    // Within the rest, and at most two quarters short of it at either end.
    EXPECT_GE(rests[i].from, made.rests[i].first - 1e-6) << i;
    EXPECT_LE(rests[i].to, made.rests[i].second + 0.05) << i;  // turns begin slowly
    EXPECT_LE(rests[i].from, made.rests[i].first + 0.6) << i;
    EXPECT_GE(rests[i].to, made.rests[i].second - 0.6) << i;
  }
}

}  // namespace
}  // namespace coast::tumble
