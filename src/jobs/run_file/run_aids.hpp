#pragma once
// `aids:` of a run file.

#include <vector>

#include "coast/jobs/run_file.hpp"

namespace coast::jobs {

/// Several of one kind are numbered.
/// @throws InputError  an unknown kind or key, or a value out of range
[[nodiscard]] std::vector<AidConfig> read_aids(const config::Node& list);

}  // namespace coast::jobs
