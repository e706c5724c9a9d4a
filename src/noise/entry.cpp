#include "entry.hpp"

#include <stdexcept>

namespace coast::noise {

double value_with_unit(const config::Node& entry, std::string_view key, const SensorDimension& dimension,
                       const EntryContext& context) {
  const config::Node value = entry.at(key);
  if (!(value.number() >= 0.0)) throw value.error(value.text(), "a value of zero or more");
  return signed_value_with_unit(entry, key, dimension, context);
}

double signed_value_with_unit(const config::Node& entry, std::string_view key, const SensorDimension& dimension,
                              const EntryContext& context) {
  const config::Node value = entry.at(key);
  const config::Node unit = entry.at("unit");
  try {
    return geo::to_si(value.number(), unit.text(), dimension.of(context.sensor));
  } catch (const std::invalid_argument& wrong_unit) {
    throw unit.error(wrong_unit.what(), "");
  }
}

std::string_view si_unit(geo::Dimension dimension) {
  for (const geo::Unit& unit : geo::units())
    if (unit.dimension == dimension && unit.to_si == 1.0) return unit.name;
  throw std::invalid_argument("si_unit: a dimension without an SI unit in the table");
}

}  // namespace coast::noise
