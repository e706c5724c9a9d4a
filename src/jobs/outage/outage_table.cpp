#include "outage/outage_table.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace coast::jobs {

namespace {

constexpr std::array kManoeuvres{study::Manoeuvre::kStatic, study::Manoeuvre::kStraight, study::Manoeuvre::kAccelerating,
                                 study::Manoeuvre::kTurn};

/// Calls f(name, value) for every number of one solution.
template <class Errors, class F>
void for_each_number(Errors& errors, const std::string& solution, F f) {
  const auto vector = [&](const char* what, auto& v, const std::array<const char*, 3>& axes, const char* unit) {
    for (std::size_t i = 0; i < 3; ++i)
      f(fmt::format("{}_{}_{}_{}", solution, what, axes[i], unit), v(static_cast<Eigen::Index>(i)));
  };
  constexpr std::array kNed{"n", "e", "d"};
  f(solution + "_horizontal_max_m", errors.horizontal_max_m);
  vector("max", errors.max_m, kNed, "m");
  vector("rms", errors.rms_m, kNed, "m");
  vector("end", errors.end_m, kNed, "m");
  vector("sigma_end", errors.sigma_end_m, kNed, "m");
  vector("sigma_max", errors.sigma_max_m, kNed, "m");
  vector("attitude_max", errors.attitude_max, {"roll", "pitch", "yaw"}, "rad");
}

std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

/// The fields of a line, one after the other; failed after one is missing or not a number.
class Fields {
 public:
  explicit Fields(std::string_view line) : fields_(split(line)) {}
  [[nodiscard]] std::string_view next() {
    if (at_ < fields_.size()) return fields_[at_++];
    failed_ = true;
    return {};
  }
  [[nodiscard]] double number() {
    const std::optional<double> value = number_of(next());
    failed_ = failed_ || !value;
    return value.value_or(0.0);
  }
  [[nodiscard]] std::size_t count() {
    const double value = number();
    failed_ = failed_ || value < 0.0 || value > 1e15 || value != std::floor(value);
    return failed_ ? 0 : static_cast<std::size_t>(value);
  }
  void fail() { failed_ = true; }
  [[nodiscard]] bool good() const { return !failed_ && at_ == fields_.size(); }

 private:
  std::vector<std::string_view> fields_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

void append_values(const study::OutageErrors& errors, std::string& line) {
  for_each_number(errors, {}, [&](const std::string&, double value) { line += fmt::format(",{}", value); });
  line += fmt::format(",{},{},", errors.inside_95, errors.tested);
  if (errors.gnss_horizontal_max_m) line += fmt::format("{}", *errors.gnss_horizontal_max_m);
}

study::OutageErrors errors_from(Fields& fields) {
  study::OutageErrors errors;
  for_each_number(errors, {}, [&](const std::string&, double& value) { value = fields.number(); });
  errors.inside_95 = fields.count();
  errors.tested = fields.count();
  const std::string_view gnss = fields.next();
  if (gnss.empty()) return errors;
  errors.gnss_horizontal_max_m = number_of(gnss);
  if (!errors.gnss_horizontal_max_m) fields.fail();
  return errors;
}

}  // namespace

std::string outage_columns() {
  std::string line = "manoeuvre";
  study::OutageErrors any;
  for (const std::string solution : {"forward", "smoothed"}) {
    for_each_number(any, solution, [&](const std::string& name, double) { line += "," + name; });
    line += fmt::format(",{0}_inside_95,{0}_tested,{0}_gnss_horizontal_max_m", solution);
  }
  return line;
}

std::string outage_values(const study::OutageResult& result) {
  std::string line(study::name(result.manoeuvre));
  append_values(result.forward, line);
  append_values(result.smoothed.value_or(study::OutageErrors{}), line);
  return line;
}

std::optional<study::OutageResult> outage_from(std::string_view values) {
  Fields fields(values);
  study::OutageResult result;
  const std::string_view manoeuvre = fields.next();
  bool known = false;
  for (const study::Manoeuvre candidate : kManoeuvres)
    if (study::name(candidate) == manoeuvre) {
      result.manoeuvre = candidate;
      known = true;
    }
  result.forward = errors_from(fields);
  result.smoothed = errors_from(fields);
  if (!known || !fields.good()) return std::nullopt;
  return result;
}

}  // namespace coast::jobs
