// The page of a study of arrays: one section.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "array_study/result.hpp"
#include "coast/report/panels.hpp"
#include "coast/study/drift.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

report::Section section_of(const ArrayStudyConfig& config, const noise::ArmaGarchStudy& study) {
  report::Section section{"models", "Intervals of ARMA-GARCH estimates", "", {}, {}, {}};
  section.lead = fmt::format("{} series of {} samples: 95 % intervals hold the truth in {} % of all; median time {} s.",
                             study.runs, config.samples, percent(study.pooled_coverage), number(study.median_seconds));
  report::Table table{"parameters", "Parameters", "", {}, {}};
  table.columns = {{"parameter", "", false}, {"truth", ""}, {"bias", ""}, {"spread", ""}, {"stated", ""}, {"held", "%"}};
  for (const noise::ArmaGarchParameterSummary& p : study.parameters)
    table.rows.push_back(
        cells({p.name, number(p.truth), number(p.bias), number(p.sd), number(p.mean_se), percent(p.coverage)}));
  section.tables.push_back(std::move(table));
  return section;
}

/// The paper's Fig. 10.
report::Panel error_boxes(const std::vector<std::vector<double>>& errors) {
  report::Panel panel = report::xy_panel(
      "boxes", "Errors", {"error", "", report::Axis::Scale::kLinear, {}, {}}, {"", "", report::Axis::Scale::kLinear, {}, {}},
      "Of the first run: each sensor, their mean, corrected by residuals and by errors. 5, 25, 50, 75 and 95 %.");
  constexpr std::array kMerged{"mean", "corrected", "corrected by errors"};
  const std::size_t sensors = errors.size() - kMerged.size();
  report::Boxes boxes;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::vector<double> sorted = errors[i];
    std::ranges::sort(sorted);
    const auto q = [&](double p) { return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))]; };
    boxes.boxes.push_back({static_cast<double>(i), q(0.05), q(0.25), q(0.5), q(0.75), q(0.95)});
    panel.plot().y.ticks.push_back(
        {static_cast<double>(i), i < sensors ? fmt::format("single {}", i + 1) : std::string(kMerged[i - sensors])});
  }
  panel.plot().boxes.push_back(std::move(boxes));
  return panel;
}

/// The paper's Fig. 11.
report::Panel variance_panel(const array::MergeStudy& study, double dt) {
  report::Panel panel =
      report::time_panel("tracking", "Variance tracking", "",
                         "Sensor 1, first run: its errors less what the model predicts of them, their true standard deviation "
                         "and the predicted one.");
  constexpr std::size_t kShown = 3000;  // of more only the extremes are kept, and dots would have a hole in the middle
  std::vector<double> t;
  for (std::size_t n = 0; n < std::min(kShown, study.first_sd.size()); ++n) t.push_back(dt * static_cast<double>(n));
  const auto shown = [&](const std::vector<double>& all) { return std::vector(all.begin(), all.begin() + std::ssize(t)); };
  report::add_points(panel.plot(), "residuals", curve(t, shown(study.first_residuals)), report::Tone::kMuted).radius_px = 0.8;
  report::add_line(panel.plot(), "true", curve(t, shown(study.first_sd)), report::Tone::kReference);
  report::add_line(panel.plot(), "predicted", curve(t, shown(study.first_predicted_sd)), report::Tone::kSmoothed);
  return panel;
}

report::Table merge_table(const std::vector<MergeCase>& cases) {
  report::Table table{"mse", "Mean square errors over the plain mean's", "", {{"sensors", ""}, {"motion rms", ""}}, {}};
  for (const MergeCase& one : cases) {
    std::vector<report::Cell> row = cells({fmt::format("{}", one.sensors), number(one.motion_rms)});
    for (const array::MergeResult& merge : one.study.merges) {
      if (merge.name.starts_with("single")) continue;
      if (table.rows.empty()) table.columns.push_back({merge.name, ""});
      row.push_back({decimals(ratio_to_mean(one, merge).ratio, 4)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

array::ResidualModel mean_of(const std::vector<array::ResidualModel>& models) {
  array::ResidualModel mean;
  const double share = 1.0 / static_cast<double>(models.size());
  for (const array::ResidualModel& model : models) {
    mean.own_sd_ratio += share * model.own_sd_ratio;
    mean.autocorrelation += share * model.autocorrelation;
    mean.true_autocorrelation += share * model.true_autocorrelation;
    mean.persistence += share * model.persistence;
    mean.true_persistence += share * model.true_persistence;
    mean.removed += share * model.removed;
    mean.removed_by_errors += share * model.removed_by_errors;
  }
  return mean;
}

report::Table residual_table(const std::vector<MergeCase>& cases) {
  report::Table table{"residuals", "Models from residuals beside the truth", "Means over sensors and runs.", {}, {}};
  table.columns = {{"sensors", ""},       {"motion rms", ""}, {"own sd, ratio", ""}, {"lag-1 correlation", ""}, {"true", ""},
                   {"gamma + delta", ""}, {"true", ""},       {"removed", "%"},      {"by errors", "%"}};
  for (const MergeCase& one : cases) {
    const array::ResidualModel mean = mean_of(one.study.residual_models);
    table.rows.push_back(
        cells({fmt::format("{}", one.sensors), number(one.motion_rms), decimals(mean.own_sd_ratio, 3),
               decimals(mean.autocorrelation, 3), decimals(mean.true_autocorrelation, 3), decimals(mean.persistence, 4),
               decimals(mean.true_persistence, 4), percent(mean.removed), percent(mean.removed_by_errors)}));
  }
  return table;
}

report::Section section_of(const ArrayStudyConfig& config, const std::vector<MergeCase>& cases) {
  report::Section section{"merges", "Ways of merging", "", {}, {}, {}};
  section.panels.push_back(error_boxes(cases.front().study.first_errors));
  section.panels.push_back(variance_panel(cases.front().study, config.merges.dt));
  section.tables.push_back(merge_table(cases));
  section.tables.push_back(residual_table(cases));
  return section;
}

report::Section section_of(const ArrayStudyConfig& config, const std::vector<study::ArrayOutageRun>& runs) {
  report::Section section{"outages", "Drift in an outage", "", {}, {}, {}};
  section.lead =
      fmt::format("{} seeds; ratios of the largest horizontal error to that with the plain mean, pair by pair.", config.runs);
  report::Table table{"drift", "Largest horizontal error", "", {}, {}};
  table.columns = {{"IMU", "", false},      {"forward rms", "m"}, {"over the mean's", ""}, {"95 %", ""}, {"smoothed rms", "m"},
                   {"over the mean's", ""}, {"95 %", ""},         {"inside 95 %", "%"}};
  for (const study::ArrayOutageRun& run : runs) {
    std::vector<report::Cell> row = cells({run.name});
    for (const bool smoothed : {false, true}) {
      const study::PairedRatio ratio = ratio_to_mean(runs, run, smoothed);
      row.push_back({number(study::spread_of(study::drifts(run.outages, study::DriftMeasure::kHorizontal, smoothed)).rms)});
      row.push_back({decimals(ratio.ratio, 3)});
      row.push_back({fmt::format("{} to {}", decimals(ratio.low, 3), decimals(ratio.high, 3))});
    }
    row.push_back({percent(study::drift_of(run.outages, true).inside_95)});
    table.rows.push_back(std::move(row));
  }
  section.tables.push_back(std::move(table));
  return section;
}

report::Section section_of(const ArrayStudyConfig&, const array::DefectStudyResult& study) {
  report::Section section{"defects", "Defects", "", {}, {}, {}};
  section.lead = fmt::format("{} false alarms in {} clean hours; {} are stated.", study.false_alarms, number(study.clean_hours),
                             number(study.stated_false_alarms));
  report::Table table{"detection", "Injected defects", "", {}, {}};
  table.columns = {{"kind", "", false},    {"strength", ""},      {"injected", ""},
                   {"found", "%"},         {"wrong sensor", "%"}, {"right kind", "%"},
                   {"delay, median", "s"}, {"delay, 95 %", "s"},  {"onset error", "s"}};
  for (const array::DefectStudyRow& row : study.rows)
    table.rows.push_back(cells({std::string(array::name_of(row.kind)), number(row.strength), fmt::format("{}", row.injections),
                                percent(share(row.detected, row.injections)), percent(share(row.wrong_sensor, row.injections)),
                                percent(share(row.right_kind, row.detected)), number(row.median_delay_s),
                                number(row.delay_95_s), number(row.median_onset_error_s)}));
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace

report::Page array_study_page(const ArrayStudyConfig& config, const ArrayStudyResult& result) {
  report::Page page;
  page.sections.push_back(std::visit([&](const auto& study) { return section_of(config, study); }, result));
  page.title = page.sections.front().title;
  page.subtitle = config.file.filename().string();
  page.footer = fmt::format("coast {}, coast synth", COAST_VERSION);
  return page;
}

}  // namespace coast::jobs
