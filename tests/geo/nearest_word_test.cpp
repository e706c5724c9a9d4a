#include "coast/geo/nearest_word.hpp"

#include <gtest/gtest.h>

namespace coast::geo {
namespace {

TEST(EditDistance, TextbookPairs) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("same", "same"), 0U);
  EXPECT_EQ(edit_distance("form", "from"), 1U);  // a swap of neighbours counts once
  EXPECT_EQ(edit_distance("ca", "abc"), 3U);     // optimal string alignment, not full Damerau-Levenshtein (2)
}

TEST(NearestWord, NamesWhatWasMeant) {
  const std::vector<std::string> known = {"file", "format", "gps_week", "lever_arm_m"};
  EXPECT_EQ(nearest_word("fromat", known), "format");
  EXPECT_EQ(nearest_word("lever_arm", known), "lever_arm_m");
  EXPECT_EQ(nearest_word("week", known), "");  // four insertions are more than half of four letters
  EXPECT_EQ(nearest_word("temperature", known), "");
  EXPECT_EQ(nearest_word("fil", {}), "");
}

}  // namespace
}  // namespace coast::geo
