#include "coast/report/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace coast::report {

namespace {

constexpr double kNoWidth = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Decimator::Decimator(const DecimationOptions& options) : options_(options) {
  if (options.max_points < 16) {
    throw std::invalid_argument(fmt::format("Decimator: max_points = {}, expected >= 16", options.max_points));
  }
}

void Decimator::add(double x, double y) {
  add_sample({x, y, static_cast<double>(samples_), kNoWidth}, Bounds{}, x);
}

void Decimator::add(double x, double y, double lower, double upper) {
  Bounds bounds{lower, upper};
  double half_width = 0.5 * (upper - lower);
  if (!std::isfinite(lower) || !std::isfinite(upper)) {
    ++not_finite_;
    bounds = Bounds{};
    half_width = kNoWidth;
  } else {
    has_band_ = true;
  }
  add_sample({x, y, static_cast<double>(samples_), half_width}, bounds, x);
}

void Decimator::add_track(double t, double x, double y) {
  track_ = true;
  add_sample({x, y, t, kNoWidth}, Bounds{}, t);
}

void Decimator::add_sample(const Sample& sample, const Bounds& bounds, double step_coordinate) {
  if (!std::isfinite(sample.x) || !std::isfinite(sample.y) || !std::isfinite(sample.order)) {
    ++not_finite_;
    interrupt();
    return;
  }
  if (samples_ > 0 && std::abs(step_coordinate - previous_step_coordinate_) > options_.max_gap) interrupt();
  previous_step_coordinate_ = step_coordinate;
  ++samples_;
  if (new_piece_ || last_bucket_count_ >= bucket_size_) {
    open_bucket(sample, bounds);
  } else {
    widen_bucket(sample, bounds);
  }
  pieces_.back().last = sample;
}

void Decimator::open_bucket(const Sample& sample, const Bounds& bounds) {
  if (new_piece_) pieces_.push_back({sample, sample, along_y_.size()});
  new_piece_ = false;
  along_y_.push_back({sample, sample});
  if (track_) along_x_.push_back({sample, sample});
  bounds_.push_back(bounds);
  last_bucket_count_ = 1;
  if (along_y_.size() > bucket_limit()) merge_pairs();
}

// Of equal values the earliest is the least and the latest the greatest, so that a bucket of two always keeps both.
void Decimator::widen_bucket(const Sample& sample, const Bounds& bounds) {
  Extremes& y = along_y_.back();
  if (sample.y < y.least.y) y.least = sample;
  if (sample.y >= y.greatest.y) y.greatest = sample;
  if (track_) {
    Extremes& x = along_x_.back();
    if (sample.x < x.least.x) x.least = sample;
    if (sample.x >= x.greatest.x) x.greatest = sample;
  }
  bounds_.back().lower = std::min(bounds_.back().lower, bounds.lower);
  bounds_.back().upper = std::max(bounds_.back().upper, bounds.upper);
  ++last_bucket_count_;
}

// A bucket of one sample yields one point, a larger one two (a track: four); two more per piece are its ends.
std::size_t Decimator::bucket_limit() const {
  const std::size_t points_per_bucket = bucket_size_ == 1 && !track_ ? 1 : (track_ ? 4 : 2);
  return (options_.max_points - 2) / points_per_bucket + room_for_gaps_;
}

std::size_t Decimator::end_of(std::size_t piece) const {
  return piece + 1 < pieces_.size() ? pieces_[piece + 1].first_bucket : along_y_.size();
}

void Decimator::merge_pairs() {
  const std::size_t before = along_y_.size();
  const bool last_is_odd = (before - pieces_.back().first_bucket) % 2 == 1;
  std::size_t out = 0;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const std::size_t begin = pieces_[p].first_bucket;
    const std::size_t end = end_of(p);
    pieces_[p].first_bucket = out;
    for (std::size_t i = begin; i < end; i += 2, ++out) {
      Extremes y = along_y_[i];
      Bounds bounds = bounds_[i];
      if (i + 1 < end) {
        const Extremes& later = along_y_[i + 1];
        if (later.least.y < y.least.y) y.least = later.least;
        if (later.greatest.y >= y.greatest.y) y.greatest = later.greatest;
        bounds.lower = std::min(bounds.lower, bounds_[i + 1].lower);
        bounds.upper = std::max(bounds.upper, bounds_[i + 1].upper);
      }
      if (track_) {
        Extremes x = along_x_[i];
        if (i + 1 < end) {
          const Extremes& later = along_x_[i + 1];
          if (later.least.x < x.least.x) x.least = later.least;
          if (later.greatest.x >= x.greatest.x) x.greatest = later.greatest;
        }
        along_x_[out] = x;
      }
      along_y_[out] = y;
      bounds_[out] = bounds;
    }
  }
  along_y_.resize(out);
  if (track_) along_x_.resize(out);
  bounds_.resize(out);
  if (!last_is_odd) last_bucket_count_ += bucket_size_;  // its predecessor was full
  bucket_size_ *= 2;
  // Gaps keep their buckets separate; if they dominate, merging gains nothing and the limit has to be raised.
  if (out > before / 4 * 3) room_for_gaps_ += before;
}

void Decimator::append_piece(std::size_t piece, Series& out) const {
  const std::size_t begin = pieces_[piece].first_bucket;
  const std::size_t end = end_of(piece);
  if (piece > 0) out.breaks.push_back(static_cast<std::uint32_t>(out.x.size()));
  const auto append = [&](const Sample& sample) {
    out.x.push_back(sample.x);
    out.y.push_back(sample.y);
    if (track_) out.t.push_back(sample.order);
    if (has_band_) out.half_width.push_back(sample.half_width);
  };
  for (std::size_t i = begin; i < end; ++i) {
    std::vector<Sample> kept{along_y_[i].least, along_y_[i].greatest};
    if (track_) kept.insert(kept.end(), {along_x_[i].least, along_x_[i].greatest});
    if (i == begin) kept.push_back(pieces_[piece].first);
    if (i + 1 == end) kept.push_back(pieces_[piece].last);
    std::stable_sort(kept.begin(), kept.end(), [](const Sample& a, const Sample& b) { return a.order < b.order; });
    const auto same = [](const Sample& a, const Sample& b) { return a.order == b.order && a.x == b.x && a.y == b.y; };
    kept.erase(std::unique(kept.begin(), kept.end(), same), kept.end());
    std::for_each(kept.begin(), kept.end(), append);
  }
}

void Decimator::append_band(std::size_t piece, Series::Band& band) const {
  const std::size_t begin = pieces_[piece].first_bucket;
  const std::size_t end = end_of(piece);
  bool interrupted = true;
  const auto append = [&](double x, const Bounds& bounds) {
    if (interrupted && !band.x.empty()) band.breaks.push_back(static_cast<std::uint32_t>(band.x.size()));
    interrupted = false;
    band.x.push_back(x);
    band.lower.push_back(bounds.lower);
    band.upper.push_back(bounds.upper);
  };
  for (std::size_t i = begin; i < end; ++i) {
    if (bounds_[i].lower > bounds_[i].upper) {  // no bound was given in this bucket
      interrupted = true;
      continue;
    }
    const double middle = 0.5 * (along_y_[i].least.x + along_y_[i].greatest.x);
    if (i == begin) append(pieces_[piece].first.x, bounds_[i]);
    if (i != begin && i + 1 != end) append(middle, bounds_[i]);
    if (i + 1 == end && pieces_[piece].last.order > pieces_[piece].first.order) append(pieces_[piece].last.x, bounds_[i]);
  }
}

Series Decimator::finish() const {
  Series out;
  out.not_finite = not_finite_;
  for (std::size_t p = 0; p < pieces_.size(); ++p) append_piece(p, out);
  if (has_band_) {
    Series::Band& band = out.band.emplace();
    for (std::size_t p = 0; p < pieces_.size(); ++p) append_band(p, band);
  }
  return out;
}

namespace {

void require_equal_lengths(const Series& series) {
  const std::size_t n = series.x.size();
  const bool band_agrees = !series.band || (series.band->lower.size() == series.band->x.size() &&
                                            series.band->upper.size() == series.band->x.size());
  if (series.y.size() != n || (!series.half_width.empty() && series.half_width.size() != n) ||
      (!series.t.empty() && series.t.size() != n) || !band_agrees) {
    throw std::invalid_argument("decimate: the arrays of a series differ in length");
  }
}

}  // namespace

Series decimate(const Series& series, const DecimationOptions& options) {
  require_equal_lengths(series);
  Decimator curve(options);
  auto next_break = series.breaks.begin();
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    for (; next_break != series.breaks.end() && *next_break <= i; ++next_break) curve.interrupt();
    if (!series.half_width.empty()) {
      curve.add(series.x[i], series.y[i], series.y[i] - series.half_width[i], series.y[i] + series.half_width[i]);
    } else if (series.t.empty()) {
      curve.add(series.x[i], series.y[i]);
    } else {
      curve.add_track(series.t[i], series.x[i], series.y[i]);
    }
  }
  Series out = curve.finish();
  out.band.reset();  // its own is added below, on its own x
  out.not_finite += series.not_finite;
  if (series.band) {
    Decimator band(options);
    auto next = series.band->breaks.begin();
    for (std::size_t i = 0; i < series.band->x.size(); ++i) {
      for (; next != series.band->breaks.end() && *next <= i; ++next) band.interrupt();
      band.add(series.band->x[i], series.band->upper[i], series.band->lower[i], series.band->upper[i]);
    }
    Series bounds = band.finish();
    out.not_finite += bounds.not_finite;
    out.band = std::move(bounds.band);
  }
  return out;
}

}  // namespace coast::report
