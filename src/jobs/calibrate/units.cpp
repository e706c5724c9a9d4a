#include "calibrate/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/geo/units.hpp"

namespace coast::jobs {

namespace {

/// Conversion of a parameter with this unit to that of data sheets.
struct Conversion {
  enum class Kind { kRoot, kInverse, kPlain } kind = Kind::kPlain;
  const char* unit = "";  ///< of the result; empty: SI, or none
};

Conversion conversion_of(std::string_view unit, noise::Sensor sensor) {
  const SheetUnits& sheet = sheet_units(sensor);
  using Kind = Conversion::Kind;
  if (unit == "signal^2/Hz") return {Kind::kRoot, sheet.white_noise};
  if (unit == "signal^2") return {Kind::kRoot, sheet.signal};
  if (unit == "signal^2/s") return {Kind::kRoot, sheet.rate_random_walk};
  if (unit == "(signal s)^2") return {Kind::kRoot, sheet.integral};
  if (unit == "1/s") return {Kind::kInverse, "s"};
  return {};
}

/// "sigma" from "sigma2", "correlation time" from "beta".
std::string quantity_of(const noise::ParameterInfo& info, Conversion::Kind kind) {
  std::string name(info.name);
  if (kind == Conversion::Kind::kInverse) return "correlation time";
  if (kind == Conversion::Kind::kRoot && name.back() == '2') name.pop_back();
  return name == "q" ? "Q" : name;
}

double convert(const Conversion& conversion, double si) {
  if (conversion.kind == Conversion::Kind::kInverse) return 1.0 / si;
  if (conversion.kind == Conversion::Kind::kRoot) return in_unit(std::sqrt(si), conversion.unit);
  return si;
}

std::size_t term_of(const noise::SumModel& model, std::size_t parameter) {
  const auto& terms = model.terms();
  const auto after =
      std::ranges::find_if(terms, [&](const auto& term) { return term.parameter + term.parameters > parameter; });
  return static_cast<std::size_t>(after - terms.begin());
}

}  // namespace

const SheetUnits& sheet_units(noise::Sensor sensor) {
  static constexpr SheetUnits kGyro{"deg/sqrt(h)", "deg/h", "deg/h/sqrt(h)", "deg/h/h", "arcsec"};
  static constexpr SheetUnits kAccel{"m/s/sqrt(h)", "ug", "ug/sqrt(s)", "ug/h", "m/s"};
  return sensor == noise::Sensor::kGyro ? kGyro : kAccel;
}

double in_unit(double si, const char* unit) {
  return si / geo::unit(unit).to_si;
}

SheetValue sheet_value(const noise::SumModel& model, std::size_t i, noise::Sensor sensor,
                       const noise::ParameterEstimate& estimate) {
  const noise::ParameterInfo info = model.parameter(i);
  const Conversion conversion = conversion_of(info.unit, sensor);
  SheetValue value;
  const bool plain = conversion.kind == Conversion::Kind::kPlain;
  value.name = fmt::format("{} {}", term_name(model, term_of(model, i)), quantity_of(info, conversion.kind));
  value.unit = plain ? si_unit_of(info.unit, sensor) : conversion.unit;
  value.value = convert(conversion, estimate.value);
  if (estimate.lower) value.lower = convert(conversion, *estimate.lower);
  if (estimate.upper) value.upper = convert(conversion, *estimate.upper);
  value.relative_bound = estimate.relative_bound * (conversion.kind == Conversion::Kind::kRoot ? 0.5 : 1.0);
  if (conversion.kind == Conversion::Kind::kInverse) std::swap(value.lower, value.upper);
  return value;
}

std::string si_unit_of(std::string_view unit, noise::Sensor sensor) {
  const bool gyro = sensor == noise::Sensor::kGyro;
  if (unit == "1") return "";
  if (unit == "(signal s)^2") return gyro ? "rad^2" : "(m/s)^2";
  std::string text(unit);
  const auto at = text.find("signal");
  if (at == std::string::npos) return text;
  return text.replace(at, 6, gyro ? "(rad/s)" : "(m/s^2)");
}

std::string term_name(const noise::SumModel& model, std::size_t term) {
  const auto& terms = model.terms();
  const auto same = [&](const noise::SumModel::Term& other) { return other.process == terms[term].process; };
  std::string symbol(terms[term].process->symbol());
  if (std::ranges::count_if(terms, same) == 1) return symbol;
  return fmt::format("{} {}", symbol,
                     std::count_if(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(term) + 1, same));
}

}  // namespace coast::jobs
