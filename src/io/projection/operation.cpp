#include "operation.hpp"

#include <algorithm>
#include <utility>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

/// How widely PROJ looks for transformations, the strictest first.
struct Search {
  PROJ_SPATIAL_CRITERION area;
  PROJ_INTERMEDIATE_CRS_USE intermediate;
};
constexpr Search kSearches[] = {
    {PROJ_SPATIAL_CRITERION_STRICT_CONTAINMENT, PROJ_INTERMEDIATE_CRS_USE_IF_NO_DIRECT_TRANSFORMATION},
    {PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION, PROJ_INTERMEDIATE_CRS_USE_IF_NO_DIRECT_TRANSFORMATION},
    {PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION, PROJ_INTERMEDIATE_CRS_USE_ALWAYS}};

ProjList operations_between(const ProjContext& context, const PJ* from, const PJ* to, const Search& search,
                            const std::optional<geo::Geodetic>& place) {
  PJ_CONTEXT* c = context.get();
  const ProjFactory factory(proj_create_operation_factory_context(c, nullptr));
  proj_operation_factory_context_set_spatial_criterion(c, factory.get(), search.area);
  proj_operation_factory_context_set_allow_use_intermediate_crs(c, factory.get(), search.intermediate);
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
    const char* name = "";
    int available = 0;
    proj_coordoperation_get_grid_used(context.get(), operation, i, &name, nullptr, nullptr, nullptr, nullptr, nullptr,
                                      &available);
    if (available == 0) names.emplace_back(name);
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
  for (const Search& search : kSearches) {
    if (!best.steps.empty()) break;
    const ProjList list = operations_between(context, from, to, search, place);
    take_first(context, list.get(), best);
  }
  static_cast<void>(context.take_log());  // of operations without their grids
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
  constexpr double kUnknown = 1e3;  // m
  CoordinateOperation direct = direct_operation(context, from, to, place);
  if (datum == nullptr || proj_is_equivalent_to(from, datum, PJ_COMP_EQUIVALENT) != 0) return direct;
  CoordinateOperation shift = direct_operation(context, from, datum, place);
  CoordinateOperation rest = direct_operation(context, datum, to, place);
  if (shift.steps.empty() || rest.steps.empty()) return direct;
  // A map projection has no accuracy of its own.
  const double through = shift.accuracy_m.value_or(kUnknown) + rest.accuracy_m.value_or(0.0);
  if (!direct.steps.empty() && direct.accuracy_m.value_or(kUnknown) <= through) return direct;
  shift.steps.push_back(std::move(rest.steps.front()));
  shift.name += " + " + rest.name;
  if (shift.accuracy_m) shift.accuracy_m = through;
  add_new(shift.missing, rest.missing);
  return shift;
}

}  // namespace coast::io
