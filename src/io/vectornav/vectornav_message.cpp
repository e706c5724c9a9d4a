#include "vectornav_message.hpp"

#include "../binary.hpp"

namespace coast::io {

namespace {

constexpr std::uint8_t kVaries = 255;

/// Bytes of each field by group and bit; 0: not known.
constexpr std::array<std::array<std::uint8_t, 15>, 7> kFieldSizes = {
    {{8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8},       // common
     {8, 8, 8, 2, 8, 8, 8, 4, 4, 1},                               // time
     {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2},                 // IMU
     {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, kVaries},    // GNSS 1
     {2, 12, 16, 36, 12, 12, 12, 12, 12},                          // attitude
     {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4},                    // INS
     {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, kVaries}}};  // GNSS 2

constexpr std::size_t kRawMeasBit = 16;
constexpr unsigned kGnssGroups =
    1U << static_cast<unsigned>(VectorNavGroup::kGnss1) | 1U << static_cast<unsigned>(VectorNavGroup::kGnss2);

std::uint8_t field_size(std::size_t group, std::size_t bit) {
  if (bit == kRawMeasBit) return (kGnssGroups >> group & 1U) != 0 ? kVaries : 0;
  return bit < kFieldSizes[group].size() ? kFieldSizes[group][bit] : 0;
}

/// Fields with one element for each satellite or signal.
struct VaryingField {
  std::size_t before_number, reserved, element;  ///< bytes
};
constexpr VaryingField kSatInfo{0, 1, 8}, kRawMeas{10, 1, 28};

}  // namespace

VectorNavMessage::Head VectorNavMessage::parse(std::string_view bytes, Form form) {
  constexpr unsigned kMoreGroups = 0x80;
  bytes_ = bytes;
  form_ = form;
  size_ = 1;
  if (bytes.empty()) return Head::kMore;
  groups_ = number_at<std::uint8_t>(bytes, 0);
  if (groups_ == 0 || (groups_ & kMoreGroups) != 0) return Head::kUnknown;
  if (const Head head = parse_masks(bytes); head != Head::kWhole) return head;
  for (std::size_t group = 0; group < kGroups; ++group)
    if ((groups_ >> group & 1U) != 0)
      if (const Head head = parse_group(bytes, group); head != Head::kWhole) return head;
  return bytes.size() < size_ ? Head::kMore : Head::kWhole;
}

/// One word of fields for each group; bit 15 of it announces a second one.
VectorNavMessage::Head VectorNavMessage::parse_masks(std::string_view bytes) {
  constexpr std::uint32_t kExtended = 1U << 15;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if ((groups_ >> group & 1U) == 0) continue;
    const auto word = [&]() -> std::optional<std::uint32_t> {
      size_ += 2;
      return bytes.size() < size_ ? std::nullopt : std::optional<std::uint32_t>(number_at<std::uint16_t>(bytes, size_ - 2));
    };
    const auto first = word();
    if (!first) return Head::kMore;
    masks_.at(group) = *first & ~kExtended;
    if ((*first & kExtended) != 0) {
      const auto second = word();
      if (!second) return Head::kMore;
      if ((*second & kExtended) != 0) return Head::kUnknown;
      masks_.at(group) |= *second << 16;
    }
    if (masks_.at(group) == 0) return Head::kUnknown;
  }
  return Head::kWhole;
}

VectorNavMessage::Head VectorNavMessage::parse_group(std::string_view bytes, std::size_t group) {
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    if ((masks_.at(group) >> bit & 1U) == 0) continue;
    const std::uint8_t size = field_size(group, bit);
    if (size == 0) return Head::kUnknown;
    offsets_.at(group).at(bit) = static_cast<std::uint16_t>(size_);
    if (size != kVaries) {
      size_ += size;
      continue;
    }
    const VaryingField& field = bit == kRawMeasBit ? kRawMeas : kSatInfo;
    const std::size_t number_at_byte = size_ + field.before_number;
    size_ = number_at_byte + 1 + (form_ == Form::kSent ? field.reserved : 0);
    if (bytes.size() < size_) return Head::kMore;
    size_ += field.element * number_at<std::uint8_t>(bytes, number_at_byte);
  }
  return Head::kWhole;
}

std::optional<std::string_view> VectorNavMessage::field(VectorNavGroup group, int bit) const {
  const auto index = static_cast<std::size_t>(group);
  if ((groups_ >> index & 1U) == 0 || (masks_.at(index) >> bit & 1U) == 0) return std::nullopt;
  return bytes_.substr(offsets_.at(index).at(static_cast<std::size_t>(bit)));
}

}  // namespace coast::io
