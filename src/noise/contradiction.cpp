#include "contradiction.hpp"

#include <algorithm>

#include "candidate.hpp"
#include "full_fit.hpp"
#include "model_search.hpp"
#include "spectrum.hpp"

namespace coast::noise {

namespace {

class Contradiction {
 public:
  Contradiction(const std::vector<StaticSignal>& records, const AllanCurve& curve, const CalibrationOptions& options,
                std::vector<Candidate>& candidates, WorkProgress& work)
      : records_(records), curve_(curve), options_(options), candidates_(candidates), work_(work) {}

  CurveBand run(std::size_t& chosen) {
    work_.begin(0.6);
    CurveBand band = band_around(candidates_[chosen]);
    if (band.tau.empty() || band.inside || !options_.processes.empty() || options_.criterion != Criterion::kBic) return band;
    work_.begin(0.4);
    fit_neighbours(chosen);
    constexpr std::size_t kMost = 4;  // bands, each as costly as a realisation of the record times their number
    const std::vector<std::size_t> others = more_likely_than(chosen);
    for (std::size_t i = 0; i < std::min(kMost, others.size()); ++i) {
      work_.begin(0.3);
      CurveBand other = band_around(candidates_[others[i]]);
      if (!other.inside) continue;
      chosen = others[i];
      return other;
    }
    return band;
  }

 private:
  [[nodiscard]] CurveBand band_around(const Candidate& candidate) const {
    double slope = 0.0;
    if (candidate.model.mean() == Mean::kLevelAndDrift)
      slope = Likelihood(records_, candidate.model).value(candidate.fit.u).means.front().value(1);
    return band_of(curve_, candidate.model, candidate.fit.u, records_.front(), slope, options_);
  }

  /// The next larger sums that the search fitted only to extracts or to the spectrum.
  void fit_neighbours(std::size_t chosen) {
    const Candidate from = candidates_[chosen];
    const Likelihood likelihood(records_, from.model);
    const Spectrum spectrum = spectrum_of(likelihood.records());
    const std::vector<SumModel> sums = larger(from.model, options_);
    for (const SumModel& sum : sums) {
      work_("comparing sums on all samples", static_cast<double>(&sum - sums.data()) / static_cast<double>(sums.size()));
      const auto is_it = [&](const Candidate& c) { return c.on_all_samples && c.model.name() == sum.name(); };
      if (std::ranges::any_of(candidates_, is_it)) continue;
      const auto extract = std::ranges::find_if(candidates_, [&](const Candidate& c) { return c.model.name() == sum.name(); });
      const std::vector<double> start = extract != candidates_.end()
                                            ? extract->fit.u
                                            : shared_start(from.model, from.fit.u, sum, sum.ranges(likelihood.scale()), 7.0);
      candidates_.push_back(fit_on_all_samples(records_, spectrum, sum, start, options_));
    }
  }

  /// By twice the log-likelihood minus the lower cost of parameters, the best first.
  [[nodiscard]] std::vector<std::size_t> more_likely_than(std::size_t chosen) const {
    const double samples = Likelihood(records_, candidates_[chosen].model).samples();
    const auto cost = [&](const Candidate& c) {
      return c.bic - penalty(c.model, c.independent, samples) +
             penalty(c.model, c.independent, samples, LeastGain::kContradicted);
    };
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const Candidate& c = candidates_[i];
      if (i != chosen && c.on_all_samples && !c.degenerate && cost(c) < cost(candidates_[chosen])) others.push_back(i);
    }
    std::ranges::sort(others, {}, [&](std::size_t i) { return cost(candidates_[i]); });
    return others;
  }

  const std::vector<StaticSignal>& records_;
  const AllanCurve& curve_;
  const CalibrationOptions& options_;
  std::vector<Candidate>& candidates_;
  WorkProgress& work_;
};

}  // namespace

CurveBand settle_contradiction(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                               const CalibrationOptions& options, std::vector<Candidate>& candidates, std::size_t& chosen,
                               WorkProgress& work) {
  return Contradiction(records, curve, options, candidates, work).run(chosen);
}

}  // namespace coast::noise
