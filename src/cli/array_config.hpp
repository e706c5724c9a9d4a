#pragma once
// array.yaml: which IMUs `coast synth` merges, and how.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coast/array/assembly.hpp"
#include "coast/array/clock.hpp"
#include "coast/array/synthetic.hpp"
#include "coast/config/node.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/packets.hpp"
#include "coast/noise/error_model.hpp"

namespace coast::cli {

struct ArrayImu {
  std::string name;
  std::variant<io::ImuFileOptions, io::PacketFileOptions> file;
  array::Counting counting;  ///< of packets
  array::SensorFrame frame;
  std::optional<noise::ImuErrorModel> model;  ///< of its own error states
};

enum class TimeSource {
  kTags,     ///< the files' time columns
  kPackets,  ///< counters, and arrivals at a computer whose clock a master with GPS tells
  kPulses,   ///< counters, and sync pulses
};

struct ArrayConfig {
  config::Node root;
  std::filesystem::path file;
  std::vector<ArrayImu> imus;
  TimeSource time = TimeSource::kTags;
  int week = 0;              ///< of packets
  std::size_t master = 0;    ///< index of the IMU whose packets carry GPS time
  array::PulseTrain pulses;  ///< s of week
  array::AssemblyOptions assembly;
  array::MergeOptions merge;
  std::optional<io::ImuFileOptions> reference;  ///< true rates and forces, body axes at the origin
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] ArrayConfig read_array_config(const std::filesystem::path& file);

/// [d, h, p, q] of an ARMA(d,h)-GARCH(p,q).  @throws InputError  not four whole numbers from 0 to 9, or q without p
[[nodiscard]] noise::ArmaGarchOrders arma_garch_orders(const config::Node& list);

[[nodiscard]] std::string_view merge_name(array::Merge merge);

}  // namespace coast::cli
