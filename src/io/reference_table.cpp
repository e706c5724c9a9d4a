#include "reference_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "position.hpp"
#include "repairs.hpp"

namespace coast::io {

namespace {

constexpr double kReferenceNanShare = 0.01;
using Form = AttitudeOptions::Form;

class ReferenceTable {
 public:
  ReferenceTable(TableReader& table, const ReferenceFileOptions& options, std::optional<geo::GpsTime> near)
      : table_(table),
        options_(options),
        time_(table, options.time, options.time_columns, near),
        position_(options.position, table),
        order_(table, repairs_) {
    r_ = slots(options.position_columns, "position");
    v_ = slots(options.velocity_columns, "velocity");
    if (options.attitude.form != Form::kNone) attitude_ = slots(options.attitude_columns, "attitude");
    trajectory_.source = table.name();
    trajectory_.has_velocity = !v_.empty();
    trajectory_.has_attitude = !attitude_.empty();
    trajectory_.states.reserve(table.expected_rows());
  }

  record::Trajectory read() {
    while (table_.next()) take_row();
    auto& events = trajectory_.events;
    for (const auto& source : {table_.events(), time_.events(), position_.events()})
      events.insert(events.end(), source.begin(), source.end());
    repairs_.finish(table_.rows(), events);
    if (trajectory_.states.empty()) throw InputError({table_.name(), 0, "no epoch", "at least one", ""});
    return std::move(trajectory_);
  }

 private:
  std::vector<std::size_t> slots(const std::vector<Column>& columns, std::string_view role) {
    std::vector<std::size_t> s;
    s.reserve(columns.size());
    for (const Column& column : columns) s.push_back(table_.number_slot(column, role));
    return s;
  }
  [[nodiscard]] double value(std::size_t slot) const { return table_.number(slot); }

  /// q_b_n of the row, n north-east-down, b forward-right-down.
  [[nodiscard]] Eigen::Quaterniond attitude() const {
    Eigen::Quaterniond q;
    if (options_.attitude.form == Form::kEuler) {
      q = geo::quaternion_from_euler(
          {value(attitude_[0]) * geo::kDegree, value(attitude_[1]) * geo::kDegree, value(attitude_[2]) * geo::kDegree});
    } else {
      q = Eigen::Quaterniond(value(attitude_[3]), value(attitude_[0]), value(attitude_[1]), value(attitude_[2]));
      if (std::abs(q.norm() - 1.0) > 0.01)
        throw table_.error(fmt::format("a quaternion of norm {:.4f}", q.norm()), "1", "The order is x, y, z, w.");
      q.normalize();
    }
    // Half turns about (1, 1, 0)/sqrt(2) (east-north-up to north-east-down) and about x (forward-left-up to
    // forward-right-down).
    const double half = std::sqrt(0.5);
    if (options_.attitude.to_enu) q = Eigen::Quaterniond(0.0, half, half, 0.0) * q;
    if (options_.attitude.body_flu) q = q * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
    return q;
  }

  void take_row() {
    if (!table_.finite()) {
      repairs_.add("nan_row", "with a field that is empty or not finite left out", kReferenceNanShare,
                   table_.error("a field that is empty or not finite", "numbers", "Are the columns mapped right?"),
                   std::nullopt);
      return;
    }
    record::NavState state;
    state.t = time_.read();
    state.r_eb_e = position_.to_ecef(value(r_[0]), value(r_[1]), value(r_[2]));
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(state.r_eb_e));
    if (!v_.empty()) state.v_eb_e = C_n_e * Eigen::Vector3d(value(v_[0]), value(v_[1]), value(v_[2]));
    if (!attitude_.empty()) state.q_b_e = (Eigen::Quaterniond(C_n_e) * attitude()).normalized();
    auto& states = trajectory_.states;
    if (order_.accept(state.t, !states.empty() && states.back().r_eb_e == state.r_eb_e)) states.push_back(state);
  }

  TableReader& table_;
  const ReferenceFileOptions& options_;
  Repairs repairs_;
  TimeColumn time_;
  PositionConverter position_;
  TimeOrder order_;
  std::vector<std::size_t> r_, v_, attitude_;
  record::Trajectory trajectory_;
};

}  // namespace

record::Trajectory read_reference_table(TableReader& table, const ReferenceFileOptions& options,
                                        std::optional<geo::GpsTime> near) {
  return ReferenceTable(table, options, near).read();
}

}  // namespace coast::io
