#include "coast/record/error.hpp"

#include <gtest/gtest.h>

namespace coast {
namespace {

TEST(InputError, MessageNamesFileLineAndRemedy) {
  const InputError error({"imu.csv", 18204, "time goes back by 4.195 s", "increasing", "Split it here."});
  EXPECT_STREQ(error.what(), "imu.csv:18204: time goes back by 4.195 s, expected increasing. Split it here.");
  EXPECT_EQ(error.parts().line, 18204);
}

TEST(InputError, LeavesOutWhatThereIsNot) {
  EXPECT_STREQ(InputError({"a.yaml", 0, "the file is empty", "", ""}).what(), "a.yaml: the file is empty");
  EXPECT_STREQ(InputError({"", 7, "'--threads 0'", "at least 1", ""}).what(), "'--threads 0', expected at least 1");
}

TEST(NumericalError, NamesCheckAndEpoch) {
  EXPECT_STREQ(NumericalError("covariance", "week 2190, 457113.005 s", "-3e-9 on the diagonal").what(),
               "covariance at week 2190, 457113.005 s: -3e-9 on the diagonal");
  EXPECT_STREQ(NumericalError("EM", "", "no convergence").what(), "EM: no convergence");
}

TEST(OutputError, NamesThePath) {
  EXPECT_STREQ(OutputError("out/a.nav", "No space left on device").what(),
               "out/a.nav: cannot be written: No space left on device");
}

}  // namespace
}  // namespace coast
