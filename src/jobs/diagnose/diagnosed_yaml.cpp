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
  if (changes_error_model(d)) text = with_value(with_value(text, "imu", "error_model", error_model), "imu", "noise", "stated");
  bool of_gnss = false;
  std::string entries;
  for (const diagnose::RunKey& key : keys_found(d)) text = with_value(text, key.section, key.name, key.text(d.modelled.setup));
  for (const diagnose::Finding& f : d.findings)
    if (!stated_by_key(f)) entries += entry(f);
  for (const diagnose::NoiseFinding& f : d.noise) {
    of_gnss = of_gnss || f.sensor == "gnss";
    if (f.place == diagnose::NoiseFinding::Place::kEffects)
      entries += fmt::format("  - {{name: {}, sensor: {}, axis: {}, value: {:.17g}}}  # +- {:.2g} {}\n", f.name, f.sensor,
                             f.axis, f.value, f.sd, f.unit);
  }
  if (of_gnss) {
    const estimate::GnssScale& scale = d.modelled.setup.filter.gnss_scale;
    const estimate::CorrelatedGnss& correlated = d.modelled.setup.filter.auxiliary.correlated_gnss;
    text =
        with_value(text, "gnss", "noise",
                   fmt::format("{{scale_horizontal: {:.17g}, scale_vertical: {:.17g}, scale_velocity: {:.17g}, "
                               "correlated_horizontal_m: {:.17g}, correlated_vertical_m: {:.17g}, correlated_time_s: {:.17g}}}",
                               scale.horizontal, scale.vertical, scale.velocity, correlated.horizontal_m, correlated.vertical_m,
                               correlated.time_s));
  }
  return entries.empty() ? text : text + "effects:\n" + entries;
}

}  // namespace coast::jobs
