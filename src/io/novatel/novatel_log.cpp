#include "novatel_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "../text.hpp"

namespace coast::io {

namespace {

/// "GPS reference time status".
constexpr std::uint32_t kFreewheeling = 130, kSatelliteTime = 200;
constexpr std::array<NovAtelWord, 12> kTimeStatus = {{{"UNKNOWN", 20},
                                                      {"APPROXIMATE", 60},
                                                      {"COARSEADJUSTING", 80},
                                                      {"COARSE", 100},
                                                      {"COARSESTEERING", 120},
                                                      {"FREEWHEELING", kFreewheeling},
                                                      {"FINEADJUSTING", 140},
                                                      {"FINE", 160},
                                                      {"FINEBACKUPSTEERING", 170},
                                                      {"FINESTEERING", 180},
                                                      {"SATTIME", kSatelliteTime},
                                                      {"EXACT", 230}}};

/// Table 4, "binary message header structure".
std::optional<NovAtelLog> binary_log(std::string_view b) {
  constexpr std::size_t kShortHead = 12;
  constexpr double kMillisecond = 1e-3;
  constexpr unsigned kResponse = 0x80, kSource = 0x1f, kSecond = 1;
  NovAtelLog log;
  log.id = number_at<std::uint16_t>(b, 4);
  if (b[2] == '\x13') {
    log.week = number_at<std::uint16_t>(b, 6);
    log.seconds = kMillisecond * number_at<std::int32_t>(b, 8);
    log.body = b.substr(kShortHead);
    return log;
  }
  const unsigned type = number_at<std::uint8_t>(b, 6);
  if ((type & kResponse) != 0) return std::nullopt;
  log.second_antenna = (type & kSource) == kSecond;  // 2 is seen in logs of OEMV, which had one antenna
  log.time_status = number_at<std::uint8_t>(b, 13);
  log.week = number_at<std::uint16_t>(b, 14);
  log.seconds = kMillisecond * number_at<std::int32_t>(b, 16);
  log.body = b.substr(number_at<std::uint8_t>(b, 3));
  return log;
}

/// "#NAME,port,sequence,idle,status,week,seconds,receiver status,reserved,version;" or "%NAME,week,seconds;".
std::optional<NovAtelLog> ascii_log(std::string_view text, std::uint32_t id) {
  constexpr std::size_t kBeforeStatus = 4;
  const std::size_t end = text.find(';');
  if (end == std::string_view::npos) return std::nullopt;
  NovAtelLog log;
  log.id = id;
  log.ascii = true;
  log.body = text.substr(end + 1);
  const bool is_short = text.front() == '%';
  NovAtelFields head(text.substr(1, end - 1), true);
  const std::string_view name = text.substr(1, text.find(',') - 1);
  log.second_antenna = name.find('_') != std::string_view::npos;
  for (std::size_t i = 0; i < (is_short ? 1 : kBeforeStatus); ++i) head.skip_text(0);
  if (!is_short) log.time_status = head.word(kTimeStatus);
  log.week = head.u16();
  log.seconds = head.f64();
  if (!head.good()) return std::nullopt;
  return log;
}

}  // namespace

/// The next field of ASCII.
std::string_view NovAtelFields::text() {
  if (ended_) good_ = false;
  if (!good_) return {};
  const bool quoted = body_.starts_with('"');
  const std::size_t from = quoted ? std::min(body_.find('"', 1), body_.size()) : 0;
  const std::size_t comma = body_.find(',', from);
  const std::string_view field = trimmed(body_.substr(0, comma));
  ended_ = comma == std::string_view::npos;
  body_ = ended_ ? std::string_view() : body_.substr(comma + 1);
  return field;
}

template <class T>
T NovAtelFields::binary() {
  if (body_.size() < sizeof(T)) good_ = false;
  if (!good_) return T{};
  const T value = number_at<T>(body_, 0);
  body_.remove_prefix(sizeof(T));
  return value;
}

template <class T>
T NovAtelFields::real() {
  if (!ascii_) return binary<T>();
  const auto value = parse_number(text());
  if (!value) good_ = false;
  return value ? static_cast<T>(*value) : T{};
}

template <class T>
T NovAtelFields::integer(int base) {
  if (!ascii_) return binary<T>();
  const std::string_view field = text();
  T value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value, base);
  if (error != std::errc() || end != field.data() + field.size() || field.empty()) good_ = false;
  return good_ ? value : T{};
}

double NovAtelFields::f64() {
  return real<double>();
}
double NovAtelFields::f32() {
  return static_cast<double>(real<float>());
}
std::int32_t NovAtelFields::i32() {
  return integer<std::int32_t>(kDecimal);
}
std::uint32_t NovAtelFields::u32() {
  return integer<std::uint32_t>(kDecimal);
}
std::uint16_t NovAtelFields::u16() {
  return integer<std::uint16_t>(kDecimal);
}
std::int16_t NovAtelFields::i16() {
  return integer<std::int16_t>(kDecimal);
}
std::uint8_t NovAtelFields::u8() {
  return integer<std::uint8_t>(kDecimal);
}
std::uint32_t NovAtelFields::hex32() {
  return integer<std::uint32_t>(kHexadecimal);
}
std::uint8_t NovAtelFields::hex8() {
  return integer<std::uint8_t>(kHexadecimal);
}

std::uint32_t NovAtelFields::word(std::span<const NovAtelWord> words) {
  if (!ascii_) return binary<std::uint32_t>();
  const std::string_view field = text();
  for (const NovAtelWord& known : words)
    if (known.word == field) return known.number;
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  return error == std::errc() && end == field.data() + field.size() && !field.empty() ? number : kUnknownWord;
}

std::string_view NovAtelFields::name() {
  if (ascii_) return text();
  decoded_ = std::to_string(binary<std::uint32_t>());
  return decoded_;
}

Eigen::Vector3d NovAtelFields::vector() {
  const double x = f64(), y = f64(), z = f64();
  return {x, y, z};
}

std::string_view NovAtelFields::bytes(std::size_t number) {
  if (!ascii_) {
    if (body_.size() < number) good_ = false;
    if (!good_) return {};
    const std::string_view value = body_.substr(0, number);
    body_.remove_prefix(number);
    return value;
  }
  const std::string_view digits = text();
  if (digits.size() != 2 * number) good_ = false;
  decoded_.clear();
  for (std::size_t i = 0; good_ && i < number; ++i) {
    std::uint8_t byte = 0;
    const std::string_view two = digits.substr(2 * i, 2);
    const auto [end, error] = std::from_chars(two.data(), two.data() + two.size(), byte, kHexadecimal);
    if (error != std::errc() || end != two.data() + two.size()) good_ = false;
    decoded_.push_back(static_cast<char>(byte));
  }
  return good_ ? std::string_view(decoded_) : std::string_view();
}

void NovAtelFields::skip_text(std::size_t binary_bytes) {
  if (ascii_)
    static_cast<void>(text());
  else
    skip_binary(binary_bytes);
}

void NovAtelFields::skip_binary(std::size_t number) {
  if (ascii_) return;
  if (body_.size() < number) good_ = false;
  body_.remove_prefix(std::min(number, body_.size()));
}

std::optional<geo::GpsTime> novatel_time(std::uint32_t week, double seconds) {
  constexpr std::uint32_t kLastWeek = 9999;
  constexpr double kWeekSeconds = 604800.0;
  if (week == 0 || week > kLastWeek || !(seconds >= 0.0 && seconds <= kWeekSeconds)) return std::nullopt;
  return geo::GpsTime::from_week(static_cast<int>(week), seconds);
}

bool NovAtelLog::timed() const {
  return !time_status || (*time_status >= kFreewheeling && *time_status != NovAtelFields::kUnknownWord);
}

std::optional<geo::GpsTime> NovAtelLog::time() const {
  return timed() ? novatel_time(static_cast<std::uint32_t>(week), seconds) : std::nullopt;
}

std::optional<NovAtelLog> NovAtelLog::of(const MessageFrame& frame) {
  if (frame.protocol == Protocol::kNovAtel) return binary_log(frame.payload);
  if (frame.protocol == Protocol::kNovAtelAscii) return ascii_log(frame.payload, frame.id);
  return std::nullopt;
}

bool NovAtelStream::next(NovAtelLog& log) {
  MessageFrame frame;
  while (frames_.next(frame)) {
    if (const auto found = NovAtelLog::of(frame)) {
      log = *found;
      if (!log.time_status)
        log.time_status = time_status_;
      else if (*log.time_status != kSatelliteTime)
        time_status_ = log.time_status;
      return true;
    }
  }
  return false;
}

long NovAtelStream::number(std::uint32_t id) const {
  return frames_.census().number(Protocol::kNovAtel, id) + frames_.census().number(Protocol::kNovAtelAscii, id);
}

record::Events NovAtelStream::events() const {
  return file_events(frames_.census(), name(), [](Protocol protocol, std::uint32_t id) {
    return (protocol == Protocol::kNovAtel || protocol == Protocol::kNovAtelAscii) && reads_novatel_log(id);
  });
}

bool begins_as_novatel(std::string_view head) {
  for (std::size_t at = 0; at < head.size(); ++at) {
    const std::string_view rest = head.substr(at);
    const bool binary = rest.starts_with("\xaa\x44");
    const bool ascii = !binary && (rest.front() == '#' || rest.front() == '%') && (at == 0 || head[at - 1] == '\n');
    if (!binary && !ascii) continue;
    const FrameTrial trial = binary ? try_novatel(rest) : try_novatel_ascii(rest);
    if (trial.verdict == FrameTrial::Verdict::kFrame) return true;
    // A long first message may go on beyond what has been read of the file; then its header has to do.
    constexpr std::size_t kLongestHead = 160;
    if (trial.verdict == FrameTrial::Verdict::kMore && at == 0 &&
        (binary || rest.substr(0, kLongestHead).find(';') != std::string_view::npos))
      return true;
  }
  return false;
}

}  // namespace coast::io
