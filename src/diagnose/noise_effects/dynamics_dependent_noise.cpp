#include "coast/diagnose/correction.hpp"
#include "noise_effects.hpp"

namespace coast::diagnose {

NoiseEffect dynamics_dependent_noise(Site site) {
  const bool gyro = site == Site::kGyro;
  return {
      .name = "dynamics_dependent_noise",
      .site = site,
      .parameter = "coefficient",
      .unit = "sqrt(s)",
      .equation = gyro ? "white density N_i^2 + k^2 |omega|^2" : "white density N_i^2 + k^2 (|f| - g)^2",
      .meaning = gyro ? "The gyro's noise grows with the rate." : "The accelerometer's noise grows with the acceleration.",
      .separating_manoeuvre = "Equal shares of turning and of straight driving.",
      .source = "scale-factor noise of IEEE Std 952-2020",
      .times = {0.0},
      .level =
          [gyro](const Signals& s) {
            if (gyro) return s.omega.squaredNorm();
            const double beyond = s.f.norm() - geo::kStandardGravity;
            return beyond * beyond;
          },
      .power =
          [](const Disturbances& d, const Eigen::MatrixXf& score, const std::vector<double>& level, double) {
            Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(score.rows());
            for (std::size_t k = 0; k < d.t.size(); ++k)
              if (d.length[k] > 0.0)
                sum += static_cast<float>(level[k] / d.length[k]) * score.col(static_cast<Eigen::Index>(k)).array().square();
            return sum;
          },
      .add =
          [site](MissionInput& input, int axis, double root, double, const std::vector<geo::GpsTime>& t,
                 const std::vector<double>& level) {
            std::vector<RaisedNoise> stretches;
            for (std::size_t k = 0; k + 1 < t.size(); ++k) stretches.push_back({t[k], t[k + 1], root * root * level[k]});
            raise_noise(input, site, axis, stretches);
          },
  };
}

}  // namespace coast::diagnose
