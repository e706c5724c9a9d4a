#include "run_file/run_aids.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace coast::jobs {

std::vector<AidConfig> read_aids(const config::Node& list) {
  std::vector<std::string_view> names;
  for (const estimate::AidKind& kind : estimate::aid_kinds()) names.push_back(kind.name);
  std::vector<AidConfig> aids;
  for (const config::Node& item : list.items()) {
    const estimate::AidKind& kind = estimate::aid_kinds()[item.at("kind").choice(names)];
    const auto before = std::ranges::count_if(aids, [&](const AidConfig& aid) { return aid.name.starts_with(kind.name); });
    aids.push_back({before == 0 ? std::string(kind.name) : fmt::format("{}_{}", kind.name, before + 1),
                    io::AidFileOptions::from(item, kind.columns, kind.sd_columns), kind.from(item)});
  }
  return aids;
}

}  // namespace coast::jobs
