#include "vectornav_stream.hpp"

#include "../binary.hpp"
#include "vectornav_readers.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kMasks = 6;
constexpr std::size_t kRecordsHead = 4 * kMasks, kRecordTime = 16;

/// Groups and masks as the sensor sends them, from the head of a file of records; empty: it is none. The masks have bit 15,
/// which announces a second word, where there are fields in it.
std::string sent_head(std::string_view head) {
  constexpr std::uint32_t kExtended = 1U << 15, kWord = 0xFFFF;
  if (head.size() < kRecordsHead) return {};
  std::string masks;
  std::uint8_t groups = 0;
  for (std::size_t i = 0; i < kMasks; ++i) {
    const auto mask = number_at<std::uint32_t>(head, 4 * i);
    if (((mask & kExtended) != 0) != (mask > kWord)) return {};
    if (mask == 0) continue;
    groups = static_cast<std::uint8_t>(groups | (2U << i));  // the common group is the first, and not in such a file
    masks += head.substr(4 * i, mask > kWord ? 4 : 2);
  }
  return groups == 0 ? std::string() : static_cast<char>(groups) + masks;
}

bool holds_records(const std::filesystem::path& file) {
  constexpr std::size_t kEnough = 4096;
  return VectorNavRecords::begins_in(ByteWindow(file).ahead(kEnough));
}

bool possible_time(std::string_view record) {
  constexpr std::uint32_t kMostCycles = 8, kWeeks = 1024;
  constexpr double kWeek = 604800.0;
  const auto tow = number_at<double>(record, 8);
  return number_at<std::uint32_t>(record, 0) <= kMostCycles && number_at<std::uint32_t>(record, 4) < kWeeks && tow >= 0.0 &&
         tow < kWeek;
}

}  // namespace

bool VectorNavRecords::begins_in(std::string_view head) {
  const std::string sent = sent_head(head);
  if (sent.empty() || head.size() < kRecordsHead + kRecordTime || !possible_time(head.substr(kRecordsHead))) return false;
  VectorNavMessage message;
  return message.parse(sent + std::string(head.substr(kRecordsHead + kRecordTime)), VectorNavMessage::Form::kRecorded) ==
         VectorNavMessage::Head::kWhole;
}

VectorNavRecords::VectorNavRecords(const std::filesystem::path& file) : window_(file) {
  message_ = sent_head(window_.ahead(kRecordsHead));
  head_ = message_.size();
  window_.advance(kRecordsHead);
}

bool VectorNavRecords::next(VectorNavMessage& message) {
  std::size_t fields = 0;
  for (;;) {
    const std::string_view ahead = window_.ahead(kRecordTime + fields);
    if (ahead.size() < kRecordTime + fields) {
      census_.cut_off = ahead.size();
      return give_up(ahead.size());
    }
    message_.resize(head_);
    message_ += ahead.substr(kRecordTime, fields);
    const VectorNavMessage::Head parsed = message.parse(message_, VectorNavMessage::Form::kRecorded);
    if (parsed == VectorNavMessage::Head::kUnknown || !possible_time(ahead)) return give_up(ahead.size());
    if (parsed == VectorNavMessage::Head::kWhole) {
      window_.advance(kRecordTime + fields);
      ++census_.frames[{Protocol::kVectorNav, message.groups()}];
      return true;
    }
    fields = message.size() - head_;
  }
}

/// What is left of the file cannot be told apart.
bool VectorNavRecords::give_up(std::size_t bytes) {
  if (census_.skipped == 0) census_.first_skipped = window_.position();
  census_.skipped = bytes;
  return false;
}

VectorNavStream::VectorNavStream(const std::filesystem::path& file) : frames_(file, kVectorNavLog) {
  if (holds_records(file)) records_.emplace(file);
}

bool VectorNavStream::next(VectorNavMessage& message) {
  if (records_) return records_->next(message);
  MessageFrame frame;
  while (frames_.next(frame))
    if (frame.protocol == Protocol::kVectorNav && message.parse(frame.payload) == VectorNavMessage::Head::kWhole) return true;
  return false;
}

std::vector<MessageCount> count_vectornav_messages(const std::filesystem::path& file) {
  if (!holds_records(file)) return count_frames(file, kVectorNavLog);
  VectorNavRecords records(file);
  VectorNavMessage message;
  long number = 0;
  while (records.next(message)) ++number;
  return {{"VectorNav records", number}};
}

}  // namespace coast::io
