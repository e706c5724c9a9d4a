#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "coast/record/error.hpp"
#include "coast/report/panels.hpp"
#include "coast/report/render.hpp"
#include "sample_page.hpp"
#include "support/schema.hpp"

namespace coast::report {
namespace {

/// Every member of every struct away from its default.
Page full_page() {
  Page page;
  page.title = "a <title> & more";
  page.subtitle = "subtitle";
  page.footer = "footer";
  page.start = geo::GpsTime::from_week(2190, 457013.005);
  page.tiles = {{"label", "0.5", "m", Verdict::kWarn, "why", {{"fixed", 0.75, Tone::kFixed}}, "panel"}};
  Plot plot;
  plot.title = "cell";
  plot.x = {"time", "s", Axis::Scale::kTime, {}, std::pair{1.0, 2.0}};
  plot.y = {"N", "m", Axis::Scale::kLog, {{1.0, "one"}}, {}};
  Series series;
  series.x = {0.0, 1.0, 2.0};
  series.y = {1.0, -2.5, 4.0};
  series.t = {5.0, 6.0, 7.0};
  series.breaks = {2};
  series.not_finite = 3;
  series.half_width = {0.5, 0.25, 2.0};
  series.band = Series::Band{{0.0, 2.0}, {-1.0, -2.0}, {1.0, 2.0}, {1}};
  plot.lines = {{"line", series, Tone::kSmoothed, Line::Style::kSteps, "1 sigma", 2.0, true}};
  plot.points = {{"dots", series, Tone::kSingle, 3.0}};
  plot.bars = {{"bars", {0.0, 1.0, 2.0}, {3.0, 4.0}, Tone::kX}};
  plot.boxes = {{"boxes", {{1.0, -2.0, -1.0, 0.5, 1.0, 3.0}}, Tone::kY}};
  plot.intervals = {{0.5, 1.5, "outage", Tone::kBad}};
  plot.bounds = {{3.3, "gate", Tone::kWarn}};
  plot.marks = {{1.0, 2.0, "1"}};
  plot.equal_aspect = true;
  plot.sky = true;
  plot.link = "row";
  plot.height_px = 123;
  Section section{"section", "Section", "lead", {{Note::Kind::kCode, "yaml", "</script><!-- a: 1"}}, {}, {}};
  section.panels = {{"panel", "Panel", "caption", 3, {plot}}};
  section.tables = {{"table", "Table", "caption", {{"name", "", false}, {"value", "m"}}, {{{"a"}, {"1.0", Verdict::kBad}}}}};
  page.sections = {section};
  return page;
}

TEST(PageJson, RoundTripKeepsEveryMember) {
  const std::string first = to_json(full_page());
  const Page back = from_json(first, "report.json");
  EXPECT_EQ(to_json(back), first);
  const Plot& plot = back.sections.at(0).panels.at(0).plots.at(0);
  const Series& series = plot.lines.at(0).series;
  EXPECT_EQ(series.x, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_EQ(series.y, (std::vector<double>{1.0, -2.5, 4.0}));
  EXPECT_EQ(series.t, (std::vector<double>{5.0, 6.0, 7.0}));
  EXPECT_EQ(series.breaks, (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(series.not_finite, 3U);
  EXPECT_EQ(series.half_width, (std::vector<double>{0.5, 0.25, 2.0}));
  EXPECT_EQ(series.band->upper, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(series.band->breaks, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(plot.lines.at(0).style, Line::Style::kSteps);
  EXPECT_EQ(plot.lines.at(0).width_px, 2.0);
  EXPECT_TRUE(plot.lines.at(0).hidden);
  EXPECT_EQ(plot.points.at(0).tone, Tone::kSingle);
  EXPECT_EQ(plot.points.at(0).radius_px, 3.0);
  EXPECT_EQ(plot.bars.at(0).heights, (std::vector<double>{3.0, 4.0}));
  EXPECT_EQ(plot.boxes.at(0).boxes.at(0).median, 0.5);
  EXPECT_EQ(plot.boxes.at(0).boxes.at(0).q95, 3.0);
  EXPECT_EQ(plot.bounds.at(0).tone, Tone::kWarn);
  EXPECT_EQ(plot.intervals.at(0).label, "outage");
  EXPECT_EQ(plot.marks.at(0).label, "1");
  EXPECT_EQ(plot.x.range, (std::pair{1.0, 2.0}));
  EXPECT_EQ(plot.y.scale, Axis::Scale::kLog);
  EXPECT_EQ(plot.y.ticks.at(0).label, "one");
  EXPECT_TRUE(plot.equal_aspect);
  EXPECT_TRUE(plot.sky);
  EXPECT_EQ(plot.link, "row");
  EXPECT_EQ(plot.height_px, 123);
  EXPECT_EQ(back.start, full_page().start);
  EXPECT_EQ(back.tiles.at(0).shares.at(0).tone, Tone::kFixed);
  EXPECT_EQ(back.tiles.at(0).section, "panel");
  EXPECT_EQ(back.sections.at(0).tables.at(0).rows.at(0).at(1).verdict, Verdict::kBad);
  EXPECT_FALSE(back.sections.at(0).tables.at(0).columns.at(0).numeric);
  EXPECT_EQ(back.sections.at(0).notes.at(0).text, "</script><!-- a: 1");
  EXPECT_EQ(back.sections.at(0).panels.at(0).columns, 3);
}

// A tone is a word in the JSON, and a colour of that name in the style: one for light, and light's where dark has none.
TEST(PageJson, EveryToneIsKeptAndHasAColour) {
  std::ifstream stream(COAST_SOURCE_DIR "/src/report/web/style.css");
  const std::string style{std::istreambuf_iterator<char>(stream), {}};
  for (int i = 1; i <= static_cast<int>(Tone::kFaint); ++i) {
    Page page = full_page();
    page.sections.at(0).panels.at(0).plots.at(0).lines.at(0).tone = static_cast<Tone>(i);
    const std::string text = to_json(page);
    EXPECT_EQ(from_json(text, "report.json").sections.at(0).panels.at(0).plots.at(0).lines.at(0).tone, static_cast<Tone>(i));
    const auto line = nlohmann::json::parse(text).at("sections").at(0).at("panels").at(0).at("plots").at(0).at("lines").at(0);
    const std::string name = line.at("tone").get<std::string>();
    EXPECT_NE(style.find("--tone-" + name + ": #"), std::string::npos) << name;
  }
}

TEST(PageJson, FollowsItsSchema) {
  test::expect_valid("page", nlohmann::json::parse(to_json(full_page())));
  test::expect_valid("page", nlohmann::json::parse(to_json(test::sample_page())));
}

TEST(PageJson, DefaultsAreLeftOut) {
  Page page;
  page.sections = {{"s", "S", {}, {}, {}, {time_panel("p", "P", "m")}}};
  const auto json = nlohmann::json::parse(to_json(page));
  EXPECT_FALSE(json.contains("start"));
  EXPECT_FALSE(json.at("sections").at(0).contains("tables"));
  EXPECT_FALSE(json.at("sections").at(0).at("panels").at(0).contains("caption"));
  EXPECT_EQ(json.dump().find("null"), std::string::npos);
}

TEST(PageJson, RefusesWhatIsNoPageAndNamesTheFile) {
  for (const char* text : {"", "{", "[]", "{\"schema\":\"coast.page/2\"}", "{\"schema\":\"coast.page/1\",\"tiles\":3}",
                           "{\"schema\":\"coast.page/1\",\"sections\":[{\"panels\":[{\"plots\":[{}]}]}]}",
                           "{\"schema\":\"coast.page/1\",\"tiles\":[{\"verdict\":\"fine\"}]}"}) {
    try {
      (void)from_json(text, "somewhere/report.json");
      FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("somewhere/report.json"), std::string::npos);
    }
  }
}

TEST(PageJson, RefusesIdsThatAreEmptyOddOrTwice) {
  for (const char* id : {"", "two words", "section"}) {
    Page page = full_page();
    page.sections[0].panels[0].id = id;
    EXPECT_THROW((void)to_json(page), std::invalid_argument) << id;
  }
}

TEST(PageJson, RefusesArraysOfTwoLengths) {
  Page page = full_page();
  page.sections[0].panels[0].plots[0].lines[0].series.y.pop_back();
  EXPECT_THROW((void)to_json(page), std::invalid_argument);
}

TEST(Render, InlinesTheDataAndNeedsNothingElse) {
  const std::string html = render(full_page());
  EXPECT_EQ(html.rfind("<!doctype html>", 0), 0U);
  EXPECT_NE(html.find("<title>a &lt;title&gt; &amp; more</title>"), std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http", "<link"}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
  // The data end where the element ends: text cannot close it.
  const std::string open = "<script type=\"application/json\" id=\"page-data\">";
  const std::size_t begin = html.find(open) + open.size();
  const std::size_t end = html.find("</script>", begin);
  EXPECT_EQ(to_json(from_json(html.substr(begin, end - begin), "inlined")), to_json(full_page()));
}

TEST(Render, OfAStoredPageIsTheSamePage) {
  const Page page = full_page();
  EXPECT_EQ(render(from_json(to_json(page), "report.json")), render(page));
}

}  // namespace
}  // namespace coast::report
