#include "outage/outage_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace coast::jobs {
namespace {

using Fields = std::vector<std::string>;

Fields fields_of(const std::string& line) {
  Fields fields(1);
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

std::string line_of(const Fields& fields) {
  return fmt::format("{}", fmt::join(fields, ","));
}

/// Any finite number, of any size.
double any_number(std::mt19937_64& random) {
  for (;;) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

study::OutageErrors any_errors(std::mt19937_64& random) {
  study::OutageErrors errors;
  for (Eigen::Vector3d* v :
       {&errors.max_m, &errors.rms_m, &errors.end_m, &errors.sigma_end_m, &errors.sigma_max_m, &errors.attitude_max})
    for (double& value : *v) value = any_number(random);
  errors.horizontal_max_m = any_number(random);
  errors.inside_95 = random() % 100000;
  errors.tested = random() % 100000;
  if (random() % 2 == 0) errors.gnss_horizontal_max_m = any_number(random);
  return errors;
}

study::OutageResult any_result(std::mt19937_64& random) {
  study::OutageResult result;
  result.manoeuvre = static_cast<study::Manoeuvre>(random() % 4);
  result.forward = any_errors(random);
  result.smoothed = any_errors(random);
  return result;
}

/// Every number of a solution, bit by bit.
std::vector<std::uint64_t> bits_of(const study::OutageErrors& errors) {
  std::vector<std::uint64_t> bits{errors.inside_95, errors.tested, errors.gnss_horizontal_max_m.has_value()};
  const auto add = [&bits](double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const Eigen::Vector3d* v :
       {&errors.max_m, &errors.rms_m, &errors.end_m, &errors.sigma_end_m, &errors.sigma_max_m, &errors.attitude_max})
    for (const double value : *v) add(value);
  add(errors.horizontal_max_m);
  add(errors.gnss_horizontal_max_m.value_or(0.0));
  return bits;
}

void expect_same(const study::OutageResult& a, const study::OutageResult& b) {
  EXPECT_EQ(a.manoeuvre, b.manoeuvre);
  EXPECT_EQ(bits_of(a.forward), bits_of(b.forward));
  EXPECT_EQ(bits_of(*a.smoothed), bits_of(*b.smoothed));
}

TEST(OutageTable, ComesBackBitByBit) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const study::OutageResult result = any_result(random);
    const auto back = outage_from(outage_values(result));
    ASSERT_TRUE(back.has_value()) << outage_values(result);
    ASSERT_TRUE(back->smoothed.has_value());
    expect_same(*back, result);
  }
}

TEST(OutageTable, KeepsTheEdgesOfNumbers) {
  std::mt19937_64 random(4);
  using Limits = std::numeric_limits<double>;
  for (const double edge :
       {0.0, -0.0, 0.1 + 0.2, 1e15, -1e-7, Limits::min(), Limits::denorm_min(), Limits::max(), Limits::lowest()}) {
    study::OutageResult result = any_result(random);
    result.forward.end_m.x() = edge;
    result.smoothed->gnss_horizontal_max_m = edge;
    const auto back = outage_from(outage_values(result));
    ASSERT_TRUE(back.has_value()) << edge;
    expect_same(*back, result);
  }
}

TEST(OutageTable, HasAColumnForEveryValue) {
  std::mt19937_64 random(5);
  study::OutageResult result = any_result(random);
  result.manoeuvre = study::Manoeuvre::kTurn;
  result.forward.gnss_horizontal_max_m.reset();
  result.forward.sigma_end_m.y() = 0.25;
  result.smoothed->attitude_max.z() = -0.5;
  const Fields names = fields_of(outage_columns());
  const Fields values = fields_of(outage_values(result));
  ASSERT_EQ(names.size(), values.size());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  const auto value = [&](const char* name) {
    return values[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
  };
  EXPECT_EQ(value("manoeuvre"), "turn");
  EXPECT_EQ(value("forward_sigma_end_e_m"), "0.25");
  EXPECT_EQ(value("smoothed_attitude_max_yaw_rad"), "-0.5");
  EXPECT_EQ(value("forward_tested"), fmt::format("{}", result.forward.tested));
  EXPECT_EQ(value("forward_gnss_horizontal_max_m"), "");
  EXPECT_EQ(value("smoothed_horizontal_max_m"), fmt::format("{}", result.smoothed->horizontal_max_m));
}

TEST(OutageTable, WithoutASmoothedSolutionIsOneOfZeros) {
  study::OutageResult result;
  result.forward.horizontal_max_m = 3.0;
  const auto back = outage_from(outage_values(result));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->forward.horizontal_max_m, 3.0);
  EXPECT_EQ(back->smoothed->horizontal_max_m, 0.0);
}

TEST(OutageTable, OfGarbageIsNothing) {
  std::mt19937_64 random(6);
  study::OutageResult result = any_result(random);
  result.forward.gnss_horizontal_max_m = 1.0;
  result.smoothed->gnss_horizontal_max_m = 2.0;
  const std::string line = outage_values(result);
  const Fields good = fields_of(line);
  const Fields names = fields_of(outage_columns());
  ASSERT_TRUE(outage_from(line).has_value());
  for (std::size_t i = 0; i < good.size(); ++i) {
    Fields missing = good;
    missing.erase(missing.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(outage_from(line_of(missing)).has_value()) << names[i];
    Fields more = good;
    more.insert(more.begin() + static_cast<std::ptrdiff_t>(i), "1");
    EXPECT_FALSE(outage_from(line_of(more)).has_value()) << names[i];
    for (const char* spoiled : {"", "x", "1x", "nan", "inf", "-inf", "1e999", " 1", "1 ", "+1", "0x10", "1;2", "\"1\""}) {
      if (*spoiled == '\0' && names[i].ends_with("gnss_horizontal_max_m")) continue;  // no fix in that outage
      Fields other = good;
      other[i] = spoiled;
      EXPECT_FALSE(outage_from(line_of(other)).has_value()) << names[i] << " " << spoiled;
    }
    if (!names[i].ends_with("_tested") && !names[i].ends_with("_inside_95")) continue;
    for (const char* spoiled : {"-1", "1.5", "1e300"}) {
      Fields other = good;
      other[i] = spoiled;
      EXPECT_FALSE(outage_from(line_of(other)).has_value()) << names[i] << " " << spoiled;
    }
  }
  for (const char* whole : {"", ",", "turn", "Turn", "turn,", "\n"}) EXPECT_FALSE(outage_from(whole).has_value()) << whole;
  for (const char* behind : {",", ",1", "\n", "\r", " "}) EXPECT_FALSE(outage_from(line + behind).has_value());
  for (std::size_t length = 0; length < line.size(); ++length) {
    const auto cut = outage_from(line.substr(0, length));
    // All that a line may lose unseen is the end of its last number; a journal's has a line's end behind it.
    EXPECT_TRUE(!cut || length >= line.rfind(',') + 1) << length;
  }
}

// Bytes changed, put in and taken out at random: nothing, or a result that a line stands for.
TEST(OutageTable, SurvivesRandomDamage) {
  std::mt19937_64 random(7);
  using namespace std::string_literals;
  const std::string alphabet = "0123456789.,-+einfax\"\n\0 \xff"s;
  for (int i = 0; i < 10000; ++i) {
    std::string line = outage_values(any_result(random));
    for (std::size_t k = 1 + random() % 3; k > 0; --k) {
      const std::size_t at = random() % line.size();
      const char byte = alphabet[random() % alphabet.size()];
      if (random() % 3 == 0)
        line.erase(at, 1);
      else if (random() % 2 == 0)
        line.insert(line.begin() + static_cast<std::ptrdiff_t>(at), byte);
      else
        line[at] = byte;
    }
    const auto result = outage_from(line);
    if (!result) continue;
    const auto back = outage_from(outage_values(*result));
    ASSERT_TRUE(back.has_value()) << line;
    expect_same(*back, *result);
  }
}

}  // namespace
}  // namespace coast::jobs
