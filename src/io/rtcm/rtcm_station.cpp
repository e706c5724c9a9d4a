#include "rtcm_station.hpp"

#include <algorithm>

#include "../broadcast/bit_field.hpp"
#include "../text.hpp"
#include "coast/geo/earth.hpp"
#include "rtcm_messages.hpp"

namespace coast::io {

namespace {

constexpr double kStationUnit = 1e-4;  // m

/// DF025 to DF027: 38 bits.
double coordinate(const BitField& bits, std::size_t at) {
  constexpr double kLowBits = 64.0;
  return kStationUnit * (kLowBits * bits.signed_bits(at, 32) + bits.bits(at + 32, 6));
}

void take_position(const MessageFrame& frame, RtcmStation& station) {
  constexpr std::size_t kX = 34, kY = 74, kZ = 114, kHeight = 152, kBytes = 19, kHeightBytes = 21;
  constexpr double kNearest = 6.3e6, kFarthest = 6.5e6;  // zeros stand for unknown
  const bool has_height = frame.id == rtcm::kPositionAndHeight;
  if (frame.payload.size() < (has_height ? kHeightBytes : kBytes)) return;
  const BitField bits = bits_of(frame.payload);
  const Eigen::Vector3d r_e(coordinate(bits, kX), coordinate(bits, kY), coordinate(bits, kZ));
  if (r_e.norm() < kNearest || r_e.norm() > kFarthest) return;
  station.r_e = r_e;
  if (has_height) station.height = kStationUnit * bits.bits(kHeight, 16);
}

/// Texts with their lengths before them.
class TextFields {
 public:
  explicit TextFields(std::string_view payload) : rest_(payload.substr(std::min<std::size_t>(3, payload.size()))) {}
  /// Printable; empty where the message is too short.
  std::string next() {
    const std::size_t length = rest_.empty() ? 0 : static_cast<unsigned char>(rest_.front());
    if (length + 1 > rest_.size()) {
      rest_ = {};
      return "";
    }
    std::string text(rest_.substr(1, length));
    rest_.remove_prefix(length + 1);
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, ' ');
    return std::string(trimmed(text));
  }
  void skip_byte() { rest_.remove_prefix(std::min<std::size_t>(1, rest_.size())); }

 private:
  std::string_view rest_;
};

void put_text(std::string text, std::string& into) {
  if (!text.empty()) into = std::move(text);
}

}  // namespace

void take_station(const MessageFrame& frame, RtcmStation& station) {
  if (frame.id == rtcm::kPosition || frame.id == rtcm::kPositionAndHeight) return take_position(frame, station);
  const bool receiver = frame.id == rtcm::kReceiver;
  if (!receiver && frame.id != rtcm::kAntenna && frame.id != rtcm::kAntennaAndSerial) return;
  TextFields fields(frame.payload);
  put_text(fields.next(), station.antenna);
  if (!receiver) return;
  fields.skip_byte();  // setup of the antenna
  static_cast<void>(fields.next());
  put_text(fields.next(), station.receiver);
}

void put_station(const RtcmStation& station, record::ObservationRecording& recording) {
  recording.antenna = station.antenna;
  recording.receiver = station.receiver;
  if (!station.r_e) return;
  const Eigen::Vector3d up_e = -geo::C_n_e(geo::geodetic_from_ecef(*station.r_e)).col(2);
  recording.approximate_r_e = *station.r_e - station.height * up_e;
  recording.antenna_offset_enu = {0.0, 0.0, station.height};
}

}  // namespace coast::io
