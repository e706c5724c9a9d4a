#include "pass_record.hpp"

#include "coast/geo/earth.hpp"

namespace coast::estimate {

FilterResult PassRecord::run(const ForwardFilter& filter, const FilterState& start) {
  size_ = 0;
  pending_.clear();
  FilterOutputs outputs;
  outputs.measurements = [this](const Measurement& measurement, bool used) {
    if (used) pending_.push_back(measurement);
  };
  outputs.closed_knots = [this, gnss_error = filter.layout().gnss_error()](const Knot& knot, const AxisNoise& white) {
    add(knot, white, gnss_error);
  };
  return filter.run(start, outputs);
}

void PassRecord::add(const Knot& knot, const AxisNoise& white, const std::optional<int>& gnss_error) {
  if (size_ == knots_.size()) knots_.emplace_back();
  RecordedKnot& to = knots_[size_++];
  to.knot.post = knot.post;
  to.knot.updates = knot.updates;
  to.knot.interval = knot.interval;
  to.knot.renews_gnss_error = knot.renews_gnss_error;
  to.knot.Phi_n = knot.Phi_n;
  to.measurements.swap(pending_);
  pending_.clear();
  to.white = white;
  if (gnss_error) to.P_gnss = knot.P_post.middleRows<3>(*gnss_error);
  to.C_n_e = geo::C_n_e(geo::geodetic_from_ecef(knot.post.nav.r_eb_e));
}

}  // namespace coast::estimate
