#include "operation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

/// Within which area PROJ looks for transformations, the strictest first: within that of both CRS, or of either.
constexpr std::array kAreas{PROJ_SPATIAL_CRITERION_STRICT_CONTAINMENT, PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION};

// Frames of global networks, and that of Europe, from which PROJ does not find the way to every national one by itself:
// ITRF2014, ETRS89.
constexpr std::array kFrames{"EPSG:7912", "EPSG:4937"};

ProjList operations_between(const ProjContext& context, const PJ* from, const PJ* to, PROJ_SPATIAL_CRITERION area,
                            const std::optional<geo::Geodetic>& place) {
  PJ_CONTEXT* c = context.get();
  const ProjFactory factory(proj_create_operation_factory_context(c, nullptr));
  proj_operation_factory_context_set_spatial_criterion(c, factory.get(), area);
  proj_operation_factory_context_set_grid_availability_use(c, factory.get(), PROJ_GRID_AVAILABILITY_IGNORED);
  if (place) {
    constexpr double kAround = 1e-3;  // deg: areas are wanted that contain the place
    const double latitude = place->latitude / geo::kDegree, longitude = place->longitude / geo::kDegree;
    proj_operation_factory_context_set_area_of_interest(c, factory.get(), longitude - kAround,
                                                        std::max(-90.0, latitude - kAround), longitude + kAround,
                                                        std::min(90.0, latitude + kAround));
  }
  return ProjList(proj_create_operations(c, from, to, factory.get()));
}

/// Grids that an operation uses and that are not installed.
std::vector<std::string> missing_grids(const ProjContext& context, const PJ* operation) {
  std::vector<std::string> names;
  const int count = proj_coordoperation_get_grid_used_count(context.get(), operation);
  for (int i = 0; i < count; ++i) {
    const char *name = "", *address = "";
    int available = 0;
    proj_coordoperation_get_grid_used(context.get(), operation, i, &name, nullptr, nullptr, &address, nullptr, nullptr,
                                      &available);
    if (available == 0) names.push_back(*address == '\0' ? name : fmt::format("{} ({})", name, address));
  }
  return names;
}

void add_new(std::vector<std::string>& names, const std::vector<std::string>& others) {
  for (const std::string& name : others)
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// The first that can be used of a list, which PROJ orders by area, accuracy and grids as though all were installed.
void take_first(const ProjContext& context, const PJ_OBJ_LIST* list, CoordinateOperation& best) {
  PJ_CONTEXT* c = context.get();
  const int count = list == nullptr ? 0 : proj_list_get_count(list);
  for (int i = 0; i < count && best.steps.empty(); ++i) {
    const ProjObject operation(proj_list_get(c, list, i));
    if (proj_coordoperation_has_ballpark_transformation(c, operation.get()) != 0) continue;
    if (proj_coordoperation_is_instantiable(c, operation.get()) == 0) {
      add_new(best.missing, missing_grids(context, operation.get()));
      continue;
    }
    best.steps.emplace_back(proj_normalize_for_visualization(c, operation.get()));
    best.name = proj_pj_info(operation.get()).description;
    const double accuracy = proj_coordoperation_get_accuracy(c, operation.get());
    if (accuracy >= 0.0) best.accuracy_m = accuracy;
  }
}

CoordinateOperation direct_operation(ProjContext& context, const PJ* from, const PJ* to,
                                     const std::optional<geo::Geodetic>& place) {
  CoordinateOperation best;
  std::vector<std::string> missing;  // of the first search that knows some: wider ones bring grids of other places
  for (const PROJ_SPATIAL_CRITERION area : kAreas) {
    if (!best.steps.empty()) break;
    const ProjList list = operations_between(context, from, to, area, place);
    take_first(context, list.get(), best);
    if (missing.empty()) missing = best.missing;
  }
  best.missing = std::move(missing);
  static_cast<void>(context.take_log());  // of operations without their grids
  return best;
}

/// By way of another geographic CRS; none where that is the first.
/// @param rest  from the pivot on
CoordinateOperation through(ProjContext& context, const PJ* from, const PJ* pivot, CoordinateOperation rest,
                            const std::optional<geo::Geodetic>& place) {
  CoordinateOperation chain = direct_operation(context, from, pivot, place);
  add_new(chain.missing, rest.missing);
  if (chain.steps.empty() || rest.steps.empty()) {
    chain.steps.clear();
    return chain;
  }
  for (ProjObject& step : rest.steps) chain.steps.push_back(std::move(step));
  chain.name += " + " + rest.name;
  if (chain.accuracy_m) *chain.accuracy_m += rest.accuracy_m.value_or(0.0);  // a map projection has none of its own
  return chain;
}

/// The more accurate of two, the first if neither is.
CoordinateOperation better(CoordinateOperation a, CoordinateOperation b) {
  constexpr double kUnknown = 1e3;  // m
  if (b.steps.empty()) {
    if (a.steps.empty() && a.missing.empty()) a.missing = std::move(b.missing);
    return a;
  }
  return a.steps.empty() || b.accuracy_m.value_or(kUnknown) < a.accuracy_m.value_or(kUnknown) ? std::move(b) : std::move(a);
}

struct Ends {
  const PJ *from, *to, *datum;
};

CoordinateOperation best_by_way(ProjContext& context, const Ends& ends, std::span<const char* const> frames,
                                const std::optional<geo::Geodetic>& place) {
  const auto starts_at = [&](const PJ* pivot) { return proj_is_equivalent_to(ends.from, pivot, PJ_COMP_EQUIVALENT) != 0; };
  CoordinateOperation best = direct_operation(context, ends.from, ends.to, place);
  constexpr double kGood = 1.0;  // m: as good as any way from WGS 84, which itself is known to a metre or two
  const bool good = best.accuracy_m && *best.accuracy_m <= kGood;
  if (!good && ends.datum != nullptr && !starts_at(ends.datum))
    best = better(std::move(best),
                  through(context, ends.from, ends.datum, direct_operation(context, ends.datum, ends.to, place), place));
  for (std::size_t i = 0; i < frames.size() && best.steps.empty(); ++i) {
    const ProjObject pivot(proj_create(context.get(), frames[i]));
    if (!pivot || starts_at(pivot.get())) continue;
    CoordinateOperation rest = best_by_way(context, {pivot.get(), ends.to, ends.datum}, frames.subspan(i + 1), place);
    best = better(std::move(best), through(context, ends.from, pivot.get(), std::move(rest), place));
  }
  return best;
}

}  // namespace

PJ_COORD CoordinateOperation::apply(PJ_COORD coordinates) const {
  for (const ProjObject& step : steps) {
    const double year = coordinates.xyzt.t;
    coordinates = proj_trans(step.get(), PJ_FWD, coordinates);
    coordinates.xyzt.t = year;
  }
  return coordinates;
}

CoordinateOperation best_operation(ProjContext& context, const PJ* from, const PJ* to, const PJ* datum,
                                   const std::optional<geo::Geodetic>& place) {
  return best_by_way(context, {from, to, datum}, kFrames, place);
}

}  // namespace coast::io
