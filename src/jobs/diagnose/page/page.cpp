// The page of `coast diagnose`: findings, their certainty, alternatives and gain.

#include <fmt/format.h>

#include <cmath>

#include "coast/diagnose/sentence.hpp"
#include "common/page_parts.hpp"
#include "diagnose/result.hpp"

namespace coast::jobs {

namespace {

using diagnose::Diagnosis;
using report::Verdict;

std::string change(double before, double after, int significant = 3) {
  return fmt::format("{} / {}", number(before, significant), number(after, significant));
}

std::vector<report::Tile> diagnosis_tiles(const Diagnosis& d) {
  std::vector<report::Tile> tiles(4);
  const std::size_t found = d.findings.size() + d.noise.size();
  tiles[0].label = "Missing effects";
  tiles[0].value = fmt::format("{}", found);
  tiles[0].verdict = found == 0 ? Verdict::kGood : Verdict::kWarn;
  tiles[0].explanation = "Of recordings in which nothing is missing one in twenty raises any.";
  tiles[0].section = "missing";
  tiles[1].label = "NIS before / after";
  tiles[1].value = change(d.before.nis, d.after.nis);
  tiles[1].verdict = std::abs(d.after.nis - 1.0) < 0.1 ? Verdict::kGood : Verdict::kWarn;
  tiles[1].explanation = "Squared innovations over their variance: 1 where the model is right.";
  tiles[1].section = "fit";
  tiles[2].label = "Outages of 20 s, before / after";
  tiles[2].value = change(d.before.outage_rms_m, d.after.outage_rms_m);
  tiles[2].unit = "m";
  tiles[2].verdict = d.after.outage_rms_m <= 1.02 * d.before.outage_rms_m ? Verdict::kGood : Verdict::kWarn;
  tiles[2].explanation = "Largest horizontal drift forward, rms over the sweep, against the run's own smoothed trajectory.";
  tiles[2].section = "fit";
  tiles[3].label = "Asked for";
  tiles[3].value = number(std::sqrt(d.threshold));
  tiles[3].unit = "sigma";
  tiles[3].explanation = "The largest of all effects exceeds it by chance in three clean recordings of a hundred.";
  tiles[3].section = "detectable";
  return tiles;
}

std::string sized(double value, double sd, std::string_view unit) {
  const std::string of = unit == "1" ? std::string() : fmt::format(" {}", unit);
  return sd > 0.0 ? fmt::format("{:.3g} +- {:.2g}{}", value, sd, of) : fmt::format("{:.3g}{}", value, of);
}

std::string p_value(double p) {
  constexpr double kLeast = 1e-15;  // for a tail computed in double precision
  return p < kLeast ? fmt::format("< {:.0g}", kLeast) : fmt::format("{:.1g}", p);
}

std::string when(const diagnose::Finding& f) {
  if (!f.from) return "always";
  const std::string begin = fmt::format("{:.1f} +- {:.1f}", f.from->sow(), f.from_sd_s);
  return f.to ? fmt::format("{} to {:.1f}", begin, f.to->sow()) : fmt::format("from {}", begin);
}

/// How sure the name of a finding is, if others come near it.
std::string certainty(const std::vector<diagnose::Alternative>& alternatives) {
  if (alternatives.empty()) return {};
  const diagnose::Alternative& first = alternatives.front();
  const std::string name = fmt::format("{} {}{}{}{}", first.name, first.sensor, first.axis.empty() ? "" : " ", first.axis,
                                       first.implausible ? " (of an implausible size)" : "");
  constexpr double kTwoToOne = 0.7;
  if (first.log_odds < -kTwoToOne) return fmt::format("{} would explain more, but was not selected.", name);
  if (first.log_odds < kTwoToOne) return fmt::format("It may as well be {}: this recording does not tell them apart.", name);
  return fmt::format("Less likely, but possible: {}.", name);
}

report::Table finding_table(const Diagnosis& d) {
  report::Table table;
  table.id = "findings";
  table.title = "Found, the likeliest first";
  table.caption =
      "Value: what the recording has beyond the configured model (lever arm: true minus configured; sensors: measured minus "
      "true). Gain: logarithm of the likelihood with the effect over that without it, as runs have it; held out: on blocks "
      "that "
      "its size was not estimated from.";
  table.columns = {{"effect", "", false}, {"sensor", "", false}, {"axis", "", false}, {"when, s of week", "", false},
                   {"value", "", false},  {"gain", ""},          {"held out", ""},    {"p", ""}};
  for (const diagnose::Finding& finding : d.findings)
    for (const diagnose::Finding& f : diagnose::times_of(finding))
      table.rows.push_back(cells({std::string(f.hypothesis.effect->name),
                                  std::string(diagnose::name(f.hypothesis.effect->site)), f.hypothesis.axis_name(), when(f),
                                  sized(f.value, f.sd, f.hypothesis.effect->unit), number(f.delta_log_likelihood),
                                  f.held_out_gain ? number(*f.held_out_gain) : std::string(), p_value(f.p_value)}));
  for (const diagnose::NoiseFinding& f : d.noise)
    table.rows.push_back(cells(
        {f.name, f.sensor, f.axis, "", sized(f.value, f.sd, f.unit), number(f.delta_log_likelihood), "", p_value(f.p_value)}));
  return table;
}

/// For whoever wants to know what to do and not why.
report::Section plain_section(const Diagnosis& d, const std::string& changed) {
  report::Section section;
  section.id = "plain";
  section.title = "In plain words";
  constexpr const char* kAlone = "No other known effect is a thousandth as likely.";
  for (const diagnose::Finding& f : d.findings)
    section.notes.push_back(
        {report::Note::Kind::kWarning, diagnose::sentence(f), f.alternatives.empty() ? kAlone : certainty(f.alternatives)});
  for (const diagnose::NoiseFinding& f : d.noise)
    section.notes.push_back({report::Note::Kind::kWarning, diagnose::sentence(f), certainty(f.alternatives)});
  section.lead = diagnose::consequence(d);
  if (const std::string why = why_not_accepted(d); !why.empty()) section.lead = why;
  section.notes.push_back({report::Note::Kind::kCode, "What to write into the run file (run.diagnosed.yaml has it)", changed});
  return section;
}

report::Section missing_section(const Diagnosis& d, const std::optional<SimulationCheck>& simulation) {
  report::Section section;
  section.id = "missing";
  section.title = "What is missing";
  if (d.findings.empty() && d.noise.empty()) {
    section.lead = "No effect is missing from the model that this mission could have shown.";
    return section;
  }
  section.lead = "What the recording has and the configured model has not, each with the equation that was missing.";
  for (const diagnose::Finding& f : d.findings)
    section.notes.push_back(
        {report::Note::Kind::kWarning, full_name(f), explanation(f) + std::string(in_simulation(f, simulation))});
  for (const diagnose::NoiseFinding& f : d.noise)
    section.notes.push_back({report::Note::Kind::kWarning, full_name(f), explanation(f)});
  if (!d.noise.empty())
    section.notes.push_back(
        {report::Note::Kind::kInfo, "Noise is fitted as a whole",
         "run.diagnosed.yaml has all of the fit, also what differs from what is stated by no more than chance "
         "and is not told here."});
  section.tables.push_back(finding_table(d));
  return section;
}

report::Section fit_section(const Diagnosis& d) {
  report::Section section;
  section.id = "fit";
  section.title = "The fit, before and after";
  section.lead = "The same filter on the recording as it is, and with what was found taken out.";
  report::Panel panel =
      report::stacked_time_panel("innovations", "Position innovations over their sigma", {kNed.begin(), kNed.end()}, "sigma",
                                 "White and within 3 where the model is right.");
  const auto add = [&](const std::vector<estimate::InnovationRecord>& innovations, const char* label, report::Tone tone) {
    for (int i = 0; i < 3; ++i) {
      std::vector<double> x, y;
      for (const estimate::InnovationRecord& r : innovations) {
        if (r.kind != estimate::UpdateKind::kGnssPosition) continue;
        x.push_back(r.t - innovations.front().t);
        y.push_back(r.nu(i) / r.sd(i));
      }
      report::add_line(panel.plots[static_cast<std::size_t>(i)], label, curve(x, y), tone);
    }
  };
  add(d.innovations_before, "before", report::Tone::kMuted);
  if (!d.findings.empty() || !d.noise.empty()) add(d.innovations_after, "after", report::Tone::kSmoothed);
  section.panels.push_back(std::move(panel));
  report::Table table;
  table.id = "fit-numbers";
  table.title = "In numbers";
  table.columns = {{"figure", "", false}, {"before", ""}, {"after", ""}};
  table.rows = {
      cells({"log-likelihood of an epoch", number(d.before.log_likelihood_per_epoch, 5),
             number(d.after.log_likelihood_per_epoch, 5)}),
      cells({"NIS over degrees of freedom", number(d.before.nis), number(d.after.nis)}),
      cells({"outages of 20 s, rms of horizontal maxima, m", number(d.before.outage_rms_m), number(d.after.outage_rms_m)})};
  section.tables.push_back(std::move(table));
  if (d.held_out)
    section.notes.push_back(
        {report::Note::Kind::kInfo, "On data that the sizes were not estimated from",
         fmt::format("Sizes from one half of the mission, in alternating blocks, on the other: logarithm of the "
                     "likelihood ratio {:.1f} +- {:.1f}, better in {:.0f} % of {} blocks.",
                     d.held_out->gain, d.held_out->gain_sd, 100.0 * d.held_out->better, d.held_out->blocks)});
  if (const std::string why = why_not_accepted(d); !why.empty())
    section.notes.push_back({report::Note::Kind::kWarning, "Not accepted", why});
  for (const diagnose::Rejected& one : d.rejected)
    section.notes.push_back(
        {report::Note::Kind::kWarning, "Given up", fmt::format("{}: {}.", one.effect, why_rejected(one.reason))});
  return section;
}

report::Section detectable_section(const Diagnosis& d) {
  report::Section section;
  section.id = "detectable";
  section.title = "What would have been seen";
  section.lead = fmt::format(
      "Of every effect that was not found: the smallest size that this mission shows with a probability of 80 %; of what may "
      "begin at "
      "any time, at the median instant. Plausible: what is usual for an IMU of the grade \"{}\"; where the smallest is larger, "
      "the "
      "effect may be there unseen.",
      diagnose::name(d.grade));
  report::Table table;
  table.id = "detectable-sizes";
  table.title = "Smallest detectable sizes";
  table.columns = {{"effect", "", false}, {"sensor", "", false}, {"axis", "", false},
                   {"smallest", ""},      {"plausible", ""},     {"unit", "", false}};
  for (const diagnose::Detectable& one : d.detectable_not_found)
    table.rows.push_back(
        cells({std::string(one.hypothesis.effect->name), std::string(diagnose::name(one.hypothesis.effect->site)),
               one.hypothesis.axis_name(), fmt::format("{:.2g}", one.minimal), fmt::format("{:.2g}", one.hypothesis.plausible),
               std::string(one.hypothesis.effect->unit)}));
  section.tables.push_back(std::move(table));
  report::Table blind;
  blind.id = "not-observable";
  blind.title = "Not to be seen here";
  blind.columns = {{"effect", "", false}, {"sensor", "", false}, {"axis", "", false}, {"why", "", false}};
  for (const diagnose::NotObservable& one : d.not_observable)
    blind.rows.push_back(
        cells({std::string(one.hypothesis.effect->name), std::string(diagnose::name(one.hypothesis.effect->site)),
               one.hypothesis.axis_name(), one.reason}));
  section.tables.push_back(std::move(blind));
  return section;
}

}  // namespace

report::Page diagnosis_page(const std::string& title, const DiagnosisResult& result, const std::string& diagnosed_yaml,
                            const std::string& changed) {
  const Diagnosis& d = result.diagnosis;
  const std::optional<SimulationCheck>& simulation = result.simulation;
  report::Page page;
  page.title = title;
  page.subtitle = "What the configured model leaves out";
  if (!d.innovations_before.empty()) page.start = d.innovations_before.front().t;
  page.tiles = diagnosis_tiles(d);
  if (!d.findings.empty() || !d.noise.empty()) page.sections.push_back(plain_section(d, changed));
  page.sections.push_back(missing_section(d, simulation));
  page.sections.push_back(fit_section(d));
  if (result.quick) page.sections.front().notes.push_back({report::Note::Kind::kInfo, "Quick", std::string(kQuick)});
  if (!d.twins.empty()) page.sections.push_back(twin_section(d, simulation));
  page.sections.push_back(detectable_section(d));
  page.sections.back().notes.push_back(
      {report::Note::Kind::kCode, "run.diagnosed.yaml: the run with what was found", diagnosed_yaml});
  page.footer = fmt::format("coast {}, coast diagnose", COAST_VERSION);
  return page;
}

}  // namespace coast::jobs
