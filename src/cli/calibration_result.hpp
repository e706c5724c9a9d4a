#pragma once
// What `coast calibrate` found, for its files, its page and the terminal.

#include <string>
#include <vector>

#include "calibration_config.hpp"
#include "coast/record/event.hpp"

namespace coast::cli {

/// One recording as it was read.
struct ReadRecord {
  std::string source;
  double duration = 0.0;     ///< s, holes included
  std::uint64_t length = 0;  ///< intervals, holes included
  std::size_t samples = 0;
  std::size_t holes = 0;
  std::vector<std::string> remarks;
};

/// A chosen sum fitted to one of several records alone.
struct OwnEstimate {
  std::vector<double> u;
  std::vector<double> sd;  ///< of each u, Cramer-Rao; infinite: nothing is known
};

/// A record that the estimate was held against.
struct TestedRecord {
  std::string source;
  noise::RecordTest test;
};

struct CalibratedAxis {
  SensorAxis axis;
  std::vector<noise::StaticSignal> signals;  ///< of each record that was estimated from
  noise::AxisCalibration result;
  std::vector<OwnEstimate> own;  ///< of each record, where there are several
  std::vector<TestedRecord> tests;
};

struct CalibrationResult {
  double interval = 0.0;  ///< s
  std::vector<ReadRecord> records;
  std::vector<ReadRecord> tested_on;
  record::Events events;  ///< of the readers
  std::vector<CalibratedAxis> axes;

  /// Those of one sensor, in order.
  [[nodiscard]] std::vector<const CalibratedAxis*> of(noise::Sensor sensor) const {
    std::vector<const CalibratedAxis*> list;
    for (const CalibratedAxis& axis : axes)
      if (axis.axis.sensor == sensor) list.push_back(&axis);
    return list;
  }
};

/// error_model.yaml: what was chosen, as `coast process` reads it, with where each value comes from.
[[nodiscard]] std::string error_model_yaml(const CalibrationConfig& config, const CalibrationResult& result);
/// calibration.json (docs/schema/calibration.schema.json).
[[nodiscard]] std::string calibration_json(const CalibrationConfig& config, const CalibrationResult& result);
/// A few lines per axis for the terminal.
[[nodiscard]] std::string calibration_text(const CalibrationResult& result);

}  // namespace coast::cli
