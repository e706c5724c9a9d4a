#pragma once
// A GeoPackage (OGC 12-128r18, version 1.3) in memory: a data base of SQLite, written as a whole when it is complete. Private
// to the room.

#include <sqlite3.h>

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/io/projection.hpp"

namespace coast::io {

/// A value of a column.
using SqlValue = std::variant<std::monostate, double, std::int64_t, std::string>;

/// A layer of features: geometries in three dimensions, and columns.
struct GeoLayer {
  std::string name;                                          ///< of the table
  std::string description;                                   ///< for people
  std::string geometry;                                      ///< POINT or LINESTRING
  std::vector<std::pair<std::string, std::string>> columns;  ///< name and type of SQL
};

class GeoPackage {
 public:
  /// An empty one.
  /// @param projection  of all geometries; null: WGS 84 with ellipsoidal heights
  GeoPackage(std::filesystem::path path, const Projection* projection);
  /// One that GeoPackage wrote.  @throws OutputError  it cannot be read
  static GeoPackage opened(const std::filesystem::path& path, const Projection* projection);

  void create(const GeoLayer& layer);
  /// Adds a feature to a layer.
  void add(const GeoLayer& layer, const std::vector<Eigen::Vector3d>& coordinates, const std::vector<SqlValue>& values);
  /// Coordinates of a position in the CRS of the layers.
  [[nodiscard]] Eigen::Vector3d coordinates(const Eigen::Vector3d& r_e, geo::GpsTime t) const;
  /// Writes the file.  @throws OutputError
  void close();

 private:
  struct CloseBase {
    void operator()(sqlite3* base) const { sqlite3_close_v2(base); }
  };
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;
  struct Extent {
    Eigen::Vector3d least = Eigen::Vector3d::Constant(HUGE_VAL), greatest = Eigen::Vector3d::Constant(-HUGE_VAL);
  };

  void run(const std::string& sql);
  [[nodiscard]] Statement prepared(const std::string& sql) const;
  void bind(sqlite3_stmt* statement, int index, const SqlValue& value) const;
  /// Runs a statement to its end and makes it ready for other values.
  void finish(sqlite3_stmt* statement) const;
  void create_tables();
  void add_reference_systems();
  void write_extents();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  const Projection* projection_;
  std::int64_t srs_;
  std::unique_ptr<sqlite3, CloseBase> base_;
  struct Open {
    std::string layer;
    Statement insert;
    Extent extent;
  };
  std::vector<Open> open_;
};

}  // namespace coast::io
