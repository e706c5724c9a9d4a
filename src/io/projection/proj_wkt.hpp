#pragma once
// Definitions of CRS for files that contain them. Private to the room.

#include <string>

namespace coast::io {

/// WKT 2 of a CRS by its code, "EPSG:4979"; empty if PROJ does not know it.
[[nodiscard]] std::string wkt_of(const std::string& code);

}  // namespace coast::io
