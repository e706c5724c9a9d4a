#include "coast/io/time_marks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "coast/io/rinex.hpp"
#include "counted.hpp"
#include "position.hpp"
#include "registry_lookup.hpp"

namespace coast::io {

namespace {

constexpr std::array<const char*, 3> kDefaultPosition{"lat_deg", "lon_deg", "height_m"};

class TimeMarkTable {
 public:
  TimeMarkTable(TableReader& table, const TimeMarkFileOptions& options, std::optional<geo::GpsTime> near)
      : table_(table), time_(table, options.time, options.time_columns, near), position_(options.position, table) {
    if (!options.id_column.empty()) id_ = table.text_slot(options.id_column, "id");
    if (options.position_columns.empty()) return;
    std::array<std::size_t, 3>& slots = r_.emplace();
    for (std::size_t i = 0; i < 3; ++i) slots[i] = table.number_slot(options.position_columns[i], "position");
  }

  record::TimeMarkRecording read() {
    record::TimeMarkRecording recording;
    recording.source = table_.name();
    Counted not_finite;
    while (table_.next()) {
      if (!table_.finite()) {
        not_finite.add();
        continue;
      }
      record::TimeMark& mark = recording.marks.emplace_back();
      mark.t = time_.read();
      if (id_) mark.id = table_.text(*id_);
      if (r_) mark.r_e = position_.to_ecef(table_.number((*r_)[0]), table_.number((*r_)[1]), table_.number((*r_)[2]));
    }
    recording.events = table_.events();
    for (const record::Events& more : {time_.events(), r_ ? position_.events() : record::Events{}})
      recording.events.insert(recording.events.end(), more.begin(), more.end());
    add_counted(recording.events, recording.source, not_finite,
                {"time_mark_not_finite", "row", "rows", "with a field that is empty or not finite left out"});
    return recording;
  }

 private:
  TableReader& table_;
  TimeColumn time_;
  PositionConverter position_;
  std::optional<std::size_t> id_;
  std::optional<std::array<std::size_t, 3>> r_;
};

/// Dates and names alone look like a header line: the first event must not be lost.
void refuse_event_as_header(const TableReader& table, const std::vector<Column>& time) {
  if (time.empty() || time.front().number < 1) return;
  const auto at = static_cast<std::size_t>(time.front().number) - 1;
  if (at >= table.header().size() || table.header()[at].empty()) return;
  const std::string& first = table.header()[at];
  if (first.front() < '0' || first.front() > '9') return;
  throw InputError({table.name(), 1, fmt::format("\"{}\" in a line without a number, which is read as the header", first),
                    "names of the columns in the first line", "Put a header line above the first event."});
}

record::TimeMarkRecording read_time_mark_table(const TimeMarkFileOptions& given, std::optional<geo::GpsTime> near) {
  TimeMarkFileOptions o = given;
  TableReader table(o.file);
  refuse_event_as_header(table, o.time_columns);
  if (o.time_columns.empty() && o.time.kind != TimeKind::kRow) {
    default_time_columns(table, o.time, o.time_columns);
    if (o.id_column.empty() && table.has("id")) o.id_column = "id";
    if (std::ranges::all_of(kDefaultPosition, [&](const char* name) { return table.has(name); }))
      o.position_columns = {kDefaultPosition.begin(), kDefaultPosition.end()};
  }
  return TimeMarkTable(table, o, near).read();
}

record::TimeMarkRecording marks_of_rinex(const std::filesystem::path& file) {
  record::ObservationRecording observations = read_observations(file);
  if (observations.marks.empty())
    throw InputError({observations.source, 0, "no time mark", "event records with flag 5 between the epochs",
                      "If the receiver logged its marks elsewhere, convert its own file again with events."});
  return {std::move(observations.source), std::move(observations.marks), std::move(observations.events)};
}

void keep_edge(record::Edge edge, record::TimeMarkRecording& recording) {
  const bool stated = std::ranges::any_of(recording.marks, [](const auto& m) { return m.edge != record::Edge::kNotStated; });
  std::erase_if(recording.marks, [&](const record::TimeMark& mark) { return mark.edge != edge; });
  if (recording.marks.empty())
    throw InputError(
        {recording.source, 0,
         stated ? fmt::format("no {} edge", edge == record::Edge::kRising ? "rising" : "falling") : "time marks without edges",
         "edge: any", ""});
}

/// The format whose own time marks these are; null: RINEX or a table.
const Format* own_format(const TimeMarkFileOptions& options) {
  return options.time_columns.empty() ? format_beside_rinex(options.file, &Format::read_time_marks) : nullptr;
}

bool is_rinex(const std::filesystem::path& file) {
  constexpr std::size_t kHead = 4096;
  const auto kind = file_kind(read_head(file, kHead));
  return kind && kind->content == FileKind::Content::kRinex;
}

}  // namespace

TimeMarkFileOptions TimeMarkFileOptions::from(const config::Node& events) {
  TimeMarkFileOptions o;
  o.file = events.at("file").path();
  o.position = PositionOptions::from(events);
  o.time = TimeOptions::from(events);
  const std::size_t edge = events.choice("edge", {"any", "rising", "falling"}, 0);
  if (edge != 0) o.edge = edge == 1 ? record::Edge::kRising : record::Edge::kFalling;
  const auto columns = events.find("columns");
  if (!columns) return o;
  if (o.time.kind != TimeKind::kRow) o.time_columns = Column::list_from(columns->at("time"), 0);
  if (const auto id = columns->find("id")) o.id_column = Column::from(*id);
  if (const auto position = columns->find("position")) o.position_columns = Column::list_from(*position, 3);
  return o;
}

TimeMarkFileOptions TimeMarkFileOptions::of_file(const std::filesystem::path& file) {
  TimeMarkFileOptions o;
  o.file = file;
  return o;
}

record::TimeMarkRecording read_time_marks(const TimeMarkFileOptions& options, std::optional<geo::GpsTime> near) {
  record::TimeMarkRecording recording;
  if (const Format* format = own_format(options))
    recording = format->read_time_marks(options.file);
  else if (options.time_columns.empty() && is_rinex(options.file))
    recording = marks_of_rinex(options.file);
  else
    recording = read_as(options.file, FileKind::Content::kPositions, "a table of events",
                        [&] { return read_time_mark_table(options, near); });
  if (recording.marks.empty()) throw InputError({recording.source, 0, "no time mark that can be used", "at least one", ""});
  if (options.edge) keep_edge(*options.edge, recording);
  std::ranges::stable_sort(recording.marks, {}, &record::TimeMark::t);
  return recording;
}

}  // namespace coast::io
