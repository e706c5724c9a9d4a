#pragma once
// Phases, codes and Doppler of one epoch as linearised measurements free of the receivers' clocks. Private to the room.

#include "coast/carrier/ppk.hpp"
#include "coast/carrier/relative_state.hpp"

namespace coast::carrier {

/// Nominal sd of the difference of two receivers' phases, m: see NoiseScale.
double nominal_phase_sd(double rover_elevation, double base_elevation, const BandDifference& band);

enum class Observable : std::uint8_t { kCode, kPhase, kRate };

/// One observation, scaled to unit variance.
struct Row {
  std::size_t satellite = 0;  ///< of the epoch
  std::size_t band = 0;       ///< of the satellite
  Observable observable = Observable::kPhase;
  double sd = 0.0;  ///< m, of rates m/s
  Direction direction;
};

/// All observations of an epoch, the double differences made of them and their place in the state. A group is what shares a
/// clock: rates of all; phases, or codes, of one system and band. Double differences with any satellite as reference span the
/// same space: here it is the complement of the clock's column, with orthonormal rows, so that noise stays white and no
/// satellite is special. Where phases of several wavelengths share a clock, the turn of the antenna about the vertical, a cycle
/// of each, is a column beside it.
struct DoubleDifferences {
  std::vector<Row> rows;     ///< by group
  Eigen::MatrixXd H;         ///< rows x state
  Eigen::VectorXd residual;  ///< observed less modelled
  Eigen::MatrixXd B;         ///< differences x rows

  [[nodiscard]] bool empty() const { return B.rows() == 0; }
};

/// Which rows of the epoch are not used: (satellite, band, observable).
using LeftOut = std::set<std::tuple<std::size_t, std::size_t, Observable>>;

/// How observations are weighted.
struct Weighting {
  NoiseScale noise;
  std::set<Unknown> known;  ///< ambiguities that a code has told of before
  /// Phases of all systems and bands share the receiver's one clock and its antenna's turn, which their ambiguities differ from
  /// by constants: two satellites of two systems then still tell something. Else each system and band has its own clock.
  bool one_phase_clock = false;
};

/// Rates are among them where the state has a velocity.
DoubleDifferences double_differences(const DifferenceEpoch& epoch, const RelativeState& state, const LeftOut& left_out,
                                     const DifferenceOptions& options, const Weighting& weighting);

}  // namespace coast::carrier
