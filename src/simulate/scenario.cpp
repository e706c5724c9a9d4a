#include "coast/simulate/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/geo/units.hpp"
#include "coast/simulate/sensor_errors.hpp"

namespace coast::simulate {
namespace {

using config::Node;
using geo::kDegree;
constexpr double kLongest = 1e5;  // s

std::string read_kind(const Node& trajectory, MotionParameters& parameters) {
  std::vector<std::string_view> names;
  for (const MotionKind& motion : motions()) names.push_back(motion.name);
  const Node kind = trajectory.at("kind");
  const MotionKind& motion = motions()[kind.choice(names)];
  parameters.static_start = trajectory.number_within("static_s", 60.0, 0.0, 3600.0);
  parameters.duration = trajectory.number_within("duration_s", 900.0, motion.shortest + parameters.static_start, kLongest);
  parameters.course = trajectory.number_within("course_deg", 0.0, -360.0, 360.0) * kDegree;
  return std::string(motion.name);
}

geo::Geodetic read_origin(const Node& trajectory) {
  const Node node = trajectory.at("origin_deg_m");
  const Eigen::Vector3d origin = node.vector3();
  if (std::abs(origin[0]) > 90.0 || std::abs(origin[1]) > 360.0 || std::abs(origin[2]) > 20000.0)
    throw node.error(fmt::format("[{}, {}, {}]", origin[0], origin[1], origin[2]),
                     "latitude -90 to 90 deg, longitude -360 to 360 deg, height -20000 to 20000 m");
  return {origin[0] * kDegree, origin[1] * kDegree, origin[2]};
}

Eigen::Vector3d not_negative(const Node& node) {
  Eigen::Vector3d v = node.vector3();
  if (v.minCoeff() < 0.0) throw node.error(fmt::format("{}", v.minCoeff()), "three values of at least 0");
  return v;
}

Eigen::Vector3d positive(const Node& node) {
  Eigen::Vector3d v = node.vector3();
  if (!(v.minCoeff() > 0.0)) throw node.error(fmt::format("{}", v.minCoeff()), "three values above 0");
  return v;
}

double positive_duration(const Node& node) {
  const double value = node.number();
  if (!(value > 0.0)) throw node.error(node.text(), "a duration above 0 s");
  return value;
}

Interval read_interval(const Node& node) {
  return {node.at("elapsed_s").number(), positive_duration(node.at("duration_s"))};
}

DegradedGnss read_degraded(const Node& node) {
  using record::FixQuality;
  constexpr std::array kQualities = {FixQuality::kFixed, FixQuality::kFloat,  FixQuality::kSbas,
                                     FixQuality::kDgps,  FixQuality::kSingle, FixQuality::kPpp};
  DegradedGnss degraded;
  degraded.when = read_interval(node);
  degraded.quality = kQualities[node.choice("quality", {"fixed", "float", "sbas", "dgps", "single", "ppp"}, 1)];
  degraded.sd_factor = node.number_within("sd_factor", 1.0, 0.0, 1e6);
  degraded.stated_sd_factor = node.number_within("stated_sd_factor", std::max(degraded.sd_factor, 1e-3), 1e-3, 1e6);
  return degraded;
}

GnssOptions read_gnss(const Node& node) {
  GnssOptions gnss;
  gnss.rate_hz = node.number_within("rate_hz", gnss.rate_hz, 0.001, 1000.0);
  gnss.phase = node.number_within("phase_s", 0.0, 0.0, kLongest);
  if (const auto sd = node.find("sd_m")) gnss.sd = not_negative(*sd);
  if (const auto correlated = node.find("correlated"))
    gnss.correlated = GnssOptions::Correlated{not_negative(correlated->at("sd_m")),
                                              correlated->number_within("correlation_time_s", 60.0, 1e-3, 1e9)};
  if (const auto stated = node.find("stated_sd_m")) gnss.stated_sd = positive(*stated);
  const Eigen::Vector3d lasting = gnss.correlated ? gnss.correlated->sd : Eigen::Vector3d::Zero();
  if (!gnss.stated_sd && gnss.sd.cwiseMax(lasting).minCoeff() == 0.0)
    throw node.error("sd_m with a zero", "stated_sd_m", "Say what sigma the error-free fixes shall state.");
  if (const auto velocity = node.find("velocity_sd_mps")) gnss.velocity_sd = positive(*velocity);
  gnss.time_offset = node.number_within("time_offset_s", 0.0, -10.0, 10.0);
  if (const auto gaps = node.find("gaps"))
    for (const Node& gap : gaps->items()) gnss.gaps.push_back(read_interval(gap));
  if (const auto degraded = node.find("degraded"))
    for (const Node& stretch : degraded->items()) gnss.degraded.push_back(read_degraded(stretch));
  return gnss;
}

Obstacle read_obstacle(const Node& node) {
  Obstacle obstacle;
  obstacle.when = read_interval(node);
  if (const auto azimuth = node.find("azimuth_deg")) {
    const std::vector<double> range = azimuth->numbers();
    if (range.size() != 2 || std::min(range[0], range[1]) < 0.0 || std::max(range[0], range[1]) > 360.0)
      throw azimuth->error("not a range of azimuths", "[from, to], clockwise from north, 0 to 360");
    obstacle.azimuth_from = range[0] * kDegree;
    obstacle.azimuth_to = range[1] * kDegree;
  }
  obstacle.elevation = node.number_within("below_deg", 90.0, 0.0, 90.0) * kDegree;
  return obstacle;
}

ObservationOptions read_observations(const Node& node) {
  using record::SatelliteSystem;
  constexpr std::array kSystems{SatelliteSystem::kGps, SatelliteSystem::kGlonass, SatelliteSystem::kGalileo,
                                SatelliteSystem::kBeidou};
  ObservationOptions o;
  if (const auto systems = node.find("systems")) {
    o.systems.clear();
    for (const Node& item : systems->items())
      o.systems.push_back(kSystems[item.choice({"gps", "glonass", "galileo", "beidou"})]);
    if (o.systems.empty()) throw systems->error("an empty list", "some of gps, glonass, galileo, beidou");
  }
  o.rate_hz = node.number_within("rate_hz", o.rate_hz, 0.001, 100.0);
  o.base_rate_hz = node.number_within("base_rate_hz", o.rate_hz, 0.001, 100.0);
  o.base_n = node.vector3("base_ned_m", o.base_n);
  o.elevation_mask = node.number_within("elevation_mask_deg", 5.0, 2.0, 60.0) * kDegree;
  o.code_sd = node.number_within("code_sd_m", o.code_sd, 0.0, 100.0);
  o.phase_sd = node.number_within("phase_sd_m", o.phase_sd, 0.0, 1.0);
  o.code_multipath_sd = node.number_within("code_multipath_sd_m", o.code_multipath_sd, 0.0, 100.0);
  o.phase_multipath_sd = node.number_within("phase_multipath_sd_m", o.phase_multipath_sd, 0.0, 1.0);
  o.multipath_time = node.number_within("multipath_time_s", o.multipath_time, 0.01, 1e5);
  o.vertical_delay = node.number_within("ionosphere_m", o.vertical_delay, 0.0, 50.0);
  o.ionosphere_gradient = 1e-6 * node.number_within("ionosphere_gradient_mm_per_km", 1e6 * o.ionosphere_gradient, 0.0, 500.0);
  o.wet_zenith_sd = node.number_within("wet_zenith_sd_m", o.wet_zenith_sd, 0.0, 1.0);
  o.slips_per_hour = node.number_within("slips_per_hour", o.slips_per_hour, 0.0, 3600.0);
  o.flagged_share = node.number_within("flagged_share", o.flagged_share, 0.0, 1.0);
  if (const auto obstacles = node.find("obstacles"))
    for (const Node& item : obstacles->items()) o.obstacles.push_back(read_obstacle(item));
  return o;
}

Scenario::Outage read_outage(const Node& node, double mission) {
  Scenario::Outage outage;
  const auto manoeuvre = node.find("manoeuvre");
  const auto duration = node.find("duration_s");
  if (manoeuvre) outage.manoeuvre = manoeuvre->text();
  if (duration) outage.duration = positive_duration(*duration);
  outage.elapsed = manoeuvre ? node.number("elapsed_s", 0.0) : node.at("elapsed_s").number();
  if (!manoeuvre && !duration) throw node.error("no duration_s", "duration_s beside elapsed_s");
  if (outage.elapsed < 0.0 || outage.elapsed >= mission)
    throw node.error(fmt::format("elapsed_s {}", outage.elapsed), fmt::format("0 to {} s, within the mission", mission));
  return outage;
}

std::uint64_t read_seed(const Node& root) {
  const long seed = root.integer("seed", 1);
  if (seed < 0) throw root.at("seed").error(fmt::format("{}", seed), "a whole number of at least 0");
  return static_cast<std::uint64_t>(seed);
}

geo::GpsTime read_start(const Node& root) {
  const auto start = root.find("start_gps");
  if (!start) return geo::GpsTime::from_week(2374, 208800.0);
  const long week = start->integer("week", 2374);
  if (week < 1 || week > 9999) throw start->at("week").error(fmt::format("{}", week), "a GPS week of 1 to 9999");
  return geo::GpsTime::from_week(static_cast<int>(week), start->number_within("sow", 0.0, 0.0, 604799.999999999));
}

Scenario::ArrayImu read_array_imu(const Node& node, const TreeReader& read) {
  Scenario::ArrayImu imu;
  imu.name = node.at("name").text();
  if (imu.name.empty() ||
      imu.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") != std::string::npos)
    throw node.at("name").error(imu.name, "letters, digits, _ and -: it names a file");
  imu.error_model = noise::ImuErrorModel::from(read(node.at("error_model").path()));
  imu.mounting = ins::MountingOptions::from(node);
  imu.position_b = node.vector3("position_m", imu.position_b);
  imu.clock_offset = node.number_within("clock_offset_s", 0.0, -10.0, 10.0);
  imu.clock_drift_ppm = node.number_within("clock_drift_ppm", 0.0, -1e4, 1e4);
  return imu;
}

StudiedOutage placed(const Scenario::Outage& outage, const MotionPlan& plan, geo::GpsTime start) {
  if (outage.manoeuvre.empty()) return {start + outage.elapsed, *outage.duration};
  std::string known;
  for (const Manoeuvre& manoeuvre : plan.manoeuvres) {
    if (manoeuvre.name == outage.manoeuvre)
      return {start + (manoeuvre.start + outage.elapsed), outage.duration.value_or(manoeuvre.duration)};
    if (known.find(manoeuvre.name) == std::string::npos) known += (known.empty() ? "" : ", ") + manoeuvre.name;
  }
  throw InputError({.file = "",
                    .line = 0,
                    .found = fmt::format("outage at the manoeuvre '{}'", outage.manoeuvre),
                    .expected = known.empty() ? "an outage at a time: this motion names no manoeuvre" : "one of " + known,
                    .what_to_do = ""});
}

}  // namespace

Scenario Scenario::from(const Node& root, const TreeReader& read) {
  const Node schema = root.at("schema");
  if (schema.text() != "coast.scenario/1") throw schema.error(schema.text(), "coast.scenario/1");
  Scenario scenario;
  const Node trajectory = root.at("trajectory");
  scenario.kind = read_kind(trajectory, scenario.motion);
  scenario.motion.origin = read_origin(trajectory);

  const Node imu = root.at("imu");
  scenario.imu_rate_hz = imu.number_within("rate_hz", 100.0, 0.1, 1e5);
  scenario.mounting = ins::MountingOptions::from(imu);
  if (const auto file = imu.find("error_model")) {
    scenario.error_model_file = file->path();
    scenario.error_model = noise::ImuErrorModel::from(read(*scenario.error_model_file));
  }
  const Node gnss = root.at("gnss");
  scenario.gnss = read_gnss(gnss);
  if (const auto observations = gnss.find("observations")) scenario.observations = read_observations(*observations);
  scenario.gnss.lever_arm_b = imu.vector3("lever_arm_m", Eigen::Vector3d::Zero());
  if (scenario.observations) scenario.observations->lever_arm_b = scenario.gnss.lever_arm_b;
  if (const auto array = root.find("array"))
    for (const Node& item : array->items()) scenario.array.push_back(read_array_imu(item, read));
  if (const auto aids = root.find("aids"))
    for (const Node& item : aids->items()) scenario.aids.push_back(AidOptions::from(item));
  if (const auto outages = root.find("outages"))
    for (const Node& outage : outages->items()) scenario.outages.push_back(read_outage(outage, scenario.motion.duration));
  scenario.start = read_start(root);
  scenario.seed = read_seed(root);
  root.refuse_unasked();
  return scenario;
}

std::vector<StudiedOutage> studied_outages(const Scenario& scenario, const MotionPlan& plan) {
  std::vector<StudiedOutage> outages;
  for (const Scenario::Outage& outage : scenario.outages) outages.push_back(placed(outage, plan, scenario.start));
  return outages;
}

ErrorFreeMission::ErrorFreeMission(const Scenario& scenario, int threads)
    : motion_(make_motion(scenario.kind, scenario.motion)),
      start_(scenario.start),
      gnss_(scenario.gnss),
      outages_(studied_outages(scenario, motion_.plan())) {
  ImuSampling sampling;
  sampling.start = scenario.start;
  sampling.rate_hz = scenario.imu_rate_hz;
  const ImuInstallation installation{Eigen::Vector3d::Zero(), ins::C_s_b(scenario.mounting).transpose()};
  increments_ = true_increments(motion_, sampling, installation, threads);
  truth_ = true_states(motion_, increments_, scenario.start, threads);
}

ErrorFreeMission::Recordings ErrorFreeMission::recorded(const std::optional<noise::ImuErrorModel>& model,
                                                        std::uint64_t seed) const {
  return {model ? with_errors(increments_, *model, seed) : increments_, gnss_fixes(motion_, start_, gnss_, seed)};
}

record::ImuRecording simulate_array_imu(const Scenario& scenario, std::size_t index, int threads) {
  constexpr std::uint64_t kOwnSeeds = 1000003;  // different from those of the scenario's own IMU and of further seeds
  const Scenario::ArrayImu& imu = scenario.array.at(index);
  const AnalyticTrajectory motion = make_motion(scenario.kind, scenario.motion);
  const double gain = 1.0 + 1e-6 * imu.clock_drift_ppm;
  ImuSampling sampling;
  sampling.start = scenario.start;
  sampling.rate_hz = scenario.imu_rate_hz * gain;  // the intervals of a fast clock are too short
  record::ImuRecording recording =
      with_errors(true_increments(motion, sampling, {imu.position_b, ins::C_s_b(imu.mounting).transpose()}, threads),
                  imu.error_model, scenario.seed + kOwnSeeds * (index + 1));
  for (record::ImuSample& sample : recording.samples)
    sample.t = scenario.start + (imu.clock_offset + gain * (sample.t - scenario.start));
  return recording;
}

SimulatedMission simulate(const Scenario& scenario, int threads) {
  const ErrorFreeMission error_free(scenario, threads);
  ErrorFreeMission::Recordings recordings = error_free.recorded(scenario.error_model, scenario.seed);
  return {std::move(recordings.imu), std::move(recordings.gnss), error_free.truth(), error_free.outages()};
}

}  // namespace coast::simulate
