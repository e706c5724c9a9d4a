#pragma once
// result.json of a unit: what is merged, and what it cost.

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "coast/jobs/diagnose.hpp"
#include "coast/jobs/outage.hpp"
#include "coast/jobs/process.hpp"

namespace coast::jobs {

inline constexpr const char* kResult = "result.json";    ///< closes a result
inline constexpr const char* kError = "error.txt";       ///< beside it if the unit has failed
inline constexpr const char* kSummary = "summary.json";  ///< of the job, beside it

/// One line of estimates.csv.
struct CampaignEstimated {
  std::string quantity, axis;
  double value = 0.0;
  double sigma = 0.0;
  std::string unit;
};

/// What a unit contributes to the merged files.
struct UnitResult {
  nlohmann::ordered_json row = nlohmann::ordered_json::object();  ///< of missions.csv, by column
  std::vector<std::string> outages = {};                          ///< start_s, duration_s, then outage_columns()
  std::vector<CampaignEstimated> estimates = {};
  std::string imu = {};          ///< which device
  std::string temperature = {};  ///< mean, degC; empty: not known
  std::string error = {};        ///< empty unless it has failed
};

/// What a unit has used. It is told, and never merged.
struct UnitCost {
  double seconds = 0.0;
  double memory_bytes = 0.0;  ///< of the process, where the unit ran alone; else 0
};

[[nodiscard]] std::string result_json(const UnitResult& result, const UnitCost& cost);
/// @return  none if the text is not whole
[[nodiscard]] std::optional<UnitResult> result_from(const std::string& json);
[[nodiscard]] std::optional<UnitCost> cost_from(const std::string& json);

/// Columns of missions.csv between those of the factors and the error, in order.
[[nodiscard]] const std::vector<std::string>& mission_columns();

/// Mean temperature of the IMU as text; empty if it was not recorded.
[[nodiscard]] std::string temperature_of(const record::ImuRecording& imu);
/// The stated name and serial number of an IMU, else the sensor of its error model.
[[nodiscard]] std::string device_of(const RunConfig& config);

[[nodiscard]] UnitResult unit_result(const ProcessResult& result);
[[nodiscard]] UnitResult unit_result(const OutageStudy& study);
[[nodiscard]] UnitResult unit_result(const DiagnosisResult& result);

/// One outage as a line of a unit.
[[nodiscard]] std::string outage_line(double start_s, const study::OutageResult& outage);
/// The inverse. @return  none if the text is no such line
[[nodiscard]] std::optional<study::OutageResult> outage_from_line(std::string_view line);

}  // namespace coast::jobs
