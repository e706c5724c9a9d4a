#include "sample_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "coast/record/gnss.hpp"
#include "coast/report/panels.hpp"

namespace coast::test {
namespace {

using namespace report;  // the whole file builds a page
using std::cos;
using std::sin;

constexpr double kRate = 200.0;     // Hz
constexpr double kSpan = 3600.0;    // s
constexpr double kSigmaFix = 0.01;  // m
const std::array<std::string, 3> kNed{"N", "E", "D"};
const std::array<Interval, 4> kOutages{{{600.0, 660.0, "outage 1", Tone::kBad},
                                        {1500.0, 1530.0, "outage 2", Tone::kBad},
                                        {2100.0, 2230.0, "outage 3", Tone::kBad},
                                        {3000.0, 3020.0, "outage 4", Tone::kBad}}};

/// Seconds since the last fix, 0 outside outages.
double coasting(double t) {
  for (const Interval& outage : kOutages) {
    if (t >= outage.from && t < outage.to) return t - outage.from;
  }
  return 0.0;
}

double length_of_outage(double t) {
  for (const Interval& outage : kOutages) {
    if (t >= outage.from && t < outage.to) return outage.to - outage.from;
  }
  return 0.0;
}

/// A drive of a few closed figures, N, E, D in metres.
std::array<double, 3> place(double t) {
  const double u = 2.0 * std::numbers::pi * t / kSpan;
  const double r = 420.0 + 130.0 * sin(7.0 * u) + 40.0 * cos(17.0 * u);
  return {r * sin(3.0 * u), 1.4 * r * cos(2.0 * u) + 60.0 * sin(23.0 * u), -12.0 * sin(5.0 * u)};
}

double forward_sigma(double t) {
  return kSigmaFix + 2e-4 * std::pow(coasting(t), 2.0);
}

double smoothed_sigma(double t) {
  const double span = length_of_outage(t);
  const double tau = coasting(t);
  return 0.6 * kSigmaFix + 2e-5 * tau * (span - tau);
}

record::FixQuality quality_at(double t) {
  if (sin(t / 41.0) > 0.97) return record::FixQuality::kSingle;
  if (sin(t / 90.0) > 0.86) return record::FixQuality::kFloat;
  return record::FixQuality::kFixed;
}

/// Curves of one component, filled sample by sample as a run does.
struct Curves {
  Decimator forward, smoothed, separation, sigma, velocity, bias;
};

struct Drive {
  std::array<Curves, 3> curves;
  Decimator track;
};

Drive drive() {
  Drive out;
  std::mt19937_64 engine(20250708);
  std::normal_distribution<double> normal;
  std::array<double, 3> forward_error{};
  std::array<double, 3> smoothed_error{};
  std::array<double, 3> bias{};
  for (long i = 0; i < static_cast<long>(kSpan * kRate); ++i) {
    const double t = static_cast<double>(i) / kRate;
    const auto here = place(t);
    const auto next = place(t + 1e-3);
    out.track.add_track(t, here[1], here[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      Curves& c = out.curves[k];
      const double sf = forward_sigma(t);
      const double ss = smoothed_sigma(t);
      if (coasting(t) == 0.0) forward_error[k] *= std::exp(-0.5 / kRate);
      forward_error[k] += 0.3 * sf * std::sqrt(1.0 / kRate) * normal(engine);
      smoothed_error[k] += (-smoothed_error[k] / 20.0 + ss * std::sqrt(2.0 / 20.0 * kRate) * normal(engine)) / kRate;
      bias[k] += (-bias[k] / 300.0 + 20.0 * std::sqrt(2.0 / 300.0 * kRate) * normal(engine)) / kRate;
      c.forward.add(t, forward_error[k], -sf, sf);
      c.smoothed.add(t, smoothed_error[k], -ss, ss);
      c.separation.add(t, (forward_error[k] - smoothed_error[k]) / (1.5 * std::sqrt(sf * sf + ss * ss)) * 0.8);
      c.sigma.add(t, sf);
      c.velocity.add(t, (next[k] - here[k]) / 1e-3 + 0.02 * normal(engine));
      const double sb = 4.0 + 60.0 * std::exp(-t / 120.0);
      c.bias.add(t, bias[k], bias[k] - sb, bias[k] + sb);
    }
  }
  return out;
}

Panel plan(const Drive& data) {
  Panel panel = plan_panel("plan", "Plan view",
                           "GNSS quality along the way; fixed (green) nearly everywhere is good. Outages are numbered.");
  Plot& plot = panel.plot();
  for (std::size_t i = 0; i < kOutages.size(); ++i) {
    Decimator stretch;
    for (double t = kOutages[i].from; t <= kOutages[i].to; t += 0.1) stretch.add_track(t, place(t)[1], place(t)[0]);
    Line& line = add_line(plot, "outages", stretch.finish(), Tone::kBad);
    line.width_px = 9.0;
    const double middle = 0.5 * (kOutages[i].from + kOutages[i].to);
    plot.marks.push_back({place(middle)[1], place(middle)[0], fmt::format("{}", i + 1)});
  }
  add_line(plot, "smoothed", data.track.finish(), Tone::kSmoothed);
  std::map<record::FixQuality, Series> fixes;
  for (double t = 0.0; t < kSpan; t += 0.5) {
    if (coasting(t) > 0.0) continue;
    Series& series = fixes[quality_at(t)];
    series.x.push_back(place(t)[1]);
    series.y.push_back(place(t)[0]);
  }
  for (auto& [quality, series] : fixes) add_points(plot, name_of(quality), std::move(series), tone_of(quality)).radius_px = 2.2;
  return panel;
}

Panel errors(const Drive& data) {
  Panel panel = stacked_time_panel("errors", "Position error against the reference", {kNed.begin(), kNed.end()}, "m",
                                   "Inside the one-sigma band for about two thirds of the time is good.");
  for (std::size_t k = 0; k < 3; ++k) {
    add_line(panel.plots[k], "forward", data.curves[k].forward.finish(), Tone::kForward).hidden = false;
    add_line(panel.plots[k], "smoothed", data.curves[k].smoothed.finish(), Tone::kSmoothed).band_label = "1 sigma";
  }
  shade(panel, kOutages);
  return panel;
}

Panel velocity(const Drive& data) {
  Panel panel = time_panel("velocity", "Velocity", "m/s", "Continuous, without steps at the outages' ends.");
  const std::array<Tone, 3> tones{Tone::kX, Tone::kY, Tone::kZ};
  for (std::size_t k = 0; k < 3; ++k) add_line(panel.plot(), kNed[k], data.curves[k].velocity.finish(), tones[k]);
  shade(panel, kOutages);
  return panel;
}

Panel sigmas(const Drive& data) {
  Panel panel = time_panel("sigma", "Estimated accuracy", "m", "Flat at the accuracy of the fixes, with one hump per outage.");
  panel.plot().y.scale = Axis::Scale::kLog;
  const std::array<Tone, 3> tones{Tone::kX, Tone::kY, Tone::kZ};
  for (std::size_t k = 0; k < 3; ++k) add_line(panel.plot(), "sigma " + kNed[k], data.curves[k].sigma.finish(), tones[k]);
  shade(panel, kOutages);
  return panel;
}

Panel biases(const Drive& data) {
  Panel panel = stacked_time_panel("bias", "Gyro bias", {"x", "y", "z"}, "deg/h",
                                   "Forward and smoothed agree within the band after the first minutes.");
  for (std::size_t k = 0; k < 3; ++k)
    add_line(panel.plots[k], "smoothed", data.curves[k].bias.finish(), Tone::kSmoothed).band_label = "1 sigma";
  return panel;
}

Panel innovations() {
  Panel panel = time_panel("innovations", "Innovations over their sigma", "",
                           "Within the gate, without trend; single dots outside are listed as rejected.");
  Plot& plot = panel.plot();
  plot.y.label = "innovation / sigma";
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < 3; ++k) {
    Series series;
    for (double t = 0.0; t < kSpan; t += 1.0) {
      if (coasting(t) > 0.0) continue;
      series.x.push_back(t);
      series.y.push_back(normal(engine));
    }
    add_points(plot, kNed[k], std::move(series), std::array{Tone::kX, Tone::kY, Tone::kZ}[k]);
  }
  add_bound(plot, 3.3, "gate");
  add_bound(plot, -3.3);
  shade(panel, kOutages);
  return panel;
}

Panel updates() {
  Panel panel =
      time_panel("updates", "Update type", "", "GNSS positions throughout, zero velocity at stops, nothing in outages.");
  Plot& plot = panel.plot();
  plot.height_px = 170;
  const std::array<std::string, 4> names{"GNSS position", "zero velocity", "non-holonomic", "rejected"};
  const std::array<Tone, 4> tones{Tone::kFixed, Tone::kX, Tone::kMuted, Tone::kBad};
  for (std::size_t k = 0; k < names.size(); ++k) {
    plot.y.ticks.push_back({static_cast<double>(k), names[k]});
    Series series;
    for (double t = 0.0; t < kSpan; t += k == 3 ? 431.0 : 1.0 + static_cast<double>(k)) {
      if (k == 0 && coasting(t) > 0.0) continue;
      if (k == 1 && sin(t / 100.0) < 0.8) continue;
      series.x.push_back(t);
      series.y.push_back(static_cast<double>(k));
    }
    add_points(plot, names[k], std::move(series), tones[k]).radius_px = 2.5;
  }
  shade(panel, kOutages);
  return panel;
}

Panel outage_grid() {
  Panel panel = grid_panel("outages-ned", "Errors through each outage", 3,
                           "Forward grows with time; smoothed stays within its band and returns to zero at both ends.");
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kOutages.size(); ++i) {
    const double span = kOutages[i].to - kOutages[i].from;
    for (std::size_t k = 0; k < 3; ++k) {
      Plot& plot =
          add_cell(panel, fmt::format("outage {}, {:.0f} s: {}", i + 1, span, kNed[k]), "time in outage", kNed[k], "m");
      Series forward;
      Series smoothed;
      smoothed.band.emplace();
      const double drift = 5e-4 * normal(engine);
      for (double s = -10.0; s < span + 10.0; s += 0.05) {
        const double inside = std::clamp(s, 0.0, span);
        const double bell = 8e-5 * inside * (span - inside);
        forward.x.push_back(s);
        forward.y.push_back(s < span ? drift * inside * inside : 0.0);
        smoothed.x.push_back(s);
        smoothed.y.push_back(drift * 0.1 * inside * (span - inside));
        smoothed.band->x.push_back(s);
        smoothed.band->lower.push_back(-bell - 0.006);
        smoothed.band->upper.push_back(bell + 0.006);
      }
      add_line(plot, "forward", std::move(forward), Tone::kForward);
      add_line(plot, "smoothed", std::move(smoothed), Tone::kSmoothed).band_label = "1 sigma";
      plot.intervals.push_back({0.0, span, {}, Tone::kMuted});
    }
  }
  return panel;
}

Panel allan() {
  Panel panel = xy_panel("allan", "Allan deviation", {"averaging time", "s", Axis::Scale::kLog, {}, {}},
                         {"Allan deviation", "deg/h", Axis::Scale::kLog, {}, {}},
                         "Slope -1/2 at the left is angular random walk; the floor is bias instability.");
  Series curve;
  curve.band.emplace();
  for (double tau = 0.01; tau < 2000.0; tau *= 1.25) {
    const double value = std::sqrt(81.0 / tau + 4.0 + 0.004 * tau);
    const double relative = std::min(0.6, 0.02 * std::sqrt(tau));
    curve.x.push_back(tau);
    curve.y.push_back(value);
    curve.band->x.push_back(tau);
    curve.band->lower.push_back(value * (1.0 - relative));
    curve.band->upper.push_back(value * (1.0 + relative));
  }
  Line& line = add_line(panel.plot(), "gyro z", std::move(curve));
  line.band_label = "95 %";
  Series model;
  for (double tau : {0.01, 1.0, 80.0}) {
    model.x.push_back(tau);
    model.y.push_back(9.0 / std::sqrt(tau));
  }
  add_line(panel.plot(), "white noise 0.15 deg/sqrt(h)", std::move(model), Tone::kReference).style = Line::Style::kDashed;
  return panel;
}

Panel histogram() {
  Panel panel = xy_panel("nis", "Normalised innovation squared", {"NIS", "", Axis::Scale::kLinear, {}, {}},
                         {"epochs", "", Axis::Scale::kLinear, {}, {}},
                         "Falls as chi-square of three degrees of freedom; mean 3 is good.");
  std::mt19937_64 engine(3);
  std::chi_squared_distribution<double> chi2(3.0);
  std::vector<double> values(3400);
  for (double& value : values) value = chi2(engine);
  add_histogram(panel.plot(), "epochs", std::move(values), 40);
  return panel;
}

Table outage_table() {
  Table table{"outage-table",
              "Outages",
              "Maximum error in each outage, against the reference.",
              {{"outage", "", true},
               {"start", "s"},
               {"duration", "s"},
               {"forward N", "m"},
               {"forward E", "m"},
               {"forward D", "m"},
               {"smoothed N", "m"},
               {"smoothed E", "m"},
               {"smoothed D", "m"},
               {"inside 95 %", "%"},
               {"remark", "", false}},
              {}};
  for (std::size_t i = 0; i < kOutages.size(); ++i) {
    const double d = kOutages[i].to - kOutages[i].from;
    const auto m = [](double v) { return Cell{fmt::format("{:.3f}", v)}; };
    table.rows.push_back({{fmt::format("{}", i + 1)},
                          {fmt::format("{:.0f}", kOutages[i].from)},
                          {fmt::format("{:.0f}", d)},
                          m(2e-4 * d * d),
                          m(1.4e-4 * d * d),
                          m(0.9e-4 * d * d),
                          m(1e-3 * d),
                          m(0.8e-3 * d),
                          m(0.5e-3 * d),
                          {d > 100.0 ? "88.1" : "96.0", d > 100.0 ? Verdict::kWarn : Verdict::kGood},
                          {d > 100.0 ? "straight road" : "roundabout"}});
  }
  return table;
}

std::vector<Tile> tiles() {
  return {{"GNSS quality",
           "91 / 6 / 3",
           "%",
           Verdict::kGood,
           "Shares of fixed, float and single epochs; above 90 % fixed is good.",
           {{"fixed", 0.91, Tone::kFixed}, {"float", 0.06, Tone::kFloat}, {"single", 0.03, Tone::kSingle}},
           "plan"},
          {"Lever-arm misclosure",
           "0.4 / 0.6 / 1.9",
           "cm",
           Verdict::kGood,
           "Estimated minus configured, forward, right, down; sigma 0.5, 0.5, 2.0 cm.",
           {},
           "parameters"},
          {"Position separation",
           "0.012",
           "m",
           Verdict::kGood,
           "Forward minus backward, rms in 3-D; the size of the GNSS sigma is good.",
           {},
           "errors"},
          {"Heading separation",
           "3.1",
           "arcmin",
           Verdict::kWarn,
           "Forward minus backward; pitch 0.4, roll 0.5 arcmin.",
           {},
           "errors"},
          {"Innovations over sigma",
           "1.04",
           "",
           Verdict::kGood,
           "Root mean square; 1 means that the stated sigmas fit.",
           {},
           "innovations"},
          {"Worst outage",
           "0.131",
           "m",
           Verdict::kNone,
           "Largest horizontal error of the smoothed trajectory, outage 3, 130 s.",
           {},
           "outages-ned"},
          {"Warnings", "2", "", Verdict::kBad, "Read them below before you use the trajectory.", {}, "input"}};
}

}  // namespace

Page sample_page() {
  const Drive data = drive();
  Page page;
  page.title = "Sample drive, 8 July 2025";
  page.subtitle =
      "Smoothed trajectory of a car with an industrial MEMS IMU at 200 Hz and RTK positions at 1 Hz; made-up data with the "
      "shapes of a run";
  page.start = geo::GpsTime::from_week(2374, 243258.499);
  page.tiles = tiles();
  page.footer = "coast 0.1.0 \xC2\xB7 coast process run.yaml \xC2\xB7 numbers as in summary.json";
  Section input{"input", "What was read", "The recording as it was understood, before anything was computed from it.", {}, {},
                {}};
  input.notes = {{Note::Kind::kWarning, "Gyro noise",
                  "The recording's white noise is 6.1 deg/sqrt(h), 41 times the configured 0.15; the error model is too "
                  "optimistic on this vehicle."},
                 {Note::Kind::kWarning, {}, "imu.csv:18204: 3 samples are missing (0.015 s); bridged."},
                 {Note::Kind::kInfo,
                  {},
                  "Gravity at rest reads -9.81 m/s2 on z: axes are forward, right, down. <b>&amp; no markup</b> </script>"}};
  input.tables = {{"parameters",
                   "Recording",
                   {},
                   {{"quantity", "", false}, {"IMU", "", false}, {"GNSS", "", false}},
                   {{{"span"}, {"3600.0 s"}, {"3599.0 s"}},
                    {{"rate"}, {"200.0 Hz"}, {"1.0 Hz"}},
                    {{"gaps"}, {"1", Verdict::kWarn}, {"0", Verdict::kGood}}}}};
  Section trajectory{"trajectory", "Trajectory", "", {}, {}, {plan(data), errors(data), velocity(data), sigmas(data)}};
  Section filter{"filter", "Filter", "How well measurements and model agree.", {}, {}, {innovations(), updates(), histogram()}};
  Section sensors{"sensors", "Sensor errors", "", {}, {}, {biases(data), allan()}};
  Section outages{
      "outages", "Outages",        "GNSS was withheld here and the result compared with the trajectory without the gap.",
      {},        {outage_table()}, {outage_grid()}};
  Section configuration{
      "configuration",
      "Configuration",
      "",
      {{Note::Kind::kCode, "run.resolved.yaml", "imu:\n  file: imu.csv  # run.yaml:2\n  rate_hz: 200    # estimated\n"}},
      {},
      {}};
  page.sections = {input, trajectory, filter, sensors, outages, configuration};
  return page;
}

}  // namespace coast::test
