#include "aids.hpp"

#include <algorithm>

#include "coast/geo/rotation.hpp"
#include "coast/ins/reversal.hpp"

namespace coast::estimate {

const std::vector<AidKind>& aid_kinds() {
  static const std::vector<AidKind> kinds{odometer_kind(), heading_kind(), baseline_kind(),
                                          attitude_kind(), height_kind(),  position_kind()};
  return kinds;
}

std::vector<AidStream> reversed(const std::vector<AidStream>& aids, geo::GpsTime mirror) {
  std::vector<AidStream> result = aids;
  for (AidStream& stream : result) {
    std::vector<record::AidSample> samples(stream.samples->rbegin(), stream.samples->rend());
    for (record::AidSample& sample : samples) sample.t = ins::mirrored(sample.t, mirror);
    stream.samples = std::make_shared<const std::vector<record::AidSample>>(std::move(samples));
  }
  return result;
}

AntennaPrediction point_position(const FilterState& state, const UpdateContext& context, const Eigen::Vector3d& point_b) {
  const Eigen::Vector3d arm_e = state.nav.q_b_e * point_b;
  AntennaPrediction p{state.nav.r_eb_e + arm_e, Eigen::MatrixXd::Zero(3, context.layout.size())};
  p.H.block<3, 3>(0, kPos).setIdentity();
  p.H.block<3, 3>(0, kPsi) = -geo::skew(arm_e);
  return p;
}

std::vector<record::AidSample> with_sd(const record::AidRecording& rows, const Eigen::Vector3d& stated_sd, double unit) {
  std::vector<record::AidSample> samples = rows.samples;
  for (record::AidSample& sample : samples) {
    sample.value *= unit;
    for (Eigen::Index i = 0; i < 3; ++i) sample.sd(i) = sample.sd(i) > 0.0 ? unit * sample.sd(i) : stated_sd(i);
  }
  return samples;
}

std::vector<record::AidSample> thinned(const std::vector<record::AidSample>& samples, double interval_s) {
  std::vector<record::AidSample> kept;
  for (const record::AidSample& sample : samples) {
    constexpr double kJitter = 1e-3;  // s
    if (kept.empty() || sample.t - kept.back().t >= interval_s - kJitter) kept.push_back(sample);
  }
  return kept;
}

}  // namespace coast::estimate
