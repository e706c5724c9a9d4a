// Plots <-> JSON.

#include "json_parts.hpp"
#include "pack.hpp"

namespace coast::report {

namespace {

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

// --- parts of a plot

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

// --- parts of a page

}  // namespace

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

}  // namespace coast::report
