// Page <-> JSON, schema "coast.page/1". Members with default values are omitted; the readers have the same defaults.

#include <set>

#include "coast/record/error.hpp"
#include "coast/report/render.hpp"
#include "json_parts.hpp"

namespace coast::report {
namespace {

constexpr std::string_view kSchema = "coast.page/1";

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
