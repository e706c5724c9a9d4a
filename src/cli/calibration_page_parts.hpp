#pragma once
// Sections and panels of the calibration page: calibration_page_<part>.cpp. What has no data is absent.

#include <optional>
#include <string>
#include <vector>

#include "calibration_result.hpp"
#include "coast/report/page.hpp"

namespace coast::cli {

/// Allan curves of a sensor's axes, and the coefficients that people read from them.
[[nodiscard]] report::Section sensor_section(const CalibrationResult& result, noise::Sensor sensor);
[[nodiscard]] report::Section axis_section(const CalibrationConfig& config, const CalibratedAxis& axis);

// --- of one axis

/// Curve of the record or records, of the model and of its parts, and the band of its realisations.
[[nodiscard]] report::Panel allan_panel(const CalibratedAxis& axis);
/// The record among realisations of the estimate; its first samples beside those of one.
void add_restitution(const CalibratedAxis& axis, std::uint64_t seed, report::Section& section);
[[nodiscard]] std::optional<report::Panel> components_panel(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Panel> search_panel(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Panel> whiteness_panel(const CalibratedAxis& axis);
/// The records that the estimate was held against, with its band for each.
[[nodiscard]] std::optional<report::Panel> tests_panel(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Table> tests_table(const CalibratedAxis& axis);
/// Estimates of each record alone, where there are several.
[[nodiscard]] std::optional<report::Panel> records_panel(const CalibratedAxis& axis);

[[nodiscard]] report::Table parameter_table(const CalibratedAxis& axis);
[[nodiscard]] report::Table means_table(const CalibratedAxis& axis);
[[nodiscard]] report::Table candidate_table(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Table> combination_table(const CalibratedAxis& axis);

// --- shared

/// "gyro-x", the begin of every id of an axis.
[[nodiscard]] std::string id_of(const CalibratedAxis& axis);
/// Colour of x, y or z.
[[nodiscard]] report::Tone tone_of(const CalibratedAxis& axis);
/// Name of a record for legends: its file without folder and extensions.
[[nodiscard]] std::string record_name(const std::string& source);
/// "12 s", "3.4 h", "21 d"
[[nodiscard]] std::string duration_text(double seconds);
/// A number with three significant digits, with a power of ten where it is far from 1.
[[nodiscard]] std::string figure(double value);
/// A record's Allan deviation with its 95 % band, in a unit.
[[nodiscard]] report::Series allan_series(const noise::AllanCurve& curve, const char* unit, bool band);
/// The median of realisations with the band of 95 % of all curves.
[[nodiscard]] report::Series band_series(const noise::CurveBand& band, const char* unit);
/// An empty plot of Allan deviations, with the view on these curves: parts of a model go far below.
[[nodiscard]] report::Plot allan_plot(const std::vector<const noise::AllanCurve*>& curves, const char* unit);

}  // namespace coast::cli
