#pragma once
// Estimates of many missions, ordered for statistics: a panel has one figure (a quantity and its axis) of every unit.

#include <optional>
#include <string>
#include <vector>

namespace coast::fleet {

/// One figure of one mission. Values and sigmas of a panel have one unit, SI.
struct Estimate {
  std::string mission;
  double t = 0.0;                     ///< years (365.25 days) since the first mission of the fleet
  double value = 0.0;                 ///< finite
  double sigma = 0.0;                 ///< > 0: standard deviation as the mission stated it
  std::optional<double> temperature;  ///< deg C
  std::vector<std::string> groups;    ///< levels of the grouping factors, in the order of Fleet::factors
};

struct Series {
  std::string unit;
  std::vector<Estimate> estimates;  ///< by time
};

struct Panel {
  std::string quantity;
  std::string axis;  ///< may be empty
  std::string unit_of_value;
  std::vector<Series> series;
};

struct Fleet {
  std::vector<std::string> factors;  ///< names of grouping columns, "firmware"
  std::vector<Panel> panels;
};

}  // namespace coast::fleet
