// coast_report_sample DIR: writes DIR/report.html, DIR/report.json and DIR/expected.json of the sample page; the last holds
// sums over every line as they are before packing, for decode_test.mjs.

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "coast/report/render.hpp"
#include "sample_page.hpp"

namespace {

nlohmann::json sums(const std::vector<double>& values) {
  return {{"n", values.size()}, {"sum", std::accumulate(values.begin(), values.end(), 0.0)}, {"last", values.back()}};
}

nlohmann::json expected(const coast::report::Page& page) {
  nlohmann::json lines = nlohmann::json::array();
  for (const auto& section : page.sections) {
    for (const auto& panel : section.panels) {
      for (const auto& plot : panel.plots) {
        for (const auto& line : plot.lines) {
          lines.push_back({{"label", line.label}, {"x", sums(line.series.x)}, {"y", sums(line.series.y)}});
          if (line.series.band) lines.back()["upper"] = sums(line.series.band->upper);
        }
      }
    }
  }
  return lines;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: coast_report_sample DIR\n";
    return 2;
  }
  const std::string directory = argv[1];
  const coast::report::Page page = coast::test::sample_page();
  std::ofstream html(directory + "/report.html");
  std::ofstream json(directory + "/report.json");
  std::ofstream sums(directory + "/expected.json");
  html << coast::report::render(page);
  json << coast::report::to_json(page);
  sums << expected(page);
  html.flush();
  json.flush();
  sums.flush();
  return html && json && sums ? 0 : 1;
}
