#pragma once
// Blocks of SBF that are read, their time, and their fields one after another (mosaic-X5 reference guide 4.14.10, chapter 4;
// for ExtSensorMeas, which that receiver does not send, Septentrio's ROS driver). Private to the room.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "../binary.hpp"
#include "../frames/frame_stream.hpp"
#include "coast/geo/time.hpp"

namespace coast::io {

namespace sbf {
inline constexpr std::uint32_t kGalNav = 4002;
inline constexpr std::uint32_t kGloNav = 4004;
inline constexpr std::uint32_t kPvtCartesian = 4006;
inline constexpr std::uint32_t kPvtGeodetic = 4007;
inline constexpr std::uint32_t kGpsRawCa = 4017;
inline constexpr std::uint32_t kGalRawInav = 4023;
inline constexpr std::uint32_t kGloRawCa = 4026;
inline constexpr std::uint32_t kMeasEpoch = 4027;
inline constexpr std::uint32_t kExtSensorMeas = 4050;
inline constexpr std::uint32_t kQzsRawL1Ca = 4066;
inline constexpr std::uint32_t kBdsNav = 4081;
inline constexpr std::uint32_t kQzsNav = 4095;
inline constexpr std::uint32_t kMeas3Ranges = 4109;
inline constexpr std::uint32_t kGpsNav = 5891;
inline constexpr std::uint32_t kGpsIon = 5893;
inline constexpr std::uint32_t kReceiverSetup = 5902;
inline constexpr std::uint32_t kPosCovCartesian = 5905;
inline constexpr std::uint32_t kPosCovGeodetic = 5906;
inline constexpr std::uint32_t kVelCovCartesian = 5907;
inline constexpr std::uint32_t kVelCovGeodetic = 5908;
inline constexpr std::uint32_t kExtEvent = 5924;
}  // namespace sbf

/// Floating-point fields hold -2e10 where the receiver does not know them (4.1.7).
[[nodiscard]] inline bool sbf_known(double value) {
  constexpr double kLimit = 1e10;
  return value > -kLimit && value < kLimit;  // not so of NaN
}

/// Where the contents of a block begin in its payload, after TOW and WNc.
inline constexpr std::size_t kSbfBody = 6;

/// The time stamp that each block begins with. None while the receiver does not know the time or the week.
[[nodiscard]] std::optional<geo::GpsTime> sbf_time(std::string_view payload);
/// Milliseconds of the week; none while not known.
[[nodiscard]] std::optional<std::uint32_t> sbf_milliseconds(std::string_view payload);

/// Fields one after another, of a block whose size has been checked.
class SbfFields {
 public:
  SbfFields(std::string_view payload, std::size_t at) : payload_(payload), at_(at) {}
  template <class T>
  T next() {
    const T value = number_at<T>(payload_, at_);
    at_ += sizeof(T);
    return value;
  }
  int u1() { return next<std::uint8_t>(); }
  int u2() { return next<std::uint16_t>(); }
  double u4() { return next<std::uint32_t>(); }
  double f4() { return static_cast<double>(next<float>()); }
  double f8() { return next<double>(); }
  /// ASCII of a field that is filled up with zeros, without what cannot be printed.
  std::string text(std::size_t size);
  void skip(std::size_t bytes) { at_ += bytes; }

 private:
  std::string_view payload_;
  std::size_t at_;
};

/// Damage of the file, and the blocks that no reader of SBF uses, by name and number.
[[nodiscard]] record::Events sbf_file_events(const FrameCensus& census, const std::string& file);

/// A block of SBF has been found whole in the first bytes of a file.
[[nodiscard]] bool begins_as_sbf(std::string_view head);

}  // namespace coast::io
