#include "coast/io/table.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "text.hpp"

namespace coast::io {

namespace {

constexpr long kMaxTrailingLines = 3;   // other text after the last row that is treated as a footer
constexpr long kRowsBeforeFooter = 10;  // but only after this number of valid rows

bool is_comment(std::string_view line) {
  return !line.empty() && (line.front() == '#' || line.front() == '%');
}

char delimiter_of(std::string_view line) {
  for (const char c : {';', ',', '\t'})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

std::string hint_for(std::string_view field) {
  const bool decimal_comma =
      std::count(field.begin(), field.end(), ',') == 1 && field.find_first_not_of("+-0123456789,eE ") == std::string_view::npos;
  return decimal_comma ? "Write decimals with a point, not a comma." : "";
}

}  // namespace

Column Column::from(const config::Node& node) {
  const std::string text = node.text();
  const bool digits =
      !text.empty() && text.size() < 6 && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits) return Column(std::string_view(text));
  const int number = std::stoi(text);
  if (number == 0) throw node.error("column 0", "a name, or a number from 1", "Columns are counted from 1.");
  return Column(number);
}

std::vector<Column> Column::list_from(const config::Node& node, std::size_t count) {
  std::vector<Column> columns;
  if (node.is_list())
    for (const config::Node& item : node.items()) columns.push_back(from(item));
  else
    columns.push_back(from(node));
  if (count > 0 && columns.size() != count)
    throw node.error(fmt::format("{} columns", columns.size()), fmt::format("{}", count), "");
  return columns;
}

TableReader::TableReader(const std::filesystem::path& path) : lines_(path) {
  name_ = lines_->name();
  recognise_first_lines();
}

TableReader::TableReader(std::shared_ptr<const record::Table> table)
    : name_(table->name), memory_(std::move(table)), header_(memory_->header), columns_(memory_->columns.size()) {
  const auto& columns = memory_->columns;
  if (header_.size() != columns.size()) throw std::invalid_argument("a table with as many names as columns");
  for (std::size_t i = 1; i < columns.size(); ++i)
    if (columns[i].size() != columns[0].size())
      throw InputError(
          {name_, 0, fmt::format("{} values of {} and {} of {}", columns[i].size(), header_[i], columns[0].size(), header_[0]),
           "columns of equal lengths", ""});
  if (columns.empty() || columns[0].empty()) throw InputError({name_, 0, "no row of numbers", "a table", ""});
}

void TableReader::recognise_first_lines() {
  std::string_view line;
  while (lines_->next(line)) {
    if (is_comment(line)) {
      comments_.emplace_back(line);
      continue;
    }
    if (trimmed(line).empty()) continue;
    delimiter_ = delimiter_of(line);
    split(line, delimiter_, fields_);
    const bool any_number =
        std::any_of(fields_.begin(), fields_.end(), [](auto f) { return parse_number(unquoted(f)).has_value(); });
    if (!any_number && header_.empty()) {
      take_header(line);
      continue;
    }
    first_row_ = line;
    first_row_line_ = lines_->line_number();
    columns_ = fields_.size();
    // The views in fields_ must not outlive this line.
    fields_.clear();
    break;
  }
  line_ = first_row_line_;
  if (first_row_.empty()) throw InputError({name(), lines_->line_number(), "no row of numbers", "a table", ""});
  const auto names = static_cast<std::size_t>(
      std::distance(std::find_if(header_.rbegin(), header_.rend(), [](const auto& n) { return !n.empty(); }), header_.rend()));
  if (names > columns_)
    throw error(fmt::format("{} columns below a header of {} names", columns_, names), "as many columns as names");
}

void TableReader::take_header(std::string_view line) {
  for (const std::string_view field : fields_) header_.emplace_back(unquoted(field));
  if (std::all_of(header_.begin(), header_.end(), [](const auto& n) { return n.empty(); }))
    throw InputError({name(), lines_->line_number(), fmt::format("\"{}\"", excerpt(line)), "a header or a row of numbers", ""});
}

bool TableReader::has(std::string_view column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

std::vector<std::string> TableReader::first_fields() const {
  std::vector<std::string> texts;
  if (memory_) {
    for (const std::vector<double>& column : memory_->columns) texts.push_back(fmt::format("{}", column.front()));
    return texts;
  }
  std::vector<std::string_view> fields;
  split(first_row_, delimiter_, fields);
  texts.reserve(fields.size());
  for (const std::string_view field : fields) texts.emplace_back(unquoted(field));
  return texts;
}

std::size_t TableReader::find(const Column& column, std::string_view role) const {
  if (column.number > 0) {
    if (static_cast<std::size_t>(column.number) <= columns_) return static_cast<std::size_t>(column.number) - 1;
    throw InputError({name(), first_row_line_, fmt::format("{} columns", columns_),
                      fmt::format("column {} ({})", column.number, role), "Columns are counted from 1."});
  }
  if (header_.empty())
    throw InputError({name(), first_row_line_, "no header line above the first row",
                      fmt::format("a column named \"{}\" ({})", column.name, role),
                      "Give the column's number under `columns:`."});
  const auto it = std::find(header_.begin(), header_.end(), column.name);
  if (it == header_.end()) {
    const std::string near = config::nearest(column.name, header_);
    throw InputError({name(), 0, fmt::format("no column named \"{}\" ({})", column.name, role),
                      fmt::format("one of: {}", fmt::join(header_, ", ")),
                      near.empty() ? "Map the columns under `columns:`." : fmt::format("Do you mean \"{}\"?", near)});
  }
  if (std::find(it + 1, header_.end(), column.name) != header_.end())
    throw InputError({name(), 0, fmt::format("two columns named \"{}\" ({})", column.name, role), "one",
                      "Give the column's number under `columns:`."});
  return static_cast<std::size_t>(it - header_.begin());
}

std::size_t TableReader::add_slot(const Column& column, std::string_view role, bool text) {
  const std::size_t slot = text ? texts_.size() : numbers_.size();
  const Step step{find(column, role), slot, text};
  plan_.insert(
      std::upper_bound(plan_.begin(), plan_.end(), step, [](const Step& a, const Step& b) { return a.field < b.field; }), step);
  if (text)
    texts_.emplace_back();
  else
    numbers_.push_back(0.0);
  return slot;
}

std::size_t TableReader::number_slot(const Column& column, std::string_view role) {
  return add_slot(column, role, false);
}
std::size_t TableReader::text_slot(const Column& column, std::string_view role) {
  if (memory_)
    throw InputError({name_, 0, fmt::format("numbers in column {} ({})", column.text(), role), "text, which only files have",
                      "Give times as numbers, for instance seconds of week."});
  return add_slot(column, role, true);
}

std::size_t TableReader::expected_rows() const {
  if (memory_) return memory_->columns.front().size();
  return static_cast<std::size_t>(lines_->expected_size() / (first_row_.size() + 1)) + 16;
}

InputError TableReader::error(std::string found, std::string expected, std::string what_to_do) const {
  return InputError({name(), line_, std::move(found), std::move(expected), std::move(what_to_do)});
}

bool TableReader::next_line(std::string_view& line) {
  if (first_row_pending_) {
    first_row_pending_ = false;
    line = first_row_;
    line_ = first_row_line_;
    return true;
  }
  while (lines_->next(line)) {
    line_ = lines_->line_number();
    if (!is_comment(line) && !trimmed(line).empty()) return true;
  }
  for (const record::Event& event : lines_->events()) events_.push_back(event);
  return false;
}

bool TableReader::next_in_memory() {
  const auto row = static_cast<std::size_t>(rows_);
  if (row == memory_->columns.front().size()) return false;
  finite_ = true;
  for (const Step& step : plan_) {
    const double value = memory_->columns[step.field][row];
    numbers_[step.slot] = value;
    if (!std::isfinite(value)) finite_ = false;
  }
  line_ = ++rows_;
  return true;
}

bool TableReader::next() {
  if (memory_) return next_in_memory();
  std::string_view line;
  if (!next_line(line)) return false;
  const std::size_t previous_length = last_field_length_;
  const bool good = parse(line);
  // A last line without a line feed may be incomplete. Missing fields are detected; a last number shorter than the one above
  // may have lost digits.
  const bool cut_off = !lines_->terminated() && rows_ > 0 && (!good || last_field_length_ < previous_length);
  if (good && !cut_off) {
    ++rows_;
    return true;
  }
  if (cut_off)
    note_tail(line, line_, 1);
  else
    leave_out_the_rest();
  for (const record::Event& event : lines_->events()) events_.push_back(event);
  return false;
}

void TableReader::leave_out_the_rest() {
  const InputError refused = error(problem_.found, problem_.expected, problem_.what_to_do);
  if (rows_ < kRowsBeforeFooter) throw refused;
  const long first = line_;
  long count = 1;
  std::string_view line;
  std::string text;
  while (next_line(line)) {
    if (++count > kMaxTrailingLines || parse(line)) throw refused;
    text = line;
  }
  note_tail(text, first, count);
}

void TableReader::note_tail(std::string_view text, long first_line, long count) {
  events_.push_back(
      {record::Event::Severity::kWarning, "trailing_garbage",
       fmt::format("{}:{}: the file ends with {} that {} no whole row (\"{}\"); left out", name(), first_line,
                   count == 1 ? "a line" : fmt::format("{} lines", count), count == 1 ? "is" : "are", excerpt(text)),
       std::nullopt, count});
}

bool TableReader::parse(std::string_view line) {
  finite_ = true;
  if (std::memchr(line.data(), '"', line.size()) != nullptr) return parse_fields(line);
  return delimiter_ == ' ' ? parse_blank(line) : parse_plain(line);
}

bool TableReader::wrong_columns(std::size_t count) {
  problem_ = {fmt::format("{} column{}", count, count == 1 ? "" : "s"), fmt::format("{}", columns_),
              "Is the line cut off, or does the table change here?"};
  return false;
}

// One pass from the left; unused columns are skipped by memchr.
bool TableReader::parse_plain(std::string_view line) {
  const char* p = line.data();
  const char* const end = p + line.size();
  std::size_t field = 0;
  const auto field_end = [&](const char* from) {
    const auto* d = static_cast<const char*>(std::memchr(from, delimiter_, static_cast<std::size_t>(end - from)));
    return d != nullptr ? d : end;
  };
  for (const Step& step : plan_) {
    for (; field < step.field; ++field) {
      p = field_end(p);
      if (p == end) return wrong_columns(field + 1);
      ++p;
    }
    if (!step.text) {
      const char* q = p;
      while (q < end && is_blank(*q)) ++q;
      const auto [stop, status] = fast_float::from_chars(q, end, numbers_[step.slot]);
      if (status == std::errc() && (stop == end || *stop == delimiter_)) {
        if (!std::isfinite(numbers_[step.slot])) finite_ = false;
        continue;
      }
    }
    const std::string_view text(p, static_cast<std::size_t>(field_end(p) - p));
    if (step.text)
      texts_[step.slot] = trimmed(text);
    else if (!take_number(text, step))
      return false;
  }
  std::size_t count = field + 1;
  const char* last = p;
  for (const char* d = field_end(p); d != end; d = field_end(last)) {
    last = d + 1;
    ++count;
  }
  last_field_length_ = static_cast<std::size_t>(end - last);
  return count == columns_ || wrong_columns(count);
}

bool TableReader::parse_blank(std::string_view line) {
  const char* p = line.data();
  const char* const end = p + line.size();
  std::size_t field = 0;
  auto step = plan_.begin();
  while (true) {
    while (p < end && is_blank(*p)) ++p;
    if (p == end) break;
    const char* const begin = p;
    bool at_end = false;
    for (; step != plan_.end() && step->field == field; ++step) {
      if (!step->text) {
        const auto [stop, status] = fast_float::from_chars(begin, end, numbers_[step->slot]);
        if (status == std::errc() && (stop == end || is_blank(*stop))) {
          if (!std::isfinite(numbers_[step->slot])) finite_ = false;
          p = stop;
          at_end = true;
          continue;
        }
      }
      const std::string_view text(begin, static_cast<std::size_t>(std::find_if(begin, end, is_blank) - begin));
      if (step->text)
        texts_[step->slot] = text;
      else if (!take_number(text, *step))
        return false;
    }
    if (!at_end) p = std::find_if(begin, end, is_blank);
    last_field_length_ = static_cast<std::size_t>(p - begin);
    ++field;
  }
  return field == columns_ || wrong_columns(field);
}

bool TableReader::parse_fields(std::string_view line) {
  split(line, delimiter_, fields_);
  if (fields_.size() != columns_) return wrong_columns(fields_.size());
  for (const Step& step : plan_) {
    const std::string_view field = unquoted(fields_[step.field]);
    if (step.text)
      texts_[step.slot] = field;
    else if (!take_number(field, step))
      return false;
  }
  last_field_length_ = fields_.back().size();
  return true;
}

bool TableReader::take_number(std::string_view field, const Step& step) {
  const std::string_view text = trimmed(field);
  const auto value = text.empty() ? std::numeric_limits<double>::quiet_NaN() : parse_number(text);
  if (!value) {
    const std::string column = step.field < header_.size() ? fmt::format(" ({})", header_[step.field]) : "";
    problem_ = {fmt::format("\"{}\" in column {}{}", excerpt(text), step.field + 1, column), "a number", hint_for(text)};
    return false;
  }
  numbers_[step.slot] = *value;
  if (!std::isfinite(*value)) finite_ = false;
  return true;
}

}  // namespace coast::io
