#pragma once
// The error states of the filter: their order and their effect.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/noise/error_model.hpp"

namespace coast::estimate {

/// Indices of the navigation states, errors = estimate - truth in e: position m, velocity m/s, attitude psi_e rad.
inline constexpr int kPos = 0;
inline constexpr int kVel = 3;
inline constexpr int kPsi = 6;
inline constexpr int kNav = 9;

/// Time-correlated GNSS position errors: a stationary Gauss-Markov process each in N, E, D at the antenna. Where fixes with
/// fixed ambiguities begin or end it is drawn anew: what lasts are errors of one set of ambiguities.
struct CorrelatedGnss {
  double horizontal_m = 0.0;  ///< stationary sd per axis, 0: none
  double vertical_m = 0.0;
  double time_s = 60.0;  ///< correlation time
};

/// An error of an aiding sensor: a constant, or a stationary Gauss-Markov process.
struct AidState {
  std::string name;     ///< without that of the aid: "scale"
  double sd = 0.0;      ///< above zero
  double time_s = 0.0;  ///< correlation time; 0: constant
};

/// States estimated in addition to the IMU errors. A standard deviation of zero leaves the states out.
struct AuxiliaryStates {
  double lever_arm_sd_m = 0.0;    ///< prior sd of each component, body axes
  double time_offset_sd_s = 0.0;  ///< prior sd of the GNSS time offset
  double mounting_sd = 0.0;       ///< prior sd of the vehicle's yaw and pitch relative to the body, rad
  double base_offset_sd_m = 0.0;  ///< prior sd of the common error of all GNSS positions, each component in e
  CorrelatedGnss correlated_gnss = {};
  /// Number of states reserved for unknowns of carrier-phase observations, which begin and end: constant states without prior,
  /// unnamed here.
  int carrier_slots = 0;
  /// Errors of aiding sensors, those of each aid together.
  struct Aid {
    std::string name;
    std::vector<AidState> states;
  };
  std::vector<Aid> aids = {};
};

class StateLayout {
 public:
  /// States of one process.
  struct Block {
    noise::ProcessPtr process;
    int offset = 0;  ///< of its first state
    int size = 0;
    std::string name;           ///< "gyro_x gauss_markov"
    Eigen::RowVectorXd output;  ///< h of the process
  };
  /// A block that acts on the navigation states through a sensor axis:
  /// error of the sensor in b = response_b * (h x) * (1 or signal_b . true signal in b).
  struct SensorBlock : Block {
    noise::Sensor sensor = noise::Sensor::kGyro;
    Eigen::Vector3d response_b;
    std::optional<Eigen::Vector3d> signal_b;
    int axis = 0;                       ///< of the sensor
    std::optional<int> signal_axis;     ///< the same as signal_b
    std::optional<std::size_t> member;  ///< index in members(): IMU that it belongs to, if several IMUs were merged
    Eigen::RowVectorXd own_output;      ///< contribution of the states to that member's error, in the axes of the sum
  };
  /// One of several merged IMUs, if the error model has shares.
  struct Member {
    std::string name;
    Eigen::Vector3d gyro_density = Eigen::Vector3d::Zero();  ///< of its own white noise, [signal]^2/Hz, sensor axes
    Eigen::Vector3d accel_density = Eigen::Vector3d::Zero();
  };

  /// @param C_s_b sensor to body axes: processes are in sensor axes
  StateLayout(const noise::ImuErrorModel& model, const Eigen::Matrix3d& C_s_b, const AuxiliaryStates& auxiliary);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int sensor_end() const { return sensor_end_; }  ///< navigation and sensor states are [0, sensor_end)
  [[nodiscard]] const std::vector<SensorBlock>& sensors() const { return sensors_; }
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  [[nodiscard]] const std::vector<Block>& auxiliaries() const { return auxiliaries_; }
  [[nodiscard]] std::optional<int> lever_arm() const { return lever_arm_; }      ///< 3 states, b
  [[nodiscard]] std::optional<int> time_offset() const { return time_offset_; }  ///< 1 state, s
  [[nodiscard]] std::optional<int> mounting() const { return mounting_; }        ///< pitch, yaw, rad
  [[nodiscard]] std::optional<int> base_offset() const { return base_offset_; }  ///< 3 states, e
  [[nodiscard]] std::optional<int> gnss_error() const { return gnss_error_; }    ///< 3 states, N, E, D
  [[nodiscard]] bool is_gnss_error(int state) const { return gnss_error_ && state >= *gnss_error_ && state < *gnss_error_ + 3; }
  /// Index of the first state of each aid.
  [[nodiscard]] const std::vector<int>& aids() const { return aids_; }
  /// The carrier slots are the last states, [carrier_slots(), size()).
  [[nodiscard]] int carrier_slots() const { return carrier_slots_; }
  /// A column per axis of the sensor: its direction in b, times the root of its white-noise density, [signal]/sqrt(Hz).
  [[nodiscard]] const Eigen::Matrix3d& gyro_noise_b() const { return gyro_noise_b_; }
  [[nodiscard]] const Eigen::Matrix3d& accel_noise_b() const { return accel_noise_b_; }
  /// Shortest correlation time of any sensor state, s; infinity if all are constant. Auxiliary states are propagated exactly
  /// over any interval.
  [[nodiscard]] double shortest_time() const { return shortest_time_; }

  /// Covariance of the non-navigation states at the start (size x size, navigation rows zero).
  [[nodiscard]] Eigen::MatrixXd initial_covariance() const;
  /// Mean of the non-navigation states `elapsed` seconds after the start (navigation rows zero).
  [[nodiscard]] Eigen::VectorXd mean(double elapsed) const;
  /// Sensor and auxiliary blocks in the order of their states.
  template <typename Visit>
  void for_each_block(Visit visit) const {
    for (const Block& block : sensors_) visit(block);
    for (const Block& block : auxiliaries_) visit(block);
  }

 private:
  void add_sensor(const noise::ImuErrorModel& model, noise::Sensor sensor, const Eigen::Matrix3d& C_s_b);
  int add_auxiliary(const std::string& name, double sigma, double beta, int count);
  int size_ = kNav;
  int sensor_end_ = kNav;
  [[nodiscard]] std::size_t member(const std::string& name) const;
  std::vector<SensorBlock> sensors_;
  std::vector<Member> members_;
  std::vector<Block> auxiliaries_;
  std::optional<int> lever_arm_;
  std::optional<int> time_offset_;
  std::optional<int> mounting_;
  std::optional<int> base_offset_;
  std::optional<int> gnss_error_;
  std::vector<int> aids_;
  int carrier_slots_ = kNav;
  Eigen::Matrix3d gyro_noise_b_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d accel_noise_b_ = Eigen::Matrix3d::Zero();
  double shortest_time_ = 0.0;
};

/// D and Q_d of the sensor and auxiliary states over one interval, cached until another interval is requested: most intervals
/// of a mission are equal. The matrices passed in have size() - kNav rows: row 0 is state kNav.
class BlockTransitions {
 public:
  explicit BlockTransitions(const StateLayout& layout);
  /// Sets the interval. @param dt s, >= 0  @param renews_gnss_error  at its end the GNSS error is independent of that before
  const BlockTransitions& over(double dt, bool renews_gnss_error = false);

  /// M <- D M
  void apply(Eigen::Ref<Eigen::MatrixXd> M) const;
  /// M <- D' M
  void apply_transposed(Eigen::Ref<Eigen::MatrixXd> M) const;
  /// row <- row D, for a row over the first states
  void apply_to_row(Eigen::Ref<Eigen::RowVectorXd> row) const;
  /// P <- D P D' + Q_d
  void propagate(Eigen::Ref<Eigen::MatrixXd> P) const;
  /// Q_d of a block.
  [[nodiscard]] auto driving_noise(const StateLayout::Block& block) const {
    return Q_d_.block(block.offset - kNav, 0, block.size, block.size);
  }

 private:
  struct Dense {
    int row = 0;
    Eigen::MatrixXd Phi;
  };
  const StateLayout& layout_;
  double dt_ = -1.0;
  bool renews_gnss_error_ = false;
  Eigen::VectorXd diagonal_;  ///< phi of blocks of one state, 1 elsewhere
  std::vector<Dense> dense_;  ///< Phi of larger blocks
  Eigen::MatrixXd Q_d_;       ///< blocks stacked, as wide as the largest
};

}  // namespace coast::estimate
