#include "evidence/selected_effects.hpp"

#include <algorithm>

namespace coast::diagnose {

bool WithSelected::any_holds(geo::GpsTime t) const {
  return std::ranges::any_of(selected_, [t](const SelectedEffect& one) { return one.holds(t); });
}

void WithSelected::repeat(geo::GpsTime t, Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (std::size_t i = 0; i < selected_.size(); ++i)
    if (selected_[i].holds(t)) columns.col(row(i)) = columns.col(selected_[i].hypothesis);
}

void WithSelected::add_sensor_errors(const estimate::SampleView& sample, Eigen::Matrix3Xd& gyro_b,
                                     Eigen::Matrix3Xd& accel_b) const {
  hypotheses_.add_sensor_errors(sample, gyro_b, accel_b);
  repeat(sample.nav.t, gyro_b);
  repeat(sample.nav.t, accel_b);
}

void WithSelected::add_own_slopes(const estimate::SampleView& sample, estimate::OwnSlopes& slopes) const {
  estimate::OwnSlopes of_all = estimate::OwnSlopes::Zero(6, hypotheses_.size());
  hypotheses_.add_own_slopes(sample, of_all);
  slopes.leftCols(of_all.cols()) = of_all;
  repeat(sample.nav.t, slopes);
}

void WithSelected::add_measurement_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const {
  hypotheses_.add_measurement_errors(measurement, D);
  repeat(measurement.nav.t, D);
}

void WithSelected::add_fix_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const {
  hypotheses_.add_fix_errors(measurement, D);
  repeat(measurement.nav.t, D);
}

namespace {

std::vector<Eigen::Index> hypotheses_of(const std::vector<SelectedEffect>& selected) {
  std::vector<Eigen::Index> all;
  for (const SelectedEffect& one : selected) all.push_back(one.hypothesis);
  return all;
}

/// By their numbers in `few`.
std::vector<SelectedEffect> numbered(std::vector<SelectedEffect> selected, const Hypotheses& all, const Hypotheses& few) {
  for (SelectedEffect& one : selected) {
    const Hypothesis& h = all[one.hypothesis];
    const auto same = [&](const Hypothesis& other) { return other.effect == h.effect && other.axis == h.axis; };
    one.hypothesis = std::ranges::find_if(few.all(), same) - few.all().begin();
  }
  return selected;
}

}  // namespace

SelectedAlone::SelectedAlone(const Hypotheses& all, const std::vector<SelectedEffect>& selected)
    : few_(all, hypotheses_of(selected)), selected_(numbered(selected, all, few_)), effects_(few_, selected_) {}

Eigen::VectorXd SelectedAlone::coefficients() const {
  Eigen::VectorXd c = Eigen::VectorXd::Zero(effects_.size());
  for (std::size_t i = 0; i < selected_.size(); ++i) c(effects_.row(i)) = selected_[i].value;
  return c;
}

std::vector<Eigen::Index> SelectedAlone::rows() const {
  std::vector<Eigen::Index> all;
  for (std::size_t i = 0; i < selected_.size(); ++i) all.push_back(effects_.row(i));
  return all;
}

SizeEvidence evidence_of_sizes(const estimate::Mission& mission, const estimate::StateLayout& layout,
                               const estimate::KnotStore& knots, const SelectedAlone& selected,
                               const std::function<bool(geo::GpsTime)>& counts) {
  const std::vector<Eigen::Index> rows = selected.rows();
  SizeEvidence result;
  std::size_t left = knots.size();
  estimate::effect_pass(mission, layout, knots, selected.effects(), {.draw = {}, .progress = {}, .counts = counts},
                        [&](const estimate::Evidence& e) {
                          if (--left > 0) return;
                          result.score = -Eigen::VectorXd(e.r_effects(rows));
                          result.own_noise = e.own_noise(rows);
                          const Eigen::MatrixXd N = e.N_effects.selfadjointView<Eigen::Lower>();
                          result.information = N(rows, rows);
                        });
  return result;
}

}  // namespace coast::diagnose
