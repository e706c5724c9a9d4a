// Page <-> JSON, schema "coast.page/1". Members at their default are left out; the readers below take the same defaults.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>

#include "coast/record/error.hpp"
#include "coast/report/render.hpp"
#include "pack.hpp"

namespace coast::report {
namespace {

using nlohmann::json;

constexpr std::string_view kSchema = "coast.page/1";

// Names of the enumerators, in their order.
constexpr std::array<std::string_view, 4> kVerdicts{"none", "good", "warn", "bad"};
constexpr std::array<std::string_view, 19> kTones{"auto",    "x",     "y",     "z",    "forward", "smoothed", "reference",
                                                  "muted",   "fixed", "float", "sbas", "dgps",    "single",   "ppp",
                                                  "unknown", "good",  "warn",  "bad",  "faint"};
constexpr std::array<std::string_view, 3> kScales{"linear", "log", "time"};
constexpr std::array<std::string_view, 3> kStyles{"line", "dashed", "steps"};
constexpr std::array<std::string_view, 3> kNoteKinds{"info", "warning", "code"};

using Words = std::span<const std::string_view>;

template <typename Enum>
std::string word_of(Enum value, Words words) {
  return std::string(words[static_cast<std::size_t>(value)]);
}

template <typename Enum>
Enum enum_of(const json& node, const char* key, Words words) {
  const std::string word = node.value(key, std::string(words.front()));
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) throw std::invalid_argument(fmt::format("{}: unknown word '{}'", key, word));
  return static_cast<Enum>(found - words.begin());
}

/// Writes `value` under `key` unless it is the default of its type's member.
template <typename Value>
void put(json& node, const char* key, const Value& value, const Value& fallback = {}) {
  if (value != fallback) node[key] = value;
}

template <typename Enum>
void put_word(json& node, const char* key, Enum value, Words words) {
  if (value != Enum{}) node[key] = word_of(value, words);
}

std::string text(const json& node, const char* key) {
  return node.value(key, std::string{});
}

template <typename Item, typename Write>
void put_list(json& node, const char* key, const std::vector<Item>& items, Write write) {
  if (items.empty()) return;
  json& list = node[key] = json::array();
  for (const Item& item : items) list.push_back(write(item));
}

template <typename Item, typename Read>
std::vector<Item> read_list(const json& node, const char* key, Read read) {
  std::vector<Item> items;
  if (!node.contains(key)) return items;
  for (const json& item : node.at(key)) items.push_back(read(item));
  return items;
}

void require_length(std::size_t expected, std::size_t found, const std::string& what) {
  if (expected != found) throw std::invalid_argument(fmt::format("{}: {} values, expected {}", what, found, expected));
}

// --- curves

json write_series(const Series& series, const std::string& what) {
  require_length(series.x.size(), series.y.size(), what + ", y");
  json node{{"x", pack_abscissae(series.x)}, {"y", pack_floats(series.y)}};
  if (!series.t.empty()) {
    require_length(series.x.size(), series.t.size(), what + ", t");
    node["t"] = pack_abscissae(series.t);
  }
  if (!series.half_width.empty()) {
    require_length(series.x.size(), series.half_width.size(), what + ", half width");
    node["half_width"] = pack_floats(series.half_width);
  }
  if (!series.breaks.empty()) node["breaks"] = series.breaks;
  put(node, "not_finite", series.not_finite);
  if (series.band) {
    require_length(series.band->x.size(), series.band->lower.size(), what + ", lower bound");
    require_length(series.band->x.size(), series.band->upper.size(), what + ", upper bound");
    json& band = node["band"] = {{"x", pack_abscissae(series.band->x)},
                                 {"lower", pack_floats(series.band->lower)},
                                 {"upper", pack_floats(series.band->upper)}};
    if (!series.band->breaks.empty()) band["breaks"] = series.band->breaks;
  }
  return node;
}

Series read_series(const json& node, const std::string& what) {
  Series series;
  series.x = unpack(node.at("x"));
  series.y = unpack(node.at("y"));
  require_length(series.x.size(), series.y.size(), what + ", y");
  if (node.contains("t")) {
    series.t = unpack(node.at("t"));
    require_length(series.x.size(), series.t.size(), what + ", t");
  }
  if (node.contains("half_width")) {
    series.half_width = unpack(node.at("half_width"));
    require_length(series.x.size(), series.half_width.size(), what + ", half width");
  }
  series.breaks = node.value("breaks", series.breaks);
  series.not_finite = node.value("not_finite", series.not_finite);
  if (node.contains("band")) {
    const json& stored = node.at("band");
    Series::Band& band = series.band.emplace();
    band.x = unpack(stored.at("x"));
    band.lower = unpack(stored.at("lower"));
    band.upper = unpack(stored.at("upper"));
    band.breaks = stored.value("breaks", band.breaks);
    require_length(band.x.size(), band.lower.size(), what + ", lower bound");
    require_length(band.x.size(), band.upper.size(), what + ", upper bound");
  }
  return series;
}

// --- what a plot holds

json write_axis(const Axis& axis) {
  json node = json::object();
  put(node, "label", axis.label);
  put(node, "unit", axis.unit);
  put_word(node, "scale", axis.scale, kScales);
  put_list(node, "ticks", axis.ticks, [](const Axis::Tick& tick) { return json{tick.value, tick.label}; });
  if (axis.range) node["range"] = {axis.range->first, axis.range->second};
  return node;
}

Axis read_axis(const json& node) {
  Axis axis{text(node, "label"), text(node, "unit"), enum_of<Axis::Scale>(node, "scale", kScales), {}, {}};
  axis.ticks = read_list<Axis::Tick>(node, "ticks", [](const json& tick) {
    return Axis::Tick{tick.at(0).get<double>(), tick.at(1).get<std::string>()};
  });
  if (node.contains("range")) axis.range.emplace(node.at("range").at(0).get<double>(), node.at("range").at(1).get<double>());
  return axis;
}

json write_line(const Line& line) {
  json node{{"label", line.label}, {"series", write_series(line.series, line.label)}};
  put_word(node, "tone", line.tone, kTones);
  put_word(node, "style", line.style, kStyles);
  put(node, "band_label", line.band_label);
  put(node, "width_px", line.width_px, Line{}.width_px);
  put(node, "hidden", line.hidden);
  return node;
}

Line read_line(const json& node) {
  return {text(node, "label"),
          read_series(node.at("series"), text(node, "label")),
          enum_of<Tone>(node, "tone", kTones),
          enum_of<Line::Style>(node, "style", kStyles),
          text(node, "band_label"),
          node.value("width_px", Line{}.width_px),
          node.value("hidden", false)};
}

json write_points(const Points& points) {
  json node{{"label", points.label}, {"series", write_series(points.series, points.label)}};
  put_word(node, "tone", points.tone, kTones);
  put(node, "radius_px", points.radius_px, Points{}.radius_px);
  return node;
}

Points read_points(const json& node) {
  return {text(node, "label"), read_series(node.at("series"), text(node, "label")), enum_of<Tone>(node, "tone", kTones),
          node.value("radius_px", Points{}.radius_px)};
}

json write_bars(const Bars& bars) {
  require_length(bars.heights.empty() ? 0 : bars.heights.size() + 1, bars.edges.size(), bars.label + ", edges");
  json node{{"label", bars.label}, {"edges", pack_abscissae(bars.edges)}, {"heights", pack_floats(bars.heights)}};
  put_word(node, "tone", bars.tone, kTones);
  return node;
}

Bars read_bars(const json& node) {
  return {text(node, "label"), unpack(node.at("edges")), unpack(node.at("heights")), enum_of<Tone>(node, "tone", kTones)};
}

json write_boxes(const Boxes& boxes) {
  json node{{"label", boxes.label}};
  json& list = node["boxes"] = json::array();
  for (const Boxes::Box& box : boxes.boxes) list.push_back({box.y, box.q05, box.q25, box.median, box.q75, box.q95});
  put_word(node, "tone", boxes.tone, kTones);
  return node;
}

Boxes read_boxes(const json& node) {
  const auto box = [](const json& values) {
    const auto v = values.get<std::array<double, 6>>();
    return Boxes::Box{v[0], v[1], v[2], v[3], v[4], v[5]};
  };
  return {text(node, "label"), read_list<Boxes::Box>(node, "boxes", box), enum_of<Tone>(node, "tone", kTones)};
}

json write_interval(const Interval& interval) {
  json node{{"from", interval.from}, {"to", interval.to}};
  put(node, "label", interval.label);
  put_word(node, "tone", interval.tone, kTones);
  return node;
}

Interval read_interval(const json& node) {
  return {node.at("from").get<double>(), node.at("to").get<double>(), text(node, "label"), enum_of<Tone>(node, "tone", kTones)};
}

json write_bound(const Bound& bound) {
  json node{{"value", bound.value}};
  put(node, "label", bound.label);
  put_word(node, "tone", bound.tone, kTones);
  return node;
}

Bound read_bound(const json& node) {
  return {node.at("value").get<double>(), text(node, "label"), enum_of<Tone>(node, "tone", kTones)};
}

json write_mark(const Mark& mark) {
  return {{"x", mark.x}, {"y", mark.y}, {"label", mark.label}};
}

Mark read_mark(const json& node) {
  return {node.at("x").get<double>(), node.at("y").get<double>(), text(node, "label")};
}

json write_plot(const Plot& plot) {
  json node{{"x", write_axis(plot.x)}, {"y", write_axis(plot.y)}};
  put(node, "title", plot.title);
  put_list(node, "lines", plot.lines, write_line);
  put_list(node, "points", plot.points, write_points);
  put_list(node, "bars", plot.bars, write_bars);
  put_list(node, "boxes", plot.boxes, write_boxes);
  put_list(node, "intervals", plot.intervals, write_interval);
  put_list(node, "bounds", plot.bounds, write_bound);
  put_list(node, "marks", plot.marks, write_mark);
  put(node, "equal_aspect", plot.equal_aspect);
  put(node, "sky", plot.sky);
  put(node, "link", plot.link);
  put(node, "height_px", plot.height_px);
  return node;
}

Plot read_plot(const json& node) {
  return {text(node, "title"),
          read_axis(node.at("x")),
          read_axis(node.at("y")),
          read_list<Line>(node, "lines", read_line),
          read_list<Points>(node, "points", read_points),
          read_list<Bars>(node, "bars", read_bars),
          read_list<Boxes>(node, "boxes", read_boxes),
          read_list<Interval>(node, "intervals", read_interval),
          read_list<Bound>(node, "bounds", read_bound),
          read_list<Mark>(node, "marks", read_mark),
          node.value("equal_aspect", false),
          node.value("sky", false),
          text(node, "link"),
          node.value("height_px", 0)};
}

// --- what a page holds

json write_panel(const Panel& panel) {
  json node{{"id", panel.id}, {"title", panel.title}};
  put(node, "caption", panel.caption);
  put(node, "columns", panel.columns, 1);
  put_list(node, "plots", panel.plots, write_plot);
  return node;
}

Panel read_panel(const json& node) {
  return {text(node, "id"), text(node, "title"), text(node, "caption"), node.value("columns", 1),
          read_list<Plot>(node, "plots", read_plot)};
}

json write_cell(const Cell& cell) {
  if (cell.verdict == Verdict::kNone) return cell.text;
  return {{"text", cell.text}, {"verdict", word_of(cell.verdict, kVerdicts)}};
}

Cell read_cell(const json& node) {
  if (node.is_string()) return {node.get<std::string>(), Verdict::kNone};
  return {text(node, "text"), enum_of<Verdict>(node, "verdict", kVerdicts)};
}

json write_column(const Table::Column& column) {
  json node{{"label", column.label}};
  put(node, "unit", column.unit);
  put(node, "numeric", column.numeric, true);
  return node;
}

json write_table(const Table& table) {
  json node{{"id", table.id}, {"title", table.title}};
  put(node, "caption", table.caption);
  put_list(node, "columns", table.columns, write_column);
  put_list(node, "rows", table.rows, [&](const std::vector<Cell>& row) {
    require_length(table.columns.size(), row.size(), table.id + ", cells of a row");
    json cells = json::array();
    for (const Cell& cell : row) cells.push_back(write_cell(cell));
    return cells;
  });
  return node;
}

Table read_table(const json& node) {
  Table table{text(node, "id"), text(node, "title"), text(node, "caption"), {}, {}};
  table.columns = read_list<Table::Column>(node, "columns", [](const json& column) {
    return Table::Column{text(column, "label"), text(column, "unit"), column.value("numeric", true)};
  });
  table.rows = read_list<std::vector<Cell>>(node, "rows", [](const json& row) {
    std::vector<Cell> cells;
    for (const json& cell : row) cells.push_back(read_cell(cell));
    return cells;
  });
  return table;
}

json write_note(const Note& note) {
  json node{{"text", note.text}};
  put_word(node, "kind", note.kind, kNoteKinds);
  put(node, "title", note.title);
  return node;
}

Note read_note(const json& node) {
  return {enum_of<Note::Kind>(node, "kind", kNoteKinds), text(node, "title"), text(node, "text")};
}

json write_section(const Section& section) {
  json node{{"id", section.id}, {"title", section.title}};
  put(node, "lead", section.lead);
  put_list(node, "notes", section.notes, write_note);
  put_list(node, "tables", section.tables, write_table);
  put_list(node, "panels", section.panels, write_panel);
  return node;
}

Section read_section(const json& node) {
  return {text(node, "id"),
          text(node, "title"),
          text(node, "lead"),
          read_list<Note>(node, "notes", read_note),
          read_list<Table>(node, "tables", read_table),
          read_list<Panel>(node, "panels", read_panel)};
}

json write_tile(const Tile& tile) {
  json node{{"label", tile.label}, {"value", tile.value}};
  put(node, "unit", tile.unit);
  put_word(node, "verdict", tile.verdict, kVerdicts);
  put(node, "explanation", tile.explanation);
  put(node, "section", tile.section);
  put_list(node, "shares", tile.shares, [](const Tile::Share& share) {
    return json{{"label", share.label}, {"fraction", share.fraction}, {"tone", word_of(share.tone, kTones)}};
  });
  return node;
}

Tile read_tile(const json& node) {
  Tile tile{text(node, "label"),       text(node, "value"),
            text(node, "unit"),        enum_of<Verdict>(node, "verdict", kVerdicts),
            text(node, "explanation"), {},
            text(node, "section")};
  tile.shares = read_list<Tile::Share>(node, "shares", [](const json& share) {
    return Tile::Share{text(share, "label"), share.at("fraction").get<double>(), enum_of<Tone>(share, "tone", kTones)};
  });
  return tile;
}

void require_unique_ids(const Page& page) {
  std::set<std::string> seen;
  const auto take = [&](const std::string& id, const std::string& title) {
    const auto allowed = [](char c) {
      return c == '-' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    if (id.empty() || !std::all_of(id.begin(), id.end(), allowed)) {
      throw std::invalid_argument(fmt::format("page: id '{}' of \"{}\", expected letters, digits, '-'", id, title));
    }
    if (!seen.insert(id).second) throw std::invalid_argument(fmt::format("page: the id '{}' occurs twice", id));
  };
  for (const Section& section : page.sections) {
    take(section.id, section.title);
    for (const Table& table : section.tables) take(table.id, table.title);
    for (const Panel& panel : section.panels) take(panel.id, panel.title);
  }
}

Page read_page(const json& node) {
  Page page;
  page.title = text(node, "title");
  page.subtitle = text(node, "subtitle");
  page.footer = text(node, "footer");
  if (node.contains("start")) page.start = geo::GpsTime::from_nanoseconds(node.at("start").at("gps_ns").get<std::int64_t>());
  page.tiles = read_list<Tile>(node, "tiles", read_tile);
  page.sections = read_list<Section>(node, "sections", read_section);
  return page;
}

}  // namespace

std::string to_json(const Page& page) {
  require_unique_ids(page);
  json node{{"schema", kSchema}, {"title", page.title}};
  put(node, "subtitle", page.subtitle);
  put(node, "footer", page.footer);
  if (page.start) {
    node["start"] = {{"gps_ns", page.start->nanoseconds()},
                     {"week", page.start->week()},
                     {"sow", page.start->sow()},
                     {"text", geo::to_string(*page.start)}};
  }
  put_list(node, "tiles", page.tiles, write_tile);
  put_list(node, "sections", page.sections, write_section);
  return node.dump(-1, ' ', false, json::error_handler_t::replace);
}

Page from_json(std::string_view text, const std::string& source) {
  const auto refuse = [&](const std::string& found) {
    return InputError(
        {source, 0, found, "a page of schema " + std::string(kSchema), "Run coast process again to make it anew."});
  };
  try {
    const json node = json::parse(text);
    if (!node.is_object() || node.value("schema", std::string{}) != kSchema) throw refuse("another schema");
    return read_page(node);
  } catch (const json::exception& error) {
    throw refuse(error.what());
  } catch (const std::invalid_argument& error) {
    throw refuse(error.what());
  }
}

}  // namespace coast::report
