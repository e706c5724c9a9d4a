#pragma once
// One outage as a line of comma-separated values: of outages.csv, and of the journal that a study goes on from.

#include <optional>
#include <string>
#include <string_view>

#include "coast/study/outage.hpp"

namespace coast::cli {

/// Names of the columns, in order: manoeuvre, then of forward and smoothed solution largest errors, errors and sigmas.
[[nodiscard]] std::string outage_columns();
/// Their values; numbers to the last digit, empty where there is none. The series is left out.
[[nodiscard]] std::string outage_values(const study::OutageResult& result);
/// The inverse, but for which outage it is.
/// @return  nothing where the text is not such a line
[[nodiscard]] std::optional<study::OutageResult> outage_from(std::string_view values);

}  // namespace coast::cli
