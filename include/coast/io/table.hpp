#pragma once
// Tables of numbers as text: comma, semicolon, tab or white space between columns, with or without a header line. Used by all
// text formats; only the requested columns are converted.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/input.hpp"
#include "coast/record/error.hpp"
#include "coast/record/table.hpp"

namespace coast::io {

/// A column by its name in the header line, or by its number, counted from 1.
struct Column {
  std::string name;
  int number = 0;  ///< 0: by name
  Column() = default;
  Column(std::string_view by_name) : name(by_name) {}  // NOLINT(google-explicit-constructor): lists of names read as such
  Column(const char* by_name) : name(by_name) {}       // NOLINT(google-explicit-constructor): as above
  Column(int by_number) : number(by_number) {}         // NOLINT(google-explicit-constructor): as above

  /// A scalar: digits alone are a number, anything else a name.
  [[nodiscard]] static Column from(const config::Node& node);
  /// A list of names or numbers, or a single one.  @param count 0: any length  @throws InputError another length than `count`
  [[nodiscard]] static std::vector<Column> list_from(const config::Node& node, std::size_t count);
  [[nodiscard]] bool empty() const { return number == 0 && name.empty(); }
  [[nodiscard]] std::string text() const { return number > 0 ? std::to_string(number) : name; }
};

/// Reads a table row by row.
///
/// Lines that start with '#' or '%' are comments, blank lines are skipped. The first other line is a header if none of its
/// fields is a number. Fields may be quoted ("..."). `nan`, `inf` and empty fields give NaN, to be handled by the caller. Every
/// row must have as many columns as the first one. A last line that was cut off, and up to three lines of other text at the end
/// of the file, are left out with an event.
class TableReader {
 public:
  /// Opens the file and reads up to the first row.  @throws InputError no rows, or an error of ByteSource
  explicit TableReader(const std::filesystem::path& path);
  /// Rows of numbers only; a line in a message is a row, counted from 1.  @throws InputError no rows, columns of different
  /// lengths
  explicit TableReader(std::shared_ptr<const record::Table> table);

  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }      ///< empty where there is none
  [[nodiscard]] const std::vector<std::string>& comments() const { return comments_; }  ///< those before the first row
  [[nodiscard]] std::vector<std::string> first_fields() const;                          ///< of the first row, as text
  [[nodiscard]] bool has(std::string_view name) const;
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] char delimiter() const { return delimiter_; }  ///< ' ' for white space

  /// Requests a column as number or text; returns its slot. All calls must come before the first `next`.
  /// @throws InputError  no such column (lists the existing ones, the nearest first)
  [[nodiscard]] std::size_t number_slot(const Column& column, std::string_view role);
  [[nodiscard]] std::size_t text_slot(const Column& column, std::string_view role);

  /// The next row; false at the end.  @throws InputError wrong number of columns, not a number: with the line
  [[nodiscard]] bool next();
  [[nodiscard]] double number(std::size_t slot) const { return numbers_[slot]; }
  [[nodiscard]] std::string_view text(std::size_t slot) const { return texts_[slot]; }
  /// True if every requested number is finite in this row.
  [[nodiscard]] bool finite() const { return finite_; }

  [[nodiscard]] long line() const { return line_; }
  [[nodiscard]] long rows() const { return rows_; }  ///< returned so far
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Expected total number of rows, from the lengths of the file and of the first row; for reserving memory.
  [[nodiscard]] std::size_t expected_rows() const;
  /// The error to throw for the current row.
  [[nodiscard]] InputError error(std::string found, std::string expected = "", std::string what_to_do = "") const;
  [[nodiscard]] const record::Events& events() const { return events_; }

 private:
  struct Step {
    std::size_t field;
    std::size_t slot;
    bool text;
  };
  struct Problem {
    std::string found, expected, what_to_do;
  };
  [[nodiscard]] std::size_t add_slot(const Column& column, std::string_view role, bool text);
  [[nodiscard]] std::size_t find(const Column& column, std::string_view role) const;
  void recognise_first_lines();
  [[nodiscard]] bool next_in_memory();
  void take_header(std::string_view line);
  [[nodiscard]] bool next_line(std::string_view& line);
  [[nodiscard]] bool parse(std::string_view line);
  [[nodiscard]] bool parse_plain(std::string_view line);
  [[nodiscard]] bool parse_blank(std::string_view line);
  [[nodiscard]] bool parse_fields(std::string_view line);
  [[nodiscard]] bool take_number(std::string_view field, const Step& step);
  [[nodiscard]] bool wrong_columns(std::size_t count);
  void leave_out_the_rest();
  void note_tail(std::string_view text, long first_line, long count);

  std::string name_;
  std::optional<LineReader> lines_;  ///< of a file
  std::shared_ptr<const record::Table> memory_;
  char delimiter_ = ',';
  std::vector<std::string> header_, comments_;
  std::string first_row_;
  long first_row_line_ = 0;
  bool first_row_pending_ = true;
  std::size_t columns_ = 0;
  std::vector<Step> plan_;  ///< in the order of fields
  std::vector<double> numbers_;
  std::vector<std::string_view> texts_;
  std::vector<std::string_view> fields_;  ///< work space for rows with quotes
  std::size_t last_field_length_ = 0;     ///< of the previous row, to detect a number that was cut off
  bool finite_ = true;
  long line_ = 0;
  long rows_ = 0;
  Problem problem_;
  record::Events events_;
};

/// The table if there is one, else the file.
[[nodiscard]] inline TableReader table_reader(const std::filesystem::path& file,
                                              const std::shared_ptr<const record::Table>& table) {
  return table ? TableReader(table) : TableReader(file);
}

}  // namespace coast::io
