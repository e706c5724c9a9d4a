#include "coast/jobs/ppk.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/run_file.hpp"
#include "common/indented.hpp"
#include "common/keys.hpp"

namespace coast::jobs {

namespace {

// Also the example of docs/schema/ppk.schema.json; a test holds them together.
constexpr std::string_view kPpkExample = R"(schema: coast.ppk/1
rover: rover.obs
base: base.obs.gz
nav: [brdc.nav]
base_position: {ecef_m: [-3959400.631, 3385704.533, 3667523.111]}
)";

using config::Node;
using record::SatelliteSystem;

std::vector<std::filesystem::path> paths(const Node& node) {
  std::vector<std::filesystem::path> all;
  if (!node.is_list()) return {node.path()};
  for (const Node& item : node.items()) all.push_back(item.path());
  if (all.empty()) throw node.error("an empty list", "one file or more");
  return all;
}

Eigen::Vector3d given_position(const Node& node) {
  constexpr double kLeast = 6.2e6, kMost = 7e6;  // m from the Earth's centre
  const auto on_earth = [](double radius) { return radius > kLeast && radius < kMost; };
  const auto ecef = node.find("ecef_m");
  if (!ecef) {
    const Node geodetic = node.at("geodetic_deg_m");
    if (on_earth(geodetic.vector3().norm()))
      throw geodetic.error("x, y, z in m, ECEF", "[latitude_deg, longitude_deg, height_m]", "Give them as ecef_m.");
    return geo::ecef_from_geodetic(geodetic_from(geodetic));
  }
  if (on_earth(ecef->vector3().norm())) return ecef->vector3();
  const Eigen::Vector3d r_e = ecef->vector3();
  const bool degrees = std::abs(r_e.x()) <= 90.0 && std::abs(r_e.y()) <= 360.0;
  throw ecef->error("a point not on the Earth", "x, y, z in m, ECEF",
                    on_earth(1e3 * r_e.norm()) ? "Kilometres?"
                    : degrees                  ? "Degrees? Then it is geodetic_deg_m: [latitude, longitude, height]."
                                               : "");
}

double epoch_of(const Node& node) {
  constexpr double kFirst = 1980.0, kLast = 2100.0;
  const Node epoch = node.at("epoch");
  const double year = epoch.number();
  if (!(year >= kFirst && year <= kLast)) throw epoch.error(fmt::format("{:g}", year), "a decimal year from 1980 to 2100");
  return year;
}

/// Reference frame, epoch, and the marker's velocity or its plate.
carrier::BaseAt::Datum datum(const Node& node, const Eigen::Vector3d& r_e) {
  const Node frame = node.at("frame");
  const auto name = geo::frame_of(frame.text());
  if (!name) throw frame.error("reference frame " + frame.text(), fmt::format("one of {}", fmt::join(geo::frames(), ", ")));
  carrier::BaseAt::Datum datum{{*name, epoch_of(node)}, Eigen::Vector3d::Zero()};
  if (const auto velocity = node.find("velocity_mpy")) {
    datum.velocity_mpy = velocity->vector3();
    return datum;
  }
  const Node plate = node.at("plate");
  const auto moved = geo::plate_velocity(plate.text(), r_e, *name);
  if (!moved) throw plate.error("plate " + plate.text(), fmt::format("one of {}", fmt::join(geo::plates(), ", ")));
  datum.velocity_mpy = *moved;
  return datum;
}

carrier::BaseAt base_position(const Node& map) {
  using carrier::BaseAt;
  constexpr std::array kHows{BaseAt::How::kHeader, BaseAt::How::kAverage, BaseAt::How::kMoving};
  const auto node = map.find("base_position");
  if (node && node->is_list())
    throw node->error("a list", "{ecef_m: [x, y, z]}, {geodetic_deg_m: [latitude, longitude, height]}, or header");
  if (!node || !node->is_map()) {
    const BaseAt::How how = kHows[map.choice("base_position", {"header", "average", "moving"}, 0)];
    return {node ? how : BaseAt::How::kUnstated, {}, {}};
  }
  BaseAt given{BaseAt::How::kGiven, given_position(*node), std::nullopt};
  if (node->find("frame")) given.datum = datum(*node, given.r_e);
  return given;
}

std::set<SatelliteSystem> systems(const Node& map, std::set<SatelliteSystem> otherwise) {
  constexpr std::array kSystems{SatelliteSystem::kGps, SatelliteSystem::kGlonass, SatelliteSystem::kGalileo,
                                SatelliteSystem::kBeidou, SatelliteSystem::kQzss};
  const auto list = map.find("systems");
  if (!list) return otherwise;
  std::set<SatelliteSystem> chosen;
  for (const Node& item : list->items()) chosen.insert(kSystems[item.choice({"gps", "glonass", "galileo", "beidou", "qzss"})]);
  if (chosen.empty()) throw list->error("an empty list", "some of gps, glonass, galileo, beidou, qzss");
  return chosen;
}

void read_fixing(const Node& map, carrier::FixingOptions& fixing) {
  const auto node = map.find("fix");
  if (node && !node->is_map()) {
    fixing.wanted = node->flag();
    return;
  }
  const Node fix = map.section("fix");
  fixing.ratio = fix.number_within("ratio", fixing.ratio, 1.0, 1e3);
  fixing.success_rate = fix.number_within("success_rate", fixing.success_rate, 0.0, 1.0);
  fixing.elevation_mask = geo::kDegree * fix.number_within("elevation_mask_deg", 0.0, 0.0, 80.0);
  fixing.hold = fix.flag("hold", false);
}

void read_noise(const Node& map, carrier::PpkOptions& options) {
  const auto node = map.find("noise");
  if (!node || !node->is_map()) {
    static_cast<void>(map.choice("noise", {"estimated"}, 0));
    return;
  }
  carrier::NoiseScale noise;
  noise.phase = node->number_within("phase", 1.0, 1e-3, 100.0);
  noise.code = node->number_within("code", 1.0, 1e-3, 100.0);
  noise.code_inflation = node->number_within("code_inflation", 1.0, 1.0, 100.0);
  noise.rate = node->number_within("rate", 1.0, 1e-3, 100.0);
  options.noise = noise;
}

}  // namespace

std::string ppk_example(const std::string& indent) {
  return indented(kPpkExample, indent);
}

PpkConfig PpkConfig::from(const Node& map) {
  PpkConfig config;
  config.map = map;
  config.rover = map.at("rover").path();
  config.base = map.at("base").path();
  config.navigation = paths(map.at("nav"));
  if (const auto sp3 = map.find("sp3")) config.sp3 = paths(*sp3);
  if (const auto clocks = map.find("clk")) config.clocks = paths(*clocks);
  if (!config.clocks.empty() && config.sp3.empty()) throw map.at("clk").error("clocks without orbits", "sp3 beside clk");
  if (const auto antex = map.find("antex")) config.antex = antex->path();
  config.base_at = base_position(map);
  carrier::PpkOptions& o = config.options;
  o.differences.systems = systems(map, o.differences.systems);
  o.differences.elevation_mask = geo::kDegree * map.number_within("elevation_mask_deg", 10.0, 0.0, 60.0);
  o.differences.longest_base_gap_s = map.number_within("longest_base_gap_s", o.differences.longest_base_gap_s, 0.0, 3600.0);
  o.differences.air.troposphere = map.choice("troposphere", {"global", "none"}, 0) == 0;
  const std::size_t ionosphere = map.choice("ionosphere", {"broadcast", "none", "free"}, 0);
  config.broadcast_ionosphere = ionosphere == 0;
  o.differences.air.ionosphere_free = ionosphere == 2;
  o.motion =
      map.choice("motion", {"kinematic", "static"}, 0) == 0 ? carrier::RoverMotion::kKinematic : carrier::RoverMotion::kStatic;
  constexpr std::array kOrders{carrier::PassOrder::kCombined, carrier::PassOrder::kForward, carrier::PassOrder::kBackward};
  o.order = kOrders[map.choice("solution", {"combined", "forward", "backward"}, 0)];
  read_fixing(map, o.fixing);
  read_noise(map, o);
  return config;
}

PpkConfig read_ppk(const std::filesystem::path& file) {
  return read_ppk(io::load_yaml(file));
}

PpkConfig read_ppk(const Node& root) {
  if (const auto gnss = root.find("gnss")) {
    const Node map = gnss->at("ppk");
    PpkConfig config = PpkConfig::from(map);
    map.refuse_unasked();
    if (const auto output = root.find("output"))
      if (const auto projection = output->find("projection")) config.projection = io::Projection::from_node(*projection);
    return config;
  }
  static_cast<void>(root.choice("schema", {"coast.ppk/1"}, 0));
  PpkConfig config = PpkConfig::from(root);
  if (const auto projection = root.find("projection")) config.projection = io::Projection::from_node(*projection);
  root.refuse_unasked();
  return config;
}

}  // namespace coast::jobs
