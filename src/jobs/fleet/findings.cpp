// What was found, a sentence each.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "coast/geo/time.hpp"
#include "common/page_parts.hpp"
#include "fleet/result.hpp"

namespace coast::jobs {

namespace {

using fleet::Change;
using fleet::ChangeKind;

constexpr std::size_t kMany = 3;  // units that have something in common

const Change& change_of(const fleet::FleetChanges& changes, const FleetFinding::Part& part) {
  return changes.panels[part.panel].changes[part.change];
}

bool overlap(const Change& a, const Change& b) {
  return a.t_95.first <= b.t_95.second && b.t_95.first <= a.t_95.second;
}

/// Whether two changes are one event: same kind, same time, and the same units, or both of many units, or one of some of them.
bool belong_together(const Change& a, const Change& b, const std::set<std::string>& units_a,
                     const std::set<std::string>& units_b) {
  if (a.kind != b.kind || a.factor != b.factor || a.level != b.level) return false;
  if (a.kind == ChangeKind::kStep && !overlap(a, b)) return false;
  const auto& [fewer, more] = std::minmax(units_a, units_b, [](const auto& x, const auto& y) { return x.size() < y.size(); });
  if (fewer.size() >= kMany) return true;
  if (more.size() >= kMany) return a.kind != ChangeKind::kDrift && std::ranges::includes(more, fewer);
  return units_a == units_b;
}

std::set<std::string> units_of(const fleet::Panel& panel, const Change& change) {
  std::set<std::string> names;
  for (const std::size_t u : change.units) names.insert(panel.series[u].unit);
  return names;
}

std::string size_text(const fleet::Panel& panel, const Change& change) {
  // As many decimals as two digits of the sigma have.
  const double sd = change.common_sd;
  const int power = sd > 0.0 ? static_cast<int>(std::floor(std::log10(sd))) : 0;
  const int count = std::max(1 - power, 0);
  const std::string per = change.kind == ChangeKind::kDrift ? "/year" : "";
  const std::string size = count > 6 ? fmt::format("{:+.3g} +- {:.2g}", change.common_size, sd)
                                     : fmt::format("{:+.{}f} +- {:.{}f}", change.common_size, count, sd, count);
  return fmt::format("{} {} {}{}", figure_name(panel), size, panel.unit_of_value, per);
}

std::string list_of(const std::vector<std::string>& units) {
  constexpr std::size_t kNamed = 12;
  if (units.size() <= kNamed) return joined(units, ", ");
  return joined({units.begin(), units.begin() + kNamed}, ", ") + fmt::format(" and {} more", units.size() - kNamed);
}

std::string what_it_may_be(const FleetFinding& finding, const FleetEstimates& estimates, const Change& first) {
  const std::string& quantity = estimates.fleet.panels[finding.parts.front().panel].quantity;
  if (finding.units.size() >= kMany)
    return first.kind == ChangeKind::kDrift ? "" : " They have something in common: firmware, a setting, the processing?";
  const bool of_mounting = quantity.starts_with("lever_arm") || quantity.starts_with("mounting");
  if (first.kind == ChangeKind::kDrift) return of_mounting ? " Does its mount give way?" : " The unit ages.";
  if (quantity.starts_with("lever_arm")) return " Was the antenna moved?";
  if (quantity.starts_with("mounting")) return " Was the unit mounted anew?";
  return "";
}

void say(FleetFinding& finding, const FleetEstimates& estimates, const fleet::FleetChanges& changes) {
  const Change& first = change_of(changes, finding.parts.front());
  std::vector<std::string> sizes;
  for (const FleetFinding::Part& part : finding.parts)
    sizes.push_back(size_text(estimates.fleet.panels[part.panel], change_of(changes, part)));
  const bool many = finding.units.size() >= kMany;
  const std::string who = many ? fmt::format("{} units ({})", finding.units.size(), list_of(finding.units))
                               : fmt::format("Unit {}", joined(finding.units, " and "));
  std::string what;
  if (first.kind == ChangeKind::kDrift)
    what = many ? " drift" : " drifts";
  else if (first.kind == ChangeKind::kGroupLevel)
    what = fmt::format(" differ{} where {} is \"{}\"", many ? "" : "s", estimates.fleet.factors[first.factor], first.level);
  else
    what = fmt::format(" changed on {} (95 %: {} to {})", day_of(estimates, first.t), day_of(estimates, first.t_95.first),
                       day_of(estimates, first.t_95.second));
  finding.sentence = fmt::format("{}{}: {}.{}", who, what, joined(sizes, ", "), what_it_may_be(finding, estimates, first));
}

}  // namespace

const char* name_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kStep:
      return "step";
    case ChangeKind::kDrift:
      return "drift";
    case ChangeKind::kGroupLevel:
      return "group";
  }
  return "";
}

std::string figure_name(const fleet::Panel& panel) {
  return panel.axis.empty() ? panel.quantity : panel.quantity + " " + panel.axis;
}

std::string day_of(const FleetEstimates& estimates, double years) {
  return geo::to_string(estimates.start + years * 365.25 * 86400.0).substr(0, 10);
}

std::vector<FleetFinding> fleet_findings(const FleetEstimates& estimates, const fleet::FleetChanges& changes) {
  std::vector<FleetFinding::Part> parts;
  for (std::size_t p = 0; p < changes.panels.size(); ++p)
    for (std::size_t c = 0; c < changes.panels[p].changes.size(); ++c) parts.push_back({p, c});
  // Those of many units first, that single ones can join them.
  std::ranges::stable_sort(parts, [&](const auto& a, const auto& b) {
    const Change& of_a = change_of(changes, a);
    const Change& of_b = change_of(changes, b);
    const bool many_a = of_a.units.size() >= kMany;
    const bool many_b = of_b.units.size() >= kMany;
    return many_a != many_b ? many_a : of_a.statistic > of_b.statistic;
  });
  std::vector<FleetFinding> findings;
  for (const FleetFinding::Part& part : parts) {
    const Change& change = change_of(changes, part);
    std::set<std::string> units = units_of(estimates.fleet.panels[part.panel], change);
    const auto known = std::ranges::find_if(findings, [&](const FleetFinding& finding) {
      return belong_together(change_of(changes, finding.parts.front()), change, {finding.units.begin(), finding.units.end()},
                             units);
    });
    FleetFinding& finding = known == findings.end() ? findings.emplace_back() : *known;
    units.insert(finding.units.begin(), finding.units.end());
    finding.units.assign(units.begin(), units.end());
    finding.parts.push_back(part);
    finding.p = std::min(finding.p, change.p);
  }
  std::ranges::stable_sort(findings, [&](const FleetFinding& a, const FleetFinding& b) {
    return change_of(changes, a.parts.front()).statistic > change_of(changes, b.parts.front()).statistic;
  });
  for (FleetFinding& finding : findings) say(finding, estimates, changes);
  return findings;
}

std::string departure_sentence(const FleetEstimates& estimates, const fleet::Departure& d) {
  const fleet::Panel& panel = estimates.fleet.panels[d.panel];
  const fleet::Estimate& e = estimate_of(estimates.fleet, d);
  const double difference = e.value - d.expected;
  return fmt::format("Mission {} of unit {} ({}) departs in {} by {} {}, {} sigma from what the unit's other missions say.",
                     e.mission, panel.series[d.series].unit, day_of(estimates, e.t), figure_name(panel), number(difference),
                     panel.unit_of_value, decimals(std::abs(d.standardised), 1));
}

}  // namespace coast::jobs
