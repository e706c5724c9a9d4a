// RINEX as receivers and programs write it, and as they spoil it.

#include "coast/io/rinex.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/files.hpp"

namespace coast {
namespace {

using record::Observation;
using record::Satellite;
using record::SatelliteSystem;
using record::Signal;

std::string header_line(const std::string& text, const std::string& label) {
  return fmt::format("{:<60}{:<20}\n", text, label);
}

const std::string kEnd = header_line("", "END OF HEADER");

std::string header3(const std::string& version = "3.04") {
  return header_line(fmt::format("{:>9}           OBSERVATION DATA    M", version), "RINEX VERSION / TYPE") +
         header_line("rover", "MARKER NAME") + header_line("1                   TRM29659.00     SCIT", "ANT # / TYPE") +
         header_line("  3582105.2910   532589.7313  5232754.8054", "APPROX POSITION XYZ") +
         header_line("        1.5000        0.2000        0.1000", "ANTENNA: DELTA H/E/N") +
         header_line("G    5 C1C L1C D1C S1C L2W", "SYS / # / OBS TYPES") +
         header_line("R    2 C1C L1C", "SYS / # / OBS TYPES") + header_line("  1 R07  5", "GLONASS SLOT / FRQ #") +
         header_line("  2021     9    22     6    30    0.0000000     GPS", "TIME OF FIRST OBS");
}

std::string epoch3(const std::string& second, int satellites, char flag = '0') {
  return fmt::format("> 2021 09 22 06 30 {:>10}  {}{:3}\n", second, flag, satellites);
}

const std::string kG05 = "G05  21243381.127 7 111634716.53717     -1476.856          46.813    86988086.04926\n";
const std::string kR07 = "R07  20000000.000   106931001.500\n";

TEST(RinexObservation, Version3) {
  const test::Files files;
  files.put("a.obs", header3() + kEnd + epoch3("0.0000000", 2) + kR07 + kG05 + epoch3("1.0000000", 1) + kG05);
  const auto recording = io::read_observations(files.path("a.obs"));
  EXPECT_TRUE(recording.events.empty());
  EXPECT_EQ(recording.marker, "rover");
  EXPECT_EQ(recording.antenna, "TRM29659.00     SCIT");
  EXPECT_EQ(recording.approximate_r_e->x(), 3582105.2910);
  EXPECT_EQ(recording.antenna_offset_enu, Eigen::Vector3d(0.2, 0.1, 1.5));
  EXPECT_EQ(recording.glonass_channels.at(7), 5);
  ASSERT_EQ(recording.epochs.size(), 2U);
  EXPECT_EQ(geo::to_string(recording.epochs[0].t), "2021-09-22 06:30:00.000 GPST");
  const auto& seen = recording.epochs[0].observations;  // by satellite, then by signal
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].satellite, (Satellite{SatelliteSystem::kGps, 5}));
  EXPECT_EQ(seen[0].signal, (Signal{'1', 'C'}));
  EXPECT_EQ(seen[0].code_m, 21243381.127);
  EXPECT_EQ(seen[0].phase_cycles, 111634716.537);
  EXPECT_EQ(seen[0].doppler_hz, -1476.856);
  EXPECT_EQ(seen[0].cn0_dbhz, 46.813);
  EXPECT_TRUE(seen[0].lost_lock);
  EXPECT_FALSE(seen[0].half_cycle);
  EXPECT_EQ(seen[1].signal, (Signal{'2', 'W'}));
  EXPECT_TRUE(seen[1].half_cycle);
  EXPECT_FALSE(seen[1].code_m);
  EXPECT_EQ(to_string(seen[2].satellite), "R07");
}

TEST(RinexObservation, Version2WithMoreThanTwelveSatellitesAndSixTypes) {
  std::string header = header_line("     2.11           OBSERVATION DATA    G (GPS)", "RINEX VERSION / TYPE") +
                       header_line("     6    L1    L2    C1    P2    D1    S1", "# / TYPES OF OBSERV") + kEnd;
  std::string epoch = " 99 12 31 23 59 59.0000000  0 13";
  for (int i = 1; i <= 12; ++i) epoch += fmt::format("G{:2}", i);
  epoch += "\n" + std::string(32, ' ') + "G30\n";
  std::string rows;
  for (int i = 0; i < 13; ++i)
    rows += fmt::format("{:14.3f}  {:14.3f} 4{:14.3f}  {:14.3f}  {:14.3f}  \n{:14.3f}  \n", 1e8 + i, 8e7 + i, 2e7 + i,
                        2e7 + 10 + i, -100.0, 45.0);
  const test::Files files;
  files.put("a.99o", header + epoch + rows);
  const auto recording = io::read_observations(files.path("a.99o"));
  ASSERT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(geo::to_string(recording.epochs[0].t), "1999-12-31 23:59:59.000 GPST");
  ASSERT_EQ(recording.epochs[0].observations.size(), 26U);
  const Observation& first = recording.epochs[0].observations[24];  // of the last satellite
  EXPECT_EQ(first.satellite.number, 30);
  EXPECT_EQ(first.signal, (Signal{'1', 'C'}));
  EXPECT_EQ(first.phase_cycles, 1e8 + 12);
  EXPECT_EQ(first.code_m, 2e7 + 12);
  EXPECT_EQ(first.doppler_hz, -100.0);
  EXPECT_EQ(first.cn0_dbhz, 45.0);
  const Observation& second = recording.epochs[0].observations[25];
  EXPECT_EQ(second.signal, (Signal{'2', 'W'}));
  EXPECT_EQ(second.phase_cycles, 8e7 + 12);
  EXPECT_EQ(second.code_m, 2e7 + 22);
}

TEST(RinexObservation, TimesOfOtherSystemsBecomeGpsTime) {
  const test::Files files;
  std::string utc = header3();
  utc.replace(utc.find(" GPS  "), 6, " GLO  ");
  files.put("a.obs", utc + kEnd + epoch3("0.0000000", 1) + kG05);
  EXPECT_EQ(geo::to_string(io::read_observations(files.path("a.obs")).epochs[0].t), "2021-09-22 06:30:18.000 GPST");
  std::string bdt = header3();
  bdt.replace(bdt.find(" GPS  "), 6, " BDT  ");
  files.put("b.obs", bdt + kEnd + epoch3("0.0000000", 1) + kG05);
  EXPECT_EQ(geo::to_string(io::read_observations(files.path("b.obs")).epochs[0].t), "2021-09-22 06:30:14.000 GPST");
}

TEST(RinexObservation, EventsAndPowerFailures) {
  const test::Files files;
  files.put("a.obs", header3() + kEnd + epoch3("0.0000000", 1) + kG05 + ">                              4  2\n" +
                         header_line("a new site", "MARKER NAME") + header_line("G    1 C1C", "SYS / # / OBS TYPES") +
                         epoch3("1.0000000", 1, '1') + "G05  21243381.127\n");
  const auto recording = io::read_observations(files.path("a.obs"));
  EXPECT_EQ(recording.marker, "a new site");
  ASSERT_EQ(recording.epochs.size(), 2U);
  ASSERT_EQ(recording.epochs[1].observations.size(), 1U);  // by the types of the event
  EXPECT_TRUE(recording.epochs[1].observations[0].lost_lock);
  EXPECT_EQ(test::count_of(recording.events, "rinex_event"), 1);
  EXPECT_EQ(test::count_of(recording.events, "rinex_power_failure"), 1);
}

TEST(RinexObservation, OutsideEventsAreTimeMarks) {
  const test::Files files;
  std::string utc = header3();
  utc.replace(utc.find(" GPS  "), 6, " GLO  ");
  files.put("a.obs", utc + kEnd + epoch3("0.0000000", 1) + kG05 + epoch3("0.2500001", 0, '5') + epoch3("0.7500000", 1, '5') +
                         header_line("shutter", "COMMENT") + epoch3("1.0000000", 1) + kG05 + epoch3("0.5000000", 0, '5') +
                         ">                              5  0\n" + epoch3("2.0000000", 1) + kG05);
  const auto recording = io::read_observations(files.path("a.obs"));
  EXPECT_EQ(recording.epochs.size(), 3U);
  ASSERT_EQ(recording.marks.size(), 3U);
  const geo::GpsTime start = recording.epochs[0].t;
  EXPECT_EQ(recording.marks[0].t, start + 0.2500001);
  EXPECT_EQ(recording.marks[1].t, start + 0.5);  // in the order of time
  EXPECT_EQ(recording.marks[2].t, start + 0.75);
  EXPECT_EQ(test::count_of(recording.events, "rinex_spoiled"), 1);  // an outside event without a time
  const auto marks = files.events("a.obs").marks;
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(marks[2].t, start + 0.75);
}

TEST(RinexObservation, Version2HasTimeMarksToo) {
  const test::Files files;
  const std::string epoch = " 21  9 22  6 30 {:>10}  {}{:3}{}\n";
  files.put("a.obs", header_line("     2.11           OBSERVATION DATA    G", "RINEX VERSION / TYPE") +
                         header_line("     1    C1", "# / TYPES OF OBSERV") + kEnd +
                         fmt::format(fmt::runtime(epoch), "0.0000000", 0, 1, "G05") + "  21243381.127\n" +
                         fmt::format(fmt::runtime(epoch), "0.1234567", 5, 0, "") +
                         fmt::format(fmt::runtime(epoch), "1.0000000", 0, 1, "G05") + "  21243381.127\n");
  const auto recording = io::read_observations(files.path("a.obs"));
  ASSERT_EQ(recording.epochs.size(), 2U);
  ASSERT_EQ(recording.marks.size(), 1U);
  EXPECT_EQ(recording.marks[0].t, recording.epochs[0].t + 0.1234567);
}

// RINEX 3.05, table A2: stored numbers are divided by the factor.
TEST(RinexObservation, ScaleFactorsOfTypesOverTwoLinesAndOfAWholeSystem) {
  const auto scale = [](const std::string& text) { return header_line(text, "SYS / SCALE FACTOR"); };
  const std::string factors = scale("G   10   3 L1C L2W") + scale("           D1C") + scale("R 1000");
  const test::Files files;
  files.put("a.obs", header3() + factors + kEnd + epoch3("0.0000000", 2) + kG05 + kR07 +
                         ">                              4  2\n" + scale("G    1   1 L1C") + scale("R  100   0") +
                         epoch3("1.0000000", 2) + kG05 + kR07);
  const auto recording = io::read_observations(files.path("a.obs"));
  ASSERT_EQ(recording.epochs.size(), 2U);
  const auto& seen = recording.epochs[0].observations;
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_DOUBLE_EQ(seen[0].code_m.value(), 21243381.127);
  EXPECT_DOUBLE_EQ(seen[0].phase_cycles.value(), 11163471.6537);
  EXPECT_DOUBLE_EQ(seen[0].doppler_hz.value(), -147.6856);
  EXPECT_DOUBLE_EQ(seen[0].cn0_dbhz.value(), 46.813);
  EXPECT_DOUBLE_EQ(seen[1].phase_cycles.value(), 8698808.6049);
  EXPECT_DOUBLE_EQ(seen[2].code_m.value(), 20000.0);
  EXPECT_DOUBLE_EQ(seen[2].phase_cycles.value(), 106931.0015);
  const auto& after = recording.epochs[1].observations;  // what the event does not name stays as it was
  ASSERT_EQ(after.size(), 3U);
  EXPECT_DOUBLE_EQ(after[0].phase_cycles.value(), 111634716.537);
  EXPECT_DOUBLE_EQ(after[0].doppler_hz.value(), -147.6856);
  EXPECT_DOUBLE_EQ(after[2].code_m.value(), 200000.0);
}

TEST(RinexObservation, ScaleFactorsThatAreNoneAreRefusedWithTheirLine) {
  const test::Files files;
  const auto said = [&](const std::string& first, const std::string& second = "") {
    std::string records = header_line(first, "SYS / SCALE FACTOR");
    if (!second.empty()) records += header_line(second, "SYS / SCALE FACTOR");
    files.put("x.obs", header3() + records + kEnd + epoch3("0.0000000", 1) + kG05);
    return test::refusal([&] { static_cast<void>(io::read_observations(files.path("x.obs"))); });
  };
  for (const char* record : {"G   20   1 L1C", "G    0   1 L1C", "G  -10   1 L1C", "G        1 L1C", "G  ten   1 L1C"})
    EXPECT_NE(said(record).find("expected 1, 10, 100 or 1000"), std::string::npos) << said(record);
  EXPECT_NE(said("G   20   1 L1C").find("x.obs:10: the scale factor '20'"), std::string::npos) << said("G   20   1 L1C");
  EXPECT_NE(said("G   10   x L1C").find("x.obs:10: 'x' types"), std::string::npos) << said("G   10   x L1C");
  EXPECT_NE(said("G   10   1 L1C L2W").find("more types"), std::string::npos);
  EXPECT_NE(said("G   10     L1C").find("more types"), std::string::npos);
  EXPECT_NE(said("G   10   2 L1C").find("1 types with a scale factor of G, expected the 2 announced"), std::string::npos);
  EXPECT_NE(said("G   10   2 L1C", "R   10").find("x.obs:11:"), std::string::npos);
  EXPECT_NE(said("G   10   1 L1C", "           L2W").find("x.obs:11:"), std::string::npos);
}

TEST(RinexObservation, WhatIsSpoiledIsCountedAndTheRestIsKept) {
  const test::Files files;
  files.put("a.obs", header3() + kEnd + epoch3("0.0000000", 4) + kG05 + kG05 +             // twice
                         "X99  21243381.127\n" +                                           // no satellite
                         "R07  2000z000.000   106931001.500\n" +                           // a letter in a number
                         epoch3("0.0000000", 1) + kG05 +                                   // the same time
                         epoch3("5.0000000", 1) + "G05 -21243381.127   111634716.537\n" +  // a negative range
                         epoch3("4.0000000", 1) + kG05 +                                   // back in time
                         epoch3("6.0000000", 2) + kG05);                                   // cut off
  const auto recording = io::read_observations(files.path("a.obs"));
  ASSERT_EQ(recording.epochs.size(), 2U);
  EXPECT_EQ(recording.epochs[0].observations.size(), 3U);
  EXPECT_FALSE(recording.epochs[0].observations[2].code_m);
  EXPECT_EQ(recording.epochs[0].observations[2].phase_cycles, 106931001.5);
  for (const char* kind : {"rinex_repeated_satellite", "rinex_unknown_satellite", "rinex_spoiled", "rinex_repeated_epoch",
                           "rinex_impossible", "rinex_reversed_epoch", "rinex_cut_off"})
    EXPECT_EQ(test::count_of(recording.events, kind), 1) << kind;
}

TEST(RinexObservation, RefusalsNameFileAndLine) {
  const test::Files files;
  const auto said = [&](const std::string& content) {
    files.put("x.obs", content);
    return test::refusal([&] { static_cast<void>(io::read_observations(files.path("x.obs"))); });
  };
  EXPECT_NE(said("hello\n").find("x.obs:1: 'hello', expected RINEX VERSION / TYPE"), std::string::npos) << said("hello\n");
  EXPECT_NE(said(header3("5.00") + kEnd).find("RINEX version '5.00'"), std::string::npos);
  EXPECT_NE(said(header_line("     3.04           N", "RINEX VERSION / TYPE")).find("observations"), std::string::npos);
  EXPECT_NE(said(header3()).find("END OF HEADER"), std::string::npos);
  EXPECT_NE(
      said(header_line("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE") + kEnd).find("SYS / # / OBS TYPES"),
      std::string::npos);
  EXPECT_NE(said(header3() + kEnd).find("no epoch"), std::string::npos);
  EXPECT_NE(said(header3() + kEnd + "garbage\n").find("x.obs:11: 'garbage'"), std::string::npos)
      << said(header3() + kEnd + "garbage\n");
  EXPECT_NE(said(header3() + kEnd + "> 2021 13 22 06 30  0.0000000  0  1\n").find("a date"), std::string::npos);
}

/// Hatanaka's own compression of a text, first order, for the way back: the reader shares no code with it.
std::string compact(const std::vector<std::pair<std::string, std::vector<std::vector<std::int64_t>>>>& epochs, int order) {
  std::string text = header_line("3.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE") +
                     header_line("test", "CRINEX PROG / DATE") +
                     header_line("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
                     header_line("G    2 C1C L1C", "SYS / # / OBS TYPES") + kEnd;
  // differences[satellite][type]: the last value and the last differences
  std::vector<std::vector<std::vector<std::int64_t>>> last;
  std::string before;
  for (const auto& [line, satellites] : epochs) {
    if (before.empty()) {
      text += line + "\n\n";
    } else {
      std::string difference;
      for (std::size_t i = 0; i < line.size(); ++i)
        difference += i < before.size() && line[i] == before[i] ? ' ' : line[i] == ' ' ? '&' : line[i];
      text += difference + "\n\n";
    }
    const bool first = before.empty();
    before = line;
    last.resize(satellites.size(), std::vector<std::vector<std::int64_t>>(2));
    for (std::size_t s = 0; s < satellites.size(); ++s) {
      for (std::size_t k = 0; k < 2; ++k) {
        auto& d = last[s][k];
        std::int64_t value = satellites[s][k];
        if (first) {
          d = {value};
          text += fmt::format("{}&{} ", order, value);
          continue;
        }
        std::vector<std::int64_t> now{value};
        for (std::size_t n = 0; n < d.size() && n < static_cast<std::size_t>(order); ++n) now.push_back(now[n] - d[n]);
        text += fmt::format("{} ", now.back());
        d = now;
      }
      text += first ? " 7 6\n" : "\n";
    }
  }
  return text;
}

TEST(RinexObservation, HatanakaGivesTheNumbersBack) {
  for (const int order : {1, 3, 5}) {
    std::vector<std::pair<std::string, std::vector<std::vector<std::int64_t>>>> epochs;
    for (int e = 0; e < 12; ++e)
      epochs.push_back({fmt::format("> 2021 09 22 06 30 {:10.7f}  0  2      G05G13", static_cast<double>(e)),
                        {{21243381127 - 1234 * e + 17 * e * e * e, 111634716537 + 99 * e * e},
                         {23243381127 + 777 * e, 121634716537 - 5 * e * e * e * e}}});
    const test::Files files;
    files.put_gzip("a.crx.gz", compact(epochs, order));
    const auto recording = io::read_observations(files.path("a.crx.gz"));
    ASSERT_EQ(recording.epochs.size(), 12U);
    for (std::size_t e = 0; e < 12; ++e)
      for (std::size_t s = 0; s < 2; ++s) {
        const Observation& o = recording.epochs[e].observations.at(s);
        EXPECT_NEAR(*o.code_m, static_cast<double>(epochs[e].second[s][0]) / 1000.0, 1e-6) << order << " " << e;
        EXPECT_NEAR(*o.phase_cycles, static_cast<double>(epochs[e].second[s][1]) / 1000.0, 1e-6);
      }
    EXPECT_EQ(recording.epochs[11].t - recording.epochs[0].t, 11.0);
  }
}

TEST(RinexObservation, SpoiledCompactFilesAreRefusedWithTheirLine) {
  const test::Files files;
  std::vector<std::pair<std::string, std::vector<std::vector<std::int64_t>>>> epochs{
      {"> 2021 09 22 06 30  0.0000000  0  1      G05", {{21243381127, 111634716537}}}};
  std::string text = compact(epochs, 3);
  const auto said = [&](const std::string& content) {
    files.put("x.crx", content);
    return test::refusal([&] { static_cast<void>(io::read_observations(files.path("x.crx"))); });
  };
  EXPECT_EQ(said(text), "");
  std::string spoiled = text;
  spoiled.replace(spoiled.find("3&212"), 5, "x&212");
  EXPECT_NE(said(spoiled).find("x.crx:8: 'x&21243381127', expected an order of differences"), std::string::npos)
      << said(spoiled);
  spoiled = text;
  spoiled.replace(spoiled.find("3&212"), 5, "21212");
  EXPECT_NE(said(spoiled).find("a number that a series begins with"), std::string::npos);
  spoiled = text;
  spoiled.replace(spoiled.find("G05"), 3, "Z05");
  EXPECT_NE(said(spoiled).find("a satellite Z05"), std::string::npos);
}

TEST(RinexNavigation, EveryVersionGivesTheSameEphemeris) {
  // G06 of a real message, by hand in the three layouts.
  const std::vector<std::string> rows{" 5.600000000000D+01 6.631250000000D+01 3.800515449581D-09-2.847044012525D+00",
                                      " 3.425404429436D-06 2.182067371905D-03 1.028738915920D-05 5.153581537247D+03",
                                      " 2.664000000000D+05 3.539025783539D-08 7.091293711361D-01-3.166496753693D-08",
                                      " 9.850275519513D-01 1.970937500000D+02-1.013858938951D+00-7.659961925303D-09",
                                      " 3.478716331070D-10 1.000000000000D+00 2.176000000000D+03 0.000000000000D+00",
                                      " 2.000000000000D+00 0.000000000000D+00 3.725290298462D-09 5.600000000000D+01",
                                      " 2.641980000000D+05 4.000000000000D+00"};
  const std::string clock = " 7.914518937469D-05 7.503331289627D-12 0.000000000000D+00";
  const auto indented = [&](std::size_t by) {
    std::string text;
    for (const std::string& row : rows) text += std::string(by, ' ') + row + "\n";
    return text;
  };
  const test::Files files;
  files.put("a.21n", header_line("     2.11           NAVIGATION DATA", "RINEX VERSION / TYPE") +
                         header_line("    0.8382D-08  0.1490D-07 -0.5960D-07 -0.5960D-07", "ION ALPHA") + kEnd +
                         " 6 21  9 22  2  0  0.0" + clock + "\n" + indented(3));
  files.put("b.rnx", header_line("     3.04           N: GNSS NAV DATA    M: MIXED", "RINEX VERSION / TYPE") +
                         header_line("GPSA   8.3820E-09  1.4900E-08 -5.9600E-08 -5.9600E-08", "IONOSPHERIC CORR") + kEnd +
                         "G06 2021 09 22 02 00 00" + clock + "\n" + indented(4));
  files.put("c.rnx", header_line("     4.00           NAVIGATION DATA     M", "RINEX VERSION / TYPE") + kEnd +
                         "> STO G06 LNAV\n    2021 09 22 02 00 00 GPUT\n     0.0\n> EPH G06 CNAV\n    1 2 3\n> EPH G06 LNAV\n" +
                         "G06 2021 09 22 02 00 00" + clock + "\n" + indented(4) +
                         "> ION G06 LNAV\n    2021 09 22 02 00 00 8.382000000000E-09 1.490000000000E-08-5.960000000000E-08\n" +
                         "    -5.960000000000E-08 0.000000000000E+00 0.000000000000E+00 0.000000000000E+00\n" +
                         "     0.000000000000E+00 0.000000000000E+00\n");
  for (const char* name : {"a.21n", "b.rnx", "c.rnx"}) {
    const auto navigation = io::read_navigation(files.path(name));
    ASSERT_EQ(navigation.kepler.size(), 1U) << name;
    const auto& e = navigation.kepler[0];
    EXPECT_EQ(to_string(e.satellite), "G06");
    EXPECT_EQ(geo::to_string(e.toc), "2021-09-22 02:00:00.000 GPST");
    EXPECT_EQ(e.toe, geo::GpsTime::from_week(2176, 266400.0));
    EXPECT_EQ(e.clock[0], 7.914518937469e-05);
    EXPECT_EQ(e.issue, 56);
    EXPECT_EQ(e.sqrt_a, 5153.581537247);
    EXPECT_EQ(e.inclination_rate, 3.478716331070e-10);
    EXPECT_EQ(e.accuracy_m, 2.0);
    EXPECT_EQ(e.group_delay[0], 3.725290298462e-09);
    ASSERT_TRUE(navigation.gps_ionosphere) << name;
    EXPECT_EQ(navigation.gps_ionosphere->alpha[0], 8.382e-09);
    EXPECT_EQ(navigation.gps_ionosphere->alpha[3], -5.96e-08);
  }
}

TEST(RinexNavigation, GlonassIsInUtcAndInKilometres) {
  const test::Files files;
  files.put("a.rnx", header_line("     3.05           NAVIGATION DATA     MIXED", "RINEX VERSION / TYPE") + kEnd +
                         "R01 2020 06 25 00 15 00 1.000000000000e-05 1.818989403546e-12 3.456000000000e+05\n"
                         "     1.000000000000e+04 1.000000000000e+00 0.000000000000e+00 0.000000000000e+00\n"
                         "    -1.200000000000e+04-2.000000000000e+00 0.000000000000e+00 1.000000000000e+00\n"
                         "     2.000000000000e+04 3.000000000000e+00-2.793967723846e-09 0.000000000000e+00\n");
  const auto navigation = io::read_navigation(files.path("a.rnx"));
  ASSERT_EQ(navigation.tabulated.size(), 1U);
  const auto& e = navigation.tabulated[0];
  EXPECT_EQ(geo::to_string(e.t), "2020-06-25 00:15:18.000 GPST");
  EXPECT_EQ(e.r_e, Eigen::Vector3d(1e7, -1.2e7, 2e7));
  EXPECT_EQ(e.v_e, Eigen::Vector3d(1e3, -2e3, 3e3));
  EXPECT_NEAR(e.a_e.z(), -2.793967723846e-06, 1e-18);
  EXPECT_EQ(e.channel, 1);
}

TEST(RinexNavigation, RefusesWhatHoldsNothing) {
  const test::Files files;
  const auto said = [&](const std::string& content) {
    files.put("x.nav", content);
    return test::refusal([&] { static_cast<void>(io::read_navigation(files.path("x.nav"))); });
  };
  const std::string header = header_line("     3.04           N: GNSS NAV DATA    M: MIXED", "RINEX VERSION / TYPE");
  EXPECT_NE(said("1 2 3\n").find("x.nav:1"), std::string::npos);
  EXPECT_NE(said(header3() + kEnd).find("navigation messages"), std::string::npos);
  EXPECT_NE(said(header).find("END OF HEADER"), std::string::npos);
  EXPECT_NE(said(header + kEnd).find("no ephemeris"), std::string::npos);
  EXPECT_NE(said(header + kEnd + "G06 2021 09 22 02 00 00 1.0\n     1.0\n").find("no ephemeris"), std::string::npos);
}

}  // namespace
}  // namespace coast
