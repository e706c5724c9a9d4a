#include "vectornav_message.hpp"

#include "../binary.hpp"

namespace coast::io {

namespace {

constexpr std::uint8_t kVaries = 255;  // satellite information: two bytes and eight for each satellite

/// Bytes of each field by group and bit; 0: not known.
constexpr std::array<std::array<std::uint8_t, 15>, 7> kFieldSizes = {
    {{8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8},       // common
     {8, 8, 8, 2, 8, 8, 8, 4, 4, 1},                               // time
     {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2},                 // IMU
     {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, kVaries},    // GNSS 1
     {2, 12, 16, 36, 12, 12, 12, 12, 12},                          // attitude
     {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4},                    // INS
     {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, kVaries}}};  // GNSS 2

}  // namespace

VectorNavMessage::Head VectorNavMessage::parse(std::string_view bytes) {
  constexpr unsigned kMoreGroups = 0x80;
  bytes_ = bytes;
  size_ = 1;
  if (bytes.empty()) return Head::kMore;
  groups_ = number_at<std::uint8_t>(bytes, 0);
  if (groups_ == 0 || (groups_ & kMoreGroups) != 0) return Head::kUnknown;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if ((groups_ >> group & 1U) == 0) continue;
    size_ += 2;
    if (bytes.size() < size_) return Head::kMore;
    masks_.at(group) = number_at<std::uint16_t>(bytes, size_ - 2);
    // Bit 15 announces more words of fields, which none of these groups has had so far.
    if (masks_.at(group) == 0 || masks_.at(group) >> kBits != 0) return Head::kUnknown;
  }
  for (std::size_t group = 0; group < kGroups; ++group)
    if ((groups_ >> group & 1U) != 0)
      if (const Head head = parse_group(bytes, group); head != Head::kWhole) return head;
  return bytes.size() < size_ ? Head::kMore : Head::kWhole;
}

VectorNavMessage::Head VectorNavMessage::parse_group(std::string_view bytes, std::size_t group) {
  constexpr std::size_t kHead = 2, kSatellite = 8;
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    if ((masks_.at(group) >> bit & 1U) == 0) continue;
    const std::uint8_t size = kFieldSizes.at(group).at(bit);
    if (size == 0) return Head::kUnknown;
    offsets_.at(group).at(bit) = static_cast<std::uint16_t>(size_);
    if (size != kVaries) {
      size_ += size;
      continue;
    }
    size_ += kHead;
    if (bytes.size() < size_) return Head::kMore;
    size_ += kSatellite * number_at<std::uint8_t>(bytes, size_ - kHead);
  }
  return Head::kWhole;
}

std::optional<std::string_view> VectorNavMessage::field(VectorNavGroup group, int bit) const {
  const auto index = static_cast<std::size_t>(group);
  if ((groups_ >> index & 1U) == 0 || (masks_.at(index) >> bit & 1U) == 0) return std::nullopt;
  return bytes_.substr(offsets_.at(index).at(static_cast<std::size_t>(bit)));
}

}  // namespace coast::io
