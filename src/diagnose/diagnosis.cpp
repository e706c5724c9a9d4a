#include "coast/diagnose/diagnosis.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "coast/diagnose/twin.hpp"
#include "coast/simulate/random.hpp"
#include "search.hpp"
#include "statistics.hpp"
#include "verification.hpp"

namespace coast::diagnose {

namespace {

void search_to_the_end(Search& search) {
  constexpr int kMostSteps = 20;
  for (int i = 0; i < kMostSteps && search.step();) ++i;
}

/// What was taken for a share of another effect, and is nothing now that this one is known better.
void forget_what_vanished(Search& search) {
  constexpr double kNothing = 2.0;  // sd
  for (std::size_t i = search.taken().size(); i-- > 0;)
    if (std::abs(search.taken()[i].value) < kNothing * search.sd(i) && !search.is_part_of_a_line(i)) search.give_up(i);
}

/// What explains nothing on held-out blocks is given up, the worst first.
void hold_out(Search& search, Diagnosis& notes) {
  while (!search.taken().empty()) {
    const Verification verification = verify(search);
    notes.held_out = verification.all;
    const std::vector<Verification::Effect>& effects = verification.effects;
    if (std::ranges::all_of(effects, &Verification::Effect::holds)) {
      for (std::size_t i = 0; i < effects.size(); ++i) search.set_held_out(i, effects[i].gain);
      return;
    }
    const auto worst = std::ranges::min_element(
        effects, [](const auto& a, const auto& b) { return std::pair(a.holds(), a.gain) < std::pair(b.holds(), b.gain); });
    const auto index = static_cast<std::size_t>(worst - effects.begin());
    const Hypothesis& h = search.run().hypotheses()[search.taken()[index].hypothesis];
    notes.rejected.push_back(std::string(h.effect->name) + (h.axis_name().empty() ? "" : " " + h.axis_name()));
    search.give_up(index);
    notes.held_out.reset();
  }
}

/// The figures of many recordings, on all threads.
std::vector<std::vector<Statistic>> figures_of(std::size_t count, const std::function<MissionInput(std::size_t)>& recording,
                                               std::uint64_t seed, const study::Progress& progress) {
  std::vector<std::vector<Statistic>> figures(count);
  std::mutex telling;  // one at a time
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    figures[i] = statistics_of(recording(i), seed);
    const std::lock_guard lock(telling);
    ++done;
    if (progress) progress("running twins", static_cast<double>(done) / static_cast<double>(count));
  });
  return figures;
}

}  // namespace

Diagnosis diagnose(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& progress,
                   const std::vector<MissionInput>& simulations) {
  Search search(input, options, progress);
  const auto twins = static_cast<std::size_t>(std::max(0, options.twins));
  Diagnosis notes;
  const auto compared = [&](const std::vector<MissionInput>& given) {
    const MissionInput& model = search.modelled();
    const std::vector<record::NavState>& path = search.run().path();
    const auto recording = [&](std::size_t i) {
      if (!given.empty()) return given[i];
      MissionInput one = twin(path, model, simulate::stream_seed(options.seed, {3, i}));
      one.setup.start = input.setup.start;  // found as that of the recording was
      one.setup.start_sensor_errors = input.setup.start_sensor_errors;
      return one;
    };
    return against(statistics_of(search.run(), search.examined()),
                   figures_of(given.empty() ? twins : given.size(), recording, options.seed, progress));
  };
  if (twins > 0 || !simulations.empty()) notes.twins = compared(simulations);
  search_to_the_end(search);
  forget_what_vanished(search);
  hold_out(search, notes);
  if (twins > 0 && search.has_found_anything()) notes.twins_after = compared({});
  Diagnosis result = search.finish();
  result.twins = std::move(notes.twins);
  result.twins_after = std::move(notes.twins_after);
  result.held_out = notes.held_out;
  result.rejected = std::move(notes.rejected);
  return result;
}

}  // namespace coast::diagnose
