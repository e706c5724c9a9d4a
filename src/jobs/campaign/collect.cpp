// The results of all units in a few files: read unit by unit, in their order.

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "campaign/page/page.hpp"
#include "campaign/statistics.hpp"
#include "campaign/units.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/parallel.hpp"
#include "common/drift.hpp"
#include "common/results.hpp"
#include "outage/outage_table.hpp"
#include "outage/tables.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kListed = 1000;  // failures on the page; all of them stand in missions.csv

/// A field of a CSV file (RFC 4180).
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

std::string field(const Json& row, const std::string& column) {
  const auto value = row.find(column);
  if (value == row.end() || value->is_null()) return {};
  return value->is_string() ? field(value->get<std::string>()) : value->dump();
}

/// What is known of a unit: its result, an error without one, or nothing yet.
struct Collected {
  std::optional<UnitResult> result;
  std::string error;
  std::string folder;  ///< of the result, whether it is there or not; empty of a unit whose run file is wrong
};

Collected collected(Campaign& campaign, const CampaignUnit& unit) {
  Collected of;
  try {
    const std::string key = campaign.key(unit);
    of.folder = io::ResultStore::place_of(key);
    const std::optional<std::string> text = campaign.store().read(key, kResult);
    if (text) of.result = result_from(*text);
    if (of.result) of.error = of.result->error;
  } catch (const InputError& error) {
    of.error = campaign.portable(error.what(), {});
  }
  return of;
}

/// The merged tables, written line by line.
class Tables {
 public:
  Tables(const Campaign& campaign, const std::filesystem::path& out)
      : campaign_(campaign), missions_(out / "missions.csv"), outages_(out / "outages.csv"), estimates_(out / "estimates.csv") {
    constexpr const char* kFactors = "mission,seed,error_model,outages,effects";
    missions_.write(fmt::format("{},status,{},error,result\n", kFactors, fmt::join(mission_columns(), ",")));
    outages_.write(fmt::format("{},start_s,duration_s,{}\n", kFactors, outage_columns()));
    estimates_.write("mission,unit,start,quantity,axis,value,sigma,unit_of_value,temperature_degC\n");
  }

  void add(const CampaignUnit& unit, const Collected& of, const char* status) {
    const CampaignMission& mission = campaign_.mission(unit);
    const std::string factors =
        fmt::format("{},{},{},{},{}", field(mission.name), mission.scenario != nullptr ? fmt::format("{}", mission.seed) : "",
                    field(campaign_.error_model(unit.error_model)), field(campaign_.outages(unit.outages)),
                    field(campaign_.effects(unit.effects)));
    const Json none = Json::object();
    const Json& row = of.result ? of.result->row : none;
    std::string line = fmt::format("{},{}", factors, status);
    for (const std::string& column : mission_columns()) line += "," + field(row, column);
    missions_.write(fmt::format("{},{},{}\n", line, field(of.error), of.folder));
    if (!of.result) return;
    for (const std::string& outage : of.result->outages) outages_.write(fmt::format("{},{}\n", factors, outage));
    // One mission of the statistics of fleets is one unit here: with its factors it has a name of its own.
    std::string name = mission.name;
    for (const std::string& factor :
         {campaign_.error_model(unit.error_model), campaign_.outages(unit.outages), campaign_.effects(unit.effects)})
      if (!factor.empty()) name += "|" + factor;
    for (const CampaignEstimated& e : of.result->estimates)
      estimates_.write(fmt::format("{},{},{},{},{},{},{},{},{}\n", field(name), field(of.result->imu), field(row, "start"),
                                   field(e.quantity), field(e.axis), e.value, e.sigma, field(e.unit), of.result->temperature));
  }
  void commit() {
    missions_.commit();
    outages_.commit();
    estimates_.commit();
  }

 private:
  const Campaign& campaign_;
  io::AtomicFile missions_, outages_, estimates_;
};

Json duration_json(double duration_s, const DurationSums& sums) {
  Json j{{"duration_s", duration_s}, {"outages", sums.forward.outages()}};
  if (sums.forward.outages() > 0) j["forward"] = drift_json(sums.forward.drift());
  if (sums.smoothed.outages() > 0) j["smoothed"] = drift_json(sums.smoothed.drift());
  return j;
}

Json group_json(const GroupStatistics& group) {
  Json j{{"mission", group.mission}};
  if (!group.error_model.empty()) j["error_model"] = group.error_model;
  if (!group.outages.empty()) j["outages"] = group.outages;
  if (!group.effects.empty()) j["effects"] = group.effects;
  j["units"] = group.units;
  j["done"] = group.done;
  j["failed"] = group.failed;
  j["missing"] = group.missing;
  if (!group.verdicts.empty()) j["verdicts"] = group.verdicts;
  if (!group.nis_ratio.empty()) {
    const study::Spread nis = study::spread_of(group.nis_ratio);
    j["nis_over_expected"] = {{"median", nis.median}, {"p95", nis.p95}, {"max", nis.max}};
  }
  for (const std::size_t solution : {0U, 1U}) {
    if (group.horizontal_rms[solution].empty()) continue;
    j["reference"][solution == 0 ? "forward" : "smoothed"] = {
        {"horizontal_rms", spread_json(study::spread_of(group.horizontal_rms[solution]))},
        {"down_rms", spread_json(study::spread_of(group.down_rms[solution]))}};
  }
  for (const auto& [duration_s, sums] : group.durations) j["durations"].push_back(duration_json(duration_s, sums));
  return j;
}

/// Reads the units of one group, some at once, and adds them in their order.
class Collector {
 public:
  Collector(Campaign& campaign, Tables& tables, const Progress& progress)
      : campaign_(campaign), tables_(tables), progress_(progress) {}

  [[nodiscard]] GroupStatistics group(const CampaignGroup& of) {
    constexpr std::size_t kAtOnce = 256;
    GroupStatistics statistics;
    statistics.mission = campaign_.kinds()[of.kind].name;
    statistics.error_model = campaign_.error_model(of.error_model);
    statistics.outages = campaign_.outages(of.outages);
    statistics.effects = campaign_.effects(of.effects);
    statistics.units = of.count;
    for (std::size_t first = of.first; first < of.first + of.count; first += kAtOnce) {
      std::vector<Collected> read(std::min(kAtOnce, of.first + of.count - first));
      coast::parallel_for(std::size_t{0}, read.size(),
                          [&](std::size_t i) { read[i] = collected(campaign_, campaign_.unit(first + i)); });
      for (std::size_t i = 0; i < read.size(); ++i) add(campaign_.unit(first + i), read[i], statistics);
      progress_("collecting", static_cast<double>(first) / static_cast<double>(campaign_.size()));
    }
    return statistics;
  }
  [[nodiscard]] const std::vector<CampaignFailure>& failures() const { return failures_; }

 private:
  void add(const CampaignUnit& unit, const Collected& of, GroupStatistics& statistics) {
    if (!of.error.empty()) {
      ++statistics.failed;
      if (failures_.size() < kListed)
        failures_.push_back({campaign_.mission(unit).name, campaign_.error_model(unit.error_model),
                             campaign_.outages(unit.outages), campaign_.effects(unit.effects), of.error});
      tables_.add(unit, of, "failed");
      return;
    }
    if (!of.result) ++statistics.missing;
    if (of.result) statistics.add(*of.result);
    tables_.add(unit, of, of.result ? "done" : "missing");
  }

  Campaign& campaign_;
  Tables& tables_;
  const Progress& progress_;
  std::vector<CampaignFailure> failures_;
};

}  // namespace

std::vector<std::string> files_of(const CampaignConfig&) {
  return {"missions.csv", "outages.csv", "estimates.csv", "campaign.json", "report.json", "report.html"};
}

CampaignCollection collect_campaign(const CampaignConfig& config, const std::filesystem::path& out, const Progress& progress) {
  Campaign campaign(config, out);
  io::begin_results(out / "campaign.json");
  Tables tables(campaign, out);
  Collector collector(campaign, tables, progress);
  CampaignCollection all;
  std::vector<GroupSummary> groups;
  Json j{{"schema", "coast.campaign_result/1"}, {"job", name(config.job)}};
  for (std::size_t i = 0; i < campaign.groups(); ++i) {
    const GroupStatistics group = collector.group(campaign.group(i));
    all.units += group.units;
    all.done += group.done;
    all.failed += group.failed;
    all.missing += group.missing;
    j["groups"].push_back(group_json(group));
    groups.push_back(summary_of(group));
  }
  j["units"] = {{"all", all.units}, {"done", all.done}, {"failed", all.failed}, {"missing", all.missing}};
  tables.commit();
  write_page(campaign_page(config, all, groups, collector.failures()), out);
  io::write_text(out / "campaign.json", j.dump(1) + "\n");
  campaign.remember_digests();
  return all;
}

std::string told(const CampaignCollection& all, const std::filesystem::path& out) {
  return fmt::format("{} units: {} done, {} failed, {} missing\nreport: {}\n", all.units, all.done, all.failed, all.missing,
                     (out / "report.html").string());
}

}  // namespace coast::jobs
