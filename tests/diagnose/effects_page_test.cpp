// docs/effects.md has a row for every effect.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "coast/diagnose/effect.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/diagnose/sample_effect.hpp"

namespace coast {
namespace {

/// Columns of the page's tables.
enum PageColumn : std::size_t { kNameCell, kSensorCell, kAxesCell, kParameterCell, kUnitCell, kEquationCell, kPageColumns = 8 };
using PageRow = std::vector<std::string>;

std::string without_margin(std::string_view text, std::string_view margin) {
  while (!text.empty() && margin.find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && margin.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return std::string(text);
}

/// Cells of "| one | two |": spaces and backticks about them left out, "\|" as the character that it stands for.
PageRow page_row(const std::string& line) {
  PageRow cells;
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|') {
      cell += line[++i];
    } else if (line[i] == '|') {
      cells.push_back(without_margin(cell, " `"));
      cell.clear();
    } else {
      cell += line[i];
    }
  }
  return cells;
}

std::vector<PageRow> effects_page() {
  std::ifstream stream(COAST_SOURCE_DIR "/docs/effects.md");
  std::vector<PageRow> rows;
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("| `")) rows.push_back(page_row(line));
  return rows;
}

template <typename Entry>
void expect_on_page(const std::vector<Entry>& entries, const std::vector<PageRow>& page) {
  for (const Entry& e : entries) {
    const auto is_its = [&e](const PageRow& row) {
      return row.size() == kPageColumns && row[kNameCell] == e.name && row[kSensorCell] == diagnose::name(e.site) &&
             row[kParameterCell] == e.parameter && row[kUnitCell] == e.unit;
    };
    const auto row = std::ranges::find_if(page, is_its);
    ASSERT_NE(row, page.end()) << "no row | `" << e.name << "` | " << diagnose::name(e.site) << " | .. | " << e.parameter
                               << " | " << e.unit << " |";
    EXPECT_EQ(std::ranges::count_if(page, is_its), 1) << e.name;
    EXPECT_TRUE((*row)[kEquationCell].starts_with(e.equation)) << e.name << ": " << (*row)[kEquationCell];
  }
}

TEST(EffectsPage, HasARowForEveryEffect) {
  const std::vector<PageRow> page = effects_page();
  ASSERT_FALSE(page.empty());
  expect_on_page(diagnose::catalogue(), page);
  expect_on_page(diagnose::noise_catalogue(), page);
  expect_on_page(diagnose::sample_catalogue(), page);
}

TEST(EffectsPage, NamesTheAxesOfEveryEffect) {
  const std::vector<PageRow> page = effects_page();
  for (const diagnose::Effect& e : diagnose::catalogue()) {
    std::string axes;
    for (const std::string& axis : e.axes) axes += (axes.empty() ? "" : ", ") + axis;
    if (axes.empty()) axes.push_back('-');
    if (e.axes == diagnose::nine_pairs()) axes = "all nine pairs";
    EXPECT_TRUE(std::ranges::any_of(page,
                                    [&](const PageRow& row) {
                                      return row.size() == kPageColumns && row[kNameCell] == e.name &&
                                             row[kSensorCell] == diagnose::name(e.site) && row[kAxesCell] == axes;
                                    }))
        << e.name << ": " << axes;
  }
}

}  // namespace
}  // namespace coast
