#pragma once
// Projected coordinates and heights above a geoid, through PROJ with its data base and its installed grids. Nothing is fetched
// from a network.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "coast/config/node.hpp"
#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::io {

/// What positions are to be written in.
struct ProjectionOptions {
  std::string crs;                       ///< "EPSG:25832", compound "EPSG:25832+5773", or a PROJ string "+proj=tmerc .."
  std::string from = kWgs84;             ///< geographic CRS of the positions, which is that of the base's coordinates
  std::optional<double> epoch = {};      ///< decimal year at which the positions are valid; absent: their time
  std::optional<bool> orthometric = {};  ///< absent: if the CRS has a vertical part. True without one: above EGM96

  static constexpr const char* kWgs84 = "EPSG:4979";
  /// projection: {crs: EPSG:25832, from: EPSG:7912, epoch: 2010.0, heights: orthometric}
  [[nodiscard]] static ProjectionOptions from_node(const config::Node& node);
};

/// A position in the CRS, in its units.
struct GridPosition {
  double easting = 0.0;   ///< or westing, as columns name it
  double northing = 0.0;  ///< or southing
  double height = 0.0;    ///< above the ellipsoid of the CRS, or of its vertical part
};

/// Metres on the grid per metre.
struct GridScale {
  double point = 1.0;     ///< at the ellipsoid
  double combined = 1.0;  ///< at the height of the position
};

/// What columns of coordinates are called: easting_m, northing_us_ft, height_m, ..
struct GridColumns {
  std::string easting, northing, height;
};

/// Transforms positions to a projected CRS. One transformation is used for a whole mission, that of the highest accuracy at the
/// place of choose() whose grids are installed. All functions may be called by several threads at once.
class Projection {
 public:
  /// @throws InputError  the CRS is unknown, geographic or vertical alone, or no transformation leads to it with the grids that
  ///                     are installed; names what is missing
  explicit Projection(const ProjectionOptions& options);
  /// The same with file and line in the error.
  [[nodiscard]] static std::shared_ptr<Projection> from_node(const config::Node& node);
  ~Projection();
  Projection(const Projection&) = delete;
  Projection& operator=(const Projection&) = delete;

  /// Chooses the transformation; positions before this call choose it themselves.
  /// @throws InputError  none can be used at this place
  void choose(const Eigen::Vector3d& r_e);
  /// @throws NumericalError  the position cannot be projected
  [[nodiscard]] GridPosition at(const Eigen::Vector3d& r_e, geo::GpsTime t) const;
  /// Bearing of grid north (of increasing northing), clockwise from true north, rad: grid heading = true heading - convergence.
  /// The north of the local meridian, rotation between both datums included.
  /// @throws NumericalError  as at()
  [[nodiscard]] double convergence(const Eigen::Vector3d& r_e, geo::GpsTime t) const;
  /// Root of the product of the scales to north and to east.  @throws NumericalError  as at()
  [[nodiscard]] GridScale scale(const Eigen::Vector3d& r_e, geo::GpsTime t) const;
  /// Whether a position is in the area for which the CRS was made; true where PROJ knows none.
  [[nodiscard]] bool covers(const Eigen::Vector3d& r_e) const;

  [[nodiscard]] const std::string& name() const;     ///< "ETRS89 / UTM zone 32N"
  [[nodiscard]] const std::string& crs() const;      ///< as stated, with EGM96 if that was added
  [[nodiscard]] const std::string& heights() const;  ///< "above the ellipsoid GRS 1980", "EGM96 height"
  [[nodiscard]] bool orthometric() const;
  [[nodiscard]] const GridColumns& columns() const;
  [[nodiscard]] double metres() const;           ///< per unit of easting and northing
  [[nodiscard]] double height_metres() const;    ///< per unit of heights
  [[nodiscard]] std::string operation() const;   ///< the transformation in PROJ's words; empty before choose()
  [[nodiscard]] const std::string& wkt() const;  ///< of the CRS, WKT 2 of 2019
  /// What is to be known of the choice at choose(): the transformation, equal datums, a better grid that is not installed.
  [[nodiscard]] record::Events events() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace coast::io
