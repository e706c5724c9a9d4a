#include "target_crs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

constexpr std::string_view kCrsExamples = "EPSG:25832, EPSG:2056+5728, or a PROJ string \"+proj=tmerc ..\"";

[[noreturn]] void refuse_crs(const std::string& crs, const std::string& found, std::string what_to_do) {
  throw InputError(
      {"", 0, fmt::format("{}: {}", crs, found), fmt::format("a projected CRS: {}", kCrsExamples), std::move(what_to_do)});
}

bool is_proj_string(std::string_view text) {
  return text.starts_with('+');
}

/// AUTHORITY:CODE, with any number of +CODE behind. PROJ looks anything else up among names, and finds Amersfoort for "foo".
bool is_code(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == ':' || c == '_';
  };
  return colon != std::string_view::npos && colon > 0 && colon + 1 < text.size() && std::ranges::all_of(text, is_word);
}

/// The ellipsoid of WGS 84 or of GRS 80: 0.1 mm from each other.
bool has_ellipsoid_of_gnss(const ProjContext& context, const PJ* crs) {
  const ProjObject ellipsoid(proj_get_ellipsoid(context.get(), crs));
  double a = 0.0, inverse_flattening = 0.0;
  return ellipsoid &&
         proj_ellipsoid_get_parameters(context.get(), ellipsoid.get(), &a, nullptr, nullptr, &inverse_flattening) != 0 &&
         std::abs(a - 6378137.0) < 1e-3 && std::abs(inverse_flattening - 298.25722) < 1e-4;
}

/// A PROJ string says nothing of its datum unless it has one of these. On the ellipsoid of GNSS it is taken for the same datum.
ProjObject crs_of_proj_string(ProjContext& context, std::string text) {
  if (text.find("+type=crs") == std::string::npos) text += " +type=crs";
  const auto states = [&](const char* key) { return text.find(key) != std::string::npos; };
  ProjObject crs(proj_create(context.get(), text.c_str()));
  if (!crs || states("+datum=") || states("+towgs84=") || states("+nadgrids=")) return crs;
  if (!has_ellipsoid_of_gnss(context, crs.get()))
    refuse_crs(text, "a PROJ string without datum, on another ellipsoid than that of GNSS",
               "Add `+towgs84=..` or `+nadgrids=..`, the shift from this datum to WGS 84, or give an EPSG code.");
  return ProjObject(proj_create(context.get(), (text + " +towgs84=0,0,0").c_str()));
}

ProjObject parsed_crs(ProjContext& context, const std::string& text) {
  if (is_proj_string(text)) return crs_of_proj_string(context, text);
  return is_code(text) ? ProjObject(proj_create(context.get(), text.c_str())) : nullptr;
}

/// What a CRS is that is no projected one.
const char* kind_of(PJ_TYPE type) {
  switch (type) {
    case PJ_TYPE_GEOGRAPHIC_2D_CRS:
    case PJ_TYPE_GEOGRAPHIC_3D_CRS:
      return "a geographic CRS";
    case PJ_TYPE_GEOCENTRIC_CRS:
      return "a geocentric CRS";
    case PJ_TYPE_VERTICAL_CRS:
      return "a vertical CRS alone";
    case PJ_TYPE_ENGINEERING_CRS:
      return "an engineering CRS, which is not tied to the Earth";
    default:
      return "no CRS of map coordinates";
  }
}

/// The projected CRS within a compound one or one bound to a datum shift.
ProjObject horizontal_part(const ProjContext& context, const PJ* crs) {
  ProjObject part(proj_clone(context.get(), crs));
  while (part) {
    const PJ_TYPE type = proj_get_type(part.get());
    if (type == PJ_TYPE_COMPOUND_CRS)
      part.reset(proj_crs_get_sub_crs(context.get(), part.get(), 0));
    else if (type == PJ_TYPE_BOUND_CRS)
      part.reset(proj_get_source_crs(context.get(), part.get()));
    else
      break;
  }
  return part;
}

std::string lower_case(std::string_view text) {
  std::string lower;
  for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// Suffix of columns: m, ft, us_ft.
std::string unit_suffix(double metres, const char* name) {
  if (std::abs(metres - 1.0) < 1e-12) return "m";
  if (std::abs(metres - 0.3048) < 1e-12) return "ft";
  if (std::abs(metres - 1200.0 / 3937.0) < 1e-12) return "us_ft";
  std::string suffix = lower_case(name);
  std::ranges::replace_if(
      suffix, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return suffix;
}

struct AxisText {
  std::string name;  ///< lower case
  double metres = 1.0;
  std::string unit;
};

AxisText axis_text(const ProjContext& context, const PJ* crs, int index) {
  const ProjObject system(proj_crs_get_coordinate_system(context.get(), crs));
  const char *name = "", *unit = "metre";
  double metres = 1.0;
  if (system)
    proj_cs_get_axis_info(context.get(), system.get(), index, &name, nullptr, nullptr, &metres, &unit, nullptr, nullptr);
  return {lower_case(name), metres, unit_suffix(metres, unit)};
}

/// By the names of its axes: a polar projection has two that point north.
void find_horizontal_axes(const ProjContext& context, TargetCrs& target) {
  const ProjObject shown(proj_normalize_for_visualization(context.get(), target.horizontal.get()));
  const PJ* crs = shown ? shown.get() : target.horizontal.get();
  for (int i = 0; i < 2; ++i) {
    const AxisText axis = axis_text(context, crs, i);
    const bool along_meridian = axis.name.starts_with("north") || axis.name.starts_with("south");
    const bool stated = along_meridian || axis.name.starts_with("east") || axis.name.starts_with("west");
    const bool north = stated ? along_meridian : i == 1;
    const bool reversed = axis.name.starts_with("south") || axis.name.starts_with("west");
    const char* word = north ? (reversed ? "southing" : "northing") : (reversed ? "westing" : "easting");
    (north ? target.northing : target.easting) = {i, reversed ? -1.0 : 1.0, axis.metres, fmt::format("{}_{}", word, axis.unit)};
  }
}

/// The vertical part of a compound CRS; none of another.
ProjObject vertical_part(const ProjContext& context, const PJ* crs) {
  if (proj_get_type(crs) != PJ_TYPE_COMPOUND_CRS) return nullptr;
  return ProjObject(proj_crs_get_sub_crs(context.get(), crs, 1));
}

/// EGM96 is the one geoid whose grid comes with every PROJ.
void add_egm96(const ProjContext& context, TargetCrs& target) {
  constexpr const char* kEgm96 = "EPSG:5773";
  const ProjObject geoid(proj_create(context.get(), kEgm96));
  target.crs.reset(
      proj_create_compound_crs(context.get(), (target.name + " + EGM96 height").c_str(), target.crs.get(), geoid.get()));
  target.stated += target.stated.starts_with("EPSG:") ? "+5773" : fmt::format(" with heights of {}", kEgm96);
  target.name += " + EGM96 height";
}

void complete_heights(ProjContext& context, const ProjectionOptions& options, TargetCrs& target) {
  const bool compound = proj_get_type(target.crs.get()) == PJ_TYPE_COMPOUND_CRS;
  if (compound && options.orthometric == false)
    refuse_crs(options.crs, "a compound CRS, whose heights are not ellipsoidal", "Leave its vertical part out, or `heights`.");
  target.orthometric = compound || options.orthometric.value_or(false);
  if (target.orthometric && !compound) add_egm96(context, target);
  target.height.index = 2;
  if (const ProjObject vertical = vertical_part(context, target.crs.get())) {
    const AxisText axis = axis_text(context, vertical.get(), 0);
    target.heights = proj_get_name(vertical.get());
    target.height = {2, 1.0, axis.metres, "height_" + axis.unit};
    return;
  }
  const ProjObject ellipsoid(proj_get_ellipsoid(context.get(), target.horizontal.get()));
  target.heights = fmt::format("above the ellipsoid {}", ellipsoid ? proj_get_name(ellipsoid.get()) : "of the CRS");
  target.height.column = "height_m";
  target.crs.reset(proj_crs_promote_to_3D(context.get(), nullptr, target.crs.get()));
}

}  // namespace

TargetCrs target_crs(ProjContext& context, const ProjectionOptions& options) {
  TargetCrs target;
  target.crs = parsed_crs(context, options.crs);
  if (!target.crs) {
    const std::string log = context.take_log();
    refuse_crs(options.crs, log.empty() ? "no code and no PROJ string" : log, "");
  }
  target.stated = options.crs;
  target.name = proj_get_name(target.crs.get());
  if (target.name == "unknown") target.name = options.crs;
  target.horizontal = horizontal_part(context, target.crs.get());
  if (!target.horizontal || proj_get_type(target.horizontal.get()) != PJ_TYPE_PROJECTED_CRS)
    refuse_crs(options.crs,
               fmt::format("{} ({})", kind_of(target.horizontal ? proj_get_type(target.horizontal.get()) : PJ_TYPE_UNKNOWN),
                           target.name),
               "");
  find_horizontal_axes(context, target);
  complete_heights(context, options, target);
  if (!target.crs) refuse_crs(options.crs, context.take_log(), "");
  return target;
}

ProjObject source_crs(ProjContext& context, const std::string& from) {
  const auto refuse = [&](std::string found) {
    throw InputError({"", 0, fmt::format("{}: {}", from, found),
                      "a geographic CRS in degrees: EPSG:4979 (WGS 84), EPSG:7912 (ITRF2014), EPSG:4937 (ETRS89)", ""});
  };
  const ProjObject crs(is_code(from) ? proj_create(context.get(), from.c_str()) : nullptr);
  if (!crs) refuse("no known code");
  const PJ_TYPE type = proj_get_type(crs.get());
  if (type != PJ_TYPE_GEOGRAPHIC_2D_CRS && type != PJ_TYPE_GEOGRAPHIC_3D_CRS)
    refuse(fmt::format("{} is not geographic", proj_get_name(crs.get())));
  if (std::abs(axis_text(context, crs.get(), 0).metres - geo::kDegree) > 1e-12)
    refuse(fmt::format("{} is not in degrees", proj_get_name(crs.get())));
  return ProjObject(proj_crs_promote_to_3D(context.get(), nullptr, crs.get()));
}

}  // namespace coast::io
