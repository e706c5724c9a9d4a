#pragma once
// What is read of a bag: the messages of one topic, and their times. Private to the room.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../counted.hpp"
#include "bag_stream.hpp"
#include "coast/io/contents.hpp"
#include "coast/io/time_column.hpp"

namespace coast::io {

/// What a reader looks for in a bag.
struct BagWanted {
  std::string topic;    ///< as the run file states it; empty: the only one
  std::string section;  ///< of the run file: "imu"
  std::string types;    ///< for messages: "sensor_msgs/Imu"
};

/// The topic to read.
/// @param numbers  of the messages of the right types by topic
/// @throws InputError  none, several of which none is wanted, or not the one that is wanted
[[nodiscard]] std::string chosen_topic(const std::map<std::string, long>& numbers, const BagWanted& wanted,
                                       const std::string& file);

/// Messages of the right types by topic, of which one topic's are wanted. Only they are kept if it is stated.
template <class Row>
class BagRows {
 public:
  explicit BagRows(BagWanted wanted) : wanted_(std::move(wanted)) {}

  /// @param row  none if the message could not be decoded
  void add(const BagTopic& topic, const std::optional<Row>& row) {
    ++numbers_[topic.name];
    if (!wanted_.topic.empty() && wanted_.topic != topic.name) return;
    if (row)
      rows_[topic.name].push_back(*row);
    else
      undecoded_[topic.name].add();
  }
  /// @throws InputError  see chosen_topic
  [[nodiscard]] std::vector<Row> chosen(const std::string& file, record::Events& events) {
    const std::string topic = chosen_topic(numbers_, wanted_, file);
    add_counted(events, file, undecoded_[topic],
                {"bag_message_undecoded", "message", "messages", "of " + topic + " that contradict their type left out"});
    return std::move(rows_[topic]);
  }

 private:
  BagWanted wanted_;
  std::map<std::string, long> numbers_;
  std::map<std::string, std::vector<Row>> rows_;
  std::map<std::string, Counted> undecoded_;
};

/// Stamps of headers as GPS time. They are POSIX times, or, with `time: {kind: elapsed}`, those of any clock.
class BagTimes {
 public:
  /// @param error  makes the error of the current message
  BagTimes(const TimeOptions& options, std::optional<geo::GpsTime> near, const WeekClock::MakeError& error);

  /// @param log_ns  when the message was recorded, which stands in for a stamp that is not set
  /// @return none  a time outside the years 2000 to 2100
  [[nodiscard]] std::optional<geo::GpsTime> at(std::int64_t stamp_ns, std::int64_t log_ns);
  void report(record::Events& events, const std::string& file) const;

 private:
  bool posix_;
  double offset_s_;
  WeekClock clock_;
  Counted not_set_;
};

/// Number of messages by topic and type, the most frequent first.
[[nodiscard]] std::vector<MessageCount> count_bag_messages(BagStream& stream);

}  // namespace coast::io
