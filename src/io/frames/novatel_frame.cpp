// Frames of NovAtel receivers: OEM7 Commands and Logs Reference Manual, "Message formats". OEM4, OEMV and OEM6 have the same;
// OEM3 (sync AA 44 11) has others.

#include <algorithm>
#include <charconv>

#include "../binary.hpp"
#include "../novatel/novatel_names.hpp"
#include "checksums.hpp"
#include "frame.hpp"

namespace coast::io {

namespace {

using Verdict = FrameTrial::Verdict;

constexpr std::size_t kNovAtelCrc = 4;

FrameTrial need_novatel(std::size_t size) {
  return {Verdict::kMore, size, 0, 0, 0};
}

/// Header and body, with their CRC behind.
FrameTrial whole_novatel(std::string_view bytes, std::size_t content, std::size_t id_at) {
  if (content + kNovAtelCrc > kLongestFrame) return {};
  if (bytes.size() < content + kNovAtelCrc) return need_novatel(content + kNovAtelCrc);
  if (crc32_novatel(bytes.substr(0, content)) != number_at<std::uint32_t>(bytes, content))
    return {Verdict::kChecksum, 0, 0, 0, 0};
  return {Verdict::kFrame, content + kNovAtelCrc, number_at<std::uint16_t>(bytes, id_at), 0, content};
}

/// "RANGE" of "RANGEA,COM1,..." and of "RANGEA_1,..", which is of the second antenna.
std::string_view log_name_of(std::string_view content) {
  std::string_view name = content.substr(0, content.find_first_of(",;"));
  name = name.substr(0, name.find('_'));
  if (name.ends_with('A')) name.remove_suffix(1);
  return name;
}

bool is_log_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

/// Sync AA 44 12, length of the header, message ID, .., length of the body at 8, body; or the short header AA 44 13, length of
/// the body, message ID, week, milliseconds. CRC-32 over all of it.
FrameTrial try_novatel(std::string_view bytes) {
  constexpr std::size_t kSync = 3, kId = 4, kLength = 8, kLong = 28, kShort = 12;
  if (bytes.size() >= 2 && bytes[1] != '\x44') return {};
  if (bytes.size() < kSync) return need_novatel(kSync);
  if (bytes[2] != '\x12' && bytes[2] != '\x13') return {};
  if (bytes.size() < kShort) return need_novatel(kShort);
  const std::size_t size = number_at<std::uint8_t>(bytes, kSync);
  if (bytes[2] == '\x13') return whole_novatel(bytes, kShort + size, kId);
  if (size < kLong) return {};
  return whole_novatel(bytes, size + number_at<std::uint16_t>(bytes, kLength), kId);
}

/// '#' (or '%', short header), name and header, ';', body, '*', CRC-32 over what is between '#' and '*' in hexadecimal digits,
/// line end.
FrameTrial try_novatel_ascii(std::string_view bytes) {
  constexpr std::size_t kDigits = 8, kLineEnd = 2;
  if (bytes.size() >= 2 && !(bytes[1] >= 'A' && bytes[1] <= 'Z')) return {};
  const auto stop = std::find_if(bytes.begin() + 1, bytes.end(), [](char c) { return c == '*' || c < ' ' || c > '~'; });
  const auto star = static_cast<std::size_t>(stop - bytes.begin());
  const std::string_view content = bytes.substr(1, star - 1);
  const std::size_t name = static_cast<std::size_t>(std::ranges::find_if_not(content, is_log_letter) - content.begin());
  if (name < content.size() && content[name] != ',') return {};
  if (star == bytes.size())
    return star < kLongestFrame ? need_novatel(std::min(2 * star + kDigits, kLongestFrame)) : FrameTrial{};
  if (bytes[star] != '*' || content.find(';') == std::string_view::npos || star > kLongestFrame - kDigits - kLineEnd) return {};
  const std::size_t end = star + 1 + kDigits;
  const std::size_t least = end + (bytes.size() > end && bytes[end] == '\r' ? kLineEnd : 1);
  if (bytes.size() < least) return need_novatel(least);
  std::uint32_t stated = 0;
  const std::string_view digits = bytes.substr(star + 1, kDigits);
  const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stated, 16);
  if (error != std::errc() || last != digits.data() + digits.size() || (bytes[end] != '\r' && bytes[end] != '\n')) return {};
  if (crc32_novatel(content) != stated) return {Verdict::kChecksum, 0, 0, 0, 0};
  return {Verdict::kFrame, least, novatel_log_id(log_name_of(content)), 0, star};
}

}  // namespace coast::io
