#include "coast/jobs/process.hpp"

namespace coast::jobs {

namespace {

constexpr report::DecimationOptions kErrorCurve{12000, 5.0};

ReferenceErrors::Curves error_curves() {
  const report::Decimator curve(kErrorCurve);
  return {curve, curve, curve};
}

}  // namespace

ReferenceErrors::ReferenceErrors(geo::GpsTime start)
    : start_(start), position_(error_curves()), velocity_(error_curves()), attitude_(error_curves()) {}

void ReferenceErrors::add(const study::ErrorSample& sample) {
  statistics_.add(sample);
  const double t = sample.t - start_;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    position_[i].add(t, sample.position_n(axis), -sample.sd_position(axis), sample.sd_position(axis));
    velocity_[i].add(t, sample.velocity_n(axis));
    attitude_[i].add(t, sample.attitude(axis), -sample.sd_attitude(axis), sample.sd_attitude(axis));
  }
}

}  // namespace coast::jobs
