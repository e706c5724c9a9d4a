#pragma once
// Messages of a DataFlash log of ArduPilot (ArduPilot documentation, "Onboard message log messages"; layout in AP_Logger's
// LogStructure). Private to the room.

#include <array>
#include <map>
#include <optional>
#include <string>

#include "../frames/byte_window.hpp"
#include "coast/io/contents.hpp"
#include "coast/record/event.hpp"

namespace coast::io {

struct DataflashField {
  char type = 0;
  std::size_t offset = 0;  ///< behind the head of the message
};

/// A kind of message as a message FMT of the log defines it.
struct DataflashFormat {
  std::string name;      ///< "IMU"
  std::size_t size = 0;  ///< of the whole message
  std::map<std::string, DataflashField, std::less<>> fields;
};

struct DataflashMessage {
  const DataflashFormat* format = nullptr;
  std::string_view bytes;  ///< behind the head; valid until the next call

  /// In the unit that its type implies: hundredths as the whole, degrees.  @return none  no such field, or no finite number
  [[nodiscard]] std::optional<double> number(std::string_view name) const;
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view name) const;
  /// The autopilot's clock in us, from `name` or in logs before 2015 from `before` in ms; none: not there, or impossible.
  [[nodiscard]] std::optional<std::int64_t> boot_us(std::string_view name, std::string_view before) const;
  /// Of redundant sensors; 0 where the message has none.
  [[nodiscard]] int instance() const { return static_cast<int>(integer("I").value_or(0)); }
};

/// Reads definitions on the way, and yields everything else. Messages have no checksum: one counts where another follows it, or
/// the end of the file.
class DataflashStream {
 public:
  /// @throws InputError  not such a file
  explicit DataflashStream(const std::filesystem::path& file);

  [[nodiscard]] bool next(DataflashMessage& message);
  [[nodiscard]] const std::string& name() const { return window_.name(); }
  /// Damage, and what the logger says that it lost.
  [[nodiscard]] record::Events events() const;

 private:
  void define(std::string_view definition);
  void skip(std::size_t bytes);

  ByteWindow window_;
  std::array<std::optional<DataflashFormat>, 256> formats_;
  long undefined_ = 0, lost_ = 0;
  std::uint64_t garbage_ = 0, first_garbage_ = 0, cut_off_ = 0;
};

/// Number of messages by name, the most frequent first.
[[nodiscard]] std::vector<MessageCount> count_dataflash_messages(const std::filesystem::path& file);

/// The first bytes of a file are those of such a log.
[[nodiscard]] bool begins_as_dataflash(std::string_view head);

}  // namespace coast::io
