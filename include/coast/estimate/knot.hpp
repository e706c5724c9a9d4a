#pragma once
// Data stored by the forward pass at every knot (measurement epoch or filler), for smoother, outages and output.

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
  // State after the knot's updates, from which the nominal trajectory continues.
  Navigator::Start post;
  Eigen::MatrixXd P_post;
  std::vector<AppliedUpdate> updates;  ///< in the order applied
  /// Names of the carrier slots; kPosition marks a free one.
  std::vector<carrier::Unknown> slots;
  /// Factors on the slots before the updates: 0 if an unknown began or ended; empty: all 1.
  Eigen::VectorXd slot_factors;
  // Place of the knot in the recording: sample `next_sample` is the first not fully used, `remainder` is its unused part.
  std::size_t next_sample = 0;
  ins::RawIncrement remainder;  ///< dt = 0: the sample is unused
  // Transition to the next knot; empty at the last one.
  double interval = 0.0;
  bool renews_gnss_error = false;
  NavRows Phi_n = NavRows(kNav, 0);
};

/// Selects some of the knots for storage: the first one in each interval of a fixed time grid. The selection is the same in
/// both directions of processing.
class KnotSampling {
 public:
  KnotSampling() = default;  ///< every knot
  explicit KnotSampling(double interval_s) : interval_s_(interval_s) {}
  /// @param previous  the previous knot in time; the first knot is always selected
  [[nodiscard]] bool takes(std::optional<geo::GpsTime> previous, geo::GpsTime t) const {
    return !previous || !(interval_s_ > 0.0) || cell(*previous) != cell(t);
  }

 private:
  [[nodiscard]] double cell(geo::GpsTime t) const { return std::floor(t.sow() / interval_s_); }
  double interval_s_ = 0.0;
};

/// Knots in time order, with random read access. Stored in memory up to a limit, then in an unnamed temporary file, so that ten
/// hours at 10 Hz need no more memory than one.
class KnotStore {
 public:
  explicit KnotStore(std::size_t memory_limit_bytes = std::size_t{64} << 20);
  void append(const Knot& knot);
  /// Removes all knots; the memory is kept for another pass.
  void clear();
  [[nodiscard]] std::size_t size() const { return offsets_.size(); }
  /// Several threads may read at a time.
  [[nodiscard]] Knot at(std::size_t index) const;
  /// Only the start of the nominal trajectory and the interval; covariance, transition and updates are empty.
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
