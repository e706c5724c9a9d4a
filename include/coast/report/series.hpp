#pragma once
// Curves as stored in a page, and the decimation of a stream of any length to such a curve.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace coast::report {

/// One curve. x and y have the same length; x is sorted for a time series, not for a track.
struct Series {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> t;              ///< for a track: seconds since Page::start; links the plan to the time axes. Else empty
  std::vector<std::uint32_t> breaks;  ///< the curve is interrupted before each of these indices; increasing
  /// Half width of the band of each sample, NaN if it had none; empty without a band. In a decimated curve the band is an
  /// envelope of many samples; the cursor shows this value.
  std::vector<double> half_width;
  std::uint64_t not_finite = 0;  ///< values left out because they are not finite; reported under the panel

  /// Lower and upper bound, shaded. Has its own x, because its extremes need not coincide with those of the curve.
  struct Band {
    std::vector<double> x;
    std::vector<double> lower;
    std::vector<double> upper;
    std::vector<std::uint32_t> breaks;
  };
  std::optional<Band> band;
};

struct DecimationOptions {
  std::size_t max_points = 16000;  ///< of the result, >= 16; exceeded only if the number of gaps alone is near that
  double max_gap = std::numeric_limits<double>::infinity();  ///< a longer step in t (tracks) or x interrupts the curve
};

/// Decimates a stream of samples in bounded memory (about 1 MB at 16000 points) so that no peak is hidden.
///
/// Consecutive samples are collected in buckets of 2^k; a bucket keeps the samples with its smallest and largest y (for a
/// track, also x) at their true x, and whenever the buckets exceed the limit, pairs are merged, which is exact. So the extremes
/// of every bucket, hence of the whole, and both ends of every uninterrupted piece are kept; nothing is lost up to max_points -
/// 2 samples (a track: half of that). With n samples a bucket holds at most about 4 n / max_points (a track: twice that). A
/// band keeps the smallest lower and the largest upper bound of each bucket, between its extremes (at an end: there); each kept
/// sample also keeps its own half width. A sample that is not finite is counted and interrupts the curve.
class Decimator {
 public:
  /// @throws std::invalid_argument max_points < 16
  explicit Decimator(const DecimationOptions& options = {});

  void add(double x, double y);
  void add(double x, double y, double lower, double upper);
  /// A point of a plane curve at time t, s since Page::start. One Decimator accepts only one of the three kinds.
  void add_track(double t, double x, double y);
  /// The curve is interrupted before the next sample.
  void interrupt() { new_piece_ = true; }

  [[nodiscard]] Series finish() const;

 private:
  struct Sample {
    double x;
    double y;
    double order;                                                  ///< time of a track, else the number of the sample
    double half_width = std::numeric_limits<double>::quiet_NaN();  ///< of the band, at this sample
  };
  struct Extremes {
    Sample least;
    Sample greatest;
  };
  struct Bounds {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
  };
  struct Piece {
    Sample first;
    Sample last;
    std::size_t first_bucket;
  };

  void add_sample(const Sample& sample, const Bounds& bounds, double step_coordinate);
  void open_bucket(const Sample& sample, const Bounds& bounds);
  void widen_bucket(const Sample& sample, const Bounds& bounds);
  void merge_pairs();
  [[nodiscard]] std::size_t bucket_limit() const;
  [[nodiscard]] std::size_t end_of(std::size_t piece) const;
  void append_piece(std::size_t piece, Series& out) const;
  void append_band(std::size_t piece, Series::Band& band) const;

  DecimationOptions options_;
  std::vector<Extremes> along_y_;  ///< one per bucket, like the next two
  std::vector<Extremes> along_x_;  ///< tracks only
  std::vector<Bounds> bounds_;
  std::vector<Piece> pieces_;
  std::uint64_t bucket_size_ = 1;
  std::uint64_t last_bucket_count_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t not_finite_ = 0;
  std::size_t room_for_gaps_ = 0;
  double previous_step_coordinate_ = 0.0;
  bool new_piece_ = true;
  bool track_ = false;
  bool has_band_ = false;
};

/// The same for existing arrays; the band is decimated on its own x.  @throws std::invalid_argument lengths differ
[[nodiscard]] Series decimate(const Series& series, const DecimationOptions& options = {});

}  // namespace coast::report
