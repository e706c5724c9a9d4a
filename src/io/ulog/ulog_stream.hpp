#pragma once
// Messages of a ULog file one after another (PX4 user guide, "ULog file format"). Private to the room.

#include <array>
#include <map>

#include "../frames/byte_window.hpp"
#include "coast/io/contents.hpp"
#include "coast/record/event.hpp"
#include "ulog_layout.hpp"

namespace coast::io {

/// A kind of message in one instance, e.g. of the second of three gyros.
struct UlogTopic {
  std::string name;
  int instance = 0;
  UlogLayout layout;
};

/// One logged message.
struct UlogData {
  std::uint16_t id = 0;  ///< of the topic in this file
  const UlogTopic* topic = nullptr;
  std::string_view bytes;  ///< valid until the next call
};

/// Reads definitions and subscriptions on the way, and yields what has been logged. After damage it goes on at the next sync
/// message.
class UlogStream {
 public:
  /// @throws InputError  not a ULog file, or one of a version or with features that are not known
  explicit UlogStream(const std::filesystem::path& file);

  [[nodiscard]] bool next(UlogData& data);
  [[nodiscard]] const std::string& name() const { return window_.name(); }
  /// Damage, and pauses of the logger.
  [[nodiscard]] record::Events events() const;

 private:
  struct Header {
    std::size_t size = 0;  ///< of the message after it
    char type = 0;
  };
  [[nodiscard]] std::optional<Header> next_header();
  void take(char type, std::string_view message);
  void take_flags(std::string_view message);
  void take_subscription(std::string_view message);
  void resynchronise();
  void skip(std::size_t bytes);

  ByteWindow window_;
  UlogFormats formats_;
  std::map<std::uint16_t, UlogTopic> topics_;
  std::array<std::uint64_t, 3> appended_{};  ///< positions at which data were appended after a crash; 0: none
  long dropouts_ = 0, dropout_ms_ = 0, undefined_ = 0;
  std::uint64_t garbage_ = 0, first_garbage_ = 0, cut_off_ = 0;
};

/// Number of logged messages by topic and instance, the most frequent first.
[[nodiscard]] std::vector<MessageCount> count_ulog_topics(const std::filesystem::path& file);

/// The first bytes of a file are those of ULog.
[[nodiscard]] bool begins_as_ulog(std::string_view head);

}  // namespace coast::io
