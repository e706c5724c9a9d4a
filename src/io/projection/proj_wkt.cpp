#include "proj_wkt.hpp"

#include "proj_handles.hpp"

namespace coast::io {

std::string wkt_of(const std::string& code) {
  const ProjContext context;
  const ProjObject crs(proj_create(context.get(), code.c_str()));
  const char* text = crs ? proj_as_wkt(context.get(), crs.get(), PJ_WKT2_2019, nullptr) : nullptr;
  return text == nullptr ? "" : text;
}

}  // namespace coast::io
