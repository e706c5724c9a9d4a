// The table of estimates, as `coast campaign collect` writes it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/jobs/fleet.hpp"

namespace coast::jobs {

namespace {

struct Row {
  std::string mission, unit, quantity, axis, unit_of_value;
  geo::GpsTime start;
  fleet::Estimate estimate;
};

io::TimeOptions calendar_times() {
  io::TimeOptions options;
  options.kind = io::TimeKind::kGpst;
  return options;
}

class EstimateTable {
 public:
  EstimateTable(const std::filesystem::path& file, std::vector<std::string>& groups)
      : table_(file), time_(table_, calendar_times(), {"start"}, std::nullopt) {
    for (const char* name : {"mission", "unit", "quantity", "axis", "unit_of_value"})
      texts_.push_back(table_.text_slot(name, "of an estimate"));
    value_ = table_.number_slot("value", "of an estimate");
    sigma_ = table_.number_slot("sigma", "of an estimate");
    if (table_.has("temperature_degC")) temperature_ = table_.number_slot("temperature_degC", "of an estimate");
    if (groups.empty() && table_.has("firmware")) groups.emplace_back("firmware");
    for (const std::string& name : groups) groups_.push_back(table_.text_slot(io::Column(std::string_view(name)), "grouping"));
  }

  [[nodiscard]] bool next(Row& row) {
    if (!table_.next()) return false;
    row = Row{};
    std::string* const texts[] = {&row.mission, &row.unit, &row.quantity, &row.axis, &row.unit_of_value};
    for (std::size_t i = 0; i < texts_.size(); ++i) *texts[i] = table_.text(texts_[i]);
    for (const auto& [text, name] :
         {std::pair(&row.mission, "mission"), std::pair(&row.unit, "unit"), std::pair(&row.quantity, "quantity")})
      if (text->empty()) throw table_.error(fmt::format("no {}", name), "a name");
    row.start = time_.read();
    row.estimate.mission = row.mission;
    row.estimate.value = table_.number(value_);
    row.estimate.sigma = table_.number(sigma_);
    constexpr double kLargest = 1e12;  // squares and their sums stay finite
    constexpr double kSmallest = 1e-15;
    if (!(std::abs(row.estimate.value) < kLargest))
      throw table_.error(fmt::format("value {}", row.estimate.value), "a finite number in SI",
                         "Leave out what was not estimated.");
    if (!(row.estimate.sigma > kSmallest && row.estimate.sigma < kLargest))
      throw table_.error(fmt::format("sigma {}", row.estimate.sigma), "a standard deviation above 0 in SI",
                         "Leave out what was held fixed.");
    if (temperature_) {
      const double degrees = table_.number(*temperature_);
      if (std::isfinite(degrees)) row.estimate.temperature = degrees;
      if (row.estimate.temperature && std::abs(degrees) > 300.0)
        throw table_.error(fmt::format("{} deg C", degrees), "a temperature in deg C");
    }
    for (const std::size_t slot : groups_) row.estimate.groups.emplace_back(table_.text(slot));
    return true;
  }

  [[nodiscard]] InputError error(std::string found, std::string expected, std::string what_to_do) const {
    return table_.error(std::move(found), std::move(expected), std::move(what_to_do));
  }
  [[nodiscard]] const record::Events& events() const { return table_.events(); }

 private:
  io::TableReader table_;
  io::TimeColumn time_;
  std::vector<std::size_t> texts_, groups_;
  std::size_t value_ = 0;
  std::size_t sigma_ = 0;
  std::optional<std::size_t> temperature_;
};

/// Puts rows into panels, in alphabetical order of quantity, axis and unit.
class Collector {
 public:
  void add(const Row& row, const EstimateTable& table) {
    auto& [unit_of_value, series] = panels_[{row.quantity, row.axis}];
    if (series.empty()) unit_of_value = row.unit_of_value;
    if (unit_of_value != row.unit_of_value)
      throw table.error(fmt::format("{} {} in \"{}\"", row.quantity, row.axis, row.unit_of_value),
                        fmt::format("\"{}\", as in the rows above", unit_of_value), "One figure has one unit.");
    if (!seen_.emplace(row.unit, row.mission, row.quantity, row.axis).second)
      throw table.error(fmt::format("{} {} of mission {} of unit {} again", row.quantity, row.axis, row.mission, row.unit),
                        "one row for each", "Is a file named twice?");
    series[row.unit].push_back(row);
    missions_.emplace(row.unit, row.mission);
    units_.insert(row.unit);
    first_ = missions_.size() == 1 && units_.size() == 1 ? row.start : std::min(first_, row.start);
  }

  [[nodiscard]] FleetEstimates collected() const {
    constexpr double kYear = 365.25 * 86400.0;
    FleetEstimates all;
    all.start = first_;
    all.missions = missions_.size();
    all.units = units_.size();
    for (const auto& [key, content] : panels_) {
      fleet::Panel& panel = all.fleet.panels.emplace_back();
      std::tie(panel.quantity, panel.axis) = key;
      panel.unit_of_value = content.first;
      for (const auto& [unit, rows] : content.second) {
        fleet::Series& series = panel.series.emplace_back();
        series.unit = unit;
        for (const Row& row : rows) {
          series.estimates.push_back(row.estimate);
          series.estimates.back().t = (row.start - first_) / kYear;
        }
        std::ranges::stable_sort(series.estimates, {}, &fleet::Estimate::t);
      }
    }
    return all;
  }

 private:
  std::map<std::pair<std::string, std::string>, std::pair<std::string, std::map<std::string, std::vector<Row>>>> panels_;
  std::set<std::tuple<std::string, std::string, std::string, std::string>> seen_;
  std::set<std::pair<std::string, std::string>> missions_;
  std::set<std::string> units_;
  geo::GpsTime first_;
};

}  // namespace

FleetEstimates read_estimates(const FleetConfig& config) {
  Collector collector;
  std::vector<std::string> groups = config.groups;
  record::Events events;
  for (const std::filesystem::path& file : config.estimates) {
    EstimateTable table(file, groups);
    Row row;
    while (table.next(row)) collector.add(row, table);
    events.insert(events.end(), table.events().begin(), table.events().end());
  }
  FleetEstimates all = collector.collected();
  all.fleet.factors = groups;
  all.events = std::move(events);
  return all;
}

}  // namespace coast::jobs
