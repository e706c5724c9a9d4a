// Edges at the event inputs of the receiver: MARKTIME, MARK1TIME to MARK4TIME, and MARK1PVA to MARK4PVA of inputs without these
// (OEM7 Commands and Logs Reference Manual). MARKPOS has its time to a millisecond only and is not read.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "../counted.hpp"
#include "coast/record/error.hpp"
#include "novatel_log.hpp"
#include "novatel_readers.hpp"

namespace coast::io {

namespace {

/// "Clock model status".
constexpr std::array<NovAtelWord, 4> kClockStatus = {{{"VALID", 0}, {"CONVERGING", 1}, {"ITERATING", 2}, {"INVALID", 3}}};

struct MarkLog {
  std::uint32_t id;
  int input;
  bool pva;
};
constexpr std::array<MarkLog, 9> kMarkLogs = {{{novatel::kMarkTime, 1, false},
                                               {novatel::kMark1Time, 1, false},
                                               {novatel::kMark2Time, 2, false},
                                               {novatel::kMark3Time, 3, false},
                                               {novatel::kMark4Time, 4, false},
                                               {novatel::kMark1Pva, 1, true},
                                               {novatel::kMark2Pva, 2, true},
                                               {novatel::kMark3Pva, 3, true},
                                               {novatel::kMark4Pva, 4, true}}};

std::optional<record::TimeMark> mark_of(const NovAtelLog& log, const MarkLog& kind) {
  constexpr double kLargestSd = 1.0;  // s
  NovAtelFields f = log.fields();
  const std::uint32_t week = f.u32();
  const auto t = novatel_time(week, f.f64());
  record::TimeMark mark;
  mark.channel = kind.input;
  if (!kind.pva) {
    static_cast<void>(f.f64());  // offset of the receiver's clock
    const double sd = f.f64();
    if (sd > 0.0 && sd < kLargestSd) mark.sd_s = sd;
    static_cast<void>(f.f64());  // UTC
    if (f.word(kClockStatus) != 0) return std::nullopt;
  }
  if (!f.good() || !t) return std::nullopt;
  mark.t = *t;
  return mark;
}

}  // namespace

record::TimeMarkRecording read_novatel_time_marks(const std::filesystem::path& file) {
  NovAtelStream stream(file);
  record::TimeMarkRecording recording;
  recording.source = stream.name();
  std::vector<record::TimeMark> of_pva;
  Counted left_out;
  NovAtelLog log;
  while (stream.next(log)) {
    const auto kind = std::ranges::find(kMarkLogs, log.id, &MarkLog::id);
    if (kind == kMarkLogs.end()) continue;
    if (const auto mark = mark_of(log, *kind))
      (kind->pva ? of_pva : recording.marks).push_back(*mark);
    else
      left_out.add(log.time());
  }
  std::array<bool, 5> timed{};
  for (const record::TimeMark& mark : recording.marks) timed.at(static_cast<std::size_t>(mark.channel)) = true;
  for (const record::TimeMark& mark : of_pva)
    if (!timed.at(static_cast<std::size_t>(mark.channel))) recording.marks.push_back(mark);
  recording.events = stream.events();
  if (recording.marks.empty())
    throw InputError({recording.source, 0, fmt::format("no time mark{}", left_out.number > 0 ? " with a valid GPS time" : ""),
                      "MARKTIME, MARK1TIME to MARK4TIME, or MARK1PVA to MARK4PVA", ""});
  std::ranges::stable_sort(recording.marks, {}, &record::TimeMark::t);
  const auto same = [](const record::TimeMark& a, const record::TimeMark& b) { return a.t == b.t && a.channel == b.channel; };
  recording.marks.erase(std::unique(recording.marks.begin(), recording.marks.end(), same), recording.marks.end());
  add_counted(recording.events, recording.source, left_out,
              {"time_mark_invalid", "time mark", "time marks", "without a valid GPS time left out"});
  return recording;
}

}  // namespace coast::io
