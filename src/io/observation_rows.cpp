#include "observation_rows.hpp"

#include <algorithm>

namespace coast::io {

bool ObservationRows::begin(geo::GpsTime t) {
  const auto& epochs = recording_.epochs;
  if (!epochs.empty() && t == epochs.back().t) return repeated_.add(t), false;
  if (!epochs.empty() && t < epochs.back().t) return reversed_.add(t), false;
  t_ = t;
  row_.clear();
  return true;
}

bool ObservationRows::is_new(record::Satellite satellite, record::Signal signal) {
  const auto same = [&](const record::Observation& o) { return o.satellite == satellite && o.signal == signal; };
  if (std::ranges::none_of(row_, same)) return true;
  doubled_.add(t_);
  return false;
}

void ObservationRows::add(const record::Observation& observation) {
  if (observation.code_m || observation.phase_cycles) row_.push_back(observation);
}

void ObservationRows::end() {
  if (row_.empty()) return empty_.add(t_);
  std::ranges::stable_sort(row_, {}, [](const record::Observation& o) { return std::pair(o.satellite, o.signal); });
  recording_.epochs.push_back({t_, row_});
}

void ObservationRows::report(std::string_view prefix) {
  using Grade = record::Event::Severity;
  const auto add = [&](const Counted& counted, std::string_view kind, const char* one, const char* many, const char* what,
                       Grade severity) {
    const std::string name = std::string(prefix) + std::string(kind);
    add_counted(recording_.events, recording_.source, counted, {name.c_str(), one, many, what, severity});
  };
  add(empty_, "_empty", "epoch", "epochs", "without a signal left out", Grade::kInfo);
  add(doubled_, "_repeated_signal", "measurement", "measurements", "of a signal that the epoch has already left out",
      Grade::kWarning);
  add(repeated_, "_repeated_epoch", "epoch", "epochs", "with the time of the one before left out", Grade::kWarning);
  add(reversed_, "_reversed_epoch", "epoch", "epochs", "earlier than the one before left out", Grade::kWarning);
}

}  // namespace coast::io
