// The acceptance sheet: seven numbers that decide whether a trajectory is accepted.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/geo/units.hpp"
#include "process/page/curves.hpp"
#include "process/page/parts.hpp"
#include "process/page/separation.hpp"
#include "process/summary.hpp"

namespace coast::jobs {

namespace {

using report::Tile;
using report::Verdict;

constexpr double kCm = 0.01;  // m

Verdict below(double value, double good, double warn) {
  return value <= good ? Verdict::kGood : value <= warn ? Verdict::kWarn : Verdict::kBad;
}

/// Good from 90 % of ambiguity-fixed epochs, to be checked from 50 %; not judged if the file has no quality. More than one
/// rejected fix in a hundred is to be checked; beyond one in ten the filter and the fixes contradict each other.
Tile quality_tile(const ProcessPage& page) {
  constexpr std::size_t kMostNames = 3;
  auto qualities = page.result.qualities;
  std::ranges::stable_sort(qualities, [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<Tile::Share> shares;
  std::vector<std::string> values;
  std::vector<std::string> names;
  double fixed = 0.0;
  double stated = 0.0;
  for (const auto& [quality, count] : qualities) {
    const double share = static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(page.result.gnss_epochs, 1));
    shares.push_back({report::name_of(quality), share, report::tone_of(quality)});
    if (quality != record::FixQuality::kUnknown) stated += share;
    if (quality == record::FixQuality::kFixed || quality == record::FixQuality::kPpp) fixed += share;
    if (shares.size() > kMostNames) continue;
    values.push_back(share == 1.0 ? "100" : percent(share));
    names.push_back(report::name_of(quality));
  }
  const std::size_t offered = page.result.gnss_used + page.result.gnss_rejected;
  const double refused = offered > 0 ? static_cast<double>(page.result.gnss_rejected) / static_cast<double>(offered) : 0.0;
  const bool known = stated > 0.0;
  Tile tile{
      "GNSS quality", known ? joined(values, " / ") : "not stated", known ? "%" : "", Verdict::kNone, "", std::move(shares),
      "plan"};
  if (known) tile.explanation = fmt::format("{}; above 90 % fixed is good. ", joined(names, " / "));
  if (stated > 0.5) tile.verdict = below(1.0 - fixed, 0.1, 0.5);
  if (refused > 0.01) tile.verdict = std::max(tile.verdict, below(refused, 0.01, 0.1));
  tile.explanation += fmt::format("Of {} epochs {} were used, {} % refused by the gate; below 1 % is good.",
                                  page.result.gnss_epochs, page.result.gnss_used, percent(refused));
  return tile;
}

/// Treatment of the stated arm by the run.
enum class Arm { kTaken, kFreed, kToBeFound };

Arm arm_of(const ProcessPage& page) {
  if (page.config.setup.filter.auxiliary.lever_arm_sd_m > 0.0) return Arm::kToBeFound;
  return page.result.used.filter.auxiliary.lever_arm_sd_m > 0.0 ? Arm::kFreed : Arm::kTaken;
}

/// A misclosure that the run has accounted for does not spoil the result: an arm to be estimated is compared with its stated
/// sigma, an arm that the recording contradicts is to be checked. It is bad only if the run reports that the recording
/// contradicts the arm: a bad tile with a good verdict would be inconsistent.
Verdict arm_verdict(const ProcessPage& page, double difference, double sd) {
  constexpr double kTolerance = 0.05;  // m
  constexpr double kSigmas = 3.0;
  const bool large = std::abs(difference) >= kTolerance;
  const Arm arm = arm_of(page);
  if (arm == Arm::kToBeFound) {
    const double stated = page.config.setup.filter.auxiliary.lever_arm_sd_m;
    return std::abs(difference) > kSigmas * std::hypot(stated, sd) ? Verdict::kWarn : Verdict::kGood;
  }
  const bool significant = std::abs(difference) > kSigmas * sd;
  const bool contradicted =
      std::ranges::find(page.result.events, "lever_arm_contradicted", &record::Event::kind) != page.result.events.end();
  if (large && significant && arm == Arm::kTaken && contradicted) return Verdict::kBad;
  return large || significant ? Verdict::kWarn : Verdict::kGood;
}

/// A component is used if its sigma is below 10 cm. Good: all within 3 sigma and below 5 cm.
std::optional<Tile> lever_arm_tile(const ProcessPage& page) {
  if (!page.result.lever_arm) return std::nullopt;
  constexpr double kObservable = 0.10;  // m, one sigma
  const auto& [difference, sd] = *page.result.lever_arm;
  const bool metres = difference.cwiseAbs().maxCoeff() >= 1.0;  // m; with such a difference another point was measured
  const double unit = metres ? 1.0 : kCm;
  Tile tile{"Lever-arm misclosure", "", metres ? "m" : "cm", Verdict::kNone, "", {}, "sensors"};
  std::vector<std::string> unknown;
  const std::array<std::string, 3> names{"forward", "right", "down"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i > 0) tile.value += " / ";
    tile.value += decimals(difference(i) / unit, metres ? 2 : 1);
    if (sd(i) > kObservable) {
      unknown.push_back(names[static_cast<std::size_t>(i)]);
      continue;
    }
    tile.verdict = std::max(tile.verdict, arm_verdict(page, difference(i), sd(i)));
  }
  tile.explanation = fmt::format("Estimated minus configured, forward / right / down; sigma {:.1f} / {:.1f} / {:.1f} cm. ",
                                 sd.x() / kCm, sd.y() / kCm, sd.z() / kCm);
  if (!unknown.empty())
    tile.explanation += fmt::format("The motion does not tell {}: sigma above 10 cm.", joined(unknown, ", "));
  else if (arm_of(page) == Arm::kToBeFound)
    tile.explanation += "Estimated, as asked for; within 3 times the sigma stated for it is good.";
  else
    tile.explanation +=
        arm_of(page) == Arm::kFreed ? "The arm that the recording shows is used." : "Within 3 sigma and 5 cm is good.";
  return tile;
}

/// Judged relative to its own sigma, not in metres: up to 1.5 sigma rms good, beyond 3 the filters contradict each other.
constexpr double kConsistent = 1.5;
constexpr double kContradicting = 3.0;
// For any stated sigma, a trajectory with degrees of roll or pitch between its two filters is not good.
constexpr double kGoodTilt = 2.0, kUsableTilt = 8.0;  // deg

Tile position_separation_tile(const SeparationSummary& s) {
  return {"Separation, position",
          fmt::format("{} / {}", number(s.horizontal_rms_m, 2), number(s.vertical_rms_m, 2)),
          "m",
          below(s.position_over_sigma, kConsistent, kContradicting),
          fmt::format("Forward minus backward, rms horizontal / vertical; 95 % {} / {} m. {} times its sigma; near 1 is good.",
                      number(s.horizontal_95_m, 2), number(s.vertical_95_m, 2), number(s.position_over_sigma, 2)),
          {},
          "separation"};
}

Tile attitude_separation_tile(const SeparationSummary& s) {
  const Eigen::Vector3d rms = s.attitude_rms / geo::kArcMinute;
  return {"Separation, attitude",
          triple({rms.z(), rms.y(), rms.x()}),
          "arcmin",
          std::max(below(s.attitude_over_sigma, kConsistent, kContradicting),
                   below(std::max(s.attitude_rms.x(), s.attitude_rms.y()) / geo::kDegree, kGoodTilt, kUsableTilt)),
          fmt::format("Forward minus backward, rms of heading / pitch / roll. {} times its sigma; near 1 is good.",
                      number(s.attitude_over_sigma, 2)),
          {},
          "separation-attitude"};
}

/// 10 % in sigma is 20 % in variance: no stated sigma is better. Beyond a factor 1.4 (2 in variance) the bands mislead.
std::optional<Tile> innovation_tile(const ProcessPage& page) {
  const NisSummary& nis = page.result.nis;
  if (nis.epochs == 0 || !(nis.expected > 0.0)) return std::nullopt;
  const double ratio = std::sqrt(nis.mean / nis.expected);
  const double factor = std::max(ratio, 1.0 / std::max(ratio, 1e-9));
  return Tile{"Innovations over sigma",
              fmt::format("{:.2f}", ratio),
              "",
              below(factor, 1.1, 1.4),
              fmt::format("Root mean square over {} used epochs{}; {}. 0.9 to 1.1 is good.", nis.epochs,
                          page.result.noise_fit ? ", noise as fitted" : "",
                          ratio > 1.1   ? "above 1: the sigmas used are too small"
                          : ratio < 0.9 ? "below 1: the sigmas used are too large"
                                        : "1 means that the sigmas used fit"),
              {},
              page.result.innovations.empty() ? "" : "innovations"};
}

/// Judged by the fraction inside 95 %, not in metres.
Tile studied_outage_tile(const std::vector<const study::OutageResult*>& outages) {
  const auto error = [](const study::OutageResult& o) { return (o.smoothed ? *o.smoothed : o.forward).horizontal_max_m; };
  double inside = 0.0;
  double tested = 0.0;
  const study::OutageResult* worst = outages.front();
  for (const study::OutageResult* o : outages) {
    const study::OutageErrors& e = o->smoothed ? *o->smoothed : o->forward;
    inside += static_cast<double>(e.inside_95);
    tested += static_cast<double>(e.tested);
    if (error(*o) > error(*worst)) worst = o;
  }
  Tile tile{"Worst outage", number(error(*worst), 3), "m", Verdict::kNone, "", {}, "outages"};
  tile.explanation =
      fmt::format("Largest horizontal error, {:.0f} s {} at {:.0f} s; forward {} m. ", worst->outage.duration_s,
                  gnss_left(worst->outage), worst->outage.start.sow(), number(worst->forward.horizontal_max_m, 3));
  if (tested > 0.0) {
    tile.verdict = verdict_of_share(inside / tested, outages.size());
    tile.explanation += fmt::format("{} % of all errors are inside their predicted 95 %.", percent(inside / tested));
  }
  return tile;
}

/// Without studied outages: the longest gap of the recording itself.
Tile longest_gap_tile(const ProcessPage& page) {
  double longest = 0.0;
  double at = 0.0;
  double last = 0.0;
  const auto step = [&](double t) {
    if (t - last > longest) {
      longest = t - last;
      at = last;
    }
    last = t;
  };
  for (const estimate::InnovationRecord& r : page.result.innovations)
    if (r.used && estimate::is_position(r.kind)) step(seconds_since_start(page, r.t));
  step(page.result.end - page.result.start);
  double sigma = 0.0;
  const TrajectoryCurves::Curves& curves = page.result.curves->curves();
  const report::Series n = curves.smoothed.sd_position[0].finish();
  for (std::size_t i = 0; i < n.x.size(); ++i)
    if (n.x[i] >= at && n.x[i] <= at + longest) sigma = std::max(sigma, n.y[i]);
  return {"Longest time without GNSS",
          number(longest, 3),
          "s",
          Verdict::kNone,
          fmt::format("From {:.0f} s; the largest predicted sigma N there is {} m ({}). No outages were studied.",
                      (page.result.start + at).sow(), number(sigma, 2), delivered(page)),
          {},
          "accuracy-position"};
}

/// The verdict of summary.json, as the first tile.
Tile verdict_tile(const ProcessPage& page) {
  const Judgement& verdict = page.result.verdict;
  const std::array<Verdict, 3> colours{Verdict::kGood, Verdict::kWarn, Verdict::kBad};
  return {"Verdict",
          name(verdict.standing()),
          "",
          colours[static_cast<std::size_t>(verdict.standing())],
          verdict.line().substr(std::string("verdict: ").size()),
          {},
          "input"};
}

Tile warning_tile(const ProcessPage& page) {
  std::vector<std::string> kinds;
  for (const record::Event& event : page.result.events)
    if (event.severity == record::Event::Severity::kWarning) kinds.push_back(event.kind);
  std::string text = "Nothing had to be repaired, refused or doubted.";
  if (!kinds.empty()) {
    std::vector<std::string> names = kinds;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    if (names.size() > 3) names = {names[0], names[1], "..."};
    text = fmt::format("Read them before the trajectory is used: {}.", joined(names, ", "));
  }
  return {"Warnings", fmt::format("{}", kinds.size()), "", kinds.empty() ? Verdict::kGood : Verdict::kWarn, text, {}, "input"};
}

}  // namespace

std::vector<Tile> acceptance_tiles(const ProcessPage& page) {
  std::vector<Tile> tiles{verdict_tile(page), quality_tile(page)};
  if (auto tile = lever_arm_tile(page)) tiles.push_back(std::move(*tile));
  if (const auto separation = summarise(page.result.separations)) {
    tiles.push_back(position_separation_tile(*separation));
    tiles.push_back(attitude_separation_tile(*separation));
  }
  if (auto tile = innovation_tile(page)) tiles.push_back(std::move(*tile));
  std::vector<const study::OutageResult*> outages;
  for (const auto* list : {&page.result.outages, &page.result.sweep})
    for (const study::OutageResult& outage : *list) outages.push_back(&outage);
  tiles.push_back(outages.empty() ? longest_gap_tile(page) : studied_outage_tile(outages));
  tiles.push_back(warning_tile(page));
  return tiles;
}

}  // namespace coast::jobs
