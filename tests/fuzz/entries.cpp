#include "fuzz/entries.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "coast/io/aid.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/inspect.hpp"
#include "coast/io/member_blocks.hpp"
#include "coast/io/noise_levels.hpp"
#include "coast/io/packets.hpp"
#include "coast/io/products.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/rinex.hpp"
#include "coast/io/time_marks.hpp"
#include "coast/io/yaml.hpp"
#include "coast/record/error.hpp"
#include "support/support.hpp"

namespace coast::fuzz {

namespace {

void require(bool holds, const char* promise) {
  if (!holds) throw std::logic_error(promise);
}

template <class Records>
void require_increasing(const Records& records) {
  for (std::size_t i = 1; i < records.size(); ++i) require(records[i].t > records[i - 1].t, "time increases");
}

void check(const record::ImuRecording& imu) {
  require(imu.samples.size() >= 2, "at least two samples");
  require_increasing(imu.samples);
  for (const auto& s : imu.samples) {
    require(s.dt > 0.0, "intervals are positive");
    require(s.dtheta.allFinite() && s.dv.allFinite(), "increments are finite");
  }
  (void)io::inspect(imu);
}

void check(const std::vector<record::NoiseLevel>& levels) {
  require(levels.size() >= 2, "at least two levels");
  for (const record::NoiseLevel& level : levels) {
    require(level.from < level.to, "levels last");
    require((level.gyro.array() > 0.0).all() && level.gyro.allFinite(), "noise is above zero");
    require((level.accel.array() > 0.0).all() && level.accel.allFinite(), "noise is above zero");
  }
}

void check(const record::MemberBlocks& members) {
  require(!members.blocks.empty(), "at least one block");
  for (const record::MemberBlocks::Block& block : members.blocks) {
    require(block.from < block.to, "blocks last");
    require(block.means.size() == members.names.size(), "a place for each member");
    for (const auto& means : block.means)
      require(!means || (means->gyro.allFinite() && means->accel.allFinite()), "means are finite");
  }
}

void check(const record::PacketRecording& recording) {
  require(recording.packets.size() >= 2, "at least two packets");
  require(recording.rates.size() == recording.packets.size() && recording.forces.size() == recording.packets.size(),
          "a row of values for each packet");
  for (const record::Packet& packet : recording.packets) {
    require(packet.counter >= 0 && std::isfinite(packet.arrival_s), "counters and arrivals are numbers");
    require(recording.rates.at(packet.row).allFinite() && recording.forces.at(packet.row).allFinite(), "values are finite");
  }
}

void check(const record::AidRecording& aid) {
  require(!aid.samples.empty(), "at least one sample");
  require_increasing(aid.samples);
  for (const auto& sample : aid.samples)
    require(sample.value.allFinite() && sample.sd.allFinite() && sample.sd.minCoeff() >= 0.0, "samples are finite");
}

void check(const record::GnssRecording& gnss) {
  require(!gnss.fixes.empty(), "at least one fix");
  require_increasing(gnss.fixes);
  for (const auto& fix : gnss.fixes) {
    require(fix.r_ea_e.allFinite() && fix.r_ea_e.norm() > 5e6, "positions are on the Earth");
    require(fix.position_cov_n.llt().info() == Eigen::Success, "covariance is positive definite");
    if (fix.velocity) require(fix.velocity->cov_n.llt().info() == Eigen::Success, "velocity covariance is positive definite");
  }
}

void check(const record::Trajectory& trajectory) {
  require(!trajectory.states.empty(), "at least one epoch");
  require_increasing(trajectory.states);
  for (const auto& s : trajectory.states) {
    require(s.r_eb_e.allFinite() && s.v_eb_e.allFinite(), "states are finite");
    require(std::abs(s.q_b_e.norm() - 1.0) < 1e-9, "quaternions are unit");
  }
}

void check(const record::ObservationRecording& recording) {
  require(!recording.epochs.empty(), "at least one epoch");
  require_increasing(recording.epochs);
  for (const auto& epoch : recording.epochs) {
    require(!epoch.observations.empty(), "no empty epochs");
    for (const auto& o : epoch.observations) {
      for (const auto& value : {o.code_m, o.phase_cycles, o.doppler_hz, o.cn0_dbhz})
        require(!value || std::isfinite(*value), "measurements are finite");
      require(o.satellite.number >= 1 && o.satellite.number <= 99, "satellites have a number");
    }
  }
}

void check(const record::NavigationRecording& navigation) {
  require(!navigation.kepler.empty() || !navigation.tabulated.empty(), "at least one ephemeris");
  for (const auto& e : navigation.kepler) {
    require(e.eccentricity >= 0.0 && e.eccentricity < 1.0 && e.sqrt_a > 0.0, "orbits are ellipses");
    require(std::abs(e.toe - e.toc) <= 302401.0, "orbit and clock are of one week");
  }
  for (const auto& e : navigation.tabulated) require(e.r_e.allFinite() && e.v_e.allFinite(), "orbits are finite");
}

void check(const record::TimeMarkRecording& recording) {
  require(!recording.marks.empty(), "at least one mark");
  for (std::size_t i = 1; i < recording.marks.size(); ++i)
    require(recording.marks[i].t >= recording.marks[i - 1].t, "time does not decrease");
}

void check(const record::PreciseOrbits& orbits) {
  for (const auto& [satellite, points] : orbits.points) {
    require_increasing(points);
    for (const auto& point : points)
      require(point.r_e.allFinite() && (!point.clock_s || std::isfinite(*point.clock_s)), "orbits are finite");
  }
}

void check(const record::PreciseClocks& clocks) {
  require(!clocks.points.empty(), "at least one clock");
  for (const auto& [satellite, points] : clocks.points) {
    require_increasing(points);
    for (const auto& point : points) require(std::isfinite(point.clock_s), "clocks are finite");
  }
}

void check(const record::AntennaTable& table) {
  require(!table.antennas.empty(), "at least one antenna");
  for (const auto& antenna : table.antennas)
    for (const auto& [band, centre] : antenna.bands) {
      require(centre.offset.allFinite() && centre.step > 0.0 && !centre.variations.empty(), "phase centres are whole");
      for (const auto& row : centre.variations) {
        require(row.size() == centre.variations.front().size() && !row.empty(), "tables are rectangles");
        for (const double value : row) require(std::isfinite(value), "variations are finite");
      }
    }
}

/// The bytes as a file.
const std::filesystem::path& as_file(std::string_view bytes) {
  static const test::TemporaryDirectory folder;
  static const std::filesystem::path path = folder.path() / "input";
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

template <class Read>
void read_and_check(Read&& read) {
  try {
    check(read());
  } catch (const InputError&) {
    // Refused with a message: as it should be.
  }
}

void imu(std::string_view bytes, io::ImuFileOptions options) {
  options.file = as_file(bytes);
  options.time.gps_week = 2300;
  read_and_check([&] { return io::read_imu(options); });
}

void imu_auto(std::string_view bytes) {
  imu(bytes, {});
}

void imu_table(std::string_view bytes) {
  io::ImuFileOptions options;
  options.time_columns = {1};
  options.gyro_columns = {2, 3, 4};
  options.accel_columns = {5, 6, 7};
  imu(bytes, options);
}

void imu_binary(std::string_view bytes) {
  io::ImuFileOptions options;
  options.format = "binary";
  options.time_columns = {1};
  options.gyro_columns = {2, 3, 4};
  options.accel_columns = {5, 6, 7};
  options.binary.type = io::BinaryLayout::Type::kF64;
  imu(bytes, options);
}

void gnss(std::string_view bytes, io::GnssFileOptions options) {
  options.file = as_file(bytes);
  options.time.gps_week = 2300;
  read_and_check([&] { return io::read_gnss(options); });
}

void gnss_auto(std::string_view bytes) {
  gnss(bytes, {});
}

/// Events are read from tables of positions.
void event_table(std::string_view bytes) {
  io::TimeMarkFileOptions options = io::TimeMarkFileOptions::of_file(as_file(bytes));
  options.time.kind = io::TimeKind::kUtc;
  options.time_columns = {1};
  options.id_column = 5;
  options.position_columns = {2, 3, 4};
  read_and_check([&] { return io::read_time_marks(options); });
}

void gnss_table(std::string_view bytes) {
  io::GnssFileOptions options;
  options.time.kind = io::TimeKind::kUtc;
  options.time_columns = {1};
  options.position_columns = {2, 3, 4};
  options.sd_columns = {5, 6, 7};
  options.quality_column = 8;
  options.satellites_column = 9;
  gnss(bytes, options);
  event_table(bytes);
}

void reference_auto(std::string_view bytes) {
  io::ReferenceFileOptions options = io::ReferenceFileOptions::of_file(as_file(bytes));
  options.time.gps_week = 2300;
  read_and_check([&] { return io::read_reference(options); });
}

void rinex_observation(std::string_view bytes) {
  read_and_check([&] { return io::read_observations(as_file(bytes)); });
  read_and_check([&] { return io::read_time_marks(io::TimeMarkFileOptions::of_file(as_file(bytes)), geo::GpsTime()); });
}

void rinex_navigation(std::string_view bytes) {
  read_and_check([&] { return io::read_navigation(as_file(bytes)); });
}

void sp3(std::string_view bytes) {
  read_and_check([&] { return io::read_sp3({as_file(bytes)}); });
}

void rinex_clock(std::string_view bytes) {
  read_and_check([&] { return io::read_clocks({as_file(bytes)}); });
}

void noise_levels(std::string_view bytes) {
  read_and_check([&] { return io::read_noise_levels(as_file(bytes)); });
}

void member_blocks(std::string_view bytes) {
  read_and_check([&] { return io::read_member_blocks(as_file(bytes), {"left", "right"}); });
}

void packets(std::string_view bytes) {
  io::PacketFileOptions options;
  options.file = as_file(bytes);
  options.counter = "counter";
  options.arrival = "arrival_s";
  options.gps = "gps_s";
  options.pulse = "pulse";
  options.gyro = {"gx", "gy", "gz"};
  options.accel = {"ax", "ay", "az"};
  read_and_check([&] { return io::read_packets(options); });
}

void aid(std::string_view bytes) {
  io::AidFileOptions options;
  options.file = as_file(bytes);
  options.value_columns = {"speed_mps"};
  options.sd_columns = {"speed_sd_mps"};
  options.time.gps_week = 2300;
  read_and_check([&] { return io::read_aid(options); });
}

/// IMU and positions of a format by its name.
void both_of(std::string_view bytes, const char* format) {
  io::ImuFileOptions imu_options;
  imu_options.format = format;
  imu(bytes, imu_options);
  io::GnssFileOptions gnss_options;
  gnss_options.format = format;
  gnss(bytes, gnss_options);
}

/// Everything that a format of receivers can hold.
void all_of(std::string_view bytes, const char* format) {
  both_of(bytes, format);
  rinex_observation(bytes);  // both by content
  rinex_navigation(bytes);
  read_and_check([&] { return io::read_time_marks(io::TimeMarkFileOptions::of_file(as_file(bytes))); });
}

void rtcm(std::string_view bytes) {
  rinex_observation(bytes);  // both by content
  rinex_navigation(bytes);
  read_and_check([&] { return io::read_observations(as_file(bytes), geo::GpsTime::from_week(2244, 302400.0)); });
}

void ubx(std::string_view bytes) {
  all_of(bytes, "ubx");
}

void sbf(std::string_view bytes) {
  all_of(bytes, "sbf");
}

void vectornav(std::string_view bytes) {
  both_of(bytes, "vectornav");
  rinex_observation(bytes);  // by content
}

void novatel(std::string_view bytes) {
  both_of(bytes, "novatel");
  reference_auto(bytes);
  rinex_observation(bytes);  // both by content
  rinex_navigation(bytes);
  read_and_check([&] { return io::read_time_marks(io::TimeMarkFileOptions::of_file(as_file(bytes))); });
}

void ulog(std::string_view bytes) {
  both_of(bytes, "ulog");
}

/// Bags have poses too.
void bag(std::string_view bytes, const char* format) {
  both_of(bytes, format);
  io::ReferenceFileOptions options = io::ReferenceFileOptions::of_file(as_file(bytes));
  options.format = format;
  options.position.frame = io::PositionOptions::Frame::kEnu;
  options.position.origin = geo::Geodetic{0.8, 0.1, 500.0};
  read_and_check([&] { return io::read_reference(options); });
}

void rosbag(std::string_view bytes) {
  bag(bytes, "rosbag");
}

void mcap(std::string_view bytes) {
  bag(bytes, "mcap");
}

void rosbag2(std::string_view bytes) {
  bag(bytes, "rosbag2");
}

void dataflash(std::string_view bytes) {
  both_of(bytes, "dataflash");
}

void antex(std::string_view bytes) {
  read_and_check([&] { return io::read_antex(as_file(bytes)); });
}

void yaml(std::string_view bytes) {
  try {
    const config::Node root = io::parse_yaml(std::string(bytes), "run.yaml");
    if (const auto node = root.find("imu")) (void)io::ImuFileOptions::from(*node);
    if (const auto node = root.find("gnss")) (void)io::GnssFileOptions::from(*node);
    if (const auto node = root.find("reference")) (void)io::ReferenceFileOptions::from(*node);
    root.refuse_unasked();
  } catch (const InputError&) {
    // Refused with a message: as it should be.
  }
}

}  // namespace

const std::vector<Entry>& entries() {
  static const std::vector<Entry> table = {
      {"aid", aid},
      {"imu", imu_auto},
      {"imu_table", imu_table},
      {"imu_binary", imu_binary},
      {"gnss", gnss_auto},
      {"gnss_table", gnss_table},
      {"reference", reference_auto},
      {"rtcm", rtcm},
      {"rinex_observation", rinex_observation},
      {"rinex_navigation", rinex_navigation},
      {"sbf", sbf},
      {"sp3", sp3},
      {"rinex_clock", rinex_clock},
      {"antex", antex},
      {"member_blocks", member_blocks},
      {"noise_levels", noise_levels},
      {"novatel", novatel},
      {"packets", packets},
      {"dataflash", dataflash},
      {"mcap", mcap},
      {"rosbag", rosbag},
      {"rosbag2", rosbag2},
      {"ubx", ubx},
      {"ulog", ulog},
      {"vectornav", vectornav},
      {"yaml", yaml},
  };
  return table;
}

}  // namespace coast::fuzz
