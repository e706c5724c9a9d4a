// An outage study with one recording or with simulated ones.

#include <fmt/format.h>

#include <algorithm>

#include "coast/io/input.hpp"
#include "coast/jobs/outage.hpp"
#include "coast/jobs/run_file.hpp"
#include "coast/record/error.hpp"
#include "outage/digest.hpp"
#include "outage/study_journal.hpp"
#include "run_file/recordings.hpp"

namespace coast::jobs {

namespace {

void add_fixes(const std::vector<record::GnssFix>& fixes, Digest& digest) {
  for (const record::GnssFix& fix : fixes) {
    for (const double value : {fix.t.sow(), fix.r_ea_e.x(), fix.r_ea_e.y(), fix.r_ea_e.z(), fix.position_cov_n.trace()})
      digest.add(value);
    if (fix.velocity) digest.add(fix.velocity->v_ea_n.sum() + fix.velocity->cov_n.trace());
  }
}

std::uint64_t digest_of(const SweepStudy& config, const Recordings& recordings) {
  Digest digest;
  digest.add(config.run.root.resolved_yaml());
  digest.add(config.sweep.every_s);
  digest.add(config.sweep.first_s);
  digest.add(static_cast<double>(config.sweep.satellites_left));
  for (const double duration : config.sweep.durations_s) digest.add(duration);
  for (const SweepStudy::Model& model : config.models) {
    digest.add(model.named.model.yaml());
    digest.add(model.noise_estimated ? 1.0 + static_cast<double>(*model.noise_estimated) : 0.0);
  }
  for (const record::ImuSample& s : recordings.imu.samples)
    for (const double value : {s.t.sow(), s.dtheta.x(), s.dtheta.y(), s.dtheta.z(), s.dv.x(), s.dv.y(), s.dv.z()})
      digest.add(value);
  for (const record::NoiseLevel& level : recordings.imu.noise)
    digest.add(level.from.sow() + level.gyro.sum() + level.accel.sum());
  for (const record::MemberBlocks::Block& block : recordings.imu.members.blocks)
    for (const auto& means : block.means) digest.add(means ? means->gyro.sum() + means->accel.sum() : 0.0);
  add_fixes(recordings.gnss.fixes, digest);
  if (recordings.reference)
    for (const record::NavState& nav : recordings.reference->states) digest.add(nav.r_eb_e.sum());
  return digest.value();
}

std::uint64_t digest_of(const EnsembleStudy& config) {
  Digest digest;
  digest.add(io::read_all(config.scenario));
  if (config.plan.scenario.error_model) digest.add(config.plan.scenario.error_model->yaml());
  digest.add(static_cast<double>(config.plan.first_seed));
  digest.add(static_cast<double>(config.plan.seeds));
  for (const study::OutageGroup& group : config.plan.groups) {
    digest.add(group.duration_s);
    for (const double start : group.starts_s) digest.add(start);
  }
  for (const study::EnsembleCase& which : config.plan.cases) {
    digest.add(which.truth.model.yaml());
    for (const study::NamedModel& filter : which.filters) {
      digest.add(filter.model.yaml());
      digest.add(filter.batch ? 1.0 : 0.0);
    }
  }
  return digest.value();
}

/// @param recordings  corrected for the effects in the run file, on return
study::Setup setup_with(const SweepStudy& config, const SweepStudy::Model& model, Recordings& recordings,
                        const Progress& progress) {
  study::Setup setup = setup_of(config.run, recordings, config.sweep);
  take_out_effects(config.run, recordings, setup, progress);
  setup.fit_before = setup.refine_before;  // in situ, on a part not used by the gaps
  setup.model = model.named.model;
  if (!model.noise_estimated) return setup;
  if (!setup.noise_fit) setup.noise_fit = estimate::NoiseFitChoice{};
  setup.noise_fit->imu_white_noise = *model.noise_estimated;
  const estimate::NoiseFitChoice& choice = *setup.noise_fit;
  if (!choice.imu_white_noise && !choice.gnss_scale && !choice.correlated_gnss) setup.noise_fit.reset();
  return setup;
}

/// The recordings again for each error model: two copies of a long one need too much memory.
using Source = std::function<Recordings()>;

/// One recording with one error model after the other.
class Sweep {
 public:
  Sweep(const SweepStudy& config, const Source& source, const OpenJournal& open, const Progress& progress)
      : config_(config), source_(source), open_(open), progress_(progress) {
    study_.models = config.models.size();
  }
  void run(const SweepStudy::Model& model);
  [[nodiscard]] OutageStudy take() { return std::move(study_); }

 private:
  void begin(const Recordings& recordings, double mission_s);
  void run_outages(const study::PreparedMission& mission, const estimate::KnotStore& knots, const study::Truth& truth,
                   const std::string& model);

  const SweepStudy& config_;
  const Source& source_;
  const OpenJournal& open_;
  const Progress& progress_;
  OutageStudy study_;
  std::optional<study::StudyJournal> journal_;
};

void Sweep::begin(const Recordings& recordings, double mission_s) {
  study_.result.groups = study::grouped(config_.sweep, mission_s);
  if (study_.result.groups.empty())
    throw InputError({config_.run.file.string(), 0, "no outage of the sweep fits into the mission",
                      "durations of at most a quarter of it", "Shorten durations_s or first_s."});
  study_.described = fmt::format("The recording of {}, against {}.", config_.run.file.filename().string(),
                                 recordings.reference ? "the reference" : "each error model's own run without gaps");
}

void Sweep::run(const SweepStudy::Model& model) {
  Recordings recordings = source_();
  if (!journal_) journal_ = open_([&] { return digest_of(config_, recordings); });
  study::Setup setup = setup_with(config_, model, recordings, progress_);
  const study::PreparedMission mission(std::move(recordings.imu), std::move(recordings.gnss), std::move(setup), progress_);
  if (study_.result.groups.empty()) begin(recordings, mission.mission().imu.samples.back().t - mission.start().nav.t);
  study_.result.runs.push_back({"", model.named.name, {}});
  for (const study::OutageGroup& group : study_.result.groups)
    study_.result.runs.back().outages.emplace_back(group.starts_s.size());
  study::GapFreeReference gap_free;
  study::SolutionOutputs outputs;
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { gap_free.add(epoch); };
  const study::Solution solution = study::solve(mission, mission.options(), true, outputs, progress_);
  if (recordings.reference)
    run_outages(mission, solution.knots, {*recordings.reference, config_.run.reference_lever_arm_b}, model.named.name);
  else
    run_outages(mission, solution.knots, {gap_free.trajectory()}, model.named.name);
}

void Sweep::run_outages(const study::PreparedMission& mission, const estimate::KnotStore& knots, const study::Truth& truth,
                        const std::string& model) {
  study::ModelRun& run = study_.result.runs.back();
  std::vector<study::StudyPlace> places;  // of which the journal has no result
  std::vector<study::Outage> outages;
  for (std::size_t g = 0; g < study_.result.groups.size(); ++g)
    for (std::size_t i = 0; i < study_.result.groups[g].starts_s.size(); ++i) {
      const study::StudyPlace place{study_.result.runs.size() - 1, g, i};
      const study::Outage outage{mission.start().nav.t + study_.result.groups[g].starts_s[i],
                                 study_.result.groups[g].duration_s, config_.sweep.satellites_left};
      if (const std::optional<study::OutageResult> known = journal_->known(place)) {
        run.outages[g][i] = *known;
        run.outages[g][i].outage = outage;
      } else {
        places.push_back(place);
        outages.push_back(outage);
      }
    }
  std::size_t done = 0;
  study::run_outages(mission, knots, truth, outages, [&](std::size_t i, const study::OutageResult& result) {
    study::OutageResult& slot = run.outages[places[i].group][places[i].outage];
    slot = result;
    slot.forward.series = slot.smoothed->series = {};
    journal_->finished(places[i], result);
    progress_(("outages with " + model).c_str(), static_cast<double>(++done) / static_cast<double>(outages.size()));
  });
}

OutageStudy run_sweep(const SweepStudy& config, const Source& source, const OpenJournal& journal, const Progress& progress) {
  Sweep sweep(config, source, journal, progress);
  for (const SweepStudy::Model& model : config.models) sweep.run(model);
  return sweep.take();
}

OutageStudy run_seeds(const EnsembleStudy& config, const OpenJournal& journal, const Progress& progress) {
  OutageStudy study;
  const study::EnsemblePlan& plan = config.plan;
  study.truths = config.truths;
  study.models = config.filters;
  study.simulated = true;
  study.first_seed = plan.first_seed;
  study.described = fmt::format(
      "Simulated: the motion, GNSS and sensor errors of {}, with the errors of the IMU drawn from an error model, seeds {} to "
      "{}. Each recording is processed with every error model, GNSS and IMU alone, against the simulated truth.",
      config.scenario.filename().string(), plan.first_seed, plan.first_seed + plan.seeds - 1);
  const auto seeds = [&](double fraction) { progress("simulating and processing seeds", fraction); };
  seeds(0.0);  // the first may take minutes
  study.result = study::run_ensemble(plan, seeds, journal([&] { return digest_of(config); }));
  for (const study::EnsembleCase& which : plan.cases)
    for (std::size_t filter = 0; filter < which.filters.size(); ++filter) {
      geo::Psd density;
      for (int axis = 0; axis < 3; ++axis)
        density.value = std::max(density.value, which.truth.model.white_density(noise::Sensor::kGyro, axis).value);
      study.gyro_noise.push_back(density);
    }
  return study;
}

OutageStudy run(const StudyConfig& config, const OpenJournal& journal, const Progress& progress) {
  if (const auto* ensemble = std::get_if<EnsembleStudy>(&config)) return run_seeds(*ensemble, journal, progress);
  const auto& sweep = std::get<SweepStudy>(config);
  return run_sweep(
      sweep, [&] { return load(sweep.run, progress); }, journal, progress);
}

}  // namespace

OutageStudy outage(const StudyConfig& config, const Progress& progress, const std::filesystem::path& resume) {
  if (resume.empty()) return run(config, &no_journal, progress);
  std::optional<StudyJournalFile> file;
  const OpenJournal journal = [&](const std::function<std::uint64_t()>& made_from) {
    file.emplace(resume, made_from());
    if (file->known() > 0 && progress.say)
      progress.say(fmt::format("going on from {} outages of an interrupted run", file->known()));
    return file->callbacks();
  };
  return run(config, journal, progress);
}

OutageStudy outage(const SweepStudy& config, const Recordings& recordings, const Progress& progress) {
  return run_sweep(
      config, [&] { return recordings; }, &no_journal, progress);
}

}  // namespace coast::jobs
