#include "process/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coast/geo/units.hpp"
#include "common/drift.hpp"
#include "common/error_json.hpp"
#include "process/event_results.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

Json outage_errors_json(const study::OutageErrors& e) {
  Json j;
  j["max_m"] = array_json(e.max_m);
  j["rms_m"] = array_json(e.rms_m);
  j["end_m"] = array_json(e.end_m);
  j["sigma_end_m"] = array_json(e.sigma_end_m);
  j["sigma_max_m"] = array_json(e.sigma_max_m);
  j["horizontal_max_m"] = e.horizontal_max_m;
  if (e.gnss_horizontal_max_m) j["gnss_horizontal_max_m"] = *e.gnss_horizontal_max_m;
  j["attitude_max_deg"] = degrees_json(e.attitude_max);
  if (e.tested > 0) j["share_inside_95"] = static_cast<double>(e.inside_95) / static_cast<double>(e.tested);
  return j;
}

Json outage_json(const study::OutageResult& o, const std::string& compared_with) {
  Json j;
  j["start_s"] = o.outage.start.sow();
  j["duration_s"] = o.outage.duration_s;
  if (o.outage.satellites_left > 0) j["satellites"] = o.outage.satellites_left;
  j["compared_with"] = compared_with;
  j["forward"] = outage_errors_json(o.forward);
  if (o.smoothed) j["smoothed"] = outage_errors_json(*o.smoothed);
  return j;
}

Json sweep_json(const std::vector<study::OutageResult>& sweep, const std::string& compared_with) {
  Json list = Json::array();
  for (const DriftRow& row : drift_table(sweep)) {
    Json j;
    j["duration_s"] = row.duration_s;
    j["outages"] = row.outages;
    j["compared_with"] = compared_with;
    j["forward_horizontal_max"] = spread_json(row.forward.horizontal);
    j["smoothed_horizontal_max"] = spread_json(row.smoothed.horizontal);
    if (row.forward.against_gnss) j["forward_horizontal_max_against_gnss"] = spread_json(*row.forward.against_gnss);
    if (row.smoothed.against_gnss) j["smoothed_horizontal_max_against_gnss"] = spread_json(*row.smoothed.against_gnss);
    j["smoothed_share_inside_95"] = row.smoothed.inside_95;
    list.push_back(j);
  }
  return list;
}

Json noise_json(const estimate::NoiseFit& fit) {
  Json j;
  const auto& a = fit.adjustment;
  j["gnss_scale"] = {
      {"horizontal", a.gnss_scale.horizontal}, {"vertical", a.gnss_scale.vertical}, {"velocity", a.gnss_scale.velocity}};
  j["correlated_gnss"] = {{"horizontal_m", a.correlated_gnss.horizontal_m},
                          {"vertical_m", a.correlated_gnss.vertical_m},
                          {"time_s", a.correlated_gnss.time_s}};
  j["gyro_factor"] = std::vector<double>(a.gyro_factors.begin(), a.gyro_factors.end());
  j["accel_factor"] = std::vector<double>(a.accel_factors.begin(), a.accel_factors.end());
  j["log_likelihood"] = {fit.log_likelihood_before, fit.log_likelihood_after};
  return j;
}

Json batch_json(const estimate::BatchReport& batch) {
  Json j;
  j["iterations"] = batch.cost.size();
  j["converged"] = batch.converged;
  j["cost"] = {batch.cost.front(), batch.cost.back()};
  j["condition"] = batch.condition;
  j["unknowns"] = Json::array();
  for (const estimate::MissionUnknown& u : batch.unknowns)
    j["unknowns"].push_back({{"name", u.name},
                             {"estimate", u.estimate},
                             {"prior_sd", u.prior_sd},
                             {"posterior_sd", u.posterior_sd},
                             {"observability", estimate::name(u.observability())},
                             {"with", u.with},
                             {"correlation", u.correlation}});
  return j;
}

Json separation_json(const std::vector<Separation>& separations) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d attitude = Eigen::Vector3d::Zero();
  for (const Separation& s : separations) {
    position += s.position_n.cwiseAbs2();
    attitude += s.attitude.cwiseAbs2();
  }
  const double n = static_cast<double>(separations.size());
  Json j;
  j["epochs"] = separations.size();
  j["position_rms_m"] = array_json((position / n).cwiseSqrt());
  j["attitude_rms_arcmin"] = array_json((attitude / n).cwiseSqrt() / geo::kArcMinute);
  return j;
}

Json time_marks_json(const EventResults& marked) {
  Json j{{"located", marked.states.size()}, {"missed", marked.missed.size()}};
  if (!marked.states.empty()) {
    const WorstSigmas worst = worst_sigmas(marked.states);
    j["sd_position_max_m"] = array_json(worst.position);
    j["sd_attitude_max_deg"] = degrees_json(worst.attitude);
    j["worst_position"] = worst.id;
  }
  if (marked.delay)
    j["delay_found"] = {
        {"beyond_stated_s", marked.delay->delay_s}, {"sd_s", marked.delay->sd_s}, {"marks", marked.delay->marks}};
  return j;
}

Json projection_json(const io::Projection& projection, const ProjectedStart& start) {
  const io::GridColumns& names = projection.columns();
  Json j{{"crs", projection.crs()},
         {"name", projection.name()},
         {"heights", projection.heights()},
         {"transformation", projection.operation()}};
  j["start"] = {{names.easting, start.place.easting}, {names.northing, start.place.northing},
                {names.height, start.place.height},   {"convergence_deg", start.convergence / geo::kDegree},
                {"point_scale", start.scale.point},   {"combined_scale", start.scale.combined}};
  return j;
}

/// @param written  of the trajectory: trajectory.nav and others of that name, forward.nav
/// @param events   whether the run has events
Json files_json(const std::vector<std::string>& written, bool events) {
  const auto has = [&](const char* file) { return std::ranges::find(written, file) != written.end(); };
  Json j;
  if (!written.empty()) j["trajectory"] = written.front();
  if (has("forward.nav")) j["forward"] = "forward.nav";
  if (has("trajectory.grid.csv")) j["grid"] = "trajectory.grid.csv";
  if (has("trajectory.csv")) j["covariance"] = "trajectory.csv";
  if (events) j["events"] = "events.csv";
  j["report"] = "report.html";
  j["resolved"] = "run.resolved.yaml";
  return j;
}

Json verdict_json(const Judgement& verdict) {
  Json j{{"standing", name(verdict.standing())}, {"accepted", verdict.accepted}};
  if (!verdict.likely_cause.empty()) j["likely_cause"] = verdict.likely_cause;
  constexpr std::size_t kTold = 5;
  for (std::size_t i = 0; i < std::min(kTold, verdict.causes.size()); ++i) {
    const study::Cause& cause = verdict.causes[i];
    j["causes_by_likelihood"].push_back({{"what", cause.what}, {"remedy", cause.remedy}, {"log_likelihood_gain", cause.gain}});
  }
  j["checks"] = Json::array();
  for (const Check& check : verdict.checks) {
    Json c{{"name", check.name}, {"standing", name(check.standing())}, {"value", check.value}, {"good_up_to", check.good}};
    if (check.usable) c["usable_up_to"] = *check.usable;
    c["text"] = check.text;
    j["checks"].push_back(std::move(c));
  }
  return j;
}

}  // namespace

std::string gnss_left(const study::Outage& outage) {
  return outage.satellites_left > 0 ? fmt::format("with {} satellites", outage.satellites_left) : "without GNSS";
}

NisSummary nis_of(const std::vector<estimate::InnovationRecord>& innovations) {
  NisSummary s;
  double nis = 0.0;
  double dof = 0.0;
  std::optional<geo::GpsTime> last;
  for (const estimate::InnovationRecord& r : innovations) {
    if (!r.used || !(estimate::is_position(r.kind) || r.kind == estimate::UpdateKind::kGnssVelocity)) continue;
    if (!last || *last != r.t) ++s.epochs;
    last = r.t;
    nis += r.nis;
    dof += r.dof;
  }
  if (s.epochs == 0) return s;
  s.mean = nis / static_cast<double>(s.epochs);
  s.expected = dof / static_cast<double>(s.epochs);
  return s;
}

std::string summary_json(const ProcessResult& result) {
  Json j;
  j["schema"] = "coast.summary/1";
  j["verdict"] = verdict_json(result.verdict);
  j["imu"] = {{"samples", result.imu_samples}, {"rate_hz", result.imu_rate_hz}, {"gaps", result.imu_gaps}};
  j["gnss"] = {{"epochs", result.gnss_epochs}, {"used", result.gnss_used}, {"rejected", result.gnss_rejected}};
  j["gnss"]["time_offset_s"] = result.time_offset_s;
  if (result.time_offset_sd_s) j["gnss"]["time_offset_sd_s"] = *result.time_offset_sd_s;
  if (result.nis.epochs > 0)
    j["nis"] = {{"mean", result.nis.mean}, {"expected", result.nis.expected}, {"epochs", result.nis.epochs}};
  for (const AidUse& aid : result.aids) {
    Json a{{"name", aid.name}, {"used", aid.used}, {"refused", aid.refused}};
    if (aid.nis.epochs > 0) a["nis"] = {{"mean", aid.nis.mean}, {"expected", aid.nis.expected}};
    j["aids"].push_back(std::move(a));
  }
  j["span"] = {{"week", result.start.week()}, {"start_s", result.start.sow()}, {"end_s", result.end.sow()}};
  j["alignment"] = result.alignment;
  if (result.reference) {
    if (result.reference->smoothed)
      j["reference"]["smoothed"] = error_json(result.reference->summary(*result.reference->smoothed));
    j["reference"]["forward"] = error_json(result.reference->summary(result.reference->forward));
  }
  if (!result.outages.empty())
    for (const auto& outage : result.outages) j["outages"].push_back(outage_json(outage, result.compared_with));
  if (!result.sweep.empty()) {
    j["outage_sweep"] = sweep_json(result.sweep, result.compared_with);
    for (const auto& outage : result.sweep) j["outages"].push_back(outage_json(outage, result.compared_with));
  }
  if (result.noise_fit) j["noise_fit"] = noise_json(*result.noise_fit);
  if (result.batch) j["batch"] = batch_json(*result.batch);
  if (result.lever_arm)
    j["lever_arm_misclosure"] = {{"estimated_minus_configured_m", array_json(result.lever_arm->difference_m)},
                                 {"sd_m", array_json(result.lever_arm->sd_m)}};
  if (result.marked) j["time_marks"] = time_marks_json(*result.marked);
  if (result.projection) j["projection"] = projection_json(*result.projection, *result.projected_start);
  if (!result.separations.empty()) j["forward_backward_separation"] = separation_json(result.separations);
  for (const StateTrack& track : result.states)
    if (!track.smoothed.empty())
      j["states_at_end"][track.name] = {{"value", track.smoothed.back()}, {"sd", track.smoothed_sd.back()}};
  j["events"] = events_json(result.events);
  j["files"] = files_json(result.files, result.marked.has_value());
  return j.dump(1) + "\n";
}

std::string innovations_csv(const ProcessResult& result) {
  std::string text = "gps_week,sow_s,kind,used,quality,nu_1,nu_2,nu_3,sd_1,sd_2,sd_3,nis,dof\n";
  const auto name_of = [&result](const estimate::InnovationRecord& r) -> std::string_view {
    return r.kind == estimate::UpdateKind::kAid ? result.aids[r.aid].name : estimate::name(r.kind);
  };
  for (const estimate::InnovationRecord& r : result.innovations)
    text += fmt::format("{},{:.6f},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{}\n", r.t.week(), r.t.sow(),
                        name_of(r), r.used ? 1 : 0, static_cast<int>(r.quality), r.nu.x(), r.nu.y(), r.nu.z(), r.sd.x(),
                        r.sd.y(), r.sd.z(), r.nis, r.dof);
  return text;
}

std::string summary_text(const ProcessResult& result) {
  std::string text = fmt::format("{:.1f} s processed, {} of {} GNSS epochs used, {} refused; NIS {:.2f}, expected {:.2f}\n",
                                 result.end - result.start, result.gnss_used, result.gnss_epochs, result.gnss_rejected,
                                 result.nis.mean, result.nis.expected);
  text += "start: " + result.alignment + "\n";
  for (const AidUse& aid : result.aids)
    text += fmt::format("{}: {} samples used, {} refused; NIS {:.2f}, expected {:.2f}\n", aid.name, aid.used, aid.refused,
                        aid.nis.mean, aid.nis.expected);
  for (const record::Event& event : result.events)
    if (event.kind == "gnss_sigmas_do_not_fit") text += "warning: " + event.text + "\n";
  if (result.reference) {
    const AgainstReference& r = *result.reference;
    const Eigen::Vector3d rms = r.summary(r.smoothed ? *r.smoothed : r.forward).position.rms;
    text += fmt::format("against the reference, rms: {:.3f} {:.3f} {:.3f} m N E D\n", rms.x(), rms.y(), rms.z());
  }
  if (result.marked) text += events_text(*result.marked, result.events);
  for (const DriftRow& row : drift_table(result.sweep))
    text += fmt::format("outages of {:g} s {} ({}): largest horizontal error, median: forward {:.3f} m, smoothed {:.3f} m\n",
                        row.duration_s, gnss_left(result.sweep.front().outage), row.outages, row.forward.horizontal.median,
                        row.smoothed.horizontal.median);
  for (const auto& o : result.outages)
    text += fmt::format("outage at {:.1f} s for {:g} s {}: largest horizontal error forward {:.3f} m{}\n", o.outage.start.sow(),
                        o.outage.duration_s, gnss_left(o.outage), o.forward.horizontal_max_m,
                        o.smoothed ? fmt::format(", smoothed {:.3f} m", o.smoothed->horizontal_max_m) : "");
  return text;
}

}  // namespace coast::jobs
