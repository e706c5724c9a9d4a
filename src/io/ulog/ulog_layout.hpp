#pragma once
// Layout of ULog messages: names, types and places of fields. Private to the room.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coast::io {

enum class UlogType : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kFloat, kDouble, kBool, kChar };

/// A field of numbers: where it is in a message, and how many there are.
struct UlogField {
  UlogType type = UlogType::kU8;
  std::size_t offset = 0;
  std::size_t count = 1;
};

/// One number of a field; none if the message ends before it.
[[nodiscard]] std::optional<double> ulog_number(std::string_view message, const UlogField& field, std::size_t index = 0);
/// The same of an integer with all its digits.
[[nodiscard]] std::optional<std::int64_t> ulog_integer(std::string_view message, const UlogField& field);

/// One kind of message: its fields that are numbers, by name, and its size; the logger leaves out padding at the end.
struct UlogLayout {
  std::map<std::string, UlogField, std::less<>> fields;
  std::size_t size = 0, without_padding = 0;

  [[nodiscard]] std::optional<UlogField> find(std::string_view name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Definitions of a file, as they are collected.
class UlogFormats {
 public:
  /// "name:type field;type[3] field;".  @return false: not of this form
  [[nodiscard]] bool add(std::string_view definition);
  /// Fields of formats inside are left out, but their size is counted. None if the format, or one
  /// inside it, is not defined, or is inside itself.
  [[nodiscard]] std::optional<UlogLayout> layout(std::string_view name) const;

 private:
  struct Member {
    std::string type, name;
    std::size_t count = 1;
  };
  [[nodiscard]] std::optional<std::size_t> size_of(std::string_view type, int depth) const;
  std::map<std::string, std::vector<Member>, std::less<>> formats_;
};

}  // namespace coast::io
