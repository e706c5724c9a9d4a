#pragma once
// Allan, Hadamard and Haar wavelet variance of a sensor at rest: estimated from a stream of samples, with confidence intervals;
// computed for a model; and the classical coefficients read from a curve.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "coast/noise/interval.hpp"
#include "coast/noise/process.hpp"

namespace coast::noise {

/// Noise type by the power of frequency in its spectrum. The dominant type at an averaging time determines the degrees of
/// freedom.
enum class NoiseType {
  kQuantisation,  ///< f^2: white noise of the integral, sigma ~ 1/tau
  kWhite,         ///< f^0: sigma ~ tau^-1/2
  kFlicker,       ///< f^-1: bias instability, sigma constant
  kRandomWalk,    ///< f^-2: rate random walk, sigma ~ tau^1/2
  kRamp,          ///< steeper, or a deterministic ramp: sigma ~ tau
};

/// An estimated deviation.
struct Deviation {
  double value = 0.0;       ///< [signal]
  std::uint64_t terms = 0;  ///< number of squared differences that are averaged
  double edf = 0.0;         ///< equivalent degrees of freedom of these terms under the point's noise type
  double edf_lost = 0.0;    ///< share of the degrees of freedom of full overlap that is lost by the stride; 0 with full overlap
  Interval interval_68{};   ///< of the deviation, by chi-square: coverage 0.6827
  Interval interval_95{};
};

/// Estimates from a record at one averaging time.
struct AllanPoint {
  double tau = 0.0;           ///< averaging time, s
  std::uint64_t factor = 0;   ///< the same in samples
  std::uint64_t overlap = 0;  ///< terms start every factor/overlap samples; overlap = factor is full overlap
  NoiseType noise = NoiseType::kWhite;
  bool identified = false;  ///< false: too few averages to identify it, the type is that of the nearest shorter tau
  Deviation allan;
  Deviation hadamard;
  /// Variance of the Haar wavelet coefficients at this scale (maximal overlap, Percival & Walden 2000, sec. 8.6), [signal]^2.
  [[nodiscard]] double haar_variance() const { return 0.5 * allan.value * allan.value; }
};
using AllanCurve = std::vector<AllanPoint>;

struct AllanOptions {
  int points_per_decade = 12;                        ///< averaging times, before those with the same factor are merged
  std::uint64_t full_overlap_samples = 1ULL << 20U;  ///< up to this record length full overlap is used at every tau
};

/// Collects samples of one axis at equal intervals and yields the curve. Memory: 8 bytes per sample up to
/// `full_overlap_samples`; for longer records the samples are dropped and 2 MB suffice for any length.
///
/// With y the average over m samples (tau = m dt) the estimators are the means over all starts of
///
///     Allan:     (y[2] - y[1])^2 / 2        Hadamard:     (y[3] - 2 y[2] + y[1])^2 / 6
///
/// in full overlap (a start at every sample) for records up to `full_overlap_samples`. Longer ones have full overlap for
/// m < 128 and 64 to 127 starts per m beyond, computed from block sums. Averaging times are the same in both cases: m is
/// rounded to 7 significant bits.
///
/// Intervals: value sqrt(edf / chi2 quantile). edf is computed for the terms used, from the autocorrelation of the differences
/// of power-law noise (Greenhall & Riley 2003), so it is valid for full and partial overlap. The noise type of a point is that
/// of the slope among -1, -1/2, 0, 1/2, 1 nearest to the slope of the curve within an octave on both sides; the lag-1
/// autocorrelation (Riley & Greenhall 2004) gives the same types, but with 100 averages it separates quantisation and white
/// noise by only one standard deviation. If fewer than 16 averages fit into the record, the type of the nearest shorter tau is
/// used. Terms do not cross gaps.
class AllanAccumulator {
 public:
  /// @param interval  s between samples, > 0
  /// @throws std::invalid_argument  an argument is outside its range
  explicit AllanAccumulator(double interval, const AllanOptions& options = {});
  ~AllanAccumulator();
  AllanAccumulator(AllanAccumulator&&) noexcept;
  AllanAccumulator& operator=(AllanAccumulator&&) noexcept;

  /// The next sample: mean rate or specific force over the interval, [signal].
  void add(double rate) {
    pending_[pending_count_++] = rate;
    if (pending_count_ == pending_.size()) flush();
  }
  void add(std::span<const double> rates) {
    for (const double rate : rates) add(rate);
  }
  /// The next sample, given as the integral over the interval, [signal] s.
  void add_increment(double increment) { add(increment / interval_); }
  /// Any number of samples is missing here: nothing is interpolated, and no difference spans the gap.
  void gap();
  /// The curve, up to the longest tau at which both variances have a term. The accumulator is empty afterwards.
  /// @throws std::invalid_argument  a sample was not finite (thrown here, in add or in gap: samples are checked in blocks)
  [[nodiscard]] AllanCurve finish();

  [[nodiscard]] std::uint64_t samples() const { return samples_ + pending_count_; }

 private:
  struct Sums;
  void flush();

  double interval_;
  std::array<double, 2048> pending_{};
  std::size_t pending_count_ = 0;
  std::uint64_t samples_ = 0;
  std::unique_ptr<Sums> sums_;
};

/// Equivalent degrees of freedom of a mean of squared differences of power-law noise.
struct DifferencePlan {
  int order = 2;             ///< differences of the integrated signal: 2 Allan, 3 Hadamard
  std::uint64_t factor = 1;  ///< samples per average
  std::uint64_t stride = 1;  ///< samples from one term to the next; divides `factor`
  std::uint64_t terms = 1;
  std::uint64_t runs = 1;  ///< number of gap-free stretches that the terms come from, assumed equally long
};
[[nodiscard]] double degrees_of_freedom(NoiseType noise, const DifferencePlan& plan);
/// Interval of a deviation by sqrt(edf/quantile).  @param coverage in (0, 1)
[[nodiscard]] Interval chi_square_interval(double deviation, double edf, double coverage);

/// Sum over independent processes; processes without this variance add nothing.
[[nodiscard]] double allan_variance(std::span<const ProcessPtr> processes, double tau);
[[nodiscard]] double hadamard_variance(std::span<const ProcessPtr> processes, double tau);

/// A classical coefficient and where on the curve it was read.
struct CoefficientReading {
  double value = 0.0;
  Interval interval_68{};
  Interval interval_95{};
  double tau_from = 0.0;  ///< s, the part of the curve that has the slope; one point for the bias instability
  double tau_to = 0.0;
  double slope = 0.0;  ///< d log sigma / d log tau there
};

/// The coefficients of IEEE Std 952-1997 annex C, as usually read from the slopes; absent if the curve has no part with that
/// slope.
struct AllanReading {
  std::optional<CoefficientReading> white_noise;       ///< N: slope -1/2, sigma = N/sqrt(tau), read at 1 s; [signal]/sqrt(Hz)
  std::optional<CoefficientReading> bias_instability;  ///< B: lowest point, sigma = 0.664 B; [signal]
  std::optional<CoefficientReading> rate_random_walk;  ///< K: slope 1/2, sigma = K sqrt(tau/3), read at 3 s; [signal]/sqrt(s)
  std::optional<CoefficientReading> rate_ramp;         ///< R: slope 1, sigma = R tau/sqrt(2), read at sqrt(2) s; [signal]/s
  std::optional<CoefficientReading> quantisation;      ///< Q: slope -1, sigma = sqrt(3) Q/tau, read at sqrt(3) s; [signal] s
};
/// A part of the curve qualifies if it is at least an octave long, has at least 16 averages, and the slope within an octave on
/// both sides of each of its points is within 0.1 of the nominal one; the longest is used. The value is the mean over it,
/// weighted by degrees of freedom; its interval is that of its best point, which is conservative. The bias instability is read
/// at the minimum of the curve, unless that is at an end or the slope there is below -1/4.
/// @note All of sigma is attributed to one process; other processes bias the value. Between white noise and a random walk the
///       minimum is no evidence of bias instability.
[[nodiscard]] AllanReading read_coefficients(const AllanCurve& curve);

}  // namespace coast::noise
