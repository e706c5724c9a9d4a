#include "coast/io/writers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../../src/io/text_buffer.hpp"
#include "coast/geo/earth.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using test::Files;

std::string fixed(double value, int decimals, int width = 0) {
  const Files files;
  AtomicFile file(files.path("t"));
  TextBuffer text(file);
  text.put_fixed(value, decimals, width);
  text.flush();
  file.commit();
  return files.get("t");
}

TEST(TextBuffer, FixedDecimalsAgreeWithFmt) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  const Files files;
  AtomicFile file(files.path("t"));
  TextBuffer text(file);
  std::string expected;
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(generator) * std::pow(10.0, i % 6);
    const int decimals = i % 10;
    text.put_fixed(value, decimals);
    text.end_line();
    expected += fmt::format("{:.{}f}\n", value, decimals);
  }
  text.flush();
  file.commit();
  // Scaling rounds once more than fmt does: a last digit may differ where the value lies within 1e-16 of a tie, and "-0" is
  // "0".
  std::istringstream a(files.get("t")), b(expected);
  std::string line_a, line_b;
  int differences = 0;
  while (std::getline(a, line_a) && std::getline(b, line_b)) {
    if (line_a == line_b) continue;
    EXPECT_NEAR(std::stod(line_a), std::stod(line_b),
                1.01 * std::pow(10.0, -static_cast<double>(line_a.size() - line_a.find('.') - 1)));
    if (std::stod(line_b) != 0.0) ++differences;
  }
  EXPECT_LE(differences, 2);
}

TEST(TextBuffer, SignsWidthsAndWhatCannotBeWritten) {
  EXPECT_EQ(fixed(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(fixed(9.9996, 3), "10.000");
  EXPECT_EQ(fixed(2.5, 1, 8), "     2.5");
  EXPECT_EQ(fixed(-12.0, 0), "-12");
  EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 3), "nan");
  EXPECT_EQ(fixed(1e18, 3), "nan");
}

TEST(AtomicFile, AppearsWholeOrNotAtAll) {
  const Files files;
  {
    AtomicFile file(files.path("a.txt"));
    file.write("half");
    EXPECT_FALSE(std::filesystem::exists(files.path("a.txt")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(files.path("")));  // nothing is left behind
  write_text(files.path("a.txt"), "first");
  {
    AtomicFile file(files.path("a.txt"));
    file.write("second");
    EXPECT_EQ(files.get("a.txt"), "first");
    file.commit();
  }
  EXPECT_EQ(files.get("a.txt"), "second");
}

std::string failure(const std::function<void()>& call) {
  try {
    call();
  } catch (const OutputError& e) {
    return e.what();
  }
  return "";
}

TEST(AtomicFile, NamesThePathThatCannotBeWritten) {
  const Files files;
  EXPECT_NE(
      failure([&] { write_text(files.path("no/such/a.txt"), "x"); }).find("no/such/a.txt: cannot be written: No such file"),
      std::string::npos);
  EXPECT_NE(failure([&] { write_text(files.path(""), "x"); }).find("is a directory"), std::string::npos);
  files.put("file", "");
  EXPECT_NE(failure([&] { write_text(files.path("file/a.txt"), "x"); }).find("Not a directory"), std::string::npos);
}

TEST(AtomicFile, FullDiskIsSeen) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_NE(failure([] { write_text("/dev/full", "x"); }).find("/dev/full: cannot be written: No space left"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));  // written directly, never replaced
  const auto nav = make_nav_writer("/dev/full");
  EXPECT_NE(failure([&] {
              record::TrajectoryEpoch epoch;
              epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.7, 0.1, 0.0});
              for (int i = 0; i < 5000; ++i) nav->write(epoch);
            }).find("No space left"),
            std::string::npos);
}

TEST(Kml, ThinsTheLineAndKeepsItsEnds) {
  const Files files;
  const auto kml = make_kml_writer(files.path("a.kml"), "drive <1> & back", 1.0);
  for (int i = 0; i <= 100; ++i) {
    record::TrajectoryEpoch epoch;
    epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.0, 1e-8 * i, 5.0});  // steps of 6.4 cm
    kml->write(epoch);
  }
  kml->close();
  const std::string text = files.get("a.kml");
  EXPECT_NE(text.find("<name>drive &lt;1&gt; &amp; back</name>"), std::string::npos);
  const auto points = std::count(text.begin(), text.end(), ',') / 2;
  EXPECT_GE(points, 6);  // 6.38 m in steps of at least 1 m, with both ends
  EXPECT_LE(points, 8);
  EXPECT_NE(text.find("\n0.00000000,0.00000000,5.000\n"), std::string::npos);
  EXPECT_NE(text.find("\n0.00005730,0.00000000,5.000\n"), std::string::npos);  // 1e-6 rad
  EXPECT_EQ(text.substr(text.size() - 7), "</kml>\n");
}

TEST(Writers, EveryFormatByName) {
  const Files files;
  for (const auto name : trajectory_formats()) {
    const auto writer = make_trajectory_writer(name, files.path("trajectory"));
    record::TrajectoryEpoch epoch;
    epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.7, 0.1, 0.0});
    epoch.nav.t = geo::GpsTime::from_week(2300, 10.0);
    writer->write(epoch);
    writer->close();
    EXPECT_GT(std::filesystem::file_size(files.path(fmt::format("trajectory.{}", name))), 100U) << name;
  }
  EXPECT_THROW((void)make_trajectory_writer("xls", files.path("t")), std::invalid_argument);
}

}  // namespace
}  // namespace coast::io
