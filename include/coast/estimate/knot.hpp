#pragma once
// What the forward pass leaves behind at every knot (measurement epoch or filler), for smoother, outages and output.

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "coast/carrier/relative_state.hpp"
#include "coast/estimate/navigator.hpp"
#include "coast/estimate/update.hpp"

namespace coast::estimate {

struct Knot {
  // State after the knot's updates, from which the nominal trajectory goes on.
  Navigator::Start post;
  Eigen::MatrixXd P_post;
  std::vector<AppliedUpdate> updates;  ///< in the order applied
  /// Names of the carrier slots; a position stands for a free one.
  std::vector<carrier::Unknown> slots;
  /// What the slots were multiplied with before the updates: 0 where an unknown began or ended; empty: nothing.
  Eigen::VectorXd slot_factors;
  // Where in the recording the knot stands: sample `next_sample` is the first not fully used, `remainder` what is left of it.
  std::size_t next_sample = 0;
  ins::RawIncrement remainder;  ///< dt = 0: the sample is untouched
  // Transition to the next knot; empty at the last one.
  double interval = 0.0;
  NavRows Phi_n = NavRows(kNav, 0);
};

/// Which knots somebody keeps who has no use for all: of each interval of a fixed grid in time the first. The same ones in
/// whatever direction one comes along.
class KnotSampling {
 public:
  KnotSampling() = default;  ///< every knot
  explicit KnotSampling(double interval_s) : interval_s_(interval_s) {}
  /// @param previous  the knot before in time; the first knot is always taken
  [[nodiscard]] bool takes(std::optional<geo::GpsTime> previous, geo::GpsTime t) const {
    return !previous || !(interval_s_ > 0.0) || cell(*previous) != cell(t);
  }

 private:
  [[nodiscard]] double cell(geo::GpsTime t) const { return std::floor(t.sow() / interval_s_); }
  double interval_s_ = 0.0;
};

/// Knots in the order of time, read in any order. Kept in memory up to a limit, beyond it in an unnamed temporary file, so that
/// ten hours at 10 Hz need no more memory than one.
class KnotStore {
 public:
  explicit KnotStore(std::size_t memory_limit_bytes = std::size_t{64} << 20);
  void append(const Knot& knot);
  /// Leaves no knot, and the memory for those of another pass.
  void clear();
  [[nodiscard]] std::size_t size() const { return offsets_.size(); }
  [[nodiscard]] Knot at(std::size_t index) const;
  /// What the nominal trajectory goes on from, and the interval; covariance, transition and updates are empty.
  [[nodiscard]] Knot nominal_at(std::size_t index) const;
  [[nodiscard]] geo::GpsTime time(std::size_t index) const { return times_[index]; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void spill();
  /// The first `count` doubles of a knot (all where 0), from memory or through `buffer`.
  [[nodiscard]] const double* data(std::size_t index, std::size_t count, std::vector<double>& buffer) const;

  std::size_t limit_;
  std::vector<double> memory_;  ///< not yet spilled
  std::size_t spilled_ = 0;     ///< doubles in the file
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::vector<std::size_t> offsets_;  ///< of each knot, in doubles from the start
  std::vector<geo::GpsTime> times_;
};

}  // namespace coast::estimate
