#pragma once
// Numbers over a whole carrier-phase solution.

#include <array>
#include <string>
#include <vector>

#include "coast/jobs/ppk.hpp"

namespace coast::jobs {

struct PpkSummary {
  std::size_t epochs = 0;    ///< of the rover
  std::size_t expected = 0;  ///< if none were missing
  std::size_t fixed = 0, floats = 0, single = 0, none = 0;
  std::array<std::size_t, carrier::kShortfalls> shortfalls{};  ///< epochs by cause
  Eigen::Vector3d fixed_sd_n = Eigen::Vector3d::Zero();        ///< medians, N, E, D, m
  struct Spread {
    double median = 0.0, p95 = 0.0, largest = 0.0;  ///< m, three-dimensional
    std::size_t epochs = 0;
    std::size_t far = 0;  ///< number of epochs fixed both ways that differ by more than 0.1 m
  } separation;
  double baseline_m = 0.0;             ///< median length
  std::size_t left_out = 0, used = 0;  ///< phases and codes

  [[nodiscard]] double fix_rate() const;  ///< fraction of the expected epochs
  /// Causes of epochs that are not fixed, as text, and their numbers; first those not recorded by the rover.
  [[nodiscard]] std::vector<std::pair<std::string, std::size_t>> causes() const;
};

[[nodiscard]] PpkSummary summary_of(const PpkResult& result);
/// ppk.json, schema coast.ppk_result/1
[[nodiscard]] std::string ppk_json(const PpkConfig& config, const PpkResult& result);
/// Residuals of all phases and codes, per epoch: residuals.csv
[[nodiscard]] std::string residuals_csv(const PpkResult& result);
/// North, east, down from a moving base to the rover at each fixed or float epoch, with sigmas: baselines.csv
[[nodiscard]] std::string baselines_csv(const PpkResult& result);
/// "G L1 C, L2 W; E E1 C/X": signals of rover and base
[[nodiscard]] std::string signals_in_words(const carrier::SignalChoice& signals);

}  // namespace coast::jobs
