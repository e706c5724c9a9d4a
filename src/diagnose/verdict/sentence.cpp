#include "coast/diagnose/sentence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "coast/geo/units.hpp"
#include "evidence/observable.hpp"

namespace coast::diagnose {

namespace {

/// A unit of results, and the one that people say.
struct PlainUnit {
  std::string_view unit;
  std::optional<Site> site;  ///< of which it is said; none: of all
  double below;              ///< sizes that are said in it
  double factor;
  std::string_view said;
};

constexpr double kAlways = std::numeric_limits<double>::infinity();
constexpr double kToDegrees = 180.0 / geo::kPi;
constexpr double kToDegreesPerHour = 3600.0 * kToDegrees;
constexpr double kToMilliG = 1e3 / geo::kStandardGravity;

// The first line that fits is used.
constexpr std::array kPlain{
    PlainUnit{"m", {}, 1.0, 100.0, "cm"},
    PlainUnit{"s", {}, 1.0, 1e3, "ms"},
    PlainUnit{"1", Site::kClock, kAlways, 1e6, "ppm"},
    PlainUnit{"1", {}, kAlways, 100.0, "%"},
    PlainUnit{"rad", {}, kAlways, kToDegrees, "deg"},
    PlainUnit{"rad/s", {}, 1000.0 / kToDegreesPerHour, kToDegreesPerHour, "deg/h"},
    PlainUnit{"rad/s", {}, kAlways, kToDegrees, "deg/s"},
    PlainUnit{"m/s^2", Site::kGravity, kAlways, 1e5, "mGal"},
    PlainUnit{"m/s^2", {}, 1000.0 / kToMilliG, kToMilliG, "mg"},
    PlainUnit{"rad/s/K", {}, kAlways, kToDegreesPerHour, "deg/h for each K"},
    PlainUnit{"m/s^2/K", {}, kAlways, kToMilliG, "mg for each K"},
    PlainUnit{"rad/s/(K/s)", {}, kAlways, kToDegreesPerHour / 60.0, "deg/h for each K a minute"},
    PlainUnit{"m/s^2/(K/s)", {}, kAlways, kToMilliG / 60.0, "mg for each K a minute"},
    PlainUnit{"rad/s^2", {}, kAlways, 3600.0 * kToDegreesPerHour, "deg/h each hour"},
    PlainUnit{"m/s^3", {}, kAlways, 3600.0 * kToMilliG, "mg each hour"},
    PlainUnit{"rad/s/(m/s^2)", {}, kAlways, kToDegreesPerHour* geo::kStandardGravity, "deg/h for each g"},
    PlainUnit{
        "rad/s/(m/s^2)^2", {}, kAlways, kToDegreesPerHour* geo::kStandardGravity* geo::kStandardGravity, "deg/h for each g^2"},
    PlainUnit{"1/(m/s^2)", {}, kAlways, 1e3 * geo::kStandardGravity, "mg for each g^2"},
    PlainUnit{"s^2", Site::kAntenna, kAlways, 1e3, "mm for each m/s^2"},
};

/// Digits behind the point.
int decimals(double value, double sd) {
  const double least = sd > 0.0 ? sd : std::abs(value) / 100.0;  // of a size without sigma: three digits
  if (!(least > 0.0) || !std::isfinite(least)) return 0;
  const int place = static_cast<int>(std::floor(std::log10(least)));
  const bool begins_with_one = least < 2.0 * std::pow(10.0, place);
  return std::clamp((sd > 0.0 && begins_with_one ? 1 : 0) - place, 0, 12);
}

void replace(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

std::string_view axis_word(std::string_view axis) {
  if (axis == "cos") return "cosine";
  return axis == "sin" ? "sine" : axis;
}

/// As the end of a sentence.
std::string when(const Finding& f) {
  if (!f.from) return ".";
  if (f.to) return fmt::format(", from {:.1f} to {:.1f} s of week.", f.from->sow(), f.to->sow());
  return fmt::format(", from {:.1f} s of week on.", f.from->sow());
}

std::string_view without_stop(std::string_view sentence) {
  if (sentence.ends_with('.')) sentence.remove_suffix(1);
  return sentence;
}

std::string_view fix_errors(std::string_view axis) {
  return axis == "d" ? "vertical" : axis;
}

}  // namespace

std::string plain_size(double value, double sd, std::string_view unit, Site site) {
  const auto fits = [&](const PlainUnit& one) {
    return one.unit == unit && (!one.site || *one.site == site) && std::abs(value) < one.below;
  };
  const auto* const plain = std::ranges::find_if(kPlain, fits);
  const double factor = plain != kPlain.end() ? plain->factor : 1.0;
  const int digits = decimals(factor * value, factor * sd);
  std::string text = fmt::format("{:.{}f}", factor * value, digits);
  if (sd > 0.0) text += fmt::format(" +- {:.{}f}", factor * sd, digits);
  return fmt::format("{} {}", text, plain != kPlain.end() ? plain->said : unit);
}

std::string sentence_of_one(const Finding& f) {
  const Effect& effect = *f.hypothesis.effect;
  const std::string_view axis = f.hypothesis.axis_name();
  const bool is_pair = axis.size() == 2;
  std::string text(without_stop(effect.sentence));
  double value = f.value;
  if (!effect.ways.empty()) {
    const auto of_axis = static_cast<std::size_t>(f.hypothesis.axis);
    replace(text, "{way}", effect.ways[std::min(of_axis, effect.ways.size() - 1)][value < 0.0 ? 1 : 0]);
    value = std::abs(value);
  }
  replace(text, "{size}", plain_size(value, f.sd, effect.unit, effect.site));
  replace(text, "{axis}", is_pair ? axis.substr(0, 1) : axis_word(axis));
  replace(text, "{cause}", is_pair ? axis.substr(1) : axis);
  text += when(f);
  if (is_implausible(f.hypothesis, f.value)) text += " So much is implausible: look for another cause too.";
  return text;
}

namespace {

/// "3 times". Components of one jump begin at the same time.
std::string how_often(const std::vector<Finding>& times) {
  constexpr double kSame = 1.0;  // s
  int count = 1;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (*times[i].from - *times[i - 1].from > kSame) ++count;
  return count == 1 ? "once" : fmt::format("{} times", count);
}

}  // namespace

std::string sentence(const Finding& f) {
  if (f.further.empty()) return sentence_of_one(f);
  const std::vector<Finding> times = times_of(f);
  const Finding& largest = *std::ranges::max_element(times, {}, [](const Finding& one) { return std::abs(one.value); });
  const Effect& effect = *f.hypothesis.effect;
  std::string text(effect.sentence_of_many);
  replace(text, "{times}", how_often(times));
  replace(text, "{size}", plain_size(std::abs(largest.value), largest.sd, effect.unit, effect.site));
  return text;
}

std::string sentence(const NoiseFinding& f) {
  if (f.name == "gnss_sd_optimistic")
    return fmt::format("The {} errors of the fixes are {:.2g} times what is stated.", fix_errors(f.axis), f.value);
  if (f.name == "gnss_correlated_error")
    return fmt::format("The {} errors of the fixes last: {} over about {:.2g} s.", fix_errors(f.axis),
                       plain_size(f.value, f.sd, f.unit, Site::kGnss), f.time_s);
  if (f.name == "imu_white_noise") {
    const char* sensors = f.sensor == "gyro" ? "gyros" : "accelerometers";
    if (!f.by_axis) return fmt::format("The noise of the {} is {:.2g} times what is stated.", sensors, f.value);
    return fmt::format("The noise of the {} x, y, z is {:.2g}, {:.2g} and {:.2g} times what is stated.", sensors,
                       f.by_axis->x(), f.by_axis->y(), f.by_axis->z());
  }
  const Site site = f.sensor == "gyro" ? Site::kGyro : Site::kAccel;
  const std::string time = f.time_s > 0.0 ? fmt::format(" over about {:.2g} s", f.time_s) : std::string();
  return fmt::format("{} {}: {} ({} {}{}).", f.sensor == "gyro" ? "Gyro" : "Accelerometer", f.axis, without_stop(f.meaning),
                     f.parameter, plain_size(f.value, f.sd, f.unit, site), time);
}

std::string consequence(const Diagnosis& d) {
  constexpr double kByChance = 2.0;  // sd
  if ((d.findings.empty() && d.noise.empty()) || d.outage_change.count < 2) return {};
  const double before = d.before.outage_rms_m;
  const double after = d.after.outage_rms_m;
  const auto metres = [](double m) { return fmt::format("{:.{}f} m", m, m < 1.0 ? 2 : 1); };
  const std::string drift = fmt::format("With all of this corrected, outages of 20 s drift {}", metres(after));
  if (!(std::abs(d.outage_change.mean) > kByChance * d.outage_change.sd))
    return fmt::format("{}, before {}: within chance the same.", drift, metres(before));
  return fmt::format("{} and not {}{}", drift, metres(before), d.outage_change.mean < 0.0 ? "." : ": farther.");
}

}  // namespace coast::diagnose
