#include "coast/diagnose/diagnosis.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "search/begin.hpp"
#include "search/exchange.hpp"
#include "search/search.hpp"
#include "verdict/alternatives.hpp"
#include "verdict/diagnosis_of.hpp"
#include "verdict/held_out.hpp"
#include "verdict/outages.hpp"
#include "verdict/reference_offset.hpp"
#include "verdict/twins.hpp"

namespace coast::diagnose {

namespace {

/// An outcome of the search, and what was given up before it.
struct Searched {
  State state;
  std::vector<Rejected> rejected = {};
  std::optional<HeldOut> held_out = {};
};

void give_up(Searched& searched, std::size_t index, Rejected::Reason reason, Context& context) {
  const Hypothesis& h = searched.state.account.findings[index].hypothesis;
  const std::string axis = h.axis_name().empty() ? std::string() : " " + h.axis_name();
  searched.rejected.push_back({fmt::format("{} {}{}", h.effect->name, name(h.effect->site), axis), reason});
  searched.state = given_up(searched.state, index, context);
  searched.held_out.reset();
}

/// @return  whether something was given up
bool heed_outages(Searched& searched, Context& context) {
  bool gave_up = false;
  while (const std::optional<std::size_t> worst = what_spoils_outages(searched.state, context)) {
    give_up(searched, *worst, Rejected::Reason::kOutages, context);
    gave_up = true;
  }
  return gave_up;
}

/// Effects that explain nothing on held-out blocks are given up, the worst first. @return  whether there were any
bool hold_out(Searched& searched, Context& context) {
  bool gave_up = false;
  while (!searched.state.explanation.effects.empty()) {
    const Verification verification = verify(searched.state, context);
    searched.held_out = verification.all;
    const Verification::Effect* worst = verification.worst();
    if (worst == nullptr) {
      for (const Verification::Effect& effect : verification.effects)
        searched.state.account.findings[effect.first].held_out_gain = effect.gain;
      return gave_up;
    }
    give_up(searched, worst->first, Rejected::Reason::kHeldOut, context);
    gave_up = true;
  }
  return gave_up;
}

/// After an effect is given up its part is unexplained, and may be another effect.
void search_to_the_end(Searched& searched, Context& context) {
  constexpr int kMostRounds = 4;
  for (int round = 0; round < kMostRounds; ++round) {
    searched.state = without_insignificant(diagnose::searched(std::move(searched.state), context), context);
    const bool spoilt = heed_outages(searched, context);
    if (!hold_out(searched, context) && !spoilt) break;
  }
  look_at_start(searched.state);
}

/// Keeps the likelier of two explanations of the mission and reports the other as alternative. @return  whether `other` is kept
bool keep_likelier(Searched& best, Searched other, const Context& context) {
  const double log_odds = evidence_of(best.state) - evidence_of(other.state);
  if (log_odds < 0.0) std::swap(best, other);
  tell_of(other.state, std::abs(log_odds), context, best.state);
  return log_odds < 0.0;
}

/// A search with runs of its own, beside others.
struct Aside {
  explicit Aside(const Context& of) : runs(of.runs.beside()), context{of.options, of.asked_for, runs} {}
  Runs runs;
  Context context;
};

using Exchange = std::function<std::optional<State>(const State&, Context&)>;

/// Makes an exchange and continues the search to its end; none if there is nothing to exchange.
std::optional<Searched> after(const Exchange& exchange, const Searched& before, Context& context) {
  try {
    std::optional<State> state = exchange(before.state, context);
    if (!state) return std::nullopt;
    Searched other{*std::move(state), before.rejected};
    search_to_the_end(other, context);
    return other;
  } catch (const NumericalError&) {  // a large effect missing at first may make the filter fail at any step
    return std::nullopt;
  }
}

/// Tries exchanges of one state, several at a time; the first that is likelier is kept. @return  whether there is one
bool keep_first_likelier(const std::vector<Exchange>& exchanges, Searched& best, Context& context) {
  if (exchanges.empty()) return false;
  const Searched before = best;
  constexpr std::size_t kMost = 4;  // each remembers runs of the whole mission
  const std::size_t width = std::min(kMost, tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  for (std::size_t first = 0; first < exchanges.size(); first += width) {
    const std::size_t count = std::min(width, exchanges.size() - first);
    std::deque<Aside> asides;
    for (std::size_t i = 0; i < count; ++i) asides.emplace_back(context);
    std::vector<std::optional<Searched>> outcomes(count);
    coast::parallel_for(std::size_t{0}, count,
                        [&](std::size_t i) { outcomes[i] = after(exchanges[first + i], before, asides[i].context); });
    for (std::size_t i = 0; i < count; ++i) {
      context.runs.count(asides[i].runs.made());
      if (outcomes[i] && keep_likelier(best, *std::move(outcomes[i]), context)) return true;
    }
  }
  return false;
}

/// Replaces effects that begin at some time by those that act from the start on.
void try_all_lasting(Searched& best, Context& context) {
  std::vector<Exchange> exchanges;
  do {
    exchanges.clear();
    for (std::size_t i = 0; i < best.state.explanation.effects.size(); ++i)
      if (may_have_lasted(best.state, i))
        exchanges.emplace_back([i](const State& state, Context& c) { return with_lasting_effect(state, i, c); });
  } while (keep_first_likelier(exchanges, best, context));
}

/// Replaces biases beyond the error model by effects that are constant during this mission.
void try_all_constant(Searched& best, Context& context) {
  std::vector<Exchange> exchanges;
  do {
    exchanges.clear();
    for (std::size_t i = 0; i < best.state.start.beyond.size(); ++i)
      exchanges.emplace_back([i](const State& state, Context& c) { return with_constant_effect(state, i, c); });
  } while (keep_first_likelier(exchanges, best, context));
}

/// The outcome with mean effects first; none if the filter fails on the way.
std::optional<Searched> with_means_first(Searched searched, Context& context) {
  searched.state.limits.order = Order::kMeansFirst;
  try {
    search_to_the_end(searched, context);
  } catch (const NumericalError&) {
    return std::nullopt;
  }
  return searched;
}

/// The likelier of both orders. They are the same up to the first noise that is selected although a mean effect could be; from
/// there on they are searched at the same time, where there are threads for it.
Searched likelier_order(const State& start, Context& context) {
  Searched best{start};
  std::optional<Searched> other;
  std::optional<Aside> aside;
  tbb::task_group_context own(tbb::task_group_context::isolated);  // as those of coast::parallel_for
  tbb::task_group beside(own);
  Context noise_first = context;
  noise_first.orders_part = [&](const State& state) {
    if (aside) return;
    aside.emplace(context);
    beside.run([&, before = Searched{state, best.rejected}] { other = with_means_first(before, aside->context); });
  };
  search_to_the_end(best, noise_first);
  beside.wait();
  if (aside) context.runs.count(aside->runs.made());
  if (other) keep_likelier(best, *std::move(other), context);
  return best;
}

/// The likeliest of both orders and of all exchanges.
Searched likeliest(const State& start, Context& context) {
  if (!context.options.exchanges) {
    Searched only{start};
    search_to_the_end(only, context);
    return only;
  }
  Searched best = likelier_order(start, context);
  try_all_lasting(best, context);
  try_all_constant(best, context);
  return best;
}

/// Stages of runs that are made side by side are told one at a time.
study::Progress one_at_a_time(const study::Progress& progress) {
  if (!progress) return {};
  return [&progress, telling = std::make_shared<std::mutex>()](const char* what, double fraction) {
    const std::lock_guard lock(*telling);
    progress(what, fraction);
  };
}

bool has_found_anything(const State& state, const Context& context) {
  const Account& account = state.account;
  return !account.findings.empty() || !account.random.empty() || !account.converters.empty() || !state.start.beyond.empty() ||
         !stated_noise_findings(state, context).empty();
}

}  // namespace

Diagnosis diagnose(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& to_tell,
                   const std::vector<MissionInput>& simulations) {
  const study::Progress progress = one_at_a_time(to_tell);
  Runs runs(with_open_gate(input), grade_of(input.setup.model), progress);
  Context context{options, input.setup.noise_fit, runs};
  State start = begin(context);
  const Baseline baseline{start.run->mission().fit(), start.run->mission().solution().forward.innovations};
  start = with_draws(with_mended_samples(std::move(start), context), context);
  std::vector<TwinStatistic> before, after;
  if (options.twins > 0 || !simulations.empty())
    before = compared("running twins of the stated model", start, context, simulations);
  const Searched best = likeliest(start, context);
  if (options.twins > 0 && has_found_anything(best.state, context))
    after = compared("running twins of the diagnosed model", best.state, context, {});
  Diagnosis result = diagnosis_of(best.state, context, baseline);
  result.runs = runs.made();
  result.twins = std::move(before);
  result.twins_after = std::move(after);
  result.held_out = best.held_out;
  result.rejected = best.rejected;
  if (!options.reference) return result;
  const std::optional<ReferenceOffset> offset = offset_from(*options.reference, best.state.run->mission().path());
  if (offset) tell_offset(*offset, result);
  result.reference_used = offset.has_value();
  return result;
}

}  // namespace coast::diagnose
