#pragma once
// One log of a NovAtel receiver: its header, and its body as fields one after another, binary or ASCII alike. Private to the
// room.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "../binary.hpp"
#include "../frames/frame_stream.hpp"
#include "coast/geo/time.hpp"
#include "novatel_names.hpp"

namespace coast::io {

/// A field of an ASCII log that is a word, and the number that it has in binary logs.
struct NovAtelWord {
  std::string_view word;
  std::uint32_t number;
};

/// The fields of a body in the order of the manual. Beyond the end, and where ASCII has something else than expected, fields
/// are zero and `good` is false from there on.
class NovAtelFields {
 public:
  NovAtelFields(std::string_view body, bool ascii) : body_(body), ascii_(ascii) {}

  [[nodiscard]] double f64();
  [[nodiscard]] double f32();
  [[nodiscard]] std::int32_t i32();
  [[nodiscard]] std::uint32_t u32();
  [[nodiscard]] std::uint16_t u16();
  [[nodiscard]] std::int16_t i16();
  [[nodiscard]] std::uint8_t u8();
  /// Hexadecimal in ASCII.
  [[nodiscard]] std::uint32_t hex32();
  [[nodiscard]] std::uint8_t hex8();
  /// Words of ASCII that are not listed are `kUnknownWord`.
  [[nodiscard]] std::uint32_t word(std::span<const NovAtelWord> words);
  [[nodiscard]] Eigen::Vector3d vector();
  /// Bytes; two digits each in ASCII. Valid until the next call.
  [[nodiscard]] std::string_view bytes(std::size_t number);
  /// A word of ASCII as it stands, or the number of binary in decimal digits. Valid until the next call.
  [[nodiscard]] std::string_view name();
  /// Characters of a fixed number of bytes; one field in ASCII.
  void skip_text(std::size_t binary_bytes);
  /// Bytes that only binary logs have.
  void skip_binary(std::size_t number);
  [[nodiscard]] bool good() const { return good_; }

  static constexpr std::uint32_t kUnknownWord = 0xffffffff;

 private:
  static constexpr int kDecimal = 10, kHexadecimal = 16;
  template <class T>
  T real();
  template <class T>
  T integer(int base);
  template <class T>
  T binary();
  [[nodiscard]] std::string_view text();

  std::string_view body_;  ///< what is left of it
  bool ascii_;
  bool good_ = true, ended_ = false;
  std::string decoded_;
};

/// A log with its header.
struct NovAtelLog {
  std::uint32_t id = 0;
  int week = 0;
  double seconds = 0.0;  ///< of the week
  /// Of the header; a short header has none, and then `NovAtelStream` takes that of the log before.
  std::optional<std::uint32_t> time_status;
  bool second_antenna = false;
  bool ascii = false;
  std::string_view body;

  [[nodiscard]] NovAtelFields fields() const { return {body, ascii}; }
  /// The receiver's clock is steered, or runs freely after it has been: samples of an IMU go on in gaps of GNSS.
  [[nodiscard]] bool timed() const;
  /// Of the header; none if the receiver does not know it finely.
  [[nodiscard]] std::optional<geo::GpsTime> time() const;
  /// None for responses to commands, and a header that cannot be read.
  [[nodiscard]] static std::optional<NovAtelLog> of(const MessageFrame& frame);
};

/// None for what is no week, or no second of it.
[[nodiscard]] std::optional<geo::GpsTime> novatel_time(std::uint32_t week, double seconds);

/// The logs of a file.
class NovAtelStream {
 public:
  explicit NovAtelStream(const std::filesystem::path& file) : frames_(file, kNovAtelLog) {}

  /// The next log; its fields are valid until the next call.
  [[nodiscard]] bool next(NovAtelLog& log);
  [[nodiscard]] const std::string& name() const { return frames_.name(); }
  /// Of one message, binary and ASCII.
  [[nodiscard]] long number(std::uint32_t id) const;
  /// Damage of the file, and the messages that no reader uses.
  [[nodiscard]] record::Events events() const;

 private:
  FrameStream frames_;
  std::optional<std::uint32_t> time_status_;  ///< last stated for the receiver's clock
};

/// A whole log is in the first bytes of a file.
[[nodiscard]] bool begins_as_novatel(std::string_view head);

}  // namespace coast::io
