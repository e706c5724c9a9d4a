// array_study.json

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "array_study/result.hpp"
#include "coast/study/drift.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

Json residual_json(const array::ResidualModel& model) {
  return {{"own_sd_ratio", model.own_sd_ratio},
          {"autocorrelation", model.autocorrelation},
          {"true_autocorrelation", model.true_autocorrelation},
          {"persistence", model.persistence},
          {"true_persistence", model.true_persistence},
          {"removed", model.removed},
          {"removed_by_errors", model.removed_by_errors}};
}

Json part_of(const ArrayStudyConfig&, const noise::ArmaGarchStudy& study) {
  Json parameters = Json::array();
  for (const noise::ArmaGarchParameterSummary& p : study.parameters)
    parameters.push_back({{"name", p.name},
                          {"truth", p.truth},
                          {"bias", p.bias},
                          {"sd", p.sd},
                          {"mean_stated_sd", p.mean_se},
                          {"coverage", p.coverage}});
  return {{"runs", study.runs},
          {"pooled_coverage", study.pooled_coverage},
          {"not_converged", study.not_converged},
          {"without_uncertainty", study.without_uncertainty},
          {"median_seconds", study.median_seconds},
          {"parameters", parameters}};
}

Json part_of(const ArrayStudyConfig&, const std::vector<MergeCase>& cases) {
  Json part;
  part["cases"] = Json::array();
  for (const MergeCase& of : cases) {
    Json one = {
        {"sensors", of.sensors}, {"motion_rms", of.motion_rms}, {"merges", Json::array()}, {"residual_models", Json::array()}};
    for (const array::MergeResult& merge : of.study.merges) {
      const study::PairedRatio ratio = ratio_to_mean(of, merge);
      one["merges"].push_back(
          {{"name", merge.name}, {"mse", merge.mean()}, {"ratio_to_mean", ratio.ratio}, {"ratio_95", {ratio.low, ratio.high}}});
    }
    for (const array::ResidualModel& model : of.study.residual_models) one["residual_models"].push_back(residual_json(model));
    part["cases"].push_back(std::move(one));
  }
  return part;
}

Json part_of(const ArrayStudyConfig& config, const std::vector<study::ArrayOutageRun>& runs) {
  Json part = {{"seeds", config.runs}, {"runs", Json::array()}};
  for (const study::ArrayOutageRun& run : runs) {
    Json one = {{"name", run.name}};
    for (const bool smoothed : {false, true}) {
      const study::Spread spread = study::spread_of(study::drifts(run.outages, study::DriftMeasure::kHorizontal, smoothed));
      const study::PairedRatio ratio = ratio_to_mean(runs, run, smoothed);
      one[smoothed ? "smoothed" : "forward"] = {{"horizontal_rms_m", spread.rms},
                                                {"horizontal_median_m", spread.median},
                                                {"ratio_to_mean", ratio.ratio},
                                                {"ratio_95", {ratio.low, ratio.high}},
                                                {"inside_95", study::drift_of(run.outages, smoothed).inside_95}};
    }
    part["runs"].push_back(std::move(one));
  }
  return part;
}

Json part_of(const ArrayStudyConfig&, const array::DefectStudyResult& study) {
  Json part = {{"clean_hours", study.clean_hours},
               {"false_alarms", study.false_alarms},
               {"stated_false_alarms", study.stated_false_alarms},
               {"rows", Json::array()}};
  for (const array::DefectStudyRow& row : study.rows)
    part["rows"].push_back({{"kind", array::name_of(row.kind)},
                            {"strength", row.strength},
                            {"injections", row.injections},
                            {"detected", share(row.detected, row.injections)},
                            {"wrong_sensor", share(row.wrong_sensor, row.injections)},
                            {"right_kind", share(row.right_kind, row.detected)},
                            {"median_delay_s", row.median_delay_s},
                            {"delay_95_s", row.delay_95_s},
                            {"median_onset_error_s", row.median_onset_error_s}});
  return part;
}

}  // namespace

study::PairedRatio ratio_to_mean(const MergeCase& one, const array::MergeResult& merge) {
  return study::paired_ratio(one.study.merges[one.sensors].mse, merge.mse);
}

study::PairedRatio ratio_to_mean(const std::vector<study::ArrayOutageRun>& runs, const study::ArrayOutageRun& run,
                                 bool smoothed) {
  const auto plain = std::ranges::find(runs, "mean", &study::ArrayOutageRun::name);
  return study::paired_ratio(study::drifts(plain->outages, study::DriftMeasure::kHorizontal, smoothed),
                             study::drifts(run.outages, study::DriftMeasure::kHorizontal, smoothed));
}

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

std::string array_study_json(const ArrayStudyConfig& config, const ArrayStudyResult& result) {
  const char* kind = std::array{"models", "merges", "outages", "defects"}[result.index()];
  Json json = {{"schema", "coast.array_study_result/1"}, {"kind", kind}};
  json[kind] = std::visit([&](const auto& study) { return part_of(config, study); }, result);
  return json.dump(2) + "\n";
}

}  // namespace coast::jobs
