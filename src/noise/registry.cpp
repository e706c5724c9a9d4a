#include <algorithm>
#include <stdexcept>

#include "coast/noise/process.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

const std::vector<Registration>& registry() {
  static const std::vector<Registration> table = {
      white_noise(), random_constant(), random_walk(), gauss_markov(), scale_factor(), misalignment(),
      drift(),       rate_ramp(),       flicker(),     quantisation(), ar(),           share(),
  };
  return table;
}

const Estimable& estimable(std::string_view name) {
  // "ar(3)": autoregressions have an order.
  if (name.size() == 5 && name.starts_with("ar(") && name.back() == ')') return estimable_ar(name[3] - '0');
  const auto found = std::ranges::find(registry(), name, &Registration::name);
  if (found == registry().end() || found->estimable == nullptr)
    throw std::invalid_argument("no process '" + std::string(name) + "' that can be estimated");
  return *found->estimable;
}

std::vector<ProcessPtr> make_processes(const config::Node& entry, const EntryContext& context) {
  const config::Node process = entry.at("process");
  const std::string name = process.text();
  const auto found = std::ranges::find(registry(), name, &Registration::name);
  if (found != registry().end()) return found->make(entry, context);
  std::vector<std::string> names;
  std::string list;
  for (const Registration& r : registry()) {
    names.emplace_back(r.name);
    list += (list.empty() ? "" : ", ") + std::string(r.name);
  }
  const std::string near = config::nearest(name, names);
  throw process.error("unknown process '" + name + "'", "one of " + list, near.empty() ? "" : "Did you mean " + near + "?");
}

}  // namespace coast::noise
