// A run knows when it is wrong: `verdict` in summary.json, and the exit status.

#include <gtest/gtest.h>

#include <cmath>

#include "coast/jobs/process.hpp"

namespace coast::jobs {
namespace {

TEST(Verdict, IsThatOfTheWorstCheck) {
  const Check good{"a", 0.1, 1.0, 2.0, "a is fine"};
  const Check doubtful{"b", 1.5, 1.0, 2.0, "b is large"};
  const Check without_bound{"c", 1e9, 1.0, {}, "c is huge"};
  const Check not_a_number{"d", std::nan(""), 1.0, 2.0, "d is nothing"};
  EXPECT_EQ(good.standing(), Standing::kGood);
  EXPECT_EQ(doubtful.standing(), Standing::kDoubtful);
  EXPECT_EQ(without_bound.standing(), Standing::kDoubtful);
  EXPECT_EQ(not_a_number.standing(), Standing::kUnusable);
  const Judgement judgement{{good, doubtful}, "a cable"};
  EXPECT_EQ(judgement.standing(), Standing::kDoubtful);
  EXPECT_EQ(judgement.line(), "verdict: doubtful: b is large. Most likely cause: a cable");
}

}  // namespace
}  // namespace coast::jobs
