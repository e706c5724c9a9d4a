
#include <fmt/format.h>

#include <algorithm>

#include "coast/geo/units.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/io/imu_calibration.hpp"
#include "coast/io/writers.hpp"
#include "coast/io/yaml.hpp"
#include "coast/study/plausibility.hpp"
#include "common/keys.hpp"
#include "run_file/run_aids.hpp"
#include "run_file/run_config.hpp"
#include "run_file/run_effects.hpp"
#include "run_file/run_events.hpp"

namespace coast::jobs {

namespace {

using config::Node;

Eigen::Vector3d from_degrees(const Eigen::Vector3d& deg) {
  return geo::kDegree * deg;
}

Eigen::Vector3d positive3(const Node& node) {
  Eigen::Vector3d v = node.vector3();
  if (!(v.array() > 0.0).all()) throw node.error(node.where(), "three values above zero");
  return v;
}

/// A number for all three axes, or a list of three.
Eigen::Vector3d noise_factors(const Node& parent, std::string_view key) {
  constexpr double kLow = 1e-3, kHigh = 1e4;
  const std::optional<Node> node = parent.find(key);
  if (!node || !node->is_list()) return Eigen::Vector3d::Constant(parent.number_within(key, 1.0, kLow, kHigh));
  Eigen::Vector3d factors = node->vector3();
  if (!((factors.array() >= kLow).all() && (factors.array() <= kHigh).all()))
    throw node->error(node->where(), fmt::format("three values from {} to {}", kLow, kHigh));
  return factors;
}

GivenStart start_from(const Node& node) {
  GivenStart start;
  start.time_s = node.at("time_s").number();
  start.position = geodetic_from(node.at("position_deg_m"));
  start.velocity_n = node.at("velocity_mps").vector3();
  const Eigen::Vector3d attitude = from_degrees(node.at("attitude_deg").vector3());
  start.attitude = {attitude.x(), attitude.y(), attitude.z()};
  const Node sd = node.at("sd");
  start.sd_position_n = positive3(sd.at("position_m"));
  start.sd_velocity_n = positive3(sd.at("velocity_mps"));
  start.sd_attitude_n = from_degrees(positive3(sd.at("attitude_deg")));
  return start;
}

enum class NoiseKey { kStated, kEstimated, kAdapted };

// `noise: stated | estimated | adapted | {the values}`; values count as stated.
NoiseKey noise_key(const Node& parent, const std::function<void(const Node&)>& given) {
  const auto node = parent.find("noise");
  if (node && node->is_map()) {
    given(*node);
    return NoiseKey::kStated;
  }
  return static_cast<NoiseKey>(parent.choice("noise", {"stated", "estimated", "adapted"}, 2));
}

void read_imu_noise(const Node& imu, study::Setup& setup, estimate::NoiseFitChoice& choice) {
  const NoiseKey key = noise_key(imu, [&](const Node& given) {
    estimate::NoiseAdjustment factors;
    factors.gyro_factors = noise_factors(given, "gyro_factor");
    factors.accel_factors = noise_factors(given, "accel_factor");
    setup.model = estimate::adjusted(setup.model, factors);
    if (const auto drift = given.find("drift_factors")) {
      const study::DriftFactors factors_of{positive3(drift->at("gyro")), positive3(drift->at("accel"))};
      setup.model = study::with_drift_scaled(setup.model, 0.0, factors_of);
    }
    if (given.flag("without_gain_errors", false)) setup.model = study::without_gain_errors(setup.model, 0.0);
  });
  choice.imu_white_noise = key == NoiseKey::kEstimated;
  setup.unstated.noise.imu_white_noise =
      key == NoiseKey::kAdapted || key == NoiseKey::kEstimated;  // drift of biases and gain errors
}

void read_gnss_noise(const Node& gnss, study::Setup& setup, estimate::NoiseFitChoice& choice) {
  const NoiseKey key = noise_key(gnss, [&](const Node& given) {
    estimate::GnssScale& scale = setup.filter.gnss_scale;
    scale.horizontal = given.number_within("scale_horizontal", 1.0, 1e-3, 1e4);
    scale.vertical = given.number_within("scale_vertical", 1.0, 1e-3, 1e4);
    scale.velocity = given.number_within("scale_velocity", 1.0, 1e-3, 1e4);
    estimate::CorrelatedGnss& correlated = setup.filter.auxiliary.correlated_gnss;
    correlated.horizontal_m = given.number_within("correlated_horizontal_m", 0.0, 0.0, 1e3);
    correlated.vertical_m = given.number_within("correlated_vertical_m", 0.0, 0.0, 1e3);
    correlated.time_s = given.number_within("correlated_time_s", 60.0, 1e-2, 1e5);
  });
  choice.gnss_scale = choice.correlated_gnss = key == NoiseKey::kEstimated;
  setup.unstated.noise.gnss_scale = setup.unstated.noise.correlated_gnss = key == NoiseKey::kAdapted;
}

void read_vehicle(const Node& root, study::Setup& setup) {
  const auto vehicle = root.find("vehicle");
  if (!vehicle) return;
  const Node map = vehicle->is_map() ? *vehicle : Node();
  const std::string kind = vehicle->is_map() ? map.at("kind").text() : vehicle->text();
  if (kind != "car") throw vehicle->error("vehicle " + kind, "car");
  setup.vehicle_forward = true;
  std::vector<std::string> updates{"zupt", "zaru", "nhc"};
  if (const auto list = map.find("updates")) {
    updates.clear();
    for (const Node& item : list->items()) {
      updates.push_back(item.text());
      if (updates.back() != "zupt" && updates.back() != "zaru" && updates.back() != "nhc")
        throw item.error(updates.back(), "zupt, zaru or nhc");
    }
  }
  estimate::VehicleConstraints& constraints = setup.filter.vehicle;
  constraints.interval_s = map.number_within("interval_s", constraints.interval_s, 0.02, 60.0);
  if (std::ranges::count(updates, "zupt") > 0)
    constraints.zero_velocity_sd_mps = map.number_within("zupt_sd_mps", study::kCarZeroVelocitySd, 1e-4, 1.0);
  if (std::ranges::count(updates, "zaru") > 0)
    constraints.heading_hold_sd =
        geo::kDegree * map.number_within("zaru_sd_deg_rts", study::kCarHeadingHoldSd / geo::kDegree, 1e-6, 1.0);
  if (std::ranges::count(updates, "nhc") == 0) return;
  estimate::NonHolonomic nhc;
  nhc.point_b = map.vector3("nhc_point_m", Eigen::Vector3d::Zero());
  nhc.sd_lateral_mps = map.number_within("nhc_lateral_sd_mps", 0.1, 1e-4, 10.0);
  nhc.sd_vertical_mps = map.number_within("nhc_vertical_sd_mps", 0.1, 1e-4, 10.0);
  nhc.pitch = geo::kDegree * map.number_within("mounting_pitch_deg", 0.0, -45.0, 45.0);
  nhc.yaw = geo::kDegree * map.number_within("mounting_yaw_deg", 0.0, -180.0, 180.0);
  constraints.non_holonomic = nhc;
  setup.filter.auxiliary.mounting_sd = geo::kDegree * map.number_within("mounting_sd_deg", 5.0, 0.0, 45.0);
  setup.filter.knot_interval_s = std::min(setup.filter.knot_interval_s, constraints.interval_s);
}

int satellites_left(const Node& outage, const RunConfig& run) {
  const auto node = outage.find("satellites");
  if (!node) return 0;
  const long left = node->integer();
  if (left < 0 || left > 100) throw node->error(fmt::format("{} satellites", left), "a number from 0 to 100");
  if (left > 0 && !run.tight)
    throw node->error("a partial outage of a loosely coupled run", "gnss: {coupling: tight, ..}",
                      "Fixes need four satellites; only observations themselves help with fewer.");
  return static_cast<int>(left);
}

void read_outages(const Node& root, RunConfig& run) {
  const auto outages = root.find("outages");
  if (!outages) return;
  if (outages->is_map()) {
    run.sweep = sweep_from(*outages, run);
    return;
  }
  for (const Node& item : outages->items()) {
    OutageSeconds outage{item.at("start_s").number(), item.at("duration_s").number(), satellites_left(item, run)};
    if (!(outage.duration_s > 0.0)) throw item.at("duration_s").error("a duration of zero or less", "seconds above zero");
    run.outages.push_back(outage);
  }
}

void read_output(const Node& root, RunConfig& run) {
  const auto output = root.find("output");
  if (!output) return;
  if (const auto rate = output->find("rate_hz")) run.output.rate_hz = output->number_within("rate_hz", 0.0, 1e-3, 1e5);
  if (const auto projection = output->find("projection")) {
    run.output.projection = io::Projection::from_node(*projection);
    if (!run.ppk && run.gnss.position.above_mean_sea_level && !run.gnss.position.geoid_height)
      throw projection->error("a projection of positions whose heights are above mean sea level",
                              "`gnss: {geoid_height_m: ..}` beside `height: msl`",
                              "Without it they cannot be told from ellipsoidal heights.");
    run.output.formats.emplace_back("grid");
  }
  if (const auto formats = output->find("formats")) {
    std::vector<std::string>& wanted = run.output.formats;
    std::vector<std::string_view> known;
    for (const io::TrajectoryFormat& format : io::trajectory_formats()) known.push_back(format.name);
    wanted.clear();
    for (const Node& item : formats->items()) {
      static_cast<void>(item.choice(known));
      if (io::trajectory_format(item.text()).projected && !run.output.projection)
        throw item.error("coordinates of a map without a projection", "`output: {projection: {crs: ..}}` beside it");
      if (std::ranges::find(wanted, item.text()) == wanted.end()) wanted.push_back(item.text());
    }
    if (wanted.empty()) throw formats->error("no format", fmt::format("at least one of {}", fmt::join(known, ", ")));
  }
  run.output.point_b = output->vector3("point_m", Eigen::Vector3d::Zero());
}

void read_filter(const Node& filter, RunConfig& run) {
  run.setup.filter.gate_probability = filter.number_within("gate_probability", 1e-6, 0.0, 0.5);
  run.setup.filter.knot_interval_s = filter.number_within("knot_interval_s", 0.5, 0.01, 10.0);
  const double passes = filter.number_within("passes", 1.0, 1.0, 9.0);
  run.passes = static_cast<int>(passes);
  if (passes != run.passes || run.passes % 2 == 0)
    throw filter.at("passes").error(fmt::format("{:g} passes", passes),
                                    "an odd number: forward, or forward, backward, forward, ...");
}

void read_smoother(const Node& root, RunConfig& run) {
  const std::size_t smoother = root.choice("smoother", {"rts", "batch", "combined", "none"}, 0);
  run.smooth = smoother != 3;
  run.combined = smoother == 2;
  if (run.combined && run.passes > 1)
    throw root.at("smoother")
        .error(fmt::format("a combined solution after {} passes", run.passes), "rts, or filter: {passes: 1}",
               "After several passes either filter knows all fixes: they would count twice.");
  if (smoother != 1) return;
  if (run.tight)
    throw root.at("smoother")
        .error("a batch of tightly coupled observations", "rts: ambiguities are filtered",
               "Or positions: gnss: {coupling: loose, ppk: ..}.");
  const Node robust = root.section("robust");
  estimate::BatchOptions batch;
  batch.gnss.kind =
      static_cast<estimate::RobustLoss::Kind>(robust.choice("loss", {"squared", "huber", "cauchy", "geman_mcclure"}, 0));
  batch.gnss.scale = robust.number_within("scale", batch.gnss.scale, 0.1, 100.0);
  run.setup.batch = batch;
}

void read_imu(const Node& imu, RunConfig& run, estimate::NoiseFitChoice& choice) {
  run.imu = io::ImuFileOptions::from(imu);
  if (const auto name = imu.find("name")) run.imu_name = name->text();
  if (const auto serial = imu.find("serial")) run.imu_serial = serial->text();
  if (const auto levels = imu.find("noise_levels")) run.noise_levels = levels->path();
  run.setup.C_s_b = ins::C_s_b(ins::MountingOptions::from(imu));
  run.setup.model = noise::ImuErrorModel::from(io::load_yaml(imu.at("error_model").path()));
  if (const auto calibration = imu.find("calibration")) {
    run.calibration = io::read_imu_calibration(calibration->path());
    run.setup.model = run.setup.model.with_gains_known(*run.calibration);
  }
  if (const auto members = imu.find("members")) {
    if (run.setup.model.members().empty())
      throw members->error("members, but no `process: share` in the error model", "the error model of `coast synth` with them");
    if (run.noise_levels)
      throw members->error("members and noise_levels", "one of them: the members' own noise is that of the error model");
    run.members = members->path();
  }
  run.setup.lever_arm_b = imu.at("lever_arm_m").vector3();
  constexpr double kLongestArm = 50.0;  // m: a ship's; centimetres and millimetres of a car's exceed it
  if (run.setup.lever_arm_b.norm() > kLongestArm && !run.accept)
    throw imu.at("lever_arm_m")
        .error(fmt::format("a lever arm of {:.0f} m", run.setup.lever_arm_b.norm()), "metres from the IMU to the antenna",
               "Centimetres or millimetres? `accept: true` takes it as it is.");
  // Read only if present: a default in the resolved file would state it.
  run.setup.unstated.lever_arm = !imu.find("lever_arm_sd_m");
  if (!run.setup.unstated.lever_arm)
    run.setup.filter.auxiliary.lever_arm_sd_m = imu.number_within("lever_arm_sd_m", 0.0, 0.0, 100.0);
  run.setup.high_order_compensation = imu.choice("compensation", {"two_sample", "chebyshev"}, 0) == 1;
  read_imu_noise(imu, run.setup, choice);
}

void read_gnss(const Node& gnss, RunConfig& run, estimate::NoiseFitChoice& choice) {
  if (const auto ppk = gnss.find("ppk"))
    run.ppk = PpkConfig::from(*ppk);
  else
    run.gnss = io::GnssFileOptions::from(gnss);
  run.tight = gnss.choice("coupling", {"loose", "tight"}, 0) == 1;
  if (run.tight && !run.ppk)
    throw gnss.at("coupling")
        .error("tight coupling of positions", "gnss: {ppk: ..}",
               "Tight coupling takes the observations of a rover and a base.");
  if (run.tight && run.ppk->base_at.how == carrier::BaseAt::How::kMoving)
    throw gnss.at("coupling")
        .error("tight coupling with a moving base", "a base at rest, or coupling: loose",
               "Where a moving base is, is known to metres only.");
  run.setup.unstated.time_offset = !gnss.find("time_offset_s");
  run.setup.time_offset_s = gnss.number_within("time_offset_s", 0.0, -100.0, 100.0);
  run.setup.filter.auxiliary.time_offset_sd_s = gnss.number_within("time_offset_sd_s", 0.0, 0.0, 10.0);
  run.setup.filter.auxiliary.base_offset_sd_m = gnss.number_within("base_offset_sd_m", 0.0, 0.0, 1e4);
  if (run.tight && run.setup.filter.auxiliary.base_offset_sd_m > 0.0)
    throw gnss.at("base_offset_sd_m")
        .error("an offset of the positions of a run that does not use them", "coupling: loose, or no offset",
               "Tight coupling takes the base's position as it is given.");
  run.setup.filter.use_gnss_velocity = gnss.flag("use_velocity", true);
  read_gnss_noise(gnss, run.setup, choice);
  if (run.tight) run.setup.unstated = {};  // only fixes prepare the start
  if (run.tight && choice.gnss_scale)
    throw gnss.at("noise").error("noise of fixes that a tightly coupled run does not use", "no `noise` here",
                                 "The noise of the observations is estimated by `ppk`.");
}

}  // namespace

study::OutageSweep sweep_from(const Node& node) {
  study::OutageSweep sweep;
  sweep.every_s = node.number_within("every_s", sweep.every_s, 1.0, 1e6);
  sweep.first_s = node.number_within("first_s", sweep.first_s, 0.0, 1e6);
  sweep.durations_s = node.at("durations_s").numbers();
  for (const double duration : sweep.durations_s)
    if (!(duration > 0.0)) throw node.at("durations_s").error("a duration of zero or less", "seconds above zero");
  return sweep;
}

study::OutageSweep sweep_from(const Node& node, const RunConfig& run) {
  study::OutageSweep sweep = sweep_from(node);
  sweep.satellites_left = satellites_left(node, run);
  return sweep;
}

RunConfig read_run_config(const std::filesystem::path& file) {
  return read_run_config(io::load_yaml(file));
}

RunConfig read_run_config(const Node& root) {
  RunConfig run;
  run.file = root.file();
  run.root = root;
  static_cast<void>(root.text("schema", "coast.run/1"));
  run.accept = root.flag("accept", false);
  estimate::NoiseFitChoice choice;
  read_imu(root.at("imu"), run, choice);
  read_gnss(root.at("gnss"), run, choice);
  if (choice.gnss_scale || choice.imu_white_noise) run.setup.noise_fit = choice;
  if (const auto reference = root.find("reference")) {
    run.reference = io::ReferenceFileOptions::from(*reference);
    run.reference_lever_arm_b = reference->vector3("lever_arm_m", Eigen::Vector3d::Zero());
  }
  const auto start = root.find("start");
  if (start && start->is_map())
    run.start = start_from(*start);
  else
    static_cast<void>(root.choice("start", {"auto"}, 0));
  if (const auto filter = root.find("filter")) read_filter(*filter, run);
  read_vehicle(root, run.setup);
  if (const auto effects = root.find("effects")) {
    if (run.tight) throw effects->error("effects of a tightly coupled run", "positions: they are taken out of fixes");
    run.effects = read_effects(*effects);
  }
  if (const auto aids = root.find("aids")) run.aids = read_aids(*aids);
  read_outages(root, run);
  read_smoother(root, run);
  read_output(root, run);
  if (const auto events = root.find("events")) run.events = read_events(*events);
  root.refuse_unasked();
  return run;
}

}  // namespace coast::jobs
