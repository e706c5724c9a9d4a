#include "coast/diagnose/diagnosis.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "coast/diagnose/twin.hpp"
#include "coast/simulate/random.hpp"
#include "reference_offset.hpp"
#include "search.hpp"
#include "statistics.hpp"
#include "verification.hpp"

namespace coast::diagnose {

namespace {

/// A search, and what was given up on the way.
struct Searched {
  std::unique_ptr<Search> search;
  std::vector<Rejected> rejected = {};
  std::optional<HeldOut> held_out = {};
};

void step_to_the_end(Search& search) {
  constexpr int kMostSteps = 30;
  constexpr int kMostReviews = 2;
  for (int review = 0; review <= kMostReviews; ++review) {
    for (int i = 0; i < kMostSteps && search.step();) ++i;
    if (review == kMostReviews || !search.review()) return;
  }
}

void give_up(Searched& searched, std::size_t index, Rejected::Reason reason) {
  Search& search = *searched.search;
  const Hypothesis& h = search.run().hypotheses()[search.taken()[index].hypothesis];
  const std::string axis = h.axis_name().empty() ? std::string() : " " + h.axis_name();
  searched.rejected.push_back({fmt::format("{} {}{}", h.effect->name, name(h.effect->site), axis), reason});
  search.give_up(index);
  searched.held_out.reset();
}

/// @return  whether something was given up
bool heed_outages(Searched& searched) {
  bool gave_up = false;
  while (const std::optional<std::size_t> worst = what_spoils_outages(*searched.search)) {
    give_up(searched, *worst, Rejected::Reason::kOutages);
    gave_up = true;
  }
  return gave_up;
}

/// What explains nothing on held-out blocks is given up, the worst first. @return  whether something was
bool hold_out(Searched& searched) {
  Search& search = *searched.search;
  bool gave_up = false;
  while (!search.taken().empty()) {
    const Verification verification = verify(search);
    searched.held_out = verification.all;
    const std::vector<Verification::Effect>& effects = verification.effects;
    if (std::ranges::all_of(effects, &Verification::Effect::holds)) {
      for (std::size_t i = 0; i < effects.size(); ++i) search.set_held_out(i, effects[i].gain);
      return gave_up;
    }
    const auto worst = std::ranges::min_element(
        effects, [](const auto& a, const auto& b) { return std::pair(a.holds(), a.gain) < std::pair(b.holds(), b.gain); });
    give_up(searched, static_cast<std::size_t>(worst - effects.begin()), Rejected::Reason::kHeldOut);
    gave_up = true;
  }
  return gave_up;
}

/// What is given up leaves something unexplained, which may be something else.
void search_to_the_end(Searched& searched) {
  constexpr int kMostRounds = 4;
  for (int round = 0; round < kMostRounds; ++round) {
    step_to_the_end(*searched.search);
    searched.search->forget_what_vanished();
    const bool spoilt = heed_outages(searched);
    if (!hold_out(searched) && !spoilt) break;
  }
  searched.search->look_at_start();
}

/// Two explanations of the mission: the likelier one stays, and is told of the other. @return  whether it is the other
bool keep_likelier(Searched& best, Searched other) {
  const double log_odds = best.search->evidence() - other.search->evidence();
  if (log_odds < 0.0) std::swap(best, other);
  best.search->tell_of(*other.search, std::abs(log_odds));
  return log_odds < 0.0;
}

using Exchange = std::function<bool(Search&)>;

/// One thing in place of another, and on to the end. @return  whether it came to an end
bool try_exchange(Searched& other, const Exchange& exchange) {
  try {
    if (!exchange(*other.search)) return false;
    search_to_the_end(other);
    return true;
  } catch (const NumericalError&) {  // a large one that was not there at first may break the filter at any step
    return false;
  }
}

/// Puts one thing in place of another; the likelier of the two searches stays. @return  whether it is the new one
/// @param in_vain  takes runs that led to nothing
bool goes_on_with(const Exchange& exchange, Searched& best, std::size_t& in_vain) {
  Searched other{std::make_unique<Search>(*best.search), best.rejected};
  const bool is_possible = try_exchange(other, exchange);
  const std::size_t runs = other.search->runs() - best.search->runs();
  const bool is_likelier = is_possible && keep_likelier(best, std::move(other));
  if (!is_likelier) in_vain += runs;
  return is_likelier;
}

/// Effects that begin at some time, as such that are there from the start on. @return  runs that led to nothing
std::size_t try_all_lasting(Searched& best) {
  std::size_t in_vain = 0;
  for (std::size_t i = 0; i < best.search->taken().size();) {
    const Exchange exchange = [i](Search& search) { return search.put_lasting_in_place_of(i); };
    i = best.search->may_have_lasted(i) && goes_on_with(exchange, best, in_vain) ? 0 : i + 1;
  }
  return in_vain;
}

/// Biases that the error model does not have, as effects that are a constant during this mission. @return  as above
std::size_t try_all_constant(Searched& best) {
  std::size_t in_vain = 0;
  for (std::size_t i = 0; i < best.search->turned_on();)
    i = goes_on_with([i](Search& search) { return search.put_constant_in_place_of_bias(i); }, best, in_vain) ? 0 : i + 1;
  return in_vain;
}

/// The figures of many recordings, on all threads; those by which the filter breaks down are left out.
std::vector<std::vector<Statistic>> figures_of(std::size_t count, const std::function<MissionInput(std::size_t)>& recording,
                                               std::uint64_t seed, const std::function<void(double)>& progress) {
  std::vector<std::vector<Statistic>> figures(count);
  std::mutex telling;  // one at a time
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      figures[i] = statistics_of(recording(i), seed);
    } catch (const NumericalError&) {
      figures[i].clear();
    }
    const std::lock_guard lock(telling);
    ++done;
    progress(static_cast<double>(done) / static_cast<double>(count));
  });
  std::erase_if(figures, [](const std::vector<Statistic>& one) { return one.empty(); });
  return figures;
}

}  // namespace

Diagnosis diagnose(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& progress,
                   const std::vector<MissionInput>& simulations) {
  const auto begin = [&](Order order) { return Searched{std::make_unique<Search>(input, options, order, progress)}; };
  const auto twins = static_cast<std::size_t>(std::max(0, options.twins));
  const auto compared = [&](const char* stage, const Search& search, const std::vector<MissionInput>& given) {
    const MissionInput modelled = search.modelled();
    const auto recording = [&](std::size_t i) {
      if (!given.empty()) return given[i];
      MissionInput one = twin(search.run().path(), modelled, simulate::stream_seed(options.seed, {3, i}));
      one.setup.start = input.setup.start;  // found as that of the recording was
      one.setup.start_sensor_errors = input.setup.start_sensor_errors;
      return one;
    };
    const auto tell = [&](double done) {
      if (progress) progress(stage, done);
    };
    tell(0.0);
    return against(statistics_of(search.run(), search.examined()),
                   figures_of(given.empty() ? twins : given.size(), recording, options.seed, tell));
  };
  Searched best = begin(Order::kNoiseFirst);
  std::vector<TwinStatistic> before, after;
  if (twins > 0 || !simulations.empty()) before = compared("running twins of the stated model", *best.search, simulations);
  search_to_the_end(best);
  std::size_t further_runs = 0;
  if (best.search->has_taken_noise()) {
    Searched other = begin(Order::kMeansFirst);
    search_to_the_end(other);
    further_runs = best.search->runs() + other.search->runs();
    keep_likelier(best, std::move(other));
    further_runs -= best.search->runs();
  }
  further_runs += try_all_lasting(best);
  further_runs += try_all_constant(best);
  if (twins > 0 && best.search->has_found_anything())
    after = compared("running twins of the diagnosed model", *best.search, {});
  std::optional<ReferenceOffset> offset;
  if (options.reference) offset = offset_from(*options.reference, best.search->run().path());
  Diagnosis result = best.search->finish();
  result.runs += further_runs;
  result.twins = std::move(before);
  result.twins_after = std::move(after);
  result.held_out = best.held_out;
  result.rejected = std::move(best.rejected);
  if (offset) tell_offset(*offset, result);
  result.reference_used = offset.has_value();
  return result;
}

}  // namespace coast::diagnose
