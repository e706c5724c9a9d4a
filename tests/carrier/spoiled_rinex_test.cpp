// RINEX files spoiled in many ways, through the readers and the solver: refused with the file's name, or repaired and counted,
// and what comes out is still right. No crash, no hang, nothing that is not finite.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "coast/io/input.hpp"
#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "simulated.hpp"
#include "support/support.hpp"

namespace coast::carrier {
namespace {

namespace fs = std::filesystem;

struct SpoiledFile {
  std::string what;
  std::string file;  ///< "rover.obs", "base.obs" or "brdc.nav"
  std::function<std::string(std::string)> spoil;
  bool refused = false;  ///< must be; else it may be either
};

std::string replaced(std::string text, const std::string& from, const std::string& to, std::size_t after = 0) {
  const auto at = text.find(from, after);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}
std::string without_line(const std::string& text, const std::string& containing) {
  const auto at = text.find(containing);
  EXPECT_NE(at, std::string::npos) << containing;
  const auto begin = text.rfind('\n', at) + 1;
  return text.substr(0, begin) + text.substr(text.find('\n', at) + 1);
}
/// The n-th line that begins so (from 0), replaced by what `with` makes of it.
std::string with_line(const std::string& text, const std::string& start, int n,
                      const std::function<std::string(std::string)>& with) {
  std::size_t at = text.find("END OF HEADER");
  for (int i = 0; i <= n; ++i) at = text.find("\n" + start, at + 1);
  EXPECT_NE(at, std::string::npos) << start;
  const auto end = text.find('\n', at + 1);
  return text.substr(0, at + 1) + with(text.substr(at + 1, end - at - 1)) + text.substr(end);
}
std::string put(std::string line, std::size_t at, const std::string& text) {
  line.resize(std::max(line.size(), at + text.size()), ' ');
  return line.replace(at, text.size(), text);
}

void add_truncations(std::vector<SpoiledFile>& all) {
  for (const char* file : {"rover.obs", "base.obs", "brdc.nav"})
    for (const double share : {0.0, 0.001, 0.01, 0.5, 0.9999})
      all.push_back({fmt::format("cut off at {}", share), file,
                     [share](const std::string& text) {
                       return text.substr(0, static_cast<std::size_t>(share * static_cast<double>(text.size())));
                     },
                     share < 0.005});
}

void add_headers(std::vector<SpoiledFile>& all) {
  const auto version = [&](const char* to) {
    for (const char* file : {"rover.obs", "brdc.nav"})
      all.push_back(
          {std::string("version ") + to, file, [to](const std::string& text) { return replaced(text, "3.05", to); }, true});
  };
  for (const char* to : {"9.99", "x.yz", "    ", "1.00"}) version(to);
  for (const char* label : {"END OF HEADER", "RINEX VERSION / TYPE"})
    all.push_back({std::string("without ") + label, "rover.obs",
                   [label](const std::string& text) { return without_line(text, label); }, true});
  for (const char* label :
       {"SYS / # / OBS TYPES", "APPROX POSITION XYZ", "ANTENNA: DELTA H/E/N", "MARKER NAME", "TIME OF FIRST OBS"})
    all.push_back(
        {std::string("without ") + label, "rover.obs", [label](const std::string& text) { return without_line(text, label); }});
  all.push_back({"another type", "rover.obs",
                 [](const std::string& text) { return replaced(text, "OBSERVATION DATA", "METEOROLOGICAL  "); }, true});
  all.push_back(
      {"types that are none", "rover.obs", [](const std::string& text) { return replaced(text, " C1C L1C", " X9? @@@"); }});
  all.push_back({"more types announced than there are", "rover.obs",
                 [](const std::string& text) { return replaced(text, "G   12", "G  999"); }});
  all.push_back({"a position in space", "rover.obs", [](const std::string& text) { return replaced(text, "  43", "9.9e"); }});
}

void add_epochs(std::vector<SpoiledFile>& all) {
  const auto epoch = [&](const std::string& what, std::size_t at, const std::string& text, bool refused = false) {
    all.push_back({what, "rover.obs",
                   [at, text](const std::string& whole) {
                     return with_line(whole, ">", 20, [&](const std::string& line) { return put(line, at, text); });
                   },
                   refused});
  };
  epoch("a month of 13", 7, "13");
  epoch("an hour of 99", 13, "99");
  epoch("a second of letters", 19, "ab.cdefgh");
  epoch("a flag of 9", 31, "9");
  epoch("an event of 3 lines", 31, "4  3");
  epoch("fewer satellites than follow", 32, "  2");
  epoch("more satellites than follow", 32, "999");
  epoch("satellites below zero", 32, " -5");
  epoch("an epoch that goes back", 16, "01");
  epoch("a year of 1000", 2, "1000");
  all.push_back({"an epoch twice", "rover.obs", [](const std::string& text) {
                   const auto first = text.find("\n>", text.find("END OF HEADER")) + 1;
                   const auto second = text.find("\n>", first) + 1;
                   return text.substr(0, second) + text.substr(first, second - first) + text.substr(second);
                 }});
  all.push_back({"epochs in reverse", "base.obs", [](const std::string& text) {
                   std::size_t at = text.find("\n>", text.find("END OF HEADER")) + 1;
                   std::string reversed;
                   const std::string head = text.substr(0, at);
                   while (at < text.size()) {
                     auto next = text.find("\n>", at);
                     next = next == std::string::npos ? text.size() : next + 1;
                     reversed.insert(0, text.substr(at, next - at));
                     at = next;
                   }
                   return head + reversed;
                 }});
}

void add_observations(std::vector<SpoiledFile>& all) {
  const auto value = [&](const std::string& what, std::size_t at, const std::string& text) {
    for (const char* file : {"rover.obs", "base.obs"})
      all.push_back({what, file, [at, text](const std::string& whole) {
                       return with_line(whole, "G", 100, [&](const std::string& line) { return put(line, at, text); });
                     }});
  };
  value("a code of letters", 3, "  abcdefgh.ijk");
  value("a code of nan", 3, "           nan");
  value("a code below zero", 3, " -20000000.000");
  value("a code from beyond the Moon", 3, "999999999.9999");
  value("a code 50 m off", 3, "  20511456.236");
  value("a phase of inf", 19, "           inf");
  value("a satellite without number", 0, "G  ");
  value("a satellite of an unknown system", 0, "Q01");
  value("a satellite numbered 00", 0, "G00");
  all.push_back({"a satellite twice", "rover.obs", [](const std::string& text) {
                   return with_line(text, "G", 100, [](const std::string& line) { return line + "\n" + line; });
                 }});
  all.push_back({"bytes of noise", "rover.obs", [](std::string text) {
                   for (std::size_t i = text.size() / 2; i < text.size() / 2 + 200; ++i)
                     text[i] = static_cast<char>(33 + i * 7919 % 90);
                   return text;
                 }});
  all.push_back({"zero bytes in the middle", "rover.obs",
                 [](std::string text) { return text.replace(text.size() / 2, 4, std::string(4, '\0')); }});
  all.push_back({"lines of Windows", "rover.obs", [](const std::string& text) {
                   std::string crlf;
                   for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
                   return crlf;
                 }});
}

void add_ephemerides(std::vector<SpoiledFile>& all) {
  const auto number = [&](const std::string& what, int line, std::size_t at, const std::string& text) {
    all.push_back({what, "brdc.nav", [line, at, text](const std::string& whole) {
                     std::string spoiled = whole;  // of every satellite of GPS: nothing is left to hide behind
                     for (std::size_t g = spoiled.find("\nG"); g != std::string::npos; g = spoiled.find("\nG", g + 1)) {
                       std::size_t begin = g + 1;
                       for (int i = 0; i < line; ++i) begin = spoiled.find('\n', begin) + 1;
                       spoiled.replace(begin + at, text.size(), text);
                     }
                     return spoiled;
                   }});
  };
  number("an eccentricity of 5", 2, 23, " 5.000000000000E+00");
  number("an axis of 1 m", 2, 61, " 1.000000000000E+00");
  number("a reference time beyond the week", 3, 4, " 9.999999999999E+09");
  number("a clock an hour off", 0, 23, " 3.600000000000E+03");
  number("an inclination of letters", 4, 4, " abcdefghijklmnopqr");
  number("all unhealthy", 6, 23, " 6.300000000000E+01");
  all.push_back({"observations for navigation", "brdc.nav",
                 [](const std::string& text) { return replaced(text, "N: GNSS NAV DATA", "OBSERVATION DATA"); }, true});
  all.push_back({"a line missing in a message", "brdc.nav", [](const std::string& text) {
                   const auto at = text.find('\n', text.find("\nG02") + 1);
                   return text.substr(0, at) + text.substr(text.find('\n', at + 1));
                 }});
}

std::vector<SpoiledFile> spoiled_files() {
  std::vector<SpoiledFile> all;
  add_truncations(all);
  add_headers(all);
  add_epochs(all);
  add_observations(all);
  add_ephemerides(all);
  return all;
}

/// One mission of a minute as files.
class SpoiledRinex : public testing::Test {
 protected:
  void SetUp() override {
    constexpr std::size_t kEpochs = 60;
    for (record::ObservationRecording* receiver : {&mission_.observed.rover, &mission_.observed.base})
      receiver->epochs.resize(kEpochs);
    io::write_observations(folder_.path() / "rover.obs", mission_.observed.rover);
    io::write_observations(folder_.path() / "base.obs", mission_.observed.base);
    io::write_navigation(folder_.path() / "brdc.nav", mission_.observed.navigation);
  }

  /// Fixed epochs; every one of them is right.
  [[nodiscard]] std::size_t solve() const {
    const auto rover = io::read_observations(folder_.path() / "rover.obs");
    const auto base = io::read_observations(folder_.path() / "base.obs");
    const BroadcastOrbits orbits(io::read_navigation(folder_.path() / "brdc.nav"));
    PpkOptions options;
    options.order = PassOrder::kForward;
    options.noise = NoiseScale{};
    const PpkSolution solution = solve_ppk(
        rover, base, orbits, [&](geo::GpsTime) { return std::optional(mission_.observed.r_base_e); }, options);
    std::size_t fixed = 0;
    for (const PpkEpoch& epoch : solution.epochs) {
      EXPECT_TRUE(epoch.r_e.allFinite() && epoch.covariance_e.allFinite());
      if (epoch.quality != record::FixQuality::kFixed) continue;
      ++fixed;
      EXPECT_LT((epoch.r_e - mission_.truth(epoch.t).r_eb_e).norm(), 0.1) << geo::to_string(epoch.t);
    }
    return fixed;
  }

  test::TemporaryDirectory folder_;
  SimulatedBaseline mission_{"car_roundabout", 360.0, [] {
                               simulate::ObservationOptions options;
                               options.phase_multipath_sd = 0.001;
                               return options;
                             }()};
};

TEST_F(SpoiledRinex, IsRefusedByNameOrSolvedRightly) {
  EXPECT_GT(solve(), 55U);
  const std::vector<SpoiledFile> all = spoiled_files();
  EXPECT_GE(all.size(), 60U);
  std::size_t refusals = 0, solved = 0;
  for (const SpoiledFile& spoiled : all) {
    SCOPED_TRACE(spoiled.file + ": " + spoiled.what);
    const fs::path path = folder_.path() / spoiled.file;
    const std::string whole = io::read_all(path);
    std::ofstream(path, std::ios::binary) << spoiled.spoil(whole);
    try {
      if (solve() > 0) ++solved;
      EXPECT_FALSE(spoiled.refused);
    } catch (const InputError& error) {
      ++refusals;
      const std::string said = error.what();
      EXPECT_TRUE(said.find(".obs") != std::string::npos || said.find(".nav") != std::string::npos) << said;
    }
    std::ofstream(path, std::ios::binary) << whole;
  }
  // Most of it can be repaired, and what has no header cannot.
  EXPECT_GT(solved, all.size() / 2);
  EXPECT_GT(refusals, 15U);
}

}  // namespace
}  // namespace coast::carrier
