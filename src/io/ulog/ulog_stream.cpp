#include "ulog_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "../binary.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

constexpr std::string_view kUlogMagic("ULog\x01\x12\x35", 7);
constexpr std::string_view kUlogSync("\x08\x00S\x2f\x73\x13\x20\x25\x0c\xbb\x12", 11);  // a whole message
constexpr std::size_t kUlogHead = 16, kUlogMessageHead = 3;

}  // namespace

bool begins_as_ulog(std::string_view head) {
  return head.starts_with(kUlogMagic);
}

UlogStream::UlogStream(const std::filesystem::path& file) : window_(file) {
  const std::string_view head = window_.ahead(kUlogHead);
  if (!begins_as_ulog(head))
    throw InputError({name(), 0, "no \"ULog\" at its beginning", "a ULog file of PX4", "Is this the right file?"});
  constexpr int kLatest = 1;
  if (head.size() < kUlogHead) throw InputError({name(), 0, "the header is cut off", "16 bytes", ""});
  if (head[7] < 0 || head[7] > kLatest)
    throw InputError({name(), 0, fmt::format("version {} of ULog", static_cast<unsigned char>(head[7])), "0 or 1", ""});
  window_.advance(kUlogHead);
}

bool UlogStream::next(UlogData& data) {
  constexpr std::size_t kId = 2;
  while (const auto header = next_header()) {
    const std::string_view ahead = window_.ahead(kUlogMessageHead + header->size);
    if (ahead.size() < kUlogMessageHead + header->size) {
      cut_off_ = ahead.size();
      skip(ahead.size());
      garbage_ -= cut_off_;
      return false;
    }
    const std::string_view message = ahead.substr(kUlogMessageHead, header->size);
    window_.advance(kUlogMessageHead + header->size);
    if (header->type != 'D') {
      take(header->type, message);
      continue;
    }
    const auto topic = message.size() < kId ? topics_.end() : topics_.find(number_at<std::uint16_t>(message, 0));
    if (topic == topics_.end()) {
      ++undefined_;
      continue;
    }
    data = {topic->first, &topic->second, message.substr(kId)};
    const UlogLayout& layout = topic->second.layout;
    if (data.bytes.size() >= layout.without_padding && data.bytes.size() <= layout.size) return true;
    ++undefined_;  // after damage, what was taken for its head was none
  }
  return false;
}

/// Size and type of the next message; garbage before it is skipped.
std::optional<UlogStream::Header> UlogStream::next_header() {
  constexpr std::string_view kTypes = "BFIMPQARDLCSO";
  while (true) {
    const std::string_view ahead = window_.ahead(kUlogMessageHead);
    if (ahead.size() < kUlogMessageHead) {
      cut_off_ = ahead.size();
      return std::nullopt;
    }
    const Header header{number_at<std::uint16_t>(ahead, 0), ahead[2]};
    const std::uint64_t end = window_.position() + kUlogMessageHead + header.size;
    // What was cut off when data were appended after a crash ends in the middle of a message.
    const auto cut = std::ranges::find_if(appended_, [&](std::uint64_t at) { return at > window_.position() && at < end; });
    if (cut != appended_.end())
      skip(std::min<std::size_t>(static_cast<std::size_t>(*cut - window_.position()), window_.ahead(kUlogMessageHead).size()));
    else if (kTypes.find(header.type) != std::string_view::npos && header.size > 0)
      return header;
    else
      resynchronise();
  }
}

/// Skips to the next sync message, or to the end.
void UlogStream::resynchronise() {
  skip(1);
  while (true) {
    const std::string_view ahead = window_.ahead(kUlogSync.size());
    if (ahead.size() < kUlogSync.size()) return skip(ahead.size());
    const std::size_t found = ahead.find(kUlogSync);
    if (found != std::string_view::npos) return skip(found);
    skip(ahead.size() - kUlogSync.size() + 1);
  }
}

void UlogStream::skip(std::size_t bytes) {
  if (bytes == 0) return;
  if (garbage_ == 0) first_garbage_ = window_.position();
  garbage_ += bytes;
  window_.advance(bytes);
}

void UlogStream::take(char type, std::string_view message) {
  switch (type) {
    case 'B':
      return take_flags(message);
    case 'F':
      if (!formats_.add(message)) ++undefined_;
      return;
    case 'A':
      return take_subscription(message);
    case 'R':
      if (message.size() >= 2) topics_.erase(number_at<std::uint16_t>(message, 0));
      return;
    case 'O':
      ++dropouts_;
      if (message.size() >= 2) dropout_ms_ += number_at<std::uint16_t>(message, 0);
      return;
    default:
      return;  // information, parameters, texts, sync
  }
}

/// Compatible and incompatible flags, 8 bytes each, then three positions of appended data.
void UlogStream::take_flags(std::string_view message) {
  constexpr std::size_t kFlags = 8, kSize = 40;
  constexpr unsigned kAppended = 1;
  if (message.size() < kSize) return;
  const std::string_view incompatible = message.substr(kFlags, kFlags);
  const bool unknown = (number_at<std::uint8_t>(incompatible, 0) & ~kAppended) != 0 ||
                       std::ranges::any_of(incompatible.substr(1), [](char c) { return c != 0; });
  if (unknown)
    throw InputError(
        {name(), 0, "flags of a feature that older readers must not ignore", "a ULog file with none but appended data", ""});
  for (std::size_t i = 0; i < appended_.size(); ++i) appended_.at(i) = number_at<std::uint64_t>(message, 2 * kFlags + 8 * i);
}

void UlogStream::take_subscription(std::string_view message) {
  constexpr std::size_t kHead = 3;
  if (message.size() <= kHead) {
    ++undefined_;
    return;
  }
  const std::string topic(message.substr(kHead));
  auto layout = formats_.layout(topic);
  if (!layout) {
    ++undefined_;
    return;
  }
  const auto id = number_at<std::uint16_t>(message, 1);
  topics_.insert_or_assign(id, UlogTopic{topic, number_at<std::uint8_t>(message, 0), std::move(*layout)});
}

record::Events UlogStream::events() const {
  record::Events events;
  const auto warn = [&](long number, const char* kind, std::string text) {
    if (number > 0)
      events.push_back({record::Event::Severity::kWarning, kind, fmt::format("{}: {}", name(), text), std::nullopt, number});
  };
  warn(dropouts_, "log_dropout",
       fmt::format("the logger lost data {} time{}, {} ms in all", dropouts_, dropouts_ == 1 ? "" : "s", dropout_ms_));
  warn(undefined_, "log_undefined",
       fmt::format("{} messages without a definition, or that contradict it, left out", undefined_));
  warn(static_cast<long>(garbage_), "message_garbage",
       fmt::format("{} bytes that are no message skipped, the first at byte {}", garbage_, first_garbage_));
  warn(cut_off_ > 0 ? 1 : 0, "message_cut_off", fmt::format("the last message is cut off: {} bytes left out", cut_off_));
  return events;
}

std::vector<MessageCount> count_ulog_topics(const std::filesystem::path& file) {
  UlogStream stream(file);
  std::map<std::string, long> numbers;
  UlogData data;
  while (stream.next(data)) ++numbers[fmt::format("{} {}", data.topic->name, data.topic->instance)];
  std::vector<MessageCount> counts;
  for (const auto& [name, number] : numbers) counts.push_back({name, number});
  std::ranges::stable_sort(counts, std::greater<>{}, &MessageCount::number);
  return counts;
}

}  // namespace coast::io
