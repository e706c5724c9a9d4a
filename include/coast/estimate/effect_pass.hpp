#pragma once
// Evidence of a run for errors that are not modelled by a state: their scores and information, for every possible start time,
// in one backward pass over the knots.

#include <Eigen/Core>
#include <functional>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"

namespace coast::estimate {

/// A sample on the nominal trajectory.
struct SampleView {
  std::size_t index = 0;        ///< in the recording
  Eigen::Vector3d omega_b;      ///< mean over the sample, corrected for the estimated sensor errors, rad/s
  Eigen::Vector3d f_b;          ///< likewise, m/s^2
  const record::NavState& nav;  ///< at the end of the sample
};

/// A measurement on the nominal trajectory.
struct MeasurementView {
  UpdateKind kind = UpdateKind::kGnssPosition;
  std::size_t sample = 0;       ///< the first sample that ends after it
  const record::NavState& nav;  ///< at the time of the measurement
  const UpdateContext& context;
};

/// Derivatives of errors per unit coefficient with respect to the measured value of the same axis of the sensor: gyro x, y, z,
/// accelerometer x, y, z, by coefficient.
using OwnSlopes = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Hypotheses (effects), each with an unknown coefficient: the error in the measured values per unit coefficient. Error =
/// measured - true. A pass asks from several threads at a time.
class Effects {
 public:
  Effects() = default;
  Effects(const Effects&) = delete;
  Effects& operator=(const Effects&) = delete;
  virtual ~Effects() = default;
  [[nodiscard]] virtual Eigen::Index size() const = 0;
  /// @param gyro_b, accel_b  3 x size, rad/s and m/s^2 per unit; zero on entry
  virtual void add_sensor_errors(const SampleView& sample, Eigen::Matrix3Xd& gyro_b, Eigen::Matrix3Xd& accel_b) const = 0;
  /// @param slopes  6 x size; zero on entry, and if no error depends on what is measured
  virtual void add_own_slopes(const SampleView& /*sample*/, OwnSlopes& /*slopes*/) const {}
  /// @param D  m x size, components as in the update of the measurement; zero on entry
  virtual void add_measurement_errors(const MeasurementView& measurement, Eigen::MatrixXd& D) const = 0;
};

/// Evidence of all measurements from an instant on for a jump there, in the states and in the coefficients (de Jong & Penzer
/// 1998; de Jong 1991): with the vector r and the matrix N of docs/notation.md for states and coefficients together, changing
/// the error d = estimate - truth in the filter by delta changes the log-likelihood by -r' delta - delta' N delta / 2.
///
/// If an effect with coefficient c begins here and the filter does not model it, its estimate 0 has the error -c. The
/// likelihood is largest with the coefficient -r_c / N_cc in the filter; the log-likelihood is then higher by r_c^2 / (2 N_cc).
/// At the first knot this is an effect over the whole mission.
struct Evidence {
  geo::GpsTime t;
  const Eigen::VectorXd& r;          ///< of the states, n
  const Eigen::MatrixXd& N;          ///< n x n
  const Eigen::VectorXd& r_effects;  ///< p
  const Eigen::VectorXd& own_noise;  ///< p; what was subtracted from the scores, -r_effects
  const Eigen::MatrixXd& N_cross;    ///< n x p
  const Eigen::MatrixXd& N_effects;  ///< p x p, the lower triangle
  /// r and r_effects for the innovations of `EffectPassOptions::draw`: one column per draw.
  const Eigen::MatrixXd& null_r;          ///< n x draws
  const Eigen::MatrixXd& null_r_effects;  ///< p x draws
};

/// Fills a matrix, one column per draw, with values in place of an update's whitened innovation: `whitened` has covariance I
/// where the filter's model is true, S = L^-T L^-1, whitened = L' y.
using DrawInnovations = std::function<void(geo::GpsTime t, const Eigen::VectorXd& whitened, Eigen::Ref<Eigen::MatrixXd> draws)>;

struct EffectPassOptions {
  Eigen::Index draws = 0;
  DrawInnovations draw;  ///< not called without draws
  std::function<void(double)> progress;
  std::function<bool(geo::GpsTime)> counts = {};  ///< updates at other instants give no evidence; empty: all count
};

/// An effect whose error grows with the measured signal is in part the sensor's own noise: with e = c s and s = true + n the
/// score of c has the mean sum of g tr(N Q) where nothing is missing, g the slope of the error in s and Q the covariance that
/// the axis's white noise adds to the navigation states (errors in variables; corrected score, Nakamura 1990). It is
/// subtracted.
///
/// Processes the knots from the last to the first; `visit` is called at each with the evidence of its own and all later
/// updates. The nominal trajectory is recomputed from every knot; effects are linearised about it. The cost is some products of
/// n x p and 9 x p x p per knot and 20 flops per coefficient and sample; nothing is allocated per sample. Columns of the knots
/// are computed on all threads, `visit` and `draw` are called in order by one at a time.
/// @param knots  of a forward pass of the same mission and layout, without carrier slots
void effect_pass(const Mission& mission, const StateLayout& layout, const KnotStore& knots, const Effects& effects,
                 const EffectPassOptions& options, const std::function<void(const Evidence&)>& visit);

}  // namespace coast::estimate
