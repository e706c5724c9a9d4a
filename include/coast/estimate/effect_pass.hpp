#pragma once
// What a run says of errors that no state stands for: their scores and their information, for every instant at which they may
// have begun, in one pass backward over its knots.

#include <Eigen/Core>
#include <functional>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"

namespace coast::estimate {

/// A sample on the nominal trajectory.
struct SampleView {
  std::size_t index = 0;        ///< in the recording
  Eigen::Vector3d omega_b;      ///< mean over the sample, freed of the estimated sensor errors, rad/s
  Eigen::Vector3d f_b;          ///< likewise, m/s^2
  const record::NavState& nav;  ///< at its end
};

/// A measurement on the nominal trajectory.
struct MeasurementView {
  UpdateKind kind = UpdateKind::kGnssPosition;
  std::size_t sample = 0;       ///< the first one that ends behind it
  const record::NavState& nav;  ///< when it is valid
  const UpdateContext& context;
};

/// Hypotheses, each with an unknown coefficient: what a unit of it adds to what is measured. Error = measured - true.
class Effects {
 public:
  Effects() = default;
  Effects(const Effects&) = delete;
  Effects& operator=(const Effects&) = delete;
  virtual ~Effects() = default;
  [[nodiscard]] virtual Eigen::Index size() const = 0;
  /// @param gyro_b, accel_b  3 x size, rad/s and m/s^2 per unit; zero when it is called
  virtual void add_sensor_errors(const SampleView& sample, Eigen::Matrix3Xd& gyro_b, Eigen::Matrix3Xd& accel_b) const = 0;
  /// @param D  m x size, of the components of the measurement as its update has them; zero when it is called
  virtual void add_measurement_errors(const MeasurementView& measurement, Eigen::MatrixXd& D) const = 0;
};

/// What all measurements from an instant on say of a jump there, in the states and in the coefficients (de Jong & Penzer 1998;
/// de Jong 1991): with the vector r and the matrix N of docs/notation.md for states and coefficients together, a jump of the
/// error d = estimate - truth by delta, brought about in the filter, changes the logarithm of the likelihood by
/// -r' delta - delta' N delta / 2.
///
/// An effect that begins here with the coefficient c, and that the filter is not told of, is the error -c of the estimate 0:
/// told -r_c / N_cc the filter is likeliest, by r_c^2 / (2 N_cc). At the first knot that is the effect of the whole mission.
struct Evidence {
  geo::GpsTime t;
  const Eigen::VectorXd& r;          ///< of the states, n
  const Eigen::MatrixXd& N;          ///< n x n
  const Eigen::VectorXd& r_effects;  ///< p
  const Eigen::MatrixXd& N_cross;    ///< n x p
  const Eigen::MatrixXd& N_effects;  ///< p x p
  /// r and r_effects where the innovations are drawn from the filter's own covariances: a column a draw.
  const Eigen::MatrixXd& null_r;          ///< n x draws
  const Eigen::MatrixXd& null_r_effects;  ///< p x draws
};

struct EffectPassOptions {
  Eigen::Index draws = 0;
  std::function<void(Eigen::Ref<Eigen::MatrixXd>)> fill_normal;  ///< with independent standard normal numbers
  std::function<void(double)> progress;
  std::function<bool(geo::GpsTime)> counts = {};  ///< updates at other instants happen and say nothing; empty: all count
};

/// Walks the knots from the last to the first; `visit` is called at each with what its own updates and all behind it say. The
/// nominal trajectory is repeated from every knot on, and is what effects are linearised about. Costs some products of
/// n x p and 9 x p x p per knot and 20 flops per coefficient and sample; nothing is allocated per sample.
/// @param knots  of a forward pass of the same mission and layout, without carrier slots
void effect_pass(const Mission& mission, const StateLayout& layout, const KnotStore& knots, const Effects& effects,
                 const EffectPassOptions& options, const std::function<void(const Evidence&)>& visit);

}  // namespace coast::estimate
