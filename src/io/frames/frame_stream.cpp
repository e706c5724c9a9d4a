#include "frame_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace coast::io {

namespace {

using Verdict = FrameTrial::Verdict;

std::size_t index_of(char c) {
  return static_cast<unsigned char>(c);
}

}  // namespace

long FrameCensus::number(Protocol protocol, std::uint32_t id) const {
  const auto found = frames.find({protocol, id});
  return found == frames.end() ? 0 : found->second;
}

record::Events FrameCensus::events(const std::string& file) const {
  record::Events events;
  const auto warn = [&](const char* kind, std::string text, long number) {
    events.push_back({record::Event::Severity::kWarning, kind, fmt::format("{}: {}", file, text), std::nullopt, number});
  };
  for (std::size_t i = 0; i < kProtocols; ++i) {
    const auto protocol = static_cast<Protocol>(i);
    const auto first = frames.lower_bound({protocol, 0});
    const bool present = first != frames.end() && first->first.first == protocol;
    const Bad& bad = bad_checksums.at(i);
    // Garbage and payloads begin like a frame now and then; where the protocol occurs, a message may have been lost.
    if (present && bad.number > 0)
      warn("message_checksum",
           fmt::format("{} {} message{} with a wrong checksum left out, the first at byte {}", bad.number, name_of(protocol),
                       bad.number == 1 ? "" : "s", bad.first),
           bad.number);
  }
  if (skipped > cut_off)
    warn("message_garbage",
         fmt::format("{} bytes between messages skipped, the first at byte {}", skipped - cut_off, first_skipped),
         static_cast<long>(skipped - cut_off));
  if (cut_off > 0) warn("message_cut_off", fmt::format("the last message is cut off: {} bytes left out", cut_off), 1);
  return events;
}

void add_unread(record::Events& events, const std::string& file, const FrameCensus& census,
                bool (*is_read)(Protocol protocol, std::uint32_t id)) {
  std::vector<std::pair<long, std::string>> unread;
  long messages = 0;
  for (const auto& [key, number] : census.frames) {
    if (is_read(key.first, key.second)) continue;
    unread.emplace_back(number, frame_name(key.first, key.second));
    messages += number;
  }
  if (unread.empty()) return;
  std::ranges::stable_sort(unread, std::greater<>{}, [](const auto& one) { return one.first; });
  constexpr std::size_t kNamed = 12;
  std::string names;
  for (std::size_t i = 0; i < std::min(kNamed, unread.size()); ++i)
    names += fmt::format("{}{} {}", i == 0 ? "" : ", ", unread[i].first, unread[i].second);
  if (unread.size() > kNamed) names += fmt::format(" and {} more kinds", unread.size() - kNamed);
  events.push_back({record::Event::Severity::kInfo, "messages_not_read",
                    fmt::format("{}: {} messages that coast does not read: {}", file, messages, names), std::nullopt,
                    messages});
}

std::vector<MessageCount> count_frames(const std::filesystem::path& file, std::span<const FrameKind> kinds) {
  FrameStream stream(file, kinds);
  MessageFrame frame;
  while (stream.next(frame)) {
  }
  std::vector<MessageCount> counts;
  for (const auto& [key, number] : stream.census().frames) counts.push_back({frame_name(key.first, key.second), number});
  std::ranges::stable_sort(counts, std::greater<>{}, &MessageCount::number);
  return counts;
}

FrameStream::FrameStream(const std::filesystem::path& file, std::span<const FrameKind> kinds) : window_(file) {
  for (const FrameKind& kind : kinds) kind_of_.at(index_of(kind.first)) = &kind;
}

bool FrameStream::next(MessageFrame& frame) {
  while (true) {
    std::string_view ahead = window_.ahead(1);
    if (ahead.empty()) break;
    if (const std::size_t bytes = garbage(ahead); bytes > 0) {
      skip(bytes);
      continue;
    }
    const FrameKind& kind = *kind_of_[index_of(ahead.front())];
    const FrameTrial trial = try_here(ahead);
    if (trial.verdict == Verdict::kFrame) {
      frame = {kind.protocol, trial.id, ahead.substr(trial.payload_at, trial.payload_size), window_.position()};
      count(kind.protocol, trial.id);
      cut_from_ = 0;
      window_.advance(trial.size);
      return true;
    }
    if (trial.verdict == Verdict::kChecksum) {
      FrameCensus::Bad& bad = census_.bad_checksums.at(static_cast<std::size_t>(kind.protocol));
      if (bad.number++ == 0) bad.first = window_.position();
    }
    if (trial.verdict == Verdict::kMore && cut_from_ == 0) cut_from_ = window_.position() + 1;
    skip(1);
  }
  census_.cut_off = cut_from_ == 0 ? 0 : window_.position() + 1 - cut_from_;
  return false;
}

/// The verdict on the bytes at the position; kMore only at the end of the file.
FrameTrial FrameStream::try_here(std::string_view& ahead) {
  const FrameRule rule = kind_of_[index_of(ahead.front())]->rule;
  while (true) {
    const FrameTrial trial = rule(ahead);
    if (trial.verdict != Verdict::kMore) return trial;
    const std::size_t before = ahead.size();
    ahead = window_.ahead(trial.size);
    if (ahead.size() == before) return trial;
  }
}

/// Number of bytes ahead that begin no frame.
std::size_t FrameStream::garbage(std::string_view ahead) const {
  std::size_t bytes = 0;
  while (bytes < ahead.size() && kind_of_[index_of(ahead[bytes])] == nullptr) ++bytes;
  return bytes;
}

void FrameStream::skip(std::size_t bytes) {
  if (census_.skipped == 0) census_.first_skipped = window_.position();
  census_.skipped += bytes;
  window_.advance(bytes);
}

void FrameStream::count(Protocol protocol, std::uint32_t id) {
  // Messages of one kind often follow each other, and a map keeps its places.
  if (last_count_ == nullptr || last_ != std::pair(protocol, id)) {
    last_ = {protocol, id};
    last_count_ = &census_.frames[last_];
  }
  ++*last_count_;
}

}  // namespace coast::io
