// Bags of ROS 1 (ROS wiki, "Bags/Format/2.0"): records of a header with named fields, and data. Messages are in chunks, in the
// order of the recording. The index at the end is not needed, and is not there after a crash.

#include <fmt/format.h>

#include <map>
#include <optional>

#include "../binary.hpp"
#include "bag_compression.hpp"
#include "bag_source.hpp"
#include "bag_stream.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

constexpr std::string_view kRosbagMagic = "#ROSBAG V";
constexpr std::string_view kRosbagMagic2 = "#ROSBAG V2.0\n";

struct Rosbag1Record {
  std::string_view header, data;
};

/// Field of a header: a length, then NAME=VALUE.
std::optional<std::string_view> rosbag_field(std::string_view header, std::string_view name) {
  constexpr std::size_t kLength = 4;
  while (header.size() >= kLength) {
    const auto size = number_at<std::uint32_t>(header, 0);
    if (size > header.size() - kLength) return std::nullopt;
    const std::string_view field = header.substr(kLength, size);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    if (field.substr(0, equals) == name) return field.substr(equals + 1);
    header.remove_prefix(kLength + size);
  }
  return std::nullopt;
}

template <class T>
std::optional<T> rosbag_number(std::string_view header, std::string_view name) {
  const auto value = rosbag_field(header, name);
  return value && value->size() == sizeof(T) ? std::optional(number_at<T>(*value, 0)) : std::nullopt;
}

class Rosbag1Stream final : public BagStream {
 public:
  explicit Rosbag1Stream(const std::filesystem::path& file) : source_(file) {
    const bool whole = source_.read(header_, kRosbagMagic2.size());
    if (!begins_as_rosbag1(header_))
      throw InputError({name(), 0, "no \"#ROSBAG\" at its beginning", "a bag of ROS 1", "Is this the right file?"});
    if (!whole || header_ != kRosbagMagic2)
      throw InputError({name(), 0, fmt::format("\"{}\"", header_.substr(1, header_.find('\n') - 1)), "\"ROSBAG V2.0\"",
                        "`rosbag migrate` writes older bags anew."});
  }

  bool next(BagMessage& message) override {
    while (true) {
      while (const auto record = next_in_chunk())
        if (take(*record, message)) return true;
      if (!next_outside()) return false;
      if (const auto op = rosbag_number<std::uint8_t>(header_, "op"); op == kChunk)
        open_chunk();
      else if (take({header_, data_}, message))
        return true;
    }
  }
  [[nodiscard]] const std::string& name() const override { return source_.name(); }
  [[nodiscard]] record::Events events() const override { return damage_.events(name()); }

 private:
  static constexpr std::uint8_t kMessage = 2, kBagHeader = 3, kChunk = 5, kConnection = 7;

  /// Reads one record of the file.
  [[nodiscard]] bool next_outside() {
    constexpr std::uint32_t kLongestHeader = 1U << 20;
    data_.clear();
    const std::uint64_t start = source_.position();
    std::string length;
    if (!source_.read(length, 4)) return end(!length.empty());
    const auto size = number_at<std::uint32_t>(length, 0);
    if (size > kLongestHeader) return stop(start);
    if (!source_.read(header_, size)) return end(true);
    const auto op = rosbag_number<std::uint8_t>(header_, "op");
    if (!op) return stop(start);
    if (!source_.read(length, 4)) return end(true);
    const auto data = number_at<std::uint32_t>(length, 0);
    const bool wanted = *op == kMessage || *op == kChunk || *op == kConnection;
    if (wanted ? source_.read(data_, data) : source_.skip(data)) return true;
    // What a recorder has begun to write when it was stopped is still of use without compression.
    return *op == kChunk && rosbag_field(header_, "compression") == "none" ? end(true, true) : end(true);
  }
  [[nodiscard]] bool end(bool cut_off, bool with_rest = false) {
    damage_.cut_off = damage_.cut_off || cut_off;
    damage_.not_closed = !cut_off && (index_at_ == 0 || source_.position() < index_at_);
    return with_rest;
  }
  [[nodiscard]] bool stop(std::uint64_t at) {
    damage_.stopped_at = at;
    return false;
  }

  void open_chunk() {
    const auto compression = rosbag_field(header_, "compression");
    const auto size = rosbag_number<std::uint32_t>(header_, "size");
    bool whole = false;
    if (compression == "none") {
      chunk_.swap(data_);
      whole = true;
    } else if (size && *size <= BagSource::kMost) {
      if (compression == "bz2") whole = unpack_bz2(data_, *size, chunk_) && chunk_.size() == *size;
      if (compression == "lz4") whole = unpack_lz4(data_, *size, chunk_) && chunk_.size() == *size;
    }
    at_ = 0;
    if (whole) return;
    ++damage_.chunks;
    chunk_.clear();
  }

  [[nodiscard]] std::optional<Rosbag1Record> next_in_chunk() {
    const std::string_view rest = std::string_view(chunk_).substr(at_);
    if (rest.empty()) return std::nullopt;
    const auto header = with_length(rest);
    const auto data = header ? with_length(rest.substr(4 + header->size())) : std::nullopt;
    if (!data) {
      if (!damage_.cut_off) ++damage_.undefined;
      at_ = chunk_.size();
      return std::nullopt;
    }
    at_ += 8 + header->size() + data->size();
    return Rosbag1Record{*header, *data};
  }
  static std::optional<std::string_view> with_length(std::string_view bytes) {
    constexpr std::size_t kLength = 4;
    if (bytes.size() < kLength) return std::nullopt;
    const auto size = number_at<std::uint32_t>(bytes, 0);
    return size <= bytes.size() - kLength ? std::optional(bytes.substr(kLength, size)) : std::nullopt;
  }

  /// @return true if it is a message
  [[nodiscard]] bool take(const Rosbag1Record& record, BagMessage& message) {
    const auto op = rosbag_number<std::uint8_t>(record.header, "op");
    if (op == kConnection) take_connection(record);
    if (op == kBagHeader) take_bag_header(record.header);
    if (op != kMessage) return false;
    const auto connection = rosbag_number<std::uint32_t>(record.header, "conn");
    const auto time = rosbag_number<std::uint64_t>(record.header, "time");
    const auto topic = connection ? topics_.find(*connection) : topics_.end();
    if (topic == topics_.end() || !time) {
      ++damage_.undefined;
      return false;
    }
    constexpr std::int64_t kNano = 1'000'000'000;
    const auto seconds = static_cast<std::int64_t>(*time & 0xffffffffU), nanoseconds = static_cast<std::int64_t>(*time >> 32U);
    message = {&topic->second, kNano * seconds + nanoseconds, record.data};
    return true;
  }
  void take_connection(const Rosbag1Record& record) {
    const auto id = rosbag_number<std::uint32_t>(record.header, "conn");
    const auto topic = rosbag_field(record.header, "topic"), type = rosbag_field(record.data, "type");
    if (!id || !topic || !type)
      ++damage_.undefined;
    else
      topics_.insert_or_assign(*id, BagTopic{std::string(*topic), std::string(*type), BagEncoding::kRos1});
  }
  void take_bag_header(std::string_view header) {
    index_at_ = rosbag_number<std::uint64_t>(header, "index_pos").value_or(0);
    if (const auto encryptor = rosbag_field(header, "encryptor"); encryptor && !encryptor->empty())
      throw InputError({name(), 0, fmt::format("a bag encrypted by {}", *encryptor), "one that is not", ""});
  }

  BagSource source_;
  std::string header_, data_, chunk_;
  std::size_t at_ = 0;  ///< in the chunk
  std::uint64_t index_at_ = 0;
  std::map<std::uint32_t, BagTopic> topics_;
  BagDamage damage_;
};

}  // namespace

bool begins_as_rosbag1(std::string_view head) {
  return head.starts_with(kRosbagMagic);
}

std::unique_ptr<BagStream> open_rosbag1(const std::filesystem::path& file) {
  return std::make_unique<Rosbag1Stream>(file);
}

}  // namespace coast::io
