#pragma once
// One outage as a line of comma-separated values: for outages.csv, and for the journal from which a study is resumed.

#include <optional>
#include <string>
#include <string_view>

#include "coast/study/outage.hpp"

namespace coast::jobs {

/// Names of the columns, in order: manoeuvre, then largest errors, errors and sigmas of forward and smoothed solution.
[[nodiscard]] std::string outage_columns();
/// Their values; numbers to the last digit, empty if absent. The series is omitted.
[[nodiscard]] std::string outage_values(const study::OutageResult& result);
/// The inverse, except for the identity of the outage.
/// @return  none if the text is not such a line
[[nodiscard]] std::optional<study::OutageResult> outage_from(std::string_view values);

}  // namespace coast::jobs
