#include "coast/io/writers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "../../src/io/text_buffer.hpp"
#include "coast/geo/earth.hpp"
#include "coast/io/projection.hpp"
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
  const auto nav = trajectory_format("nav").make("/dev/full", {});
  EXPECT_NE(failure([&] {
              record::TrajectoryEpoch epoch;
              epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.7, 0.1, 0.0});
              for (int i = 0; i < 5000; ++i) nav->write(epoch);
            }).find("No space left"),
            std::string::npos);
}

long occurrences(const std::string& text, std::string_view word) {
  long count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++count;
  return count;
}

TEST(Kml, ThinsTheTrackAndKeepsItsEnds) {
  const Files files;
  const auto kml = trajectory_format("kml").make(files.path("drive <1> & back.kml"), {});
  for (int i = 0; i <= 100; ++i) {
    record::TrajectoryEpoch epoch;
    epoch.nav.t = geo::GpsTime::from_week(2374, 243258.499 + 0.01 * i);
    epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.0, 1e-8 * i, 5.0});  // steps of 6.4 cm
    kml->write(epoch);
  }
  kml->close();
  const std::string text = files.get("drive <1> & back.kml");
  EXPECT_NE(text.find("<name>drive &lt;1&gt; &amp; back</name>"), std::string::npos);
  const long points = occurrences(text, "<gx:coord>");
  EXPECT_GE(points, 6);  // 6.38 m in steps of at least 1 m, with both ends
  EXPECT_LE(points, 8);
  EXPECT_EQ(occurrences(text, "<when>"), points);
  EXPECT_NE(text.find("<gx:coord>0.00000000 0.00000000 5.000</gx:coord>"), std::string::npos);
  EXPECT_NE(text.find("<gx:coord>0.00005730 0.00000000 5.000</gx:coord>"), std::string::npos);  // 1e-6 rad
  EXPECT_NE(text.find("<when>2025-07-08T19:34:00.499Z</when>"), std::string::npos) << text;     // 18 s before GPS time
  EXPECT_EQ(text.substr(text.size() - 7), "</kml>\n");
}

TEST(Kml, HeightsAreAboveTheGeoidOrNotUsed) {
  const Files files;
  for (const bool known : {true, false}) {
    const auto kml = trajectory_format("kml").make(files.path("a.kml"), {known ? std::optional<double>(48.25) : std::nullopt});
    record::TrajectoryEpoch epoch;
    epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.7, 0.1, 500.0});
    kml->write(epoch);
    kml->close();
    const std::string text = files.get("a.kml");
    EXPECT_NE(text.find(known ? " 451.750</gx:coord>" : " 500.000</gx:coord>"), std::string::npos) << text;
    EXPECT_NE(text.find(known ? "<altitudeMode>absolute<" : "<altitudeMode>clampToGround<"), std::string::npos) << text;
    EXPECT_NE(text.find(known ? "above mean sea level" : "above the WGS 84 ellipsoid"), std::string::npos) << text;
  }
}

/// Fixed for two seconds, without GNSS for two, float from then on.
std::vector<record::TrajectoryEpoch> of_changing_quality() {
  std::vector<record::TrajectoryEpoch> epochs;
  for (int i = 0; i < 6; ++i) {
    record::TrajectoryEpoch epoch;
    epoch.nav.t = geo::GpsTime::from_week(2374, 100.0 + i);
    epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.7, 0.1 + 1e-6 * i, 500.0});
    epoch.cov = {1e-4 * Eigen::Matrix3d::Identity(), 1e-4 * Eigen::Matrix3d::Identity(), 1e-6 * Eigen::Matrix3d::Identity()};
    if (i < 2) epoch.gnss = record::GnssSupport{record::FixQuality::kFixed, 14, 1.5, 12.0};
    if (i > 3) epoch.gnss = record::GnssSupport{record::FixQuality::kFloat, {}, {}, {}};
    epochs.push_back(epoch);
  }
  return epochs;
}

TEST(Kml, EachStretchOfAQualityIsATrackInItsColourAndNoneIsApartFromTheNext) {
  const Files files;
  const auto kml = trajectory_format("kml").make(files.path("a.kml"), {});
  for (const auto& epoch : of_changing_quality()) kml->write(epoch);
  kml->close();
  const std::string text = files.get("a.kml");
  EXPECT_EQ(occurrences(text, "<Placemark>"), 3);
  const auto fixed = text.find("<styleUrl>#fixed<"), without = text.find("<styleUrl>#without-gnss<"),
             floating = text.find("<styleUrl>#float<");
  EXPECT_TRUE(fixed < without && without < floating && floating != std::string::npos) << text;
  EXPECT_EQ(occurrences(text, "<gx:coord>"), 6 + 2);  // where one ends the next begins
}

TEST(Pos, SaysWhatIsKnownOfGnssAndWhereThereWasNone) {
  const Files files;
  const auto pos = trajectory_format("pos").make(files.path("a.pos"), {});
  for (const auto& epoch : of_changing_quality()) pos->write(epoch);
  pos->close();
  std::istringstream lines(files.get("a.pos"));
  std::string line;
  std::getline(lines, line);
  std::vector<std::array<double, 4>> seen;  // Q, ns, age, ratio
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::vector<std::string> columns{std::istream_iterator<std::string>(words), {}};
    ASSERT_EQ(columns.size(), 24U);
    seen.push_back({std::stod(columns[5]), std::stod(columns[6]), std::stod(columns[13]), std::stod(columns[14])});
  }
  const std::array<double, 4> fixed{1, 14, 1.5, 12}, none{7, 0, 0, 0}, floating{2, 0, 0, 0};
  EXPECT_EQ(seen, (std::vector<std::array<double, 4>>{fixed, fixed, none, none, floating, floating}));
}

TEST(Writers, EveryFormatByName) {
  const Files files;
  for (const TrajectoryFormat& format : trajectory_formats()) {
    WriterOptions options;
    if (format.projected) {
      EXPECT_THROW(static_cast<void>(format.make(files.path("unprojected"), options)), std::invalid_argument);
      options.projection = std::make_shared<Projection>(ProjectionOptions{"EPSG:32631"});
    }
    const auto writer = format.make(files.path(fmt::format("trajectory.{}", format.name)), options);
    record::TrajectoryEpoch epoch;
    epoch.nav.r_eb_e = geo::ecef_from_geodetic({0.7, 0.1, 0.0});
    epoch.nav.t = geo::GpsTime::from_week(2300, 10.0);
    writer->write(epoch);
    writer->close();
    EXPECT_GT(std::filesystem::file_size(files.path(fmt::format("trajectory.{}", format.name))), 100U) << format.name;
    if (!format.companion.empty()) {
      EXPECT_TRUE(std::filesystem::exists(files.path(fmt::format("trajectory.{}", format.companion)))) << format.name;
    }
  }
  EXPECT_THROW((void)trajectory_format("xls"), std::invalid_argument);
}

}  // namespace
}  // namespace coast::io
