#include "ppk/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/study/paired.hpp"
#include "common/error_json.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

using carrier::PpkEpoch;
using carrier::Shortfall;
using record::FixQuality;
using Use = carrier::SignalResidual::Use;
using Json = nlohmann::ordered_json;

Eigen::Vector3d sd_n(const PpkEpoch& epoch) {
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(epoch.r_e));
  return (C_n_e.transpose() * epoch.covariance_e * C_n_e).diagonal().cwiseMax(0.0).cwiseSqrt();
}

double median(std::vector<double> values) {
  return values.empty() ? 0.0 : study::quantile(std::move(values), 0.5);
}

void count(const PpkEpoch& epoch, PpkSummary& summary) {
  switch (epoch.quality) {
    case FixQuality::kFixed:
      ++summary.fixed;
      break;
    case FixQuality::kFloat:
      ++summary.floats;
      break;
    case FixQuality::kSingle:
      ++summary.single;
      break;
    default:
      ++summary.none;
  }
  ++summary.shortfalls[static_cast<std::size_t>(epoch.shortfall)];
  for (const carrier::SignalResidual& r : epoch.residuals) ++(r.use == Use::kLeftOut ? summary.left_out : summary.used);
}

constexpr double kFar = 0.1;  // m: forward and backward have different integers

std::string_view word(Use use) {
  return use == Use::kFixed ? "fixed" : use == Use::kFloat ? "float" : "left_out";
}

}  // namespace

double PpkSummary::fix_rate() const {
  return expected == 0 ? 0.0 : static_cast<double>(fixed) / static_cast<double>(expected);
}

std::vector<std::pair<std::string, std::size_t>> PpkSummary::causes() const {
  std::vector<std::pair<std::string, std::size_t>> all;
  if (expected > epochs) all.emplace_back("nothing recorded by the rover", expected - epochs);
  for (std::size_t i = 1; i < shortfalls.size(); ++i)
    if (shortfalls[i] > 0) all.emplace_back(in_words(static_cast<Shortfall>(i)), shortfalls[i]);
  return all;
}

PpkSummary summary_of(const PpkResult& result) {
  PpkSummary summary;
  const std::vector<PpkEpoch>& epochs = result.solution.epochs;
  summary.epochs = summary.expected = epochs.size();
  if (epochs.size() > 1 && result.solution.interval_s > 0.0)
    summary.expected = std::max(
        summary.epochs,
        static_cast<std::size_t>(std::llround((epochs.back().shown - epochs.front().shown) / result.solution.interval_s)) + 1);
  std::array<std::vector<double>, 3> sds;
  std::vector<double> separations, baselines;
  for (const PpkEpoch& epoch : epochs) {
    count(epoch, summary);
    if (epoch.quality == FixQuality::kFixed) {
      const Eigen::Vector3d sd = sd_n(epoch);
      for (Eigen::Index i = 0; i < 3; ++i) sds[static_cast<std::size_t>(i)].push_back(sd(i));
    }
    if (epoch.quality == FixQuality::kFixed || epoch.quality == FixQuality::kFloat)
      baselines.push_back((epoch.r_e - epoch.r_base_e).norm());
    if (!epoch.separation_n) continue;
    separations.push_back(epoch.separation_n->norm());
    if (epoch.both_fixed && separations.back() > kFar) ++summary.separation.far;
  }
  for (Eigen::Index i = 0; i < 3; ++i) summary.fixed_sd_n(i) = median(sds[static_cast<std::size_t>(i)]);
  summary.baseline_m = median(baselines);
  summary.separation.epochs = separations.size();
  if (separations.empty()) return summary;
  summary.separation.largest = *std::ranges::max_element(separations);
  summary.separation.median = study::quantile(separations, 0.5);
  summary.separation.p95 = study::quantile(separations, 0.95);
  return summary;
}

std::string signals_in_words(const carrier::SignalChoice& signals) {
  std::string text;
  std::optional<record::SatelliteSystem> last;
  for (const auto& [band, pair] : signals) {
    if (last != band.first) text += fmt::format("{}{}", text.empty() ? "" : "; ", record::name_of(band.first));
    last = band.first;
    text += pair.rover == pair.base ? fmt::format(" {}{}", band.second, pair.rover)
                                    : fmt::format(" {}{}/{}", band.second, pair.rover, pair.base);
  }
  return text;
}

std::string ppk_json(const PpkConfig& config, const PpkResult& result) {
  const PpkSummary s = summary_of(result);
  Json j = {
      {"schema", "coast.ppk_result/1"}, {"rover", config.rover.filename().string()}, {"base", config.base.filename().string()}};
  j["base_position"] = {{"ecef_m", {result.r_base_e.x(), result.r_base_e.y(), result.r_base_e.z()}},
                        {"from", result.base_from}};
  j["baseline_m"] = s.baseline_m;
  j["signals"] = signals_in_words(result.solution.signals);
  j["noise_scale"] = {{"phase", result.solution.noise.phase},
                      {"code", result.solution.noise.code},
                      {"code_inflation", result.solution.noise.code_inflation}};
  j["states"] = {{"ionosphere", result.solution.air.ionosphere}, {"zenith_delay", result.solution.air.zenith_delay}};
  j["epochs"] = {{"expected", s.expected}, {"recorded", s.epochs}, {"fixed", s.fixed},
                 {"float", s.floats},      {"single", s.single},   {"none", s.none}};
  j["fix_rate"] = s.fix_rate();
  Json& why = j["not_fixed_because"] = Json::object();
  for (const auto& [cause, epochs] : s.causes()) why[cause] = epochs;
  j["fixed_sd_m"] = {s.fixed_sd_n.x(), s.fixed_sd_n.y(), s.fixed_sd_n.z()};
  if (s.separation.epochs > 0)
    j["forward_backward_m"] = {{"epochs", s.separation.epochs},
                               {"median", s.separation.median},
                               {"p95", s.separation.p95},
                               {"largest", s.separation.largest},
                               {"both_fixed_above_0.1_m", s.separation.far}};
  j["observations"] = {{"used", s.used}, {"left_out", s.left_out}};
  j["events"] = events_json(result.events);
  return j.dump(2) + "\n";
}

std::vector<std::string> ppk_sentences(const PpkResult& result) {
  const PpkSummary s = summary_of(result);
  std::vector<std::string> sentences{
      s.fixed + s.floats > 0
          ? fmt::format("GNSS: baseline {:.0f} m, {}", s.baseline_m, signals_in_words(result.solution.signals))
          : fmt::format("GNSS: {}", signals_in_words(result.solution.signals)),
      fmt::format("GNSS: {} of {} epochs fixed ({} %), {} float, {} single, {} without position", s.fixed, s.expected,
                  percent(s.fix_rate()), s.floats, s.single, s.none)};
  for (const auto& [cause, epochs] : s.causes())
    sentences.push_back(fmt::format("GNSS: {} epochs not fixed: {}", epochs, cause));
  if (s.separation.epochs > 0)
    sentences.push_back(fmt::format("GNSS: forward less backward: median {:.3f}, 95 % below {:.3f}, largest {:.3f} m",
                                    s.separation.median, s.separation.p95, s.separation.largest));
  return sentences;
}

std::string residuals_csv(const PpkResult& result) {
  std::string text = "gps_week,sow_s,satellite,band,observation,residual_m,sd_m,azimuth_deg,elevation_deg,use\n";
  for (const PpkEpoch& epoch : result.solution.epochs)
    for (const carrier::SignalResidual& r : epoch.residuals)
      fmt::format_to(std::back_inserter(text), "{},{:.3f},{},{},{},{:.4f},{:.4f},{:.2f},{:.2f},{}\n", epoch.shown.week(),
                     epoch.shown.sow(), to_string(r.satellite), r.band, r.phase ? "phase" : "code", r.residual, r.sd,
                     r.direction.azimuth / geo::kDegree, r.direction.elevation / geo::kDegree, word(r.use));
  return text;
}

}  // namespace coast::jobs
