#include "geopackage_base.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

#include "../projection/proj_wkt.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/writers.hpp"

namespace coast::io {

namespace {

constexpr std::int64_t kWgs84ThreeD = 4979;
constexpr std::int64_t kOwnSystem = 100000;  // of a CRS without a code of its own

/// Number of "EPSG:25832"; none of a compound code, a PROJ string, or another authority.
std::optional<std::int64_t> epsg_number(std::string_view crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  if (!crs.starts_with(kPrefix)) return std::nullopt;
  crs.remove_prefix(kPrefix.size());
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(crs.data(), crs.data() + crs.size(), number);
  if (error != std::errc() || end != crs.data() + crs.size()) return std::nullopt;
  return number;
}

template <class T>
void put_bytes(std::string& blob, T value) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(T));
  blob.append(bytes.data(), bytes.size());
}

/// StandardGeoPackageBinary: header without envelope, then ISO well-known binary, little-endian as this machine is.
std::string geometry_blob(const std::vector<Eigen::Vector3d>& coordinates, bool line, std::int64_t srs) {
  constexpr char kLittleEndian = 1;
  constexpr std::uint32_t kPointZ = 1001, kLineStringZ = 1002;
  std::string blob("GP\0\1", 4);
  put_bytes(blob, static_cast<std::int32_t>(srs));
  blob += kLittleEndian;
  put_bytes(blob, line ? kLineStringZ : kPointZ);
  if (line) put_bytes(blob, static_cast<std::uint32_t>(coordinates.size()));
  for (const Eigen::Vector3d& place : coordinates)
    for (const double x : place) put_bytes(blob, x);
  return blob;
}

std::string quoted_text(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

// The tables of the standard, and of its extension for WKT 2, which three-dimensional systems need.
constexpr const char* kTables = R"(
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT,
  definition_12_063 TEXT NOT NULL DEFAULT 'undefined');
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '', last_change DATETIME NOT NULL, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE,
  srs_id INTEGER, CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name), CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
CREATE TABLE gpkg_extensions (table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL,
  scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name));
INSERT INTO gpkg_extensions VALUES ('gpkg_spatial_ref_sys', 'definition_12_063', 'gpkg_crs_wkt',
  'http://www.geopackage.org/spec120/#extension_crs_wkt', 'read-write');
)";

}  // namespace

GeoPackage::GeoPackage(std::filesystem::path path, const Projection* projection)
    : path_(std::move(path)),
      projection_(projection),
      srs_(projection == nullptr ? kWgs84ThreeD : epsg_number(projection->crs()).value_or(kOwnSystem)) {
  sqlite3* base = nullptr;
  const int status = sqlite3_open_v2(":memory:", &base, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  base_.reset(base);
  if (status != SQLITE_OK) fail();
  create_tables();
  run("BEGIN");
}

void GeoPackage::fail() const {
  throw OutputError(path_.string(), fmt::format("SQLite: {}", base_ ? sqlite3_errmsg(base_.get()) : "no memory"));
}

void GeoPackage::run(const std::string& sql) {
  if (sqlite3_exec(base_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

GeoPackage::Statement GeoPackage::prepared(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(base_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) fail();
  return Statement(statement);
}

void GeoPackage::bind(sqlite3_stmt* statement, int index, const SqlValue& value) const {
  int status = SQLITE_OK;
  if (const auto* number = std::get_if<double>(&value))
    status = sqlite3_bind_double(statement, index, *number);
  else if (const auto* integer = std::get_if<std::int64_t>(&value))
    status = sqlite3_bind_int64(statement, index, *integer);
  else if (const auto* text = std::get_if<std::string>(&value))
    status = sqlite3_bind_text64(statement, index, text->data(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  else
    status = sqlite3_bind_null(statement, index);
  if (status != SQLITE_OK) fail();
}

void GeoPackage::finish(sqlite3_stmt* statement) const {
  if (sqlite3_step(statement) != SQLITE_DONE) fail();
  sqlite3_reset(statement);
}

void GeoPackage::create_tables() {
  constexpr int kVersion = 10300;  // of the standard: 1.3
  run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {};", 0x47504B47, kVersion));
  run(kTables);
  add_reference_systems();
}

void GeoPackage::add_reference_systems() {
  const auto add = [this](std::string_view name, std::int64_t id, std::string_view organization, std::int64_t code,
                          const std::string& wkt) {
    run(fmt::format("INSERT INTO gpkg_spatial_ref_sys VALUES ({}, {}, {}, {}, 'undefined', '', {})", quoted_text(name), id,
                    quoted_text(organization), code, quoted_text(wkt)));
  };
  add("Undefined Cartesian SRS", -1, "NONE", -1, "undefined");
  add("Undefined geographic SRS", 0, "NONE", 0, "undefined");
  add("WGS 84", 4326, "EPSG", 4326, wkt_of("EPSG:4326"));
  add("WGS 84 3D", kWgs84ThreeD, "EPSG", kWgs84ThreeD, wkt_of("EPSG:4979"));
  if (projection_ == nullptr) return;
  add(projection_->name(), srs_, srs_ == kOwnSystem ? "NONE" : "EPSG", srs_, projection_->wkt());
}

void GeoPackage::create(const GeoLayer& layer) {
  std::string names = "geom", marks = "?", columns;
  for (const auto& [name, type] : layer.columns) {
    columns += fmt::format(", {} {}", name, type);
    names += ", " + name;
    marks += ", ?";
  }
  run(fmt::format("CREATE TABLE {} (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom {}{})", layer.name, layer.geometry,
                  columns));
  run(
      fmt::format("INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change, srs_id) VALUES "
                  "({0}, 'features', {0}, {1}, strftime('%Y-%m-%dT%H:%M:%fZ', 'now'), {2})",
                  quoted_text(layer.name), quoted_text(layer.description), srs_));
  run(fmt::format("INSERT INTO gpkg_geometry_columns VALUES ({}, 'geom', {}, {}, 1, 0)", quoted_text(layer.name),
                  quoted_text(layer.geometry), srs_));
  open_.push_back({layer.name, prepared(fmt::format("INSERT INTO {} ({}) VALUES ({})", layer.name, names, marks)), {}});
}

void GeoPackage::add(const GeoLayer& layer, const std::vector<Eigen::Vector3d>& coordinates,
                     const std::vector<SqlValue>& values) {
  Open& open = *std::ranges::find(open_, layer.name, &Open::layer);
  const std::string blob = geometry_blob(coordinates, layer.geometry == "LINESTRING", srs_);
  if (sqlite3_bind_blob64(open.insert.get(), 1, blob.data(), blob.size(), SQLITE_TRANSIENT) != SQLITE_OK) fail();
  int index = 1;
  for (const SqlValue& value : values) bind(open.insert.get(), ++index, value);
  finish(open.insert.get());
  for (const Eigen::Vector3d& place : coordinates) {
    open.extent.least = open.extent.least.cwiseMin(place);
    open.extent.greatest = open.extent.greatest.cwiseMax(place);
  }
}

Eigen::Vector3d GeoPackage::coordinates(const Eigen::Vector3d& r_e, geo::GpsTime t) const {
  if (projection_ != nullptr) {
    const GridPosition p = projection_->at(r_e, t);
    return {p.easting, p.northing, p.height};
  }
  const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
  return {p.longitude / geo::kDegree, p.latitude / geo::kDegree, p.height};
}

void GeoPackage::write_extents() {
  const Statement update = prepared("UPDATE gpkg_contents SET min_x = ?, min_y = ?, max_x = ?, max_y = ? WHERE table_name = ?");
  for (const Open& open : open_) {
    if (!open.extent.least.allFinite()) continue;  // no features
    bind(update.get(), 1, open.extent.least.x());
    bind(update.get(), 2, open.extent.least.y());
    bind(update.get(), 3, open.extent.greatest.x());
    bind(update.get(), 4, open.extent.greatest.y());
    bind(update.get(), 5, open.layer);
    finish(update.get());
  }
}

void GeoPackage::close() {
  write_extents();
  open_.clear();
  run("COMMIT");
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(sqlite3_serialize(base_.get(), "main", &size, 0), &sqlite3_free);
  if (!bytes) fail();
  AtomicFile file(path_);
  file.write({reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)});
  file.commit();
}

GeoPackage GeoPackage::opened(const std::filesystem::path& path, const Projection* projection) {
  GeoPackage package(path, projection);
  std::ifstream in(path, std::ios::binary);  // not as an input, which results may not replace
  std::stringstream content;
  content << in.rdbuf();
  const std::string bytes = content.str();
  auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(bytes.size()));
  if (copy == nullptr || bytes.empty()) throw OutputError(path.string(), "it cannot be read again");
  std::memcpy(copy, bytes.data(), bytes.size());
  package.run("COMMIT");
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  // SQLite frees the copy, of an error too.
  if (sqlite3_deserialize(package.base_.get(), "main", copy, size, size,
                          SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_RESIZEABLE) != SQLITE_OK)
    package.fail();
  package.run("BEGIN");
  return package;
}

}  // namespace coast::io
