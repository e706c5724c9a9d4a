// ExtEvent of SBF: transitions at an event input (mosaic-X5 reference guide 4.14.10, 4.2.13).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../counted.hpp"
#include "coast/record/error.hpp"
#include "sbf_blocks.hpp"
#include "sbf_readers.hpp"

namespace coast::io {

namespace {

/// None without the time or the clock bias, that is without a position in the ten minutes before.
std::optional<record::TimeMark> mark_of(std::string_view payload) {
  constexpr std::size_t kSize = 20;
  constexpr double kMost = 10.0;  // s, of offset and bias; the stamp has the same millisecond
  const auto stamp = sbf_time(payload);
  if (!stamp || payload.size() < kSize) return std::nullopt;
  SbfFields f(payload, kSbfBody);
  record::TimeMark mark;
  mark.channel = f.u1();
  mark.edge = f.u1() == 0 ? record::Edge::kRising : record::Edge::kFalling;
  const double offset = f.f4(), bias = f.f8();
  if (!(std::abs(offset) < kMost) || !(std::abs(bias) < kMost)) return std::nullopt;
  mark.t = *stamp + offset - bias;
  return mark;
}

}  // namespace

record::TimeMarkRecording read_sbf_time_marks(const std::filesystem::path& file) {
  FrameStream stream(file, kSbfLog);
  record::TimeMarkRecording recording;
  recording.source = stream.name();
  long left_out = 0;
  MessageFrame frame;
  while (stream.next(frame)) {
    if (frame.protocol != Protocol::kSbf || frame.id != sbf::kExtEvent) continue;
    if (const auto mark = mark_of(frame.payload))
      recording.marks.push_back(*mark);
    else
      ++left_out;
  }
  recording.events = sbf_file_events(stream.census(), recording.source);
  if (recording.marks.empty())
    throw InputError(
        {recording.source, 0, fmt::format("no time mark{}", left_out > 0 ? " with a valid GNSS time" : ""), "ExtEvent", ""});
  std::ranges::stable_sort(recording.marks, {}, &record::TimeMark::t);
  add_counted(recording.events, recording.source, {left_out},
              {"time_mark_invalid", "time mark", "time marks", "without a valid GNSS time left out"});
  return recording;
}

}  // namespace coast::io
