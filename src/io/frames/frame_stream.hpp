#pragma once
// The frames of a file, one after another, found again after garbage. Private to the room.

#include <map>
#include <span>
#include <utility>

#include "byte_window.hpp"
#include "coast/io/contents.hpp"
#include "coast/record/event.hpp"
#include "frame.hpp"

namespace coast::io {

/// What a file was seen to hold, up to where it was read.
struct FrameCensus {
  struct Bad {
    long number = 0;
    std::uint64_t first = 0;  ///< position
  };
  std::map<std::pair<Protocol, std::uint32_t>, long> frames;  ///< number by protocol and id
  std::array<Bad, kProtocols> bad_checksums{};                ///< by protocol; of bytes that begin like a frame
  std::uint64_t skipped = 0;                                  ///< bytes that belong to no frame
  std::uint64_t first_skipped = 0;                            ///< position
  std::uint64_t cut_off = 0;                                  ///< of them, those of a frame that the end of the file cuts off

  [[nodiscard]] long number(Protocol protocol, std::uint32_t id) const;
  /// What damage there is, as events: wrong checksums of protocols that the file has, skipped bytes, a cut end.
  [[nodiscard]] record::Events events(const std::string& file) const;
};

/// Adds an event on the messages that no reader uses, by name and number, if there are any.
void add_unread(record::Events& events, const std::string& file, const FrameCensus& census,
                bool (*is_read)(Protocol protocol, std::uint32_t id));

/// Number of frames by kind in a whole file, the most frequent first.
[[nodiscard]] std::vector<MessageCount> count_frames(const std::filesystem::path& file, std::span<const FrameKind> kinds);

/// Yields frames of several protocols. Bytes that begin no whole frame are skipped one by one: after garbage the next frame is
/// found, whatever a false beginning states as its length.
class FrameStream {
 public:
  FrameStream(const std::filesystem::path& file, std::span<const FrameKind> kinds);

  /// The next frame; its payload is valid until the next call.
  [[nodiscard]] bool next(MessageFrame& frame);
  [[nodiscard]] const FrameCensus& census() const { return census_; }
  [[nodiscard]] const std::string& name() const { return window_.name(); }

 private:
  [[nodiscard]] FrameTrial try_here(std::string_view& ahead);
  [[nodiscard]] std::size_t garbage(std::string_view ahead) const;
  void skip(std::size_t bytes);
  void count(Protocol protocol, std::uint32_t id);

  ByteWindow window_;
  std::array<const FrameKind*, 256> kind_of_{};  ///< by first byte; null: none begins so
  std::uint64_t cut_from_ = 0;                 ///< first frame since the last whole one that ends beyond the file; position + 1
  std::pair<Protocol, std::uint32_t> last_{};  ///< counted last, with its place in the census
  long* last_count_ = nullptr;
  FrameCensus census_;
};

}  // namespace coast::io
