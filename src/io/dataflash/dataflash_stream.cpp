#include "dataflash_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "../binary.hpp"
#include "../boot_clock_imu.hpp"
#include "../text.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

constexpr std::string_view kDataflashHead = "\xa3\x95";
constexpr std::size_t kDataflashHeadSize = 3;  // with the kind
constexpr unsigned kDataflashFmt = 0x80;
constexpr std::size_t kDataflashFmtSize = 89;

/// Size of a field by its type; 0: no type.
std::size_t dataflash_size(char type) {
  switch (type) {
    case 'b':
    case 'B':
    case 'M':
      return 1;
    case 'h':
    case 'H':
    case 'c':
    case 'C':
    case 'g':
      return 2;
    case 'i':
    case 'I':
    case 'e':
    case 'E':
    case 'L':
    case 'f':
    case 'n':
      return 4;
    case 'd':
    case 'q':
    case 'Q':
      return 8;
    case 'N':
      return 16;
    case 'a':
    case 'Z':
      return 64;
    default:
      return 0;
  }
}

/// The integer of a field; none for other types.
std::optional<std::int64_t> dataflash_integer(std::string_view bytes, const DataflashField& field) {
  switch (field.type) {
    case 'b':
      return number_at<std::int8_t>(bytes, field.offset);
    case 'B':
    case 'M':
      return number_at<std::uint8_t>(bytes, field.offset);
    case 'h':
    case 'c':
      return number_at<std::int16_t>(bytes, field.offset);
    case 'H':
    case 'C':
      return number_at<std::uint16_t>(bytes, field.offset);
    case 'i':
    case 'e':
    case 'L':
      return number_at<std::int32_t>(bytes, field.offset);
    case 'I':
    case 'E':
      return number_at<std::uint32_t>(bytes, field.offset);
    case 'q':
    case 'Q':
      return number_at<std::int64_t>(bytes, field.offset);
    default:
      return std::nullopt;
  }
}

std::string_view until_zero(std::string_view text) {
  return text.substr(0, text.find('\0'));
}

}  // namespace

std::optional<double> DataflashMessage::number(std::string_view name) const {
  constexpr double kHundredth = 0.01, kLatitude = 1e-7;
  const auto found = format->fields.find(name);
  if (found == format->fields.end()) return std::nullopt;
  const DataflashField& field = found->second;
  double value = 0.0;
  if (field.type == 'f')
    value = static_cast<double>(number_at<float>(bytes, field.offset));
  else if (field.type == 'd')
    value = number_at<double>(bytes, field.offset);
  else if (const auto whole = dataflash_integer(bytes, field))
    value = static_cast<double>(*whole);
  else
    return std::nullopt;
  if (std::string_view("cCeE").find(field.type) != std::string_view::npos) value *= kHundredth;
  if (field.type == 'L') value *= kLatitude;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> DataflashMessage::integer(std::string_view name) const {
  const auto found = format->fields.find(name);
  return found == format->fields.end() ? std::nullopt : dataflash_integer(bytes, found->second);
}

std::optional<std::int64_t> DataflashMessage::boot_us(std::string_view name, std::string_view before) const {
  constexpr std::int64_t kMillisecond = 1000;
  auto us = integer(name);
  if (!us) {
    const auto ms = integer(before);
    if (ms && std::abs(*ms) < kLongestUptime / kMillisecond) us = kMillisecond * *ms;
  }
  return us && *us >= 0 && *us <= kLongestUptime ? us : std::nullopt;
}

bool begins_as_dataflash(std::string_view head) {
  return head.starts_with("\xa3\x95\x80");  // a definition
}

DataflashStream::DataflashStream(const std::filesystem::path& file) : window_(file) {
  if (!begins_as_dataflash(window_.ahead(kDataflashHeadSize)))
    throw InputError({name(), 0, "no message FMT at its beginning", "a DataFlash log of ArduPilot", "Is this the right file?"});
}

bool DataflashStream::next(DataflashMessage& message) {
  while (true) {
    const std::string_view head = window_.ahead(kDataflashHeadSize);
    if (head.size() < kDataflashHeadSize) {
      cut_off_ += head.size();
      window_.advance(head.size());
      return false;
    }
    const auto kind = number_at<std::uint8_t>(head, 2);
    const auto& format = formats_.at(kind);
    const std::size_t size = kind == kDataflashFmt ? kDataflashFmtSize : format ? format->size : 0;
    if (!head.starts_with(kDataflashHead) || size == 0) {
      skip(1);
      continue;
    }
    const std::string_view ahead = window_.ahead(size + kDataflashHead.size());
    const std::string_view after = ahead.size() < size ? std::string_view() : ahead.substr(size, kDataflashHead.size());
    if (ahead.size() < size && ahead.find(kDataflashHead, 1) == std::string_view::npos) {
      cut_off_ = ahead.size();
      window_.advance(ahead.size());
      return false;
    }
    if (ahead.size() < size || !kDataflashHead.starts_with(after)) {
      skip(1);
      continue;
    }
    const std::string_view bytes = ahead.substr(kDataflashHeadSize, size - kDataflashHeadSize);
    window_.advance(size);
    if (kind == kDataflashFmt) {
      define(bytes);
      continue;
    }
    message = {&*format, bytes};
    if (format->name == "DSF") lost_ = std::max<long>(lost_, static_cast<long>(message.integer("Dp").value_or(0)));
    return true;
  }
}

/// Kind, size, name of 4 characters, types of 16, names of 64 with commas.
void DataflashStream::define(std::string_view definition) {
  constexpr std::size_t kName = 2, kTypes = 6, kNames = 22;
  const auto kind = number_at<std::uint8_t>(definition, 0);
  DataflashFormat format;
  format.size = number_at<std::uint8_t>(definition, 1);
  format.name = until_zero(definition.substr(kName, kTypes - kName));
  const std::string_view types = until_zero(definition.substr(kTypes, kNames - kTypes));
  std::vector<std::string_view> names;
  split(until_zero(definition.substr(kNames)), ',', names);
  std::size_t offset = 0;
  bool known = names.size() >= types.size();
  for (std::size_t i = 0; known && i < types.size(); ++i) {
    format.fields.insert_or_assign(std::string(names[i]), DataflashField{types[i], offset});
    offset += dataflash_size(types[i]);
    known = dataflash_size(types[i]) > 0;
  }
  if (kind == kDataflashFmt) return;
  // A kind whose fields are not known can still be stepped over.
  if (!known || offset + kDataflashHeadSize != format.size) {
    ++undefined_;
    format.fields.clear();
  }
  if (format.size >= kDataflashHeadSize) formats_.at(kind) = std::move(format);
}

void DataflashStream::skip(std::size_t bytes) {
  if (garbage_ == 0) first_garbage_ = window_.position();
  garbage_ += bytes;
  window_.advance(bytes);
}

record::Events DataflashStream::events() const {
  record::Events events;
  const auto warn = [&](long number, const char* kind, std::string text) {
    if (number > 0)
      events.push_back({record::Event::Severity::kWarning, kind, fmt::format("{}: {}", name(), text), std::nullopt, number});
  };
  warn(lost_, "log_dropout", fmt::format("the logger lost {} messages", lost_));
  warn(undefined_, "log_undefined", fmt::format("{} definitions that contradict themselves", undefined_));
  warn(static_cast<long>(garbage_), "message_garbage",
       fmt::format("{} bytes that are no message skipped, the first at byte {}", garbage_, first_garbage_));
  warn(cut_off_ > 0 ? 1 : 0, "message_cut_off", fmt::format("the last message is cut off: {} bytes left out", cut_off_));
  return events;
}

std::vector<MessageCount> count_dataflash_messages(const std::filesystem::path& file) {
  DataflashStream stream(file);
  std::map<std::string, long> numbers;
  DataflashMessage message;
  while (stream.next(message)) ++numbers[message.format->name];
  std::vector<MessageCount> counts;
  for (const auto& [name, number] : numbers) counts.push_back({name, number});
  std::ranges::stable_sort(counts, std::greater<>{}, &MessageCount::number);
  return counts;
}

}  // namespace coast::io
