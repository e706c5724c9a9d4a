#include "repairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace coast::io {

namespace {
constexpr long kAlwaysAllowed = 10;
constexpr double kRepeatedShare = 0.5;  // a log with every row twice is readable
constexpr double kDisorderShare = 0.01;
constexpr double kLongestStep = 86400.0;  // s; no mission pauses for a day
}  // namespace

void Repairs::add(const char* kind, const char* what, double most_share, const InputError& as_error,
                  std::optional<geo::GpsTime> time) {
  const auto it =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return std::strcmp(e.kind, kind) == 0; });
  if (it != entries_.end())
    ++it->count;
  else
    entries_.push_back({kind, what, most_share, as_error, time, 1});
}

void Repairs::finish(long rows, record::Events& events) const {
  for (const Entry& e : entries_) {
    if (e.count > kAlwaysAllowed && static_cast<double>(e.count) > e.most_share * static_cast<double>(rows)) {
      InputError::Parts parts = e.first.parts();
      parts.found += fmt::format(" (and so in {} of {} rows)", e.count, rows);
      throw InputError(parts);
    }
    const InputError::Parts& p = e.first.parts();
    events.push_back({record::Event::Severity::kWarning, e.kind,
                      fmt::format("{}: {} {} {}; first{}: {}", p.file, e.count, e.count == 1 ? "row" : "rows", e.what,
                                  p.line > 0 ? fmt::format(" at line {}", p.line) : "", p.found),
                      e.time, e.count});
  }
}

bool TimeOrder::accept(geo::GpsTime t, bool same_values) {
  if (!last_) {
    last_ = t;
    return true;
  }
  const double step = t - *last_;
  if (step > kLongestStep)
    throw error_(fmt::format("time jumps ahead by {:.3f} s ({:.1f} days)", step, step / 86400.0), "one recording",
                 "A damaged time tag, or two recordings in one file? Split it here.");
  if (step > 0.0) {
    step_ = step;
    last_ = t;
    return true;
  }
  const auto times = fmt::format("({:.3f} after {:.3f})", t.sow(), last_->sow());
  if (step == 0.0) {
    const InputError as_error =
        error_(fmt::format("time repeats {}", times), "increasing", "Do the time tags have enough digits for this rate?");
    if (same_values)
      repairs_.add("repeated_row", "repeating the row before left out", kRepeatedShare, as_error, t);
    else
      repairs_.add("repeated_time", "repeating a time with other values left out", kDisorderShare, as_error, t);
    return false;
  }
  const InputError as_error = error_(fmt::format("time goes back by {:.3f} s {}", -step, times), "increasing",
                                     "Two recordings in one file? Split it here.");
  if (-step > step_) throw as_error;
  repairs_.add("time_back", "going back by less than a sample left out", kDisorderShare, as_error, t);
  return false;
}

}  // namespace coast::io
