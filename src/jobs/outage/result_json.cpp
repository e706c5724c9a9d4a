// outage.json and outages.csv.

#include <fmt/format.h>

#include <algorithm>

#include "common/drift.hpp"
#include "outage/outage_table.hpp"
#include "outage/tables.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;
using study::DriftMeasure;

constexpr std::array kMeasures{DriftMeasure::kNorth, DriftMeasure::kEast, DriftMeasure::kDown, DriftMeasure::kHorizontal};
const char* name_of(DriftMeasure measure) {
  constexpr std::array kNames{"n", "e", "d", "horizontal"};
  return kNames[static_cast<std::size_t>(measure)];
}

Json solution_json(const std::vector<study::OutageResult>& outages, bool smoothed) {
  return drift_json(study::drift_of(outages, smoothed));
}

Json manoeuvres_json(const std::vector<study::OutageResult>& outages) {
  Json list = Json::array();
  for (const ManoeuvreDrift& part : by_manoeuvre(outages)) {
    Json one = {{"manoeuvre", study::name(part.manoeuvre)}, {"outages", part.outages.size()}};
    for (const bool smoothed : {false, true}) {
      const study::Drift drift = study::drift_of(part.outages, smoothed);
      one[smoothed ? "smoothed" : "forward"] = {{"horizontal", spread_json(drift.horizontal)},
                                                {"share_inside_95", drift.inside_95}};
    }
    list.push_back(one);
  }
  return list;
}

Json run_json(const OutageStudy& study, std::size_t run, std::size_t group) {
  const study::ModelRun& r = study.result.runs[run];
  const std::vector<study::OutageResult>& outages = r.outages[group];
  Json j;
  if (study.simulated) j["truth"] = r.truth;
  j["error_model"] = r.filter;
  if (study.simulated)
    j["gyro_noise_alone_m"] = study::gyro_noise_drift(study.gyro_noise[run], study.result.groups[group].duration_s);
  j["forward"] = solution_json(outages, false);
  j["smoothed"] = solution_json(outages, true);
  j["manoeuvres"] = manoeuvres_json(outages);
  return j;
}

Json paired_json(const study::PairedRatio& paired) {
  return {{"pairs", paired.pairs},
          {"ratio", paired.ratio},
          {"interval_95", {paired.low, paired.high}},
          {"second_smaller", paired.second_smaller},
          {"sign_test", paired.sign_test}};
}

Json pairs_json(const OutageStudy& study, std::size_t group) {
  Json j = Json::array();
  for (const StudyPair& pair : pairs_of(study))
    for (const bool smoothed : {false, true}) {
      Json entry;
      if (study.simulated) entry["truth"] = pair.first->truth;
      entry["first"] = pair.first->filter;
      entry["second"] = pair.second->filter;
      entry["solution"] = smoothed ? "smoothed" : "forward";
      for (const DriftMeasure measure : kMeasures)
        entry[name_of(measure)] =
            paired_json(study::compare(study.result, *pair.first, *pair.second, group, measure, smoothed));
      j.push_back(entry);
    }
  return j;
}

}  // namespace

Json drift_json(const study::Drift& drift) {
  Json j;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = name_of(kMeasures[axis]);
    j["largest"][name] = spread_json(drift.largest[axis]);
    j["largest"][name]["predicted_rms_m"] = drift.predicted_largest_rms_m(static_cast<Eigen::Index>(axis));
    j["end"][name] = spread_json(drift.end[axis]);
    j["end"][name]["predicted_rms_m"] = drift.predicted_end_rms_m(static_cast<Eigen::Index>(axis));
  }
  j["largest"]["horizontal"] = spread_json(drift.horizontal);
  if (drift.against_gnss) j["largest"]["horizontal_against_gnss"] = spread_json(*drift.against_gnss);
  j["share_inside_95"] = drift.inside_95;
  return j;
}

std::vector<StudyPair> pairs_of(const OutageStudy& study) {
  const std::vector<study::ModelRun>& runs = study.result.runs;
  const std::size_t floors = study.truths * study.models;  // index of the first floor among the runs
  std::vector<StudyPair> pairs;
  for (std::size_t truth = 0; truth < study.truths; ++truth) {
    const study::ModelRun* first = &runs[truth * study.models];
    for (std::size_t i = 1; i < study.models; ++i) pairs.push_back({first, first + i});
    for (std::size_t i = floors; i < runs.size(); ++i) pairs.push_back({first, &runs[i], true});
  }
  return pairs;
}

std::vector<ManoeuvreDrift> by_manoeuvre(const std::vector<study::OutageResult>& outages) {
  std::vector<ManoeuvreDrift> parts;
  for (const study::OutageResult& outage : outages) {
    const auto part = std::ranges::find(parts, outage.manoeuvre, &ManoeuvreDrift::manoeuvre);
    if (part == parts.end())
      parts.push_back({outage.manoeuvre, {outage}});
    else
      part->outages.push_back(outage);
  }
  std::ranges::sort(parts, {}, &ManoeuvreDrift::manoeuvre);
  return parts;
}

Json outage_json(const OutageStudy& study) {
  Json j;
  j["schema"] = "coast.outage/1";
  j["described"] = study.described;
  if (study.simulated) j["seeds"] = {{"first", study.first_seed}, {"count", study.result.seeds}};
  for (std::size_t group = 0; group < study.result.groups.size(); ++group) {
    const study::OutageGroup& g = study.result.groups[group];
    Json outage = {{"duration_s", g.duration_s}, {"starts_s", g.starts_s}};
    for (std::size_t run = 0; run < study.result.runs.size(); ++run) outage["runs"].push_back(run_json(study, run, group));
    outage["paired"] = pairs_json(study, group);
    j["outages"].push_back(outage);
  }
  return j;
}

namespace {

/// A text as a field of a CSV file (RFC 4180).
std::string csv_field(std::string_view text) {
  std::string field = "\"";
  for (const char c : text) field.append(c == '"' ? 2 : 1, c);
  return field + '"';
}

}  // namespace

std::string outages_csv(const OutageStudy& study) {
  std::string text = "truth,error_model,seed,start_s,duration_s," + outage_columns() + "\n";
  for (const study::ModelRun& run : study.result.runs)
    for (std::size_t g = 0; g < run.outages.size(); ++g)
      for (std::size_t i = 0; i < run.outages[g].size(); ++i) {
        const study::OutageGroup& group = study.result.groups[g];
        const std::string seed = study.simulated ? fmt::format("{}", study.first_seed + i % study.result.seeds) : "";
        text += fmt::format("{},{},{},{},{},{}\n", csv_field(run.truth), csv_field(run.filter), seed,
                            group.starts_s[i / study.result.seeds], group.duration_s, outage_values(run.outages[g][i]));
      }
  return text;
}

}  // namespace coast::jobs
