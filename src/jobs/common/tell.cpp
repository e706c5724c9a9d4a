#include "common/tell.hpp"

namespace coast::jobs {

void tell_warnings(const record::Events& events, const Progress& progress) {
  if (!progress.warn) return;
  for (const record::Event& event : events)
    if (event.severity == record::Event::Severity::kWarning) progress.warn(event.text);
}

}  // namespace coast::jobs
