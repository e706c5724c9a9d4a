#include "rinex_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "../text.hpp"

namespace coast::io {

namespace {

using record::SatelliteSystem;
using record::Signal;

bool is_quantity(char c) {
  return c == 'C' || c == 'L' || c == 'D' || c == 'S';
}

/// RINEX 2 gives the band of a phase, not its tracking: it is assumed to be that of the file's code in that band. P is the
/// encrypted code, tracked without its key, for GPS, and the plain one for GLONASS.
Signal signal_of_rinex2(char letter, char band, SatelliteSystem system, const std::vector<std::string>& types) {
  const bool glonass = system == SatelliteSystem::kGlonass;
  const auto has = [&](char code) { return std::ranges::find(types, std::string{code, band}) != types.end(); };
  const char precise = glonass ? 'P' : 'W';
  const char civil = band == '1' || glonass ? 'C' : 'X';
  if (letter == 'P') return {band, precise};
  if (letter == 'C') return {band, civil};
  // The second band of GPS had only P(Y) for decades; the first has C/A unless the file has only P.
  const bool prefers_precise = band == '1' ? !has('C') && has('P') : has('P');
  return {band, prefers_precise ? precise : civil};
}

}  // namespace

void SystemTypes::set(const std::vector<std::pair<char, Signal>>& types, const ScaleFactors& factors) {
  columns.clear();
  signals.clear();
  for (const auto& [quantity, signal] : types)
    if (quantity != ' ') signals.push_back(signal);
  std::ranges::sort(signals);
  signals.erase(std::unique(signals.begin(), signals.end()), signals.end());
  for (const auto& [quantity, signal] : types)
    columns.push_back({quantity, static_cast<std::size_t>(std::ranges::lower_bound(signals, signal) - signals.begin()),
                       factors.of(quantity, signal)});
}

void RinexColumns::read(std::string_view line, std::string_view label, int major) {
  major_ = major;
  if (major > 2 && label == "SYS / # / OBS TYPES") read_types3(line);
  if (major > 2 && label == "SYS / SCALE FACTOR") read_factor(line);
  if (major == 2 && label == "# / TYPES OF OBSERV") read_types2(line);
}

void RinexColumns::read_types3(std::string_view line) {
  if (line[0] != ' ') {
    system3_ = line[0];
    if (const auto system = record::system_of(system3_)) named3_.at(static_cast<std::size_t>(*system)).clear();
  }
  const auto system = record::system_of(system3_);
  if (!system) return;
  auto& types = named3_.at(static_cast<std::size_t>(*system));
  constexpr std::size_t kFirst = 7, kStep = 4, kPerLine = 13;
  for (std::size_t i = 0; i < kPerLine; ++i) {
    const std::string_view type = trimmed(field(line, kFirst + kStep * i, 3));
    if (type.empty()) continue;
    if (type.size() < 2) lines_.refuse(fmt::format("the type {}", in_quotes(type)), "one like C1C");
    const bool used = type.size() == 3 && is_quantity(type[0]);
    types.emplace_back(used ? type[0] : ' ', Signal{type[1], type.size() > 2 ? type[2] : 'C'});
  }
  stated_ = true;
  set_types3(*system);
}

void RinexColumns::set_types3(SatelliteSystem system) {
  const auto s = static_cast<std::size_t>(system);
  types_.at(s).set(named3_.at(s), factors_.at(s));
}

void RinexColumns::begin_factor(std::string_view line) {
  const auto factor = integer_field(line, 2, 4);
  if (!factor || (*factor != 1 && *factor != 10 && *factor != 100 && *factor != 1000))
    lines_.refuse(fmt::format("the scale factor {}", in_quotes(trimmed(field(line, 2, 4)))), "1, 10, 100 or 1000",
                  "Stored numbers are divided by it; see the receiver's or the converter's own description.");
  const bool all = trimmed(field(line, 8, 2)).empty();
  const auto announced = all ? 0 : integer_field(line, 8, 2);
  if (!announced || *announced < 0)
    lines_.refuse(fmt::format("{} types with a scale factor", in_quotes(trimmed(field(line, 8, 2)))),
                  "their number, or nothing for all of the system");
  scaled_ = {line[0], static_cast<double>(*factor), static_cast<std::size_t>(*announced), 0};
  if (scaled_.announced > 0) return;
  if (const auto system = record::system_of(line[0])) factors_.at(static_cast<std::size_t>(*system)) = {scaled_.factor, {}};
}

void RinexColumns::read_factor(std::string_view line) {
  constexpr std::size_t kFirst = 11, kStep = 4, kPerLine = 12;
  const bool continues = line[0] == ' ';
  if (continues != (scaled_.listed < scaled_.announced))
    lines_.refuse(in_quotes(line), continues ? "a system and its scale factor"
                                             : fmt::format("{} more types of {} with the scale factor before",
                                                           scaled_.announced - scaled_.listed, scaled_.system));
  if (!continues) begin_factor(line);
  const auto system = record::system_of(scaled_.system);
  for (std::size_t i = 0; i < kPerLine; ++i) {
    const std::string_view type = trimmed(field(line, kFirst + kStep * i, 3));
    if (type.empty()) break;
    if (++scaled_.listed > scaled_.announced)
      lines_.refuse(fmt::format("more types with a scale factor of {} than announced", scaled_.system),
                    fmt::format("{}", scaled_.announced));
    if (system) factors_.at(static_cast<std::size_t>(*system)).by_type[std::string(type)] = scaled_.factor;
  }
  if (system) set_types3(*system);
}

void RinexColumns::read_types2(std::string_view line) {
  if (const auto announced = integer_field(line, 0, 6)) {
    announced2_ = static_cast<std::size_t>(std::clamp(*announced, 0, 999));
    named2_.clear();
  }
  constexpr std::size_t kFirst = 10, kStep = 6, kPerLine = 9;
  for (std::size_t i = 0; i < kPerLine && named2_.size() < announced2_; ++i) {
    const std::string_view type = trimmed(field(line, kFirst + kStep * i, 2));
    if (!type.empty()) named2_.emplace_back(type);
  }
  stated_ = true;
  set_types2();
}

void RinexColumns::set_types2() {
  for (std::size_t s = 0; s < types_.size(); ++s) {
    std::vector<std::pair<char, Signal>> types;
    for (const std::string& type : named2_) {
      const char letter = type[0];
      const char band = type.size() > 1 ? type[1] : '1';
      const bool known = letter == 'P' || is_quantity(letter);
      types.emplace_back(!known          ? ' '
                         : letter == 'P' ? 'C'
                                         : letter,
                         signal_of_rinex2(letter, band, static_cast<SatelliteSystem>(s), named2_));
    }
    types_[s].set(types, {});
  }
}

void RinexColumns::check() const {
  if (!stated_)
    lines_.refuse("the end of the header", major_ == 2 ? "# / TYPES OF OBSERV" : "SYS / # / OBS TYPES",
                  "Without it nobody knows what the columns are.");
  if (scaled_.listed < scaled_.announced)
    lines_.refuse(fmt::format("{} types with a scale factor of {}", scaled_.listed, scaled_.system),
                  fmt::format("the {} announced", scaled_.announced));
  if (major_ == 2 && named2_.size() < announced2_)
    lines_.refuse(fmt::format("{} types of observations", named2_.size()), fmt::format("the {} announced", announced2_));
}

}  // namespace coast::io
