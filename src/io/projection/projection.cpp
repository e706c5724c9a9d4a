#include "coast/io/projection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <mutex>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"
#include "operation.hpp"
#include "target_crs.hpp"

namespace coast::io {

namespace {

/// 2025.5 for the middle of 2025, as transformations between frames take time.
double decimal_year(geo::GpsTime t) {
  const geo::Calendar date = t.calendar();
  const auto begin = [](int year) { return geo::GpsTime::from_calendar({year, 1, 1, 0, 0, 0.0}); };
  const geo::GpsTime first = begin(date.year);
  return date.year + (t - first) / (begin(date.year + 1) - first);
}

constexpr std::string_view kWhereGrids =
    "Grids of PROJ are files that belong into the folder of its data, or into one that PROJ_DATA names: the package proj-data "
    "has some, PROJ's data release has all.";

record::Event said(record::Event::Severity severity, const char* kind, std::string text) {
  return {severity, kind, std::move(text), std::nullopt, 1};
}

}  // namespace

struct Projection::State {
  explicit State(const ProjectionOptions& stated)
      : options(stated), target(target_crs(context, stated)), source(source_crs(context, stated.from)) {
    const ProjObject kept(proj_crs_get_geodetic_crs(context.get(), target.horizontal.get()));
    if (kept) datum.reset(proj_crs_promote_to_3D(context.get(), nullptr, kept.get()));
    if (const char* text = proj_as_wkt(context.get(), target.crs.get(), PJ_WKT2_2019, nullptr)) wkt = text;
    columns = {target.easting.column, target.northing.column, target.height.column};
  }

  void require(const CoordinateOperation& found, const char* where) const;
  /// Easting, northing, height as PROJ gives them.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& r_e, geo::GpsTime t);
  void choose(const Eigen::Vector3d& r_e);
  void note_equal_datums(const geo::Geodetic& place);
  void note_area(const Eigen::Vector3d& r_e);
  [[nodiscard]] bool covers(const Eigen::Vector3d& r_e) const;
  /// Metres on the grid, east and north, for a metre along a unit vector in e.
  [[nodiscard]] Eigen::Vector2d image(const Eigen::Vector3d& direction_e, const Eigen::Vector3d& r_e, geo::GpsTime t);

  std::mutex mutex;  ///< PROJ's objects are used by one thread at a time
  ProjContext context;
  ProjectionOptions options;
  TargetCrs target;
  ProjObject source;
  ProjObject datum;  ///< geographic CRS of the target
  CoordinateOperation operation;
  std::string wkt;
  GridColumns columns;
  record::Events events;
};

void Projection::State::require(const CoordinateOperation& found, const char* where) const {
  if (!found.steps.empty()) return;
  const std::string from = proj_get_name(source.get());
  if (!found.missing.empty())
    throw InputError(
        {"", 0,
         fmt::format("{}: no transformation from {} {} without grid{} {}, not installed", target.stated, from, where,
                     found.missing.size() == 1 ? "" : "s: one of", fmt::join(found.missing, ", ")),
         "a CRS whose grids are installed",
         fmt::format("{}{}", kWhereGrids,
                     target.orthometric ? " Heights above EGM96 need no more than proj-data: vertical part 5773." : "")});
  throw InputError({"", 0, fmt::format("{}: no transformation is known from {} {}", target.stated, from, where),
                    "a CRS of the place of the mission",
                    "If the base's coordinates are in the frame of this CRS, state its geographic CRS with `from`."});
}

void Projection::State::choose(const Eigen::Vector3d& r_e) {
  const geo::Geodetic place = geo::geodetic_from_ecef(r_e);
  CoordinateOperation found = best_operation(context, source.get(), target.crs.get(), datum.get(), place);
  // Transformations have areas of use, too: outside of all of them one is taken all the same, and the place is told.
  if (found.steps.empty() && found.missing.empty())
    found = best_operation(context, source.get(), target.crs.get(), datum.get(), std::nullopt);
  require(found, fmt::format("at {:.3f}, {:.3f} deg", place.latitude / geo::kDegree, place.longitude / geo::kDegree).c_str());
  operation = std::move(found);
  using Severity = record::Event::Severity;
  events = {said(Severity::kInfo, "projection",
                 fmt::format("Projected to {} ({}), heights: {}. From {} by: {}{}.", target.name, target.stated, target.heights,
                             proj_get_name(source.get()), operation.name,
                             operation.accuracy_m ? fmt::format(", accuracy {:g} m", *operation.accuracy_m) : ""))};
  if (!operation.missing.empty())
    events.push_back(said(Severity::kWarning, "projection_grid",
                          fmt::format("A better transformation to {} needs {}, which is not installed. {}", target.name,
                                      fmt::join(operation.missing, " or "), kWhereGrids)));
  note_equal_datums(place);
  note_area(r_e);
}

/// WGS 84 and ETRS89 differ by what Europe has moved since 1989, yet the transformation that is known between them is none.
void Projection::State::note_equal_datums(const geo::Geodetic& place) {
  constexpr double kMoved = 1e-4;  // m
  if (!datum || proj_is_equivalent_to(source.get(), datum.get(), PJ_COMP_EQUIVALENT) != 0) return;
  const CoordinateOperation shift = best_operation(context, source.get(), datum.get(), nullptr, place);
  if (shift.steps.empty()) return;
  const double latitude = place.latitude / geo::kDegree, longitude = place.longitude / geo::kDegree;
  const double metres = geo::radii_of_curvature(place.latitude).prime_vertical * geo::kDegree;
  for (const double year : {1990.0, 2020.0}) {  // a transformation that depends on time is none in one year
    const PJ_COORD moved = shift.apply(proj_coord(longitude, latitude, place.height, year));
    if (std::hypot(moved.v[0] - longitude, moved.v[1] - latitude) * metres > kMoved) return;
  }
  events.push_back(said(record::Event::Severity::kInfo, "equal_datums",
                        fmt::format("{} and {} are taken as one datum (null transformation): if the base's coordinates are in "
                                    "an ITRF, name it with `from`, such as EPSG:7912.",
                                    proj_get_name(source.get()), proj_get_name(datum.get()))));
}

void Projection::State::note_area(const Eigen::Vector3d& r_e) {
  if (covers(r_e)) return;
  events.push_back(said(record::Event::Severity::kWarning, "outside_area_of_use",
                        fmt::format("The mission begins outside the area of use of {}. Is it the right zone?", target.name)));
}

bool Projection::State::covers(const Eigen::Vector3d& r_e) const {
  constexpr double kUnknown = -1000.0;
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
  if (proj_get_area_of_use(context.get(), target.horizontal.get(), &west, &south, &east, &north, nullptr) == 0 ||
      west == kUnknown)
    return true;
  const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
  const double latitude = p.latitude / geo::kDegree, longitude = p.longitude / geo::kDegree;
  const bool within = west <= east ? longitude >= west && longitude <= east : longitude >= west || longitude <= east;
  return within && latitude >= south && latitude <= north;
}

Eigen::Vector3d Projection::State::project(const Eigen::Vector3d& r_e, geo::GpsTime t) {
  if (operation.steps.empty()) choose(r_e);
  const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
  const double year = options.epoch ? *options.epoch : decimal_year(t);
  const PJ_COORD out = operation.apply(proj_coord(p.longitude / geo::kDegree, p.latitude / geo::kDegree, p.height, year));
  Eigen::Vector3d grid(out.v[target.easting.index], out.v[target.northing.index], out.v[target.height.index]);
  if (!grid.allFinite() || std::abs(grid.x()) >= HUGE_VAL)
    throw NumericalError("projection", geo::to_string(t),
                         fmt::format("the position {:.5f}, {:.5f} deg has no coordinates in {}: {}. It is outside of the "
                                     "projection, or of a grid",
                                     p.latitude / geo::kDegree, p.longitude / geo::kDegree, target.name,
                                     proj_context_errno_string(context.get(), proj_errno(operation.steps.back().get()))));
  return grid;
}

// Central differences over 100 m: the third derivative adds (50 m / R)^2 = 6e-11, rounding of coordinates 1e-11.
Eigen::Vector2d Projection::State::image(const Eigen::Vector3d& direction_e, const Eigen::Vector3d& r_e, geo::GpsTime t) {
  constexpr double kStep = 50.0;  // m
  const Eigen::Vector3d step = kStep * direction_e;
  const Eigen::Vector3d d = (project(r_e + step, t) - project(r_e - step, t)) / (2.0 * kStep);
  return {target.easting.direction * target.easting.metres * d.x(), target.northing.direction * target.northing.metres * d.y()};
}

Projection::Projection(const ProjectionOptions& options) : state_(std::make_unique<State>(options)) {
  state_->require(
      best_operation(state_->context, state_->source.get(), state_->target.crs.get(), state_->datum.get(), std::nullopt),
      "anywhere");
}

Projection::~Projection() = default;

void Projection::choose(const Eigen::Vector3d& r_e) {
  const std::scoped_lock lock(state_->mutex);
  state_->choose(r_e);
}

GridPosition Projection::at(const Eigen::Vector3d& r_e, geo::GpsTime t) const {
  const std::scoped_lock lock(state_->mutex);
  const Eigen::Vector3d grid = state_->project(r_e, t);
  return {grid.x(), grid.y(), grid.z()};
}

double Projection::convergence(const Eigen::Vector3d& r_e, geo::GpsTime t) const {
  const std::scoped_lock lock(state_->mutex);
  const Eigen::Vector2d north = state_->image(geo::C_n_e(geo::geodetic_from_ecef(r_e)).col(0), r_e, t);
  return -std::atan2(north.x(), north.y());
}

GridScale Projection::scale(const Eigen::Vector3d& r_e, geo::GpsTime t) const {
  const std::scoped_lock lock(state_->mutex);
  const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  const auto root = [&](double height) {
    const Eigen::Vector3d r = geo::ecef_from_geodetic({p.latitude, p.longitude, height});
    const Eigen::Vector2d north = state_->image(C_n_e.col(0), r, t), east = state_->image(C_n_e.col(1), r, t);
    return std::sqrt(std::abs(north.x() * east.y() - north.y() * east.x()));
  };
  return {root(0.0), root(p.height)};
}

bool Projection::covers(const Eigen::Vector3d& r_e) const {
  const std::scoped_lock lock(state_->mutex);
  return state_->covers(r_e);
}

const std::string& Projection::name() const {
  return state_->target.name;
}
const std::string& Projection::crs() const {
  return state_->target.stated;
}
const std::string& Projection::heights() const {
  return state_->target.heights;
}
bool Projection::orthometric() const {
  return state_->target.orthometric;
}
const GridColumns& Projection::columns() const {
  return state_->columns;
}
double Projection::metres() const {
  return state_->target.easting.metres;
}
double Projection::height_metres() const {
  return state_->target.height.metres;
}
const std::string& Projection::wkt() const {
  return state_->wkt;
}

std::string Projection::operation() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->operation.name;
}

record::Events Projection::events() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->events;
}

ProjectionOptions ProjectionOptions::from_node(const config::Node& node) {
  ProjectionOptions options;
  options.crs = node.at("crs").text();
  options.from = node.text("from", kWgs84);
  constexpr double kFirst = 1980.0, kLast = 2100.0;
  if (node.find("epoch")) options.epoch = node.number_within("epoch", kFirst, kFirst, kLast);
  if (node.find("heights")) options.orthometric = node.choice("heights", {"ellipsoidal", "orthometric"}, 0) == 1;
  return options;
}

std::shared_ptr<Projection> Projection::from_node(const config::Node& node) {
  const ProjectionOptions options = ProjectionOptions::from_node(node);
  try {
    auto projection = std::make_shared<Projection>(options);
    static_cast<void>(node.choice("heights", {"ellipsoidal", "orthometric"}, projection->orthometric() ? 1 : 0));
    return projection;
  } catch (const InputError& error) {
    const InputError::Parts& parts = error.parts();
    throw node.at("crs").error(parts.found, parts.expected, parts.what_to_do);
  }
}

}  // namespace coast::io
