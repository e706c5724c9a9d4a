#include "coast/io/aid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counted.hpp"

namespace coast::io {

AidFileOptions AidFileOptions::from(const config::Node& aid, const std::vector<std::string_view>& values,
                                    const std::vector<std::string_view>& sds) {
  AidFileOptions o;
  o.file = aid.at("file").path();
  o.time = TimeOptions::from(aid);
  o.value_columns.assign(values.begin(), values.end());
  o.sd_columns.assign(sds.begin(), sds.end());
  const auto columns = aid.find("columns");
  if (!columns) return o;
  if (o.time.kind != TimeKind::kRow) o.time_columns = Column::list_from(columns->at("time"), 0);
  o.value_columns = Column::list_from(columns->at("value"), values.size());
  o.sd_columns.clear();
  if (const auto node = columns->find("sd")) {
    o.sd_columns = Column::list_from(*node, values.size());
    o.sds_stated = true;
  }
  return o;
}

namespace {

constexpr double kLargestAidValue = 1e12;  // pulses

class AidTable {
 public:
  AidTable(TableReader& table, const AidFileOptions& o, std::optional<geo::GpsTime> near)
      : table_(table), time_(table, o.time, o.time_columns, near) {
    for (const Column& column : o.value_columns) values_.push_back(table.number_slot(column, "a value"));
    const auto there = [&](const Column& column) { return table.has(column.name); };
    if (!o.sds_stated && !std::ranges::all_of(o.sd_columns, there)) return;
    for (const Column& column : o.sd_columns) sds_.push_back(table.number_slot(column, "a standard deviation"));
  }

  record::AidRecording read() {
    record::AidRecording recording;
    recording.source = table_.name();
    while (table_.next()) take_row(recording);
    recording.events = time_.events();
    for (const record::Event& event : table_.events()) recording.events.push_back(event);
    add_counted(recording.events, table_.name(), not_finite_,
                {"aid_nan", "row", "rows", "with a field that is not a number left out"});
    add_counted(recording.events, table_.name(), not_later_,
                {"aid_time", "row", "rows", "whose time is not after that of the row before left out"});
    if (recording.samples.empty())
      throw InputError({table_.name(), 0, "no row that can be used", "times and values that are numbers", ""});
    return recording;
  }

 private:
  void take_row(record::AidRecording& recording) {
    if (!table_.finite()) return not_finite_.add();
    record::AidSample sample;
    sample.t = time_.read();
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double value = table_.number(values_[i]);
      if (std::abs(value) > kLargestAidValue)
        throw table_.error(fmt::format("{:g}", value), "a number that a sensor can measure");
      sample.value(static_cast<Eigen::Index>(i)) = value;
    }
    for (std::size_t i = 0; i < sds_.size(); ++i) {
      const double sd = table_.number(sds_[i]);
      if (!(sd > 0.0 && sd < kLargestAidValue))
        throw table_.error("a standard deviation of zero or less", "a number above zero");
      sample.sd(static_cast<Eigen::Index>(i)) = sd;
    }
    if (!recording.samples.empty() && sample.t <= recording.samples.back().t) return not_later_.add(sample.t);
    recording.samples.push_back(sample);
  }

  TableReader& table_;
  TimeColumn time_;
  std::vector<std::size_t> values_, sds_;
  Counted not_finite_, not_later_;
};

}  // namespace

record::AidRecording read_aid(const AidFileOptions& options, std::optional<geo::GpsTime> near) {
  AidFileOptions o = options;
  TableReader table(o.file);
  default_time_columns(table, o.time, o.time_columns);
  return AidTable(table, o, near).read();
}

}  // namespace coast::io
