#include "coast/diagnose/suggested.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coast/geo/units.hpp"
#include "effects/effects.hpp"

namespace coast::diagnose {

namespace {

constexpr std::array kBasic{"omega_x", "omega_y", "omega_z", "f_x",          "f_y",          "f_z",        "alpha_x",
                            "alpha_y", "alpha_z", "speed",   "sin(heading)", "cos(heading)", "temperature"};

std::string_view unit_of(Site site) {
  return site == Site::kGyro ? "rad/s" : "m/s^2";
}

/// An effect with the strings that it refers to.
struct Worded : Effect {
  std::string equation_text;
  std::string relation_text;
  std::string unit_text;
  std::string sentence_text;
};

std::string_view called(Site site) {
  return site == Site::kGyro ? "Gyro" : "Accelerometer";
}

Columns of(Site site, SensorErrors& errors) {
  return site == Site::kGyro ? errors.gyro : errors.accel;
}

std::shared_ptr<Worded> worded(std::string_view name, Site site) {
  auto effect = std::make_shared<Worded>();
  effect->name = name;
  effect->site = site;
  // Its size is unknown: as a bias of a consumer IMU, for any grade.
  effect->plausible.fill(site == Site::kGyro ? 500.0 * kDegreePerHour : 10.0 * kMilliG);
  return effect;
}

}  // namespace

EffectPtr harmonic_disturbance(Site site, int axis, double frequency, double phase) {
  const std::shared_ptr<Worded> effect = worded("harmonic_disturbance", site);
  const std::string axis_name = three_axes()[static_cast<std::size_t>(axis)];
  effect->parameter = "amplitude";
  effect->unit = unit_of(site);
  effect->equation_text = fmt::format("d_{} = A sin(2 pi {:.5g} Hz t + {:.3g})", axis_name, frequency, phase);
  effect->equation = effect->equation_text;
  effect->sentence_text =
      fmt::format("{} {} carries an oscillation of {{size}} at {:.4g} Hz.", called(site), axis_name, frequency);
  effect->sentence = effect->sentence_text;
  effect->meaning = "An oscillation of one frequency, from a vibration that is aliased or from electronics.";
  effect->separating_manoeuvre = "Rest and motion: what the vehicle does not bring about goes on at rest.";
  effect->source = "IEEE Std 952-2020, sinusoidal noise";
  effect->axes = {axis_name, axis_name};
  effect->fixed = {{"frequency", frequency, "Hz"}, {"phase", phase, "rad"}};
  effect->sensors = [site, axis, frequency, phase](const Signals& s, SensorErrors& errors) {
    const double angle = 2.0 * geo::kPi * frequency * s.elapsed + phase;
    Columns columns = of(site, errors);
    columns(axis, 0) = std::sin(angle);
    columns(axis, 1) = std::cos(angle);
  };
  return effect;
}

EffectPtr unknown_relation(Site site, int axis, const std::string& relation) {
  const auto known = std::ranges::find(relations(), relation, &Relation::name);
  if (known == relations().end()) throw std::invalid_argument("no relation " + relation);
  const std::shared_ptr<Worded> effect = worded("unknown", site);
  const std::string axis_name = three_axes()[static_cast<std::size_t>(axis)];
  effect->parameter = "coefficient";
  effect->relation_text = relation;
  effect->relation = effect->relation_text;
  effect->equation_text = fmt::format("d({})_{} = c {}", site == Site::kGyro ? "omega" : "f", axis_name, relation);
  effect->equation = effect->equation_text;
  effect->unit_text = fmt::format("{} per unit of {}", unit_of(site), relation);
  effect->unit = effect->unit_text;
  effect->sentence_text = fmt::format("{} {} errs by {{size}}, which no known effect does.", called(site), axis_name);
  effect->sentence = effect->sentence_text;
  effect->meaning = "A relation that the catalogue has no name for.";
  effect->separating_manoeuvre = "Another mission: a relation found by search is believed when it is found again.";
  effect->source = "Brunton, Proctor & Kutz (2016), sparse regression";
  effect->axes = {axis_name};
  effect->plausible.fill(1e6);  // a coefficient with any unit has no prior
  effect->sensors = [site, axis, relation = *known](const Signals& s, SensorErrors& errors) {
    of(site, errors)(axis, 0) = relation.of(basic_signals(s));
  };
  return effect;
}

double Relation::of(const Eigen::VectorXd& signals) const {
  if (second >= 0) return signals(first) * signals(second);
  return magnitude ? std::abs(signals(first)) : signals(first);
}

const std::vector<Relation>& relations() {
  static const std::vector<Relation> all = [] {
    std::vector<Relation> list;
    const int count = static_cast<int>(kBasic.size());
    const auto word = [](int i) { return std::string(kBasic[static_cast<std::size_t>(i)]); };
    for (int i = 0; i < count; ++i) list.push_back({word(i), i});
    for (int i = 0; i < 9; ++i) list.push_back({fmt::format("|{}|", word(i)), i, -1, true});
    for (int i = 0; i < count; ++i)
      for (int j = i; j < count; ++j) list.push_back({fmt::format("{}*{}", word(i), word(j)), i, j});
    return list;
  }();
  return all;
}

Eigen::VectorXd basic_signals(const Signals& s) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(kBasic.size()));
  const Eigen::Vector3d forward_n = s.C_n_e.transpose() * s.C_e_s.transpose().col(0);
  const double level = forward_n.head<2>().norm();
  x << s.omega, s.f, s.omega_dot, s.speed, level > 0.0 ? forward_n.y() / level : 0.0, level > 0.0 ? forward_n.x() / level : 1.0,
      s.temperature;
  return x;
}

}  // namespace coast::diagnose
