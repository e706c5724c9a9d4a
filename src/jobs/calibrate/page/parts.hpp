#pragma once
// Sections and panels of the calibration page: calibration_page_<part>.cpp. Sections and panels without data are omitted.

#include <optional>
#include <string>
#include <vector>

#include "calibrate/result.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// Allan curves of a sensor's axes, and the coefficients read from them.
[[nodiscard]] report::Section sensor_section(const CalibrationResult& result, noise::Sensor sensor);
[[nodiscard]] report::Section axis_section(const CalibrationConfig& config, const CalibratedAxis& axis);

// --- for one axis

/// Curves of the records, of the model and of its parts, and the band of its realisations.
[[nodiscard]] report::Panel allan_panel(const CalibratedAxis& axis);
/// The record among realisations of the estimate; its first samples next to those of one realisation.
void add_restitution(const CalibratedAxis& axis, std::uint64_t seed, report::Section& section);
[[nodiscard]] std::optional<report::Panel> components_panel(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Panel> search_panel(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Panel> whiteness_panel(const CalibratedAxis& axis);
/// The test records of the estimate, with its band for each.
[[nodiscard]] std::optional<report::Panel> tests_panel(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Table> tests_table(const CalibratedAxis& axis);
/// Estimates from each record alone, if there are several.
[[nodiscard]] std::optional<report::Panel> records_panel(const CalibratedAxis& axis);

[[nodiscard]] report::Table parameter_table(const CalibratedAxis& axis);
[[nodiscard]] report::Table means_table(const CalibratedAxis& axis);
[[nodiscard]] report::Table candidate_table(const CalibratedAxis& axis);
[[nodiscard]] std::optional<report::Table> combination_table(const CalibratedAxis& axis);

// --- shared

/// "gyro-x", the first part of all ids of an axis.
[[nodiscard]] std::string id_of(const CalibratedAxis& axis);
/// Colour of x, y or z.
[[nodiscard]] report::Tone tone_of(const CalibratedAxis& axis);
/// Name of a record for legends: its file without folder and extensions.
[[nodiscard]] std::string record_name(const std::string& source);
/// "12 s", "3.4 h", "21 d"
[[nodiscard]] std::string duration_text(double seconds);
/// A number with three significant digits, with a power of ten if it is far from 1.
[[nodiscard]] std::string figure(double value);
/// A record's Allan deviation with its 95 % band, in a unit.
[[nodiscard]] report::Series allan_series(const noise::AllanCurve& curve, const char* unit, bool band);
/// The median of realisations with the band that contains 95 % of all curves.
[[nodiscard]] report::Series band_series(const noise::CurveBand& band, const char* unit);
/// An empty plot of Allan deviations with its view set by these curves, as parts of a model are far below.
[[nodiscard]] report::Plot allan_plot(const std::vector<const noise::AllanCurve*>& curves, const char* unit);

}  // namespace coast::jobs
