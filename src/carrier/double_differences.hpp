#pragma once
// Phases, codes and Doppler of one epoch as linearised measurements without the receivers' clocks. Private to the room.

#include "coast/carrier/ppk.hpp"
#include "coast/carrier/relative_state.hpp"

namespace coast::carrier {

/// Nominal sd of the difference of two receivers' phases, m: see NoiseScale.
double nominal_phase_sd(double rover_elevation, double base_elevation, const BandDifference& band);

enum class Observable : std::uint8_t { kCode, kPhase, kRate };

/// One observation, scaled to unit variance.
struct Row {
  std::size_t satellite = 0;  ///< index in the epoch
  std::size_t band = 0;       ///< index in the satellite
  Observable observable = Observable::kPhase;
  double sd = 0.0;  ///< m, for rates m/s
  Direction direction;
};

/// All observations of an epoch, their double differences and their positions in the state. The rows of a group share a
/// clock: rates of all; phases, or codes, of one system and band. Double differences with any satellite as reference span the
/// same space: here it is the complement of the clock's column, with orthonormal rows, so that noise remains white and there is
/// no reference satellite. If phases of several wavelengths share a clock, the antenna's rotation about the vertical, a cycle
/// of each, is an additional column.
struct DoubleDifferences {
  std::vector<Row> rows;     ///< by group
  Eigen::MatrixXd H;         ///< rows x state
  Eigen::VectorXd residual;  ///< observed minus modelled
  Eigen::MatrixXd B;         ///< differences x rows, by blocks
  struct Block {
    Eigen::Index first_row = 0, rows = 0;                ///< of the group
    Eigen::Index first_difference = 0, differences = 0;  ///< of the group
  };
  std::vector<Block> blocks;

  [[nodiscard]] bool empty() const { return B.rows() == 0; }
  /// B times M, block by block.
  [[nodiscard]] Eigen::MatrixXd without_clocks(const Eigen::MatrixXd& M) const;
};

/// Which rows of the epoch are not used: (satellite, band, observable).
using LeftOut = std::set<std::tuple<std::size_t, std::size_t, Observable>>;

/// How observations are weighted.
struct Weighting {
  NoiseScale noise;
  std::set<Unknown> known;  ///< ambiguities already estimated from a code
  /// Phases of all systems and bands share the receiver's one clock and its antenna's rotation, apart from constants in their
  /// ambiguities: then two satellites of two systems have information. Else each system and band has its own clock.
  bool one_phase_clock = false;
};

/// Includes rates if the state has a velocity. The codes have the noise of one epoch.
DoubleDifferences double_differences(const DifferenceEpoch& epoch, const RelativeState& state, const LeftOut& left_out,
                                     const DifferenceOptions& options, const Weighting& weighting);

/// Weighs the codes as the filter does, which averages them over many epochs (NoiseScale::code_inflation).
void inflate_codes(DoubleDifferences& dd, const DifferenceEpoch& epoch, const Weighting& weighting);

}  // namespace coast::carrier
