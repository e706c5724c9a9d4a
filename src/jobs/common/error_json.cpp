#include "common/error_json.hpp"

#include "coast/geo/units.hpp"

namespace coast::jobs {

nlohmann::ordered_json array_json(const Eigen::Vector3d& v) {
  return nlohmann::ordered_json::array({v.x(), v.y(), v.z()});
}

nlohmann::ordered_json degrees_json(const Eigen::Vector3d& v) {
  return array_json(v / geo::kDegree);
}

nlohmann::ordered_json error_json(const study::ErrorSummary& errors) {
  nlohmann::ordered_json j;
  j["epochs"] = errors.epochs;
  j["position_rms_m"] = array_json(errors.position.rms);
  j["position_max_m"] = array_json(errors.position.max);
  if (errors.velocity) j["velocity_rms_mps"] = array_json(errors.velocity->rms);
  if (errors.attitude) j["attitude_rms_deg"] = degrees_json(errors.attitude->rms);
  return j;
}

nlohmann::ordered_json events_json(const record::Events& events) {
  auto list = nlohmann::ordered_json::array();
  for (const record::Event& event : events) {
    nlohmann::ordered_json j;
    j["severity"] = event.severity == record::Event::Severity::kWarning ? "warning" : "info";
    j["kind"] = event.kind;
    j["text"] = event.text;
    if (event.time) j["time_s"] = event.time->sow();
    j["count"] = event.count;
    list.push_back(j);
  }
  return list;
}

}  // namespace coast::jobs
