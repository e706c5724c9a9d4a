// run.diagnosed.yaml: the run with the findings.

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "diagnose/result.hpp"

namespace coast::jobs {

namespace {

/// A resolved file with `key: value` in a top-level section, replacing the key's previous lines.
std::string with_value(const std::string& text, std::string_view section, std::string_view key, const std::string& value) {
  std::istringstream lines(text);
  std::string result;
  bool inside = false;
  bool replacing = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == 0) inside = line.starts_with(fmt::format("{}:", section));
    if (replacing && indent != std::string::npos && indent > 2) continue;
    replacing = inside && indent == 2 && std::string_view(line).substr(2).starts_with(fmt::format("{}:", key));
    if (!replacing) result += line + "\n";
    if (inside && indent == 0) result += fmt::format("  {}: {}  # coast diagnose\n", key, value);
  }
  return result;
}

std::string entry(const diagnose::Finding& f) {
  const diagnose::Effect& effect = *f.hypothesis.effect;
  std::string text = fmt::format("  - {{name: {}, sensor: {}, ", effect.name, diagnose::name(effect.site));
  if (!f.hypothesis.axis_name().empty()) text += fmt::format("axis: {}, ", f.hypothesis.axis_name());
  for (const diagnose::FixedParameter& one : effect.fixed)
    text += fmt::format("{}_{}: {:.17g}, ", one.name, one.unit == "Hz" ? "hz" : one.unit, one.value);
  if (!effect.relation.empty()) text += fmt::format("relation: \"{}\", ", effect.relation);
  if (f.from) text += fmt::format("start_s: {:.6f}, ", f.from->sow());
  if (f.to) text += fmt::format("end_s: {:.6f}, ", f.to->sow());
  return text + fmt::format("value: {:.17g}}}  # +- {:.2g} {}\n", f.value, f.sd, effect.unit);
}

bool stated_by_key(const diagnose::Finding& f) {
  return f.hypothesis.effect->key && !f.from && !f.to;
}

/// A changed line of the run file. Its views are of literals.
struct Line {
  std::string_view section;
  std::string_view key;
  std::string value;
};

std::string noise_of_gnss(const study::Setup& setup) {
  const estimate::GnssScale& scale = setup.filter.gnss_scale;
  const estimate::CorrelatedGnss& correlated = setup.filter.auxiliary.correlated_gnss;
  return fmt::format(
      "{{scale_horizontal: {:.17g}, scale_vertical: {:.17g}, scale_velocity: {:.17g}, correlated_horizontal_m: {:.17g}, "
      "correlated_vertical_m: {:.17g}, correlated_time_s: {:.17g}}}",
      scale.horizontal, scale.vertical, scale.velocity, correlated.horizontal_m, correlated.vertical_m, correlated.time_s);
}

std::vector<Line> lines(const diagnose::Diagnosis& d, const std::string& error_model) {
  std::vector<Line> all;
  if (changes_error_model(d)) all = {{"imu", "error_model", error_model}, {"imu", "noise", "stated"}};
  for (const diagnose::RunKey& key : keys_found(d)) all.push_back({key.section, key.name, key.text(d.modelled.setup)});
  if (std::ranges::any_of(d.noise, [](const diagnose::NoiseFinding& f) { return f.sensor == "gnss"; }))
    all.push_back({"gnss", "noise", noise_of_gnss(d.modelled.setup)});
  return all;
}

/// The section `effects`; empty if there are none.
std::string effect_entries(const diagnose::Diagnosis& d) {
  std::string entries;
  for (const diagnose::Finding& f : d.findings)
    if (!stated_by_key(f))
      for (const diagnose::Finding& one : diagnose::times_of(f)) entries += entry(one);
  for (const diagnose::NoiseFinding& f : d.noise)
    if (f.place == diagnose::NoiseFinding::Place::kEffects)
      entries += fmt::format("  - {{name: {}, sensor: {}, axis: {}, value: {:.17g}}}  # +- {:.2g} {}\n", f.name, f.sensor,
                             f.axis, f.value, f.sd, f.unit);
  return entries.empty() ? entries : "effects:\n" + entries;
}

}  // namespace

std::vector<diagnose::RunKey> keys_found(const diagnose::Diagnosis& d) {
  std::vector<diagnose::RunKey> keys;
  for (const diagnose::Finding& f : d.findings)
    if (stated_by_key(f) && std::ranges::find(keys, f.hypothesis.effect->key->name, &diagnose::RunKey::name) == keys.end())
      keys.push_back(*f.hypothesis.effect->key);
  return keys;
}

bool changes_error_model(const diagnose::Diagnosis& d) {
  for (const diagnose::NoiseFinding& f : d.noise)
    if (f.sensor != "gnss" && f.place != diagnose::NoiseFinding::Place::kEffects) return true;
  return false;
}

std::string diagnosed_yaml(const std::string& resolved, const diagnose::Diagnosis& d, const std::string& error_model) {
  std::string text = resolved;
  if (!text.empty() && text.back() != '\n') text += '\n';
  for (const Line& line : lines(d, error_model)) text = with_value(text, line.section, line.key, line.value);
  return text + effect_entries(d);
}

std::string changed_lines(const diagnose::Diagnosis& d, const std::string& error_model) {
  std::string text;
  std::string_view section;
  std::vector<Line> changed = lines(d, error_model);
  std::ranges::stable_sort(changed, std::ranges::greater{}, &Line::section);  // imu before gnss
  for (const Line& line : changed) {
    if (line.section != section) text += fmt::format("{}:\n", line.section);
    section = line.section;
    text += fmt::format("  {}: {}\n", line.key, line.value);
  }
  return text + effect_entries(d);
}

}  // namespace coast::jobs
