#pragma once
// One run of the forward filter; private to the room.

#include <array>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "propagation.hpp"
#include "tight_coupling.hpp"

namespace coast::estimate {

class ForwardPass {
 public:
  ForwardPass(const Mission& mission, const StateLayout& layout, const FilterOptions& options, double knot_interval,
              const FilterOutputs& outputs);
  void start(const FilterState& state);
  void start(const Knot& knot);
  void advance(geo::GpsTime end);
  [[nodiscard]] FilterResult finish();

 private:
  void begin(const Navigator::Start& start, const Eigen::MatrixXd& P);
  /// Skips those not used by a run that begins there, and instants of knots.
  void skip_measurements(geo::GpsTime before);
  [[nodiscard]] geo::GpsTime next_knot_time(geo::GpsTime end) const;
  [[nodiscard]] std::size_t gnss_epochs() const;
  [[nodiscard]] geo::GpsTime gnss_time(std::size_t index) const;
  void take_gnss(std::size_t index);
  void carrier_updates(const carrier::DifferenceEpoch& epoch);
  void close_interval();
  void knot();
  void gnss_updates(std::size_t index);
  void vehicle_updates();
  [[nodiscard]] const std::vector<record::MemberBlocks::Block>& member_blocks() const;
  void member_updates(std::size_t index);
  void aid_updates();
  [[nodiscard]] geo::GpsTime aid_time(std::size_t aid) const;
  void hold_heading();
  [[nodiscard]] bool stands_still() const;
  void note_refused_members();
  void note_refused_aids();
  /// @return whether it was used; none if it does not apply
  std::optional<bool> try_update(const Measurement& measurement, record::FixQuality quality = record::FixQuality::kUnknown);
  /// Uses or rejects a measurement.
  bool take(const Measurement& what, const Linearised& measurement, record::FixQuality quality);
  [[nodiscard]] bool gate_refuses(const Linearised& measurement, double nis);
  /// Antenna position from single-receiver code, minus that of the filter.
  [[nodiscard]] std::optional<Eigen::Vector3d> seen_alone(const carrier::DifferenceEpoch& epoch,
                                                          const UpdateContext& here) const;
  /// For positions. @return whether the filter has rejected them for so long that the filter itself is wrong
  bool refuse(const Eigen::Vector3d& nu_e);
  void note_opened(const Eigen::Vector3d& nu_n);
  [[nodiscard]] bool coasting() const;
  void admit_doubt(const Eigen::Vector3d& nu);
  void record_innovation(const Measurement& what, const Linearised& measurement, const Innovation& innovation, bool used,
                         record::FixQuality quality);
  void emit_epochs(const record::NavCovariance& at_end);
  /// Delivers the last knot, now complete, to the outputs.
  void deliver_knot();
  [[nodiscard]] bool keeps_knots() const { return outputs_.knots != nullptr || outputs_.closed_knots; }
  void check_finite() const;
  [[nodiscard]] UpdateContext context() const;

  const Mission& mission_;
  const StateLayout& layout_;
  const FilterOptions& options_;
  const FilterOutputs& outputs_;
  double knot_interval_;
  std::array<double, 4> gate_;  ///< threshold of NIS by dof

  Propagation propagation_;
  FilterState state_;                                    ///< valid at knots
  Eigen::Matrix3d C_n_e_ = Eigen::Matrix3d::Identity();  ///< at the last knot
  Knot knot_;                                            ///< the last one, before its transition
  bool have_knot_ = false;

  SampleCursor cursor_;
  std::size_t next_fix_ = 0;
  std::size_t next_stop_ = 0;  ///< index in options_.knots_at
  std::size_t next_restart_ = 0;
  std::size_t next_block_ = 0;         ///< index in the members' blocks
  std::vector<std::size_t> next_aid_;  ///< index in the samples of each aid
  struct Count {
    std::size_t met = 0;
    std::size_t refused = 0;
  };
  std::vector<Count> member_counts_;          ///< for the differences of each member
  std::vector<Count> aid_counts_;             ///< for the samples of each aid
  std::optional<record::NavState> standing_;  ///< at the last knot after its updates, if it was in a standstill
  std::optional<TightCoupling> tight_;
  geo::GpsTime last_constraint_;
  geo::GpsTime first_refused_;
  geo::GpsTime last_used_;  ///< last used position fix
  enum class GateState { kClosed, kRefusing, kOpen } gate_state_ = GateState::kClosed;
  std::vector<record::NavState> buffer_;
  record::NavCovariance cov_at_start_;
  FilterResult result_;
};

}  // namespace coast::estimate
