#pragma once
// Content of a report, without HTML: tiles, sections, panels of plots, tables, notes. panels.hpp builds the usual panels in a
// line or two, render.hpp writes it as one self-contained HTML file.
//
// Every text is plain (the page escapes it); every axis and column has a unit; N, E, D in metres, angles in degrees.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/report/series.hpp"

namespace coast::report {

enum class Verdict { kNone, kGood, kWarn, kBad };

/// Meaning of a colour; the page chooses the shade for screen (light, dark) and print. GNSS qualities: RTKLIB's colours.
enum class Tone {
  kAuto,  ///< the next colour of the palette
  kX,     ///< first of three components: N, x, roll
  kY,     ///< second: E, y, pitch
  kZ,     ///< third: D, z, yaw
  kForward,
  kSmoothed,
  kReference,
  kMuted,  ///< grey: context, bounds
  kFixed,  ///< green
  kFloat,  ///< amber
  kSbas,
  kDgps,
  kSingle,  ///< red
  kPpp,
  kUnknown,
  kGood,
  kWarn,
  kBad,
  kFaint  ///< lighter than muted: many curves for comparison with one
};

/// One number of the acceptance sheet.
struct Tile {
  std::string label;
  std::string value;  ///< formatted, without unit; may be "0.8 / 0.6 / 1.9"
  std::string unit;
  Verdict verdict = Verdict::kNone;
  std::string explanation;  ///< one sentence: what it is and what good looks like
  /// Drawn as a stacked bar under the value (shares of GNSS quality); fractions in [0, 1].
  struct Share {
    std::string label;
    double fraction = 0.0;
    Tone tone = Tone::kAuto;
  };
  std::vector<Share> shares;
  std::string section;  ///< id of the section or panel opened by a click; may be empty
};

struct Axis {
  enum class Scale { kLinear, kLog, kTime };
  std::string label;
  std::string unit;              ///< may be empty for counts and ratios
  Scale scale = Scale::kLinear;  ///< kTime (x only): seconds since Page::start, shown with GPS seconds of week
  /// Names instead of numbers (update types by row); empty: numbers.
  struct Tick {
    double value = 0.0;
    std::string label;
  };
  std::vector<Tick> ticks;
  std::optional<std::pair<double, double>> range;  ///< initial range; otherwise from the data
};

struct Line {
  enum class Style { kLine, kDashed, kSteps };  ///< steps: a value holds until the next
  std::string label;
  Series series;
  Tone tone = Tone::kAuto;
  Style style = Style::kLine;
  std::string band_label;  ///< "1 sigma"; may be empty
  double width_px = 1.3;
  bool hidden = false;  ///< initially off; the legend switches it on
};

/// Dots of one category (a GNSS quality, an update type); one per category, so that the legend switches each.
struct Points {
  std::string label;
  Series series;  ///< breaks and band are not used
  Tone tone = Tone::kAuto;
  double radius_px = 1.6;
};

/// Histogram: bin i spans edges[i] to edges[i + 1]; edges are one longer than heights.
struct Bars {
  std::string label;
  std::vector<double> edges;
  std::vector<double> heights;
  Tone tone = Tone::kAuto;
};

/// Horizontal box plots, one per row: whiskers, box and median are quantiles of a sample.
struct Boxes {
  struct Box {
    double y = 0.0;  ///< row; a tick of the y axis gives its name
    double q05 = 0.0;
    double q25 = 0.0;
    double median = 0.0;
    double q75 = 0.0;
    double q95 = 0.0;
  };
  std::string label;
  std::vector<Box> boxes;
  Tone tone = Tone::kAuto;
};

/// A shaded interval of the x axis: an outage, a static period.
struct Interval {
  double from = 0.0;
  double to = 0.0;
  std::string label;
  Tone tone = Tone::kMuted;
};

/// A horizontal line: a gate, an expected value.
struct Bound {
  double value = 0.0;
  std::string label;
  Tone tone = Tone::kMuted;
};

/// A label next to a point: the number of an outage on the plan.
struct Mark {
  double x = 0.0;
  double y = 0.0;
  std::string label;
};

/// One pair of axes with its content.
struct Plot {
  std::string title;  ///< of a cell in a grid; the panel has its own
  Axis x;
  Axis y;
  std::vector<Line> lines;
  std::vector<Points> points;
  std::vector<Bars> bars;
  std::vector<Boxes> boxes;
  std::vector<Interval> intervals;
  std::vector<Bound> bounds;
  std::vector<Mark> marks;
  bool equal_aspect = false;  ///< plan view: one metre is as long in x as in y; a scale bar is drawn
  bool sky = false;           ///< polar: zenith in the middle, north up; x east and y north, in degrees from the zenith
  std::string link;           ///< plots with the same name zoom together in x; kTime axes are always linked
  int height_px = 0;          ///< 0: the usual height
};

/// A titled figure: one plot, a stack of plots (columns 1) or a grid of small multiples.
struct Panel {
  std::string id;  ///< unique on the page; letters, digits, '-'
  std::string title;
  std::string caption;  ///< one sentence: what good looks like
  int columns = 1;
  std::vector<Plot> plots;

  [[nodiscard]] Plot& plot() { return plots.front(); }
};

struct Cell {
  std::string text;
  Verdict verdict = Verdict::kNone;
};

struct Table {
  struct Column {
    std::string label;
    std::string unit;
    bool numeric = true;  ///< right-aligned, sorted as numbers
  };
  std::string id;  ///< unique on the page
  std::string title;
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

struct Note {
  enum class Kind { kInfo, kWarning, kCode };  ///< kCode: verbatim text (the resolved configuration), folded
  Kind kind = Kind::kInfo;
  std::string title;  ///< may be empty; kCode needs one
  std::string text;
};

/// Shown in this order: lead, notes, tables, panels; verbatim notes last.
struct Section {
  std::string id;  ///< unique on the page
  std::string title;
  std::string lead;
  std::vector<Note> notes;
  std::vector<Table> tables;
  std::vector<Panel> panels;
};

struct Page {
  std::string title;
  std::string subtitle;
  std::optional<geo::GpsTime> start;  ///< zero of every kTime axis; if absent, no seconds of week are shown
  std::vector<Tile> tiles;
  std::vector<Section> sections;
  std::string footer;  ///< program, version, command
};

}  // namespace coast::report
