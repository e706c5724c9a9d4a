#include "arrays.hpp"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstdint>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::python {

namespace py = pybind11;

namespace {

/// An array that is filled row by row.
template <class Number>
class Rows {
 public:
  explicit Rows(std::size_t n) : array_(static_cast<py::ssize_t>(n)), data_(array_.mutable_data()) {}
  void operator()(std::size_t i, Number value) { data_[i] = value; }
  [[nodiscard]] py::object array() const { return array_; }

 private:
  py::array_t<Number> array_;
  Number* data_;
};

class Rows3 {
 public:
  explicit Rows3(std::size_t n) : array_({static_cast<py::ssize_t>(n), py::ssize_t{3}}), data_(array_.mutable_data()) {}
  void operator()(std::size_t i, const Eigen::Vector3d& value) {
    for (std::size_t k = 0; k < 3; ++k) data_[3 * i + k] = value[static_cast<Eigen::Index>(k)];
  }
  [[nodiscard]] py::object array() const { return array_; }

 private:
  py::array_t<double> array_;
  double* data_;
};

Eigen::Vector3d sd_of(const Eigen::Matrix3d& cov) {
  return cov.diagonal().cwiseMax(0.0).cwiseSqrt();
}

py::object array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Time, place, velocity and attitude of states in the terms of a map.
class GeographicColumns {
 public:
  explicit GeographicColumns(std::size_t n) : time_(n), latitude_(n), longitude_(n), height_(n), velocity_(n), attitude_(n) {}
  /// @return  its attitude
  geo::Euler set(std::size_t i, const record::NavState& state) {
    const geo::Geodetic p = geo::geodetic_from_ecef(state.r_eb_e);
    const Eigen::Matrix3d C_e_n = geo::C_n_e(p).transpose();
    const geo::Euler angles = geo::euler_from_dcm(C_e_n * state.q_b_e.toRotationMatrix());
    time_(i, state.t.nanoseconds());
    latitude_(i, p.latitude / geo::kDegree);
    longitude_(i, p.longitude / geo::kDegree);
    height_(i, p.height);
    velocity_(i, C_e_n * state.v_eb_e);
    attitude_(i, Eigen::Vector3d(angles.roll, angles.pitch, angles.yaw) / geo::kDegree);
    return angles;
  }
  [[nodiscard]] py::dict arrays() const {
    py::dict arrays;
    arrays["time_ns"] = time_.array();
    arrays["latitude"] = latitude_.array();
    arrays["longitude"] = longitude_.array();
    arrays["height"] = height_.array();
    arrays["velocity_n"] = velocity_.array();
    arrays["attitude"] = attitude_.array();
    return arrays;
  }

 private:
  Rows<std::int64_t> time_;
  Rows<double> latitude_, longitude_, height_;
  Rows3 velocity_, attitude_;
};

}  // namespace

py::dict state_arrays(const std::vector<record::NavState>& states) {
  const std::size_t n = states.size();
  GeographicColumns geographic(n);
  Rows3 r(n), v(n);
  py::array_t<double> C({static_cast<py::ssize_t>(n), py::ssize_t{9}});
  for (std::size_t i = 0; i < n; ++i) {
    geographic.set(i, states[i]);
    r(i, states[i].r_eb_e);
    v(i, states[i].v_eb_e);
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> C_b_e = states[i].q_b_e.toRotationMatrix();
    std::copy_n(C_b_e.data(), 9, C.mutable_data() + 9 * i);
  }
  py::dict arrays = geographic.arrays();
  arrays["r_eb_e"] = r.array();
  arrays["v_eb_e"] = v.array();
  arrays["C_b_e"] = C;
  return arrays;
}

py::dict imu_arrays(const record::ImuRecording& imu) {
  const std::size_t n = imu.samples.size();
  Rows<std::int64_t> time(n);
  Rows<double> dt(n);
  Rows3 dtheta(n), dv(n);
  for (std::size_t i = 0; i < n; ++i) {
    const record::ImuSample& sample = imu.samples[i];
    time(i, sample.t.nanoseconds());
    dt(i, sample.dt);
    dtheta(i, sample.dtheta);
    dv(i, sample.dv);
  }
  py::dict arrays;
  arrays["time_ns"] = time.array();
  arrays["dt"] = dt.array();
  arrays["dtheta"] = dtheta.array();
  arrays["dv"] = dv.array();
  return arrays;
}

py::dict fix_arrays(const record::GnssRecording& gnss) {
  const std::size_t n = gnss.fixes.size();
  Rows<std::int64_t> time(n);
  Rows<int> quality(n), satellites(n);
  Rows3 r(n), sd(n);
  for (std::size_t i = 0; i < n; ++i) {
    time(i, gnss.fixes[i].t.nanoseconds());
    quality(i, static_cast<int>(gnss.fixes[i].quality));
    satellites(i, gnss.fixes[i].satellites.value_or(0));
    r(i, gnss.fixes[i].r_ea_e);
    sd(i, sd_of(gnss.fixes[i].position_cov_n));
  }
  py::dict arrays;
  arrays["time_ns"] = time.array();
  arrays["r_ea_e"] = r.array();
  arrays["sd_position_n"] = sd.array();
  arrays["quality"] = quality.array();
  arrays["satellites"] = satellites.array();
  return arrays;
}

py::dict trajectory_arrays(const std::vector<record::TrajectoryEpoch>& epochs) {
  const std::size_t n = epochs.size();
  GeographicColumns geographic(n);
  Rows3 sd_position(n), sd_velocity(n), sd_attitude(n);
  for (std::size_t i = 0; i < n; ++i) {
    const record::TrajectoryEpoch& epoch = epochs[i];
    const Eigen::Matrix3d J = geo::euler_jacobian(geographic.set(i, epoch.nav));
    sd_position(i, sd_of(epoch.cov.position));
    sd_velocity(i, sd_of(epoch.cov.velocity));
    sd_attitude(i, sd_of(J * epoch.cov.attitude * J.transpose()) / geo::kDegree);
  }
  py::dict arrays = geographic.arrays();
  arrays["sd_position_n"] = sd_position.array();
  arrays["sd_velocity_n"] = sd_velocity.array();
  arrays["sd_attitude"] = sd_attitude.array();
  return arrays;
}

py::dict innovation_arrays(const std::vector<estimate::InnovationRecord>& innovations) {
  const std::size_t n = innovations.size();
  Rows<std::int64_t> time(n);
  Rows<int> dof(n);
  Rows<bool> used(n);
  Rows<double> nis(n);
  Rows3 innovation(n), sd(n);
  py::list kinds;
  for (std::size_t i = 0; i < n; ++i) {
    const estimate::InnovationRecord& one = innovations[i];
    time(i, one.t.nanoseconds());
    dof(i, one.dof);
    used(i, one.used);
    nis(i, one.nis);
    innovation(i, one.nu);
    sd(i, one.sd);
    kinds.append(estimate::name(one.kind));
  }
  py::dict arrays;
  arrays["time_ns"] = time.array();
  arrays["kind"] = kinds;
  arrays["used"] = used.array();
  arrays["dof"] = dof.array();
  arrays["innovation"] = innovation.array();
  arrays["sd"] = sd.array();
  arrays["nis"] = nis.array();
  return arrays;
}

py::dict track_arrays(const std::vector<jobs::StateTrack>& states) {
  py::dict arrays;
  for (const jobs::StateTrack& state : states) {
    py::dict track;
    track["seconds"] = array_of(state.seconds);
    track["forward"] = array_of(state.forward);
    track["forward_sd"] = array_of(state.forward_sd);
    track["smoothed"] = array_of(state.smoothed);
    track["smoothed_sd"] = array_of(state.smoothed_sd);
    arrays[py::str(state.name)] = track;
  }
  return arrays;
}

}  // namespace coast::python
