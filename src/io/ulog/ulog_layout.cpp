#include "ulog_layout.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "../binary.hpp"
#include "../text.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kLongestUlogMessage = 65535;

struct UlogTypeName {
  std::string_view name;
  UlogType type;
  std::size_t size;
};
constexpr std::array<UlogTypeName, 12> kUlogTypes = {{{"int8_t", UlogType::kI8, 1},
                                                      {"uint8_t", UlogType::kU8, 1},
                                                      {"int16_t", UlogType::kI16, 2},
                                                      {"uint16_t", UlogType::kU16, 2},
                                                      {"int32_t", UlogType::kI32, 4},
                                                      {"uint32_t", UlogType::kU32, 4},
                                                      {"int64_t", UlogType::kI64, 8},
                                                      {"uint64_t", UlogType::kU64, 8},
                                                      {"float", UlogType::kFloat, 4},
                                                      {"double", UlogType::kDouble, 8},
                                                      {"bool", UlogType::kBool, 1},
                                                      {"char", UlogType::kChar, 1}}};

const UlogTypeName* basic_type(std::string_view name) {
  for (const UlogTypeName& type : kUlogTypes)
    if (type.name == name) return &type;
  return nullptr;
}

std::size_t size_of_type(UlogType type) {
  for (const UlogTypeName& known : kUlogTypes)
    if (known.type == type) return known.size;
  return 1;
}

/// "float[3]" to "float" and 3.
std::optional<std::pair<std::string_view, std::size_t>> split_array(std::string_view type) {
  const std::size_t open = type.find('[');
  if (open == std::string_view::npos) return std::pair(type, std::size_t{1});
  std::size_t count = 0;
  const char* end = type.data() + type.size();
  const auto [stop, error] = std::from_chars(type.data() + open + 1, end, count);
  if (error != std::errc() || stop + 1 != end || *stop != ']' || count == 0 || count > kLongestUlogMessage) return std::nullopt;
  return std::pair(type.substr(0, open), count);
}

}  // namespace

std::optional<double> ulog_number(std::string_view message, const UlogField& field, std::size_t index) {
  const std::size_t size = size_of_type(field.type), at = field.offset + index * size;
  if (index >= field.count || at + size > message.size()) return std::nullopt;
  switch (field.type) {
    case UlogType::kI8:
      return number_at<std::int8_t>(message, at);
    case UlogType::kU8:
    case UlogType::kBool:
    case UlogType::kChar:
      return number_at<std::uint8_t>(message, at);
    case UlogType::kI16:
      return number_at<std::int16_t>(message, at);
    case UlogType::kU16:
      return number_at<std::uint16_t>(message, at);
    case UlogType::kI32:
      return number_at<std::int32_t>(message, at);
    case UlogType::kU32:
      return number_at<std::uint32_t>(message, at);
    case UlogType::kI64:
      return static_cast<double>(number_at<std::int64_t>(message, at));
    case UlogType::kU64:
      return static_cast<double>(number_at<std::uint64_t>(message, at));
    case UlogType::kFloat:
      return static_cast<double>(number_at<float>(message, at));
    case UlogType::kDouble:
      break;
  }
  return number_at<double>(message, at);
}

std::optional<std::int64_t> ulog_integer(std::string_view message, const UlogField& field) {
  if (field.type == UlogType::kFloat || field.type == UlogType::kDouble) return std::nullopt;
  if (field.type != UlogType::kI64 && field.type != UlogType::kU64) {
    const auto value = ulog_number(message, field);
    return value ? std::optional(static_cast<std::int64_t>(*value)) : std::nullopt;
  }
  if (field.offset + sizeof(std::int64_t) > message.size()) return std::nullopt;
  return number_at<std::int64_t>(message, field.offset);
}

bool UlogFormats::add(std::string_view definition) {
  const std::size_t colon = definition.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  std::vector<Member> members;
  std::vector<std::string_view> parts;
  split(definition.substr(colon + 1), ';', parts);
  for (const std::string_view member : parts) {
    if (member.empty()) continue;
    const std::size_t blank = member.find(' ');
    const auto type = split_array(member.substr(0, blank));
    if (blank == std::string_view::npos || blank + 1 >= member.size() || !type || type->first.empty()) return false;
    members.push_back({std::string(type->first), std::string(member.substr(blank + 1)), type->second});
  }
  if (members.empty()) return false;
  formats_.insert_or_assign(std::string(definition.substr(0, colon)), std::move(members));
  return true;
}

std::optional<std::size_t> UlogFormats::size_of(std::string_view type, int depth) const {
  constexpr int kDeepest = 8;
  if (const UlogTypeName* basic = basic_type(type)) return basic->size;
  const auto found = formats_.find(type);
  if (found == formats_.end() || depth > kDeepest) return std::nullopt;
  std::size_t size = 0;
  for (const Member& member : found->second) {
    const auto one = size_of(member.type, depth + 1);
    if (!one || size + *one * member.count > kLongestUlogMessage) return std::nullopt;
    size += *one * member.count;
  }
  return size;
}

std::optional<UlogLayout> UlogFormats::layout(std::string_view name) const {
  const auto found = formats_.find(name);
  if (found == formats_.end() || !size_of(name, 0)) return std::nullopt;
  UlogLayout layout;
  for (const Member& member : found->second) {
    if (const UlogTypeName* basic = basic_type(member.type))
      layout.fields[member.name] = {basic->type, layout.size, member.count};
    layout.size += *size_of(member.type, 1) * member.count;
    if (!member.name.starts_with("_padding")) layout.without_padding = layout.size;
  }
  return layout;
}

}  // namespace coast::io
