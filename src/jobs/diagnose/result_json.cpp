#include "diagnose/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coast/diagnose/sentence.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;
using diagnose::Hypothesis;

Json hypothesis_json(const Hypothesis& h) {
  return {{"name", h.effect->name}, {"sensor", diagnose::name(h.effect->site)}, {"axis", h.axis_name()}};
}

Json parameter_json(std::string_view name, double value, std::string_view unit) {
  return {{"name", name}, {"value", value}, {"unit", unit}};
}

Json alternative_json(const diagnose::Alternative& a, std::string_view separating_manoeuvre) {
  Json j = {{"name", a.name},
            {"sensor", a.sensor},
            {"axis", a.axis},
            {"log_odds", a.log_odds},
            {"separating_manoeuvre", separating_manoeuvre}};
  if (a.implausible) j["implausible"] = true;
  return j;
}

/// Odds of an alternative against the reported finding; above one if it is likelier, but the search for more effects stopped.
std::string odds(double log_odds) {
  return log_odds < 0.0 ? fmt::format("{:.0f} : 1", std::exp(-log_odds)) : fmt::format("1 : {:.0f}", std::exp(log_odds));
}

std::string other_readings(const std::vector<diagnose::Alternative>& alternatives, std::string_view separating_manoeuvre) {
  if (alternatives.empty()) return {};
  std::string text = " It could also be";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, alternatives.size()); ++i)
    text +=
        fmt::format("{} {}{}{} ({}{})", i == 0 ? "" : ",", alternatives[i].name, alternatives[i].axis.empty() ? "" : " ",
                    alternatives[i].axis, odds(alternatives[i].log_odds), alternatives[i].implausible ? ", implausible" : "");
  return text + fmt::format(". What would tell: {}", separating_manoeuvre);
}

Json times_json(const diagnose::Finding& f, double end_s) {
  Json times = Json::array();
  for (const diagnose::Finding& one : diagnose::times_of(f))
    times.push_back({{"axis", one.hypothesis.axis_name()},
                     {"t_start_s", one.from->sow()},
                     {"t_end_s", one.to ? one.to->sow() : end_s},
                     {"value", one.value},
                     {"std", one.sd},
                     {"delta_log_likelihood", one.delta_log_likelihood}});
  return times;
}

Json finding_json(const diagnose::Finding& f, double start_s, double end_s) {
  const diagnose::Effect& effect = *f.hypothesis.effect;
  Json j = hypothesis_json(f.hypothesis);
  j["t_start_s"] = f.from ? f.from->sow() : start_s;
  j["t_end_s"] = f.to ? f.to->sow() : end_s;
  if (f.from) j["t_start_std_s"] = f.from_sd_s;
  j["parameters"] = Json::array({{{"name", effect.parameter}, {"value", f.value}, {"std", f.sd}, {"unit", effect.unit}}});
  for (const diagnose::FixedParameter& one : effect.fixed)
    j["parameters"].push_back(parameter_json(one.name, one.value, one.unit));
  if (!effect.relation.empty()) j["relation"] = effect.relation;
  if (f.stability) j["stability"] = *f.stability;
  if (f.held_out_gain) j["held_out_gain"] = *f.held_out_gain;
  j["delta_log_likelihood"] = f.delta_log_likelihood;
  j["p_value"] = f.p_value;
  if (!f.further.empty()) j["times"] = times_json(f, end_s);
  j["sentence"] = diagnose::sentence(f);
  j["explanation"] = explanation(f);
  j["confounded_with"] = Json::array();
  for (const diagnose::Alternative& a : f.alternatives) {
    j["confounded_with"].push_back(alternative_json(a, effect.separating_manoeuvre));
  }
  return j;
}

Json noise_json(const diagnose::NoiseFinding& f, double start_s, double end_s) {
  Json j = {{"name", f.name}, {"sensor", f.sensor}, {"axis", f.axis}, {"t_start_s", start_s}, {"t_end_s", end_s}};
  j["parameters"] = Json::array({{{"name", f.parameter}, {"value", f.value}, {"std", f.sd}, {"unit", f.unit}}});
  if (f.by_axis)
    for (int axis = 0; axis < 3; ++axis)
      j["parameters"].push_back(parameter_json(fmt::format("{}_{}", f.parameter, "xyz"[axis]), (*f.by_axis)(axis), f.unit));
  if (f.time_s > 0.0) {
    j["parameters"].push_back(parameter_json("correlation_time", f.time_s, "s"));
    if (f.time_sd_s > 0.0) j["parameters"].back()["std"] = f.time_sd_s;
  }
  j["delta_log_likelihood"] = f.delta_log_likelihood;
  j["p_value"] = f.p_value;
  j["sentence"] = diagnose::sentence(f);
  j["explanation"] = explanation(f);
  j["confounded_with"] = Json::array();
  for (const diagnose::Alternative& a : f.alternatives)
    j["confounded_with"].push_back(alternative_json(a, f.separating_manoeuvre));
  return j;
}

}  // namespace

std::string full_name(const diagnose::Finding& f) {
  const std::string axis = f.further.empty() ? f.hypothesis.axis_name() : std::string();
  return fmt::format("{}{}{}", f.hypothesis.effect->name, axis.empty() ? "" : " ", axis);
}

std::string full_name(const diagnose::NoiseFinding& f) {
  return fmt::format("{} {}{}{}", f.name, f.sensor, f.axis.empty() ? "" : " ", f.axis);
}

std::string explanation(const diagnose::Finding& f) {
  const diagnose::Effect& effect = *f.hypothesis.effect;
  std::string text = fmt::format("{} {}: {} = {:.3g} +- {:.2g} {}{}.", effect.meaning, effect.equation, effect.parameter,
                                 f.value, f.sd, effect.unit, f.further.empty() ? "" : " for the likeliest of them");
  if (f.alternatives.empty()) return text + " No other reading of it was found.";
  return text + other_readings(f.alternatives, effect.separating_manoeuvre);
}

std::string explanation(const diagnose::NoiseFinding& f) {
  std::string text = f.meaning.empty() ? "The innovations are likelier with other noise than with the one stated:"
                                       : fmt::format("{} {}:", f.meaning, f.equation);
  text += fmt::format(" {} = {:.3g}", f.parameter, f.value);
  if (f.sd > 0.0) text += fmt::format(" +- {:.2g}", f.sd);
  if (f.by_axis)
    text += fmt::format(" in the mean of x, y, z ({:.3g}, {:.3g}, {:.3g})", f.by_axis->x(), f.by_axis->y(), f.by_axis->z());
  text += f.unit == "1" ? " times what is stated" : fmt::format(" {}", f.unit);
  text += f.time_s > 0.0 ? fmt::format(", T about {:.2g} s.", f.time_s) : ".";
  return text + other_readings(f.alternatives, f.separating_manoeuvre);
}

std::string why_not_accepted(const diagnose::Diagnosis& d) {
  if (d.findings.empty() && d.noise.empty()) return {};
  if (!(d.after.log_likelihood_per_epoch > d.before.log_likelihood_per_epoch))
    return "All that was found together makes the recording no likelier. What is really missing is not known.";
  if (diagnose::drifts_farther(d.before, d.after))
    return fmt::format(
        "With all that was found together outages drift farther, {:.3g} m before and {:.3g} m now: the fixes are "
        "likelier, the motion between them is not.",
        d.before.outage_rms_m, d.after.outage_rms_m);
  return {};
}

std::string_view why_rejected(diagnose::Rejected::Reason reason) {
  switch (reason) {
    case diagnose::Rejected::Reason::kHeldOut:
      return "its size from one half of the mission does not explain the other half";
    case diagnose::Rejected::Reason::kOutages:
      return "artificial outages drift farther with it";
  }
  return {};
}

bool SimulationCheck::has(const diagnose::Finding& finding) const {
  constexpr double kEqual = 4.0;  // standard deviations of the difference
  const diagnose::Effect& effect = *finding.hypothesis.effect;
  const auto is_same = [&](const diagnose::Finding& other) {
    const diagnose::Effect& its = *other.hypothesis.effect;
    return its.name == effect.name && its.site == effect.site && its.relation == effect.relation &&
           other.hypothesis.axis_name() == finding.hypothesis.axis_name() &&
           std::abs(other.value - finding.value) < kEqual * std::hypot(other.sd, finding.sd);
  };
  return std::ranges::any_of(diagnosis.findings, [&](const diagnose::Finding& other) {
    return is_same(other) || std::ranges::any_of(other.further, is_same);
  });
}

namespace {

Json effects_json(const diagnose::Diagnosis& d, double start, double end, const std::optional<SimulationCheck>& simulation) {
  std::vector<Json> effects;
  for (const diagnose::Finding& f : d.findings) {
    effects.push_back(finding_json(f, start, end));
    if (simulation) effects.back()["in_simulation"] = simulation->has(f);
  }
  for (const diagnose::NoiseFinding& f : d.noise) effects.push_back(noise_json(f, start, end));
  std::ranges::stable_sort(effects, std::ranges::greater{},
                           [](const Json& effect) { return effect["delta_log_likelihood"].get<double>(); });
  return effects;
}

Json twins_json(const std::vector<diagnose::TwinStatistic>& twins) {
  Json list = Json::array();
  for (const diagnose::TwinStatistic& t : twins)
    list.push_back({{"statistic", t.name},
                    {"real", t.real},
                    {"q05", t.q05},
                    {"q50", t.q50},
                    {"q95", t.q95},
                    {"p_adjusted", t.p_adjusted}});
  return list;
}

Json verification_json(const diagnose::Diagnosis& d) {
  Json j = {{"log_likelihood_per_epoch", {d.before.log_likelihood_per_epoch, d.after.log_likelihood_per_epoch}},
            {"nis", {d.before.nis, d.after.nis}},
            {"outage_rms_m", {d.before.outage_rms_m, d.after.outage_rms_m}},
            {"outage_difference_m",
             {{"mean", d.outage_change.mean}, {"sd", d.outage_change.sd}, {"outages", d.outage_change.count}}}};
  if (d.held_out) {
    j["held_out_log_likelihood_per_epoch"] = {d.held_out->before_per_epoch, d.held_out->after_per_epoch};
    j["held_out"] = {{"gain", d.held_out->gain},
                     {"sd", d.held_out->gain_sd},
                     {"blocks", d.held_out->blocks},
                     {"better", d.held_out->better}};
  }
  if (!d.twins_after.empty()) j["twins"] = twins_json(d.twins_after);
  j["rejected"] = Json::array();
  for (const diagnose::Rejected& one : d.rejected)
    j["rejected"].push_back({{"effect", one.effect}, {"reason", why_rejected(one.reason)}});
  j["accepted"] = why_not_accepted(d).empty();
  return j;
}

}  // namespace

std::string diagnosis_json(const DiagnosisResult& result) {
  const diagnose::Diagnosis& d = result.diagnosis;
  const std::optional<SimulationCheck>& simulation = result.simulation;
  const double start = result.start.sow();
  const double end = result.end.sow();
  Json j;
  j["schema"] = "coast.diagnosis/1";
  j["mismatch"] = !d.findings.empty() || !d.noise.empty();
  j["quick"] = result.quick;
  j["reference_used"] = d.reference_used;
  j["effects"] = effects_json(d, start, end, simulation);
  if (simulation)
    j["simulation"] = {{"source", simulation->source}, {"effects", effects_json(simulation->diagnosis, start, end, {})}};
  j["detectable_not_found"] = Json::array();
  for (const diagnose::Detectable& one : d.detectable_not_found) {
    Json entry = hypothesis_json(one.hypothesis);
    entry["minimal"] = one.minimal;
    entry["unit"] = one.hypothesis.effect->unit;
    j["detectable_not_found"].push_back(entry);
  }
  j["not_observable"] = Json::array();
  for (const diagnose::NotObservable& one : d.not_observable) {
    Json entry = hypothesis_json(one.hypothesis);
    entry["reason"] = one.reason;
    j["not_observable"].push_back(entry);
  }
  j["twins"] = twins_json(d.twins);
  j["verification"] = verification_json(d);
  j["modelled_run"] = "run.diagnosed.yaml";
  j["grade"] = diagnose::name(d.grade);
  j["threshold"] = d.threshold;
  j["runs"] = d.runs;
  return j.dump(1) + "\n";
}

std::string_view in_simulation(const diagnose::Finding& finding, const std::optional<SimulationCheck>& simulation) {
  if (!simulation) return {};
  return simulation->has(finding) ? " The simulation has it too." : " The simulation does not have it.";
}

namespace {

/// A line for each time of a finding that repeats.
std::string times_text(const diagnose::Finding& f) {
  std::string text;
  if (f.further.empty()) return text;
  for (const diagnose::Finding& one : diagnose::times_of(f)) text += fmt::format("  {}\n", diagnose::sentence_of_one(one));
  return text;
}

}  // namespace

std::string diagnosis_text(const DiagnosisResult& result) {
  const diagnose::Diagnosis& d = result.diagnosis;
  const std::optional<SimulationCheck>& simulation = result.simulation;
  std::string text;
  if (d.findings.empty() && d.noise.empty()) text = "Nothing is missing from the model that this mission could show.\n";
  for (const diagnose::Finding& f : d.findings)
    text +=
        fmt::format("{} [{}]{}{}\n", diagnose::sentence(f), full_name(f),
                    other_readings(f.alternatives, f.hypothesis.effect->separating_manoeuvre), in_simulation(f, simulation)) +
        times_text(f);
  for (const diagnose::NoiseFinding& f : d.noise)
    text +=
        fmt::format("{} [{}]{}\n", diagnose::sentence(f), full_name(f), other_readings(f.alternatives, f.separating_manoeuvre));
  if (const std::string gain = diagnose::consequence(d); !gain.empty()) text += gain + "\n";
  for (const diagnose::RunKey& key : keys_found(d))
    text += fmt::format("The run file states it: `{}: {{{}: {}}}`.\n", key.section, key.name, key.text(d.modelled.setup));
  if (const std::string why = why_not_accepted(d); !why.empty()) text += fmt::format("Not accepted. {}\n", why);
  if (result.quick) text += std::string(kQuick) + "\n";
  if (simulation)
    for (const diagnose::Finding& f : simulation->diagnosis.findings)
      if (!SimulationCheck{{}, d}.has(f))
        text += fmt::format("{}, {:.3g} {}: in the simulation alone.\n", full_name(f), f.value, f.hypothesis.effect->unit);
  return text;
}

}  // namespace coast::jobs
