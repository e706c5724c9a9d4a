#include "run_file/run_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/diagnose/noise_effect.hpp"
#include "coast/diagnose/sample_effect.hpp"
#include "coast/diagnose/suggested.hpp"

namespace coast::jobs {

namespace {

using config::Node;

/// The catalogue's effect with a name and a sensor, one suggested by a recording, or a random one.
diagnose::NamedEffect named_effect(const Node& item) {
  const auto axis_of = [&](const std::vector<std::string>& names) -> Eigen::Index {
    if (names.front().empty()) return 0;
    return static_cast<Eigen::Index>(item.at("axis").choice({names.begin(), names.end()}));
  };
  std::vector<std::string_view> names{"harmonic_disturbance", "unknown"};
  const auto add = [&](const auto& effect) {
    if (std::ranges::find(names, effect.name) == names.end()) names.push_back(effect.name);
  };
  for (const diagnose::Effect& effect : diagnose::catalogue()) add(effect);
  for (const diagnose::NoiseEffect& effect : diagnose::noise_catalogue())
    if (effect.level) add(effect);
  for (const diagnose::SampleEffect& effect : diagnose::sample_catalogue()) add(effect);
  const std::string_view name = names[item.at("name").choice(names)];
  const std::string sensor = item.at("sensor").text();
  const auto is_meant = [&](const auto& e) { return e.name == name && diagnose::name(e.site) == sensor; };
  diagnose::NamedEffect one;
  one.value = item.at("value").number();
  const auto& known = diagnose::catalogue();
  const auto& random = diagnose::noise_catalogue();
  const auto& of_samples = diagnose::sample_catalogue();
  if (const auto effect = std::ranges::find_if(known, is_meant); effect != known.end()) {
    one.effect = &*effect;
    one.axis = axis_of(effect->axes);
  } else if (const auto noise = std::ranges::find_if(random, is_meant); noise != random.end() && noise->level) {
    one.noise = &*noise;
    one.axis = axis_of(diagnose::three_axes());
  } else if (const auto sample = std::ranges::find_if(of_samples, is_meant); sample != of_samples.end()) {
    one.sample = &*sample;
    one.axis = axis_of(diagnose::three_axes());
  } else if ((name == "harmonic_disturbance" || name == "unknown") && (sensor == "gyro" || sensor == "accel")) {
    const diagnose::Site site = sensor == "gyro" ? diagnose::Site::kGyro : diagnose::Site::kAccel;
    const auto axis = static_cast<int>(axis_of(diagnose::three_axes()));
    if (name == "unknown") {
      std::vector<std::string_view> relations;
      for (const diagnose::Relation& r : diagnose::relations()) relations.push_back(r.name);
      one.suggested = diagnose::unknown_relation(site, axis, std::string(relations[item.at("relation").choice(relations)]));
    } else {
      one.suggested =
          diagnose::harmonic_disturbance(site, axis, item.at("frequency_hz").number(), item.at("phase_rad").number());
    }
    one.effect = one.suggested.get();
  } else {
    throw item.at("sensor").error(fmt::format("no {} of {}", name, sensor), "the sensor that diagnosis.json names with it");
  }
  return one;
}

}  // namespace

std::vector<diagnose::NamedEffect> read_effects(const Node& list) {
  std::vector<diagnose::NamedEffect> effects;
  for (const Node& item : list.items()) {
    diagnose::NamedEffect one = named_effect(item);
    const auto from = item.find("start_s");
    const auto to = item.find("end_s");
    if ((from || to) && one.effect != nullptr && one.effect->needs_reference)
      throw item.error("an instant", "none: the base stays where it is");
    if ((from || to) && one.effect == nullptr)
      throw item.error("an instant", "none: noise and converters are the same all the time");
    if ((from || to) && one.effect != nullptr && one.effect->slip)
      throw item.error("an instant", fmt::format("none: {} is configured for the whole mission", one.effect->name));
    if (from) one.from_s = from->number();
    if (to) one.to_s = to->number();
    effects.push_back(std::move(one));
  }
  return effects;
}

}  // namespace coast::jobs
