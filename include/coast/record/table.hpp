#pragma once
// Numbers in memory in place of a file.

#include <string>
#include <vector>

namespace coast::record {

/// Named columns of numbers, as in a data frame.
struct Table {
  std::string name;  ///< in messages, where a file has its path
  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;  ///< one per name, of equal lengths
};

}  // namespace coast::record
