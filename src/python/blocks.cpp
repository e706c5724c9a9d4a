#include "blocks.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "coast/estimate/transition.hpp"
#include "coast/ins/strapdown.hpp"
#include "coast/noise/allan.hpp"
#include "coast/noise/arma_garch.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/noise/likelihood.hpp"
#include "tree.hpp"

namespace coast::python {

namespace py = pybind11;

namespace {

using Vectors = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

py::dict allan(const std::vector<double>& values, double interval, int points_per_decade) {
  noise::AllanCurve curve;
  {
    const py::gil_scoped_release released;
    noise::AllanAccumulator accumulator(interval, {.points_per_decade = points_per_decade});
    accumulator.add(values);
    curve = accumulator.finish();
  }
  const auto column = [&](const auto& of) {
    py::array_t<double> array(static_cast<py::ssize_t>(curve.size()));
    for (std::size_t i = 0; i < curve.size(); ++i) array.mutable_at(static_cast<py::ssize_t>(i)) = of(curve[i]);
    return array;
  };
  py::dict result;
  const auto add = [&](const std::string& name, auto deviation) {
    result[py::str(name)] = column([&](const noise::AllanPoint& p) { return (p.*deviation).value; });
    result[py::str(name + "_low_95")] = column([&](const noise::AllanPoint& p) { return (p.*deviation).interval_95.lower; });
    result[py::str(name + "_high_95")] = column([&](const noise::AllanPoint& p) { return (p.*deviation).interval_95.upper; });
    result[py::str(name + "_edf")] = column([&](const noise::AllanPoint& p) { return (p.*deviation).edf; });
  };
  result["tau"] = column([](const noise::AllanPoint& p) { return p.tau; });
  add("allan", &noise::AllanPoint::allan);
  add("hadamard", &noise::AllanPoint::hadamard);
  return result;
}

noise::Mean mean_of(const std::string& name) {
  if (name == "zero") return noise::Mean::kZero;
  if (name == "level") return noise::Mean::kLevel;
  if (name == "level_and_drift") return noise::Mean::kLevelAndDrift;
  throw std::invalid_argument("mean is zero, level or level_and_drift, not " + name);
}

double sum_log_likelihood(const std::vector<double>& values, double interval,
                          const std::vector<std::pair<std::string, std::vector<double>>>& processes, const std::string& mean) {
  const py::gil_scoped_release released;
  std::vector<const noise::Estimable*> kinds;
  std::vector<double> u;
  for (const auto& [name, parameters] : processes) {
    kinds.push_back(&noise::estimable(name));
    const std::vector<noise::ParameterInfo> infos = kinds.back()->parameters();
    if (infos.size() != parameters.size())
      throw std::invalid_argument(name + " has " + std::to_string(infos.size()) + " parameters");
    for (std::size_t i = 0; i < infos.size(); ++i) u.push_back(infos[i].inverse(parameters[i]));
  }
  const noise::Likelihood likelihood({noise::StaticSignal::regular(values, interval)}, noise::SumModel(kinds, mean_of(mean)));
  return likelihood.value(u).log_likelihood;
}

py::list process_parameters(const std::string& name) {
  py::list names;
  for (const noise::ParameterInfo& info : noise::estimable(name).parameters())
    names.append(py::make_tuple(std::string(info.name), std::string(info.unit)));
  return names;
}

py::dict arma_garch_fit(const std::vector<double>& y, const std::array<int, 4>& orders, bool constant) {
  const noise::ArmaGarchSeries series{.y = y};
  noise::ArmaGarchFit fit;
  std::optional<noise::ArmaGarchUncertainty> uncertainty;
  {
    const py::gil_scoped_release released;
    fit = noise::fit_arma_garch(series, {orders[0], orders[1], orders[2], orders[3]}, {.constant = constant});
    uncertainty = noise::arma_garch_uncertainty(fit, series);
  }
  const Eigen::VectorXd theta = noise::arma_garch_vector(fit.model, constant);
  const std::vector<std::string> names = noise::arma_garch_names(fit.model.orders(), constant);
  py::dict value, sd;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    value[py::str(names[i])] = theta(at);
    if (uncertainty) sd[py::str(names[i])] = uncertainty->robust_sd(at);
  }
  const noise::ArmaGarchResiduals residuals = noise::arma_garch_residuals(fit.model, series);
  py::dict result;
  result["value"] = value;
  result["sd"] = sd;
  result["log_likelihood"] = fit.log_likelihood;
  result["aic"] = fit.aic();
  result["aicc"] = fit.aicc();
  result["converged"] = fit.converged;
  result["residual"] = py::array_t<double>(static_cast<py::ssize_t>(residuals.residual.size()), residuals.residual.data());
  result["variance"] = py::array_t<double>(static_cast<py::ssize_t>(residuals.variance.size()), residuals.variance.data());
  return result;
}

/// A start in the e-frame, and increments that lead on from it.
struct Motion {
  Eigen::VectorXd r_eb_e, v_eb_e;
  Eigen::MatrixXd C_b_e;
  Vectors dtheta, dv;
  Eigen::VectorXd dt;

  void check() const {
    if (r_eb_e.size() != 3 || v_eb_e.size() != 3 || C_b_e.rows() != 3 || C_b_e.cols() != 3)
      throw std::invalid_argument("r_eb_e and v_eb_e have 3 numbers, C_b_e has 3 x 3");
    if (dv.rows() != dtheta.rows() || dt.size() != dtheta.rows())
      throw std::invalid_argument("dtheta, dv and dt have one row for each interval");
    if (!(dt.array() > 0.0).all() || !dtheta.allFinite() || !dv.allFinite())
      throw std::invalid_argument("dtheta and dv are finite, dt is positive");
  }
};

/// @param each  called behind each interval with the navigator, the attitude before, and the compensated increment
template <class Each>
void navigate(const Motion& motion, Each&& each) {
  record::NavState start;
  start.r_eb_e = motion.r_eb_e;
  start.v_eb_e = motion.v_eb_e;
  start.q_b_e = Eigen::Quaterniond(Eigen::Matrix3d(motion.C_b_e)).normalized();
  ins::Strapdown navigator(start);
  ins::RawIncrement previous;
  for (Eigen::Index i = 0; i < motion.dt.size(); ++i) {
    const ins::RawIncrement current{motion.dt(i), motion.dtheta.row(i), motion.dv.row(i)};
    const ins::BodyIncrement increment = ins::compensate_two_sample(previous, current);
    const Eigen::Matrix3d before = navigator.state().q_b_e.toRotationMatrix();
    navigator.step(increment);
    previous = current;
    each(i, navigator, before, increment);
  }
}

/// Positions, velocities and attitudes before the first interval and behind each.
py::tuple strapdown(const Motion& motion) {
  motion.check();
  const Eigen::Index n = motion.dt.size();
  Vectors r(n + 1, 3), v(n + 1, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> C(n + 1, 9);
  const auto keep = [&](Eigen::Index i, const Eigen::VectorXd& r_eb_e, const Eigen::VectorXd& v_eb_e,
                        const Eigen::MatrixXd& C_b_e) {
    r.row(i) = r_eb_e;
    v.row(i) = v_eb_e;
    for (Eigen::Index k = 0; k < 9; ++k) C(i, k) = C_b_e(k / 3, k % 3);
  };
  {
    const py::gil_scoped_release released;
    keep(0, motion.r_eb_e, motion.v_eb_e, motion.C_b_e);
    navigate(motion, [&](Eigen::Index i, const ins::Strapdown& navigator, const Eigen::Matrix3d&, const ins::BodyIncrement&) {
      keep(i + 1, navigator.state().r_eb_e, navigator.state().v_eb_e, navigator.state().q_b_e.toRotationMatrix());
    });
  }
  return py::make_tuple(r, v, C);
}

py::dict error_state_transition(const Motion& motion, const py::object& error_model) {
  motion.check();
  const noise::ImuErrorModel model = noise::ImuErrorModel::from(tree_from(error_model, "."));
  const estimate::StateLayout layout(model, Eigen::Matrix3d::Identity(), {});
  estimate::TransitionAccumulator transition(layout, geo::kEarthRate);
  navigate(motion, [&](Eigen::Index i, const ins::Strapdown& navigator, const Eigen::Matrix3d& before,
                       const ins::BodyIncrement& increment) {
    transition.add({.dt = increment.dt,
                    .C_b_e = 0.5 * (before + navigator.C_b_e()),
                    .dv_e = navigator.last_dv_e(),
                    .dtheta_b = increment.phi,
                    .dv_b = increment.u});
    if (transition.substep_due() || i + 1 == motion.dt.size()) transition.fold(navigator.gravity_gradient());
  });
  py::list states;
  for (const char* part : {"position", "velocity", "attitude"})
    for (const char axis : {'x', 'y', 'z'}) states.append(std::string(part) + "_" + axis);
  for (const estimate::StateLayout::SensorBlock& block : layout.sensors())
    for (int k = 0; k < block.size; ++k) states.append(block.size == 1 ? block.name : block.name + " " + std::to_string(k + 1));
  py::dict result;
  result["states"] = states;
  result["Phi"] = Eigen::MatrixXd(transition.Phi_n());
  result["Q"] = Eigen::MatrixXd(transition.Q_n());
  return result;
}

}  // namespace

void register_blocks(py::module_& module) {
  module.def("allan", &allan);
  module.def("sum_log_likelihood", &sum_log_likelihood);
  module.def("process_parameters", &process_parameters);
  module.def("arma_garch_fit", &arma_garch_fit);
  py::class_<Motion>(module, "Motion")
      .def(py::init([](const Eigen::VectorXd& r_eb_e, const Eigen::VectorXd& v_eb_e, const Eigen::MatrixXd& C_b_e,
                       const Vectors& dtheta, const Vectors& dv,
                       const Eigen::VectorXd& dt) { return Motion{r_eb_e, v_eb_e, C_b_e, dtheta, dv, dt}; }));
  module.def("strapdown", &strapdown);
  module.def("error_state_transition", &error_state_transition);
}

}  // namespace coast::python
