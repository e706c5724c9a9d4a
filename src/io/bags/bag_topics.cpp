#include "bag_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "../posix_time.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

std::string chosen_topic(const std::map<std::string, long>& numbers, const BagWanted& wanted, const std::string& file) {
  if (numbers.empty())
    throw InputError({file, 0, fmt::format("a bag without messages of {}", wanted.types), "at least one topic with them", ""});
  if (wanted.topic.empty() && numbers.size() == 1) return numbers.begin()->first;
  if (numbers.contains(wanted.topic)) return wanted.topic;
  std::vector<std::string> listed;
  for (const auto& [topic, number] : numbers)
    listed.push_back(fmt::format("{} ({} message{})", topic, number, number == 1 ? "" : "s"));
  const auto most = std::ranges::max_element(numbers, {}, [](const auto& entry) { return entry.second; });
  const std::string found = wanted.topic.empty() ? fmt::format("{} topics of {}", numbers.size(), wanted.types)
                                                 : fmt::format("no topic {} of {}", wanted.topic, wanted.types);
  throw InputError({file, 0, found, fmt::format("one of {}", fmt::join(listed, ", ")),
                    fmt::format("Write e.g. `{}: {{file: {}, topic: {}}}`.", wanted.section,
                                std::filesystem::path(file).filename().string(), most->first)});
}

BagTimes::BagTimes(const TimeOptions& options, std::optional<geo::GpsTime> near, const WeekClock::MakeError& error)
    : posix_(!options.kind_given || options.kind != TimeKind::kElapsed),
      offset_s_(options.offset_s),
      clock_(options, near, error) {}

std::optional<geo::GpsTime> BagTimes::at(std::int64_t stamp_ns, std::int64_t log_ns) {
  constexpr std::int64_t kNano = 1'000'000'000;
  if (!posix_) return clock_.at(1e-9 * static_cast<double>(stamp_ns) + offset_s_);
  if (stamp_ns == 0) not_set_.add();
  const std::int64_t ns = stamp_ns == 0 ? log_ns : stamp_ns;
  const auto t = gps_from_posix(ns / kNano, ns % kNano);
  return t ? std::optional(*t + offset_s_) : std::nullopt;
}

void BagTimes::report(record::Events& events, const std::string& file) const {
  const record::Events rollovers = clock_.events();
  events.insert(events.end(), rollovers.begin(), rollovers.end());
  add_counted(events, file, not_set_,
              {"bag_stamp_not_set", "message", "messages", "without a stamp: the times of their recording were taken"});
}

std::vector<MessageCount> count_bag_messages(BagStream& stream) {
  std::map<std::string, long> numbers;
  BagMessage message;
  while (stream.next(message))
    ++numbers[message.topic->type.empty() ? message.topic->name
                                          : fmt::format("{} ({})", message.topic->name, message.topic->type)];
  std::vector<MessageCount> counts;
  for (const auto& [name, number] : numbers) counts.push_back({name, number});
  std::ranges::stable_sort(counts, std::greater<>{}, &MessageCount::number);
  return counts;
}

}  // namespace coast::io
