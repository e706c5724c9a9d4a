// MCAP, the container of ROS 2 bags (mcap.dev, "MCAP Format Specification"). Records are read from the beginning on: the index
// and the summary at the end are not needed, and are not there after a crash.

#include <fmt/format.h>
#include <zlib.h>

#include <map>
#include <optional>

#include "../binary.hpp"
#include "bag_compression.hpp"
#include "bag_source.hpp"
#include "bag_stream.hpp"
#include "coast/record/error.hpp"
#include "mcap_records.hpp"

namespace coast::io {

namespace {

/// Fields of a record one after another; after one that is not there, all are empty and `ok` is false.
class McapFields {
 public:
  explicit McapFields(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  T number() {
    const std::string_view raw = bytes(sizeof(T));
    return ok_ ? number_at<T>(raw, 0) : T{};
  }
  std::string_view text() { return bytes(number<std::uint32_t>()); }
  std::string_view bytes(std::uint64_t size) {
    if (size > rest_.size()) ok_ = false;
    if (!ok_) return {};
    const std::string_view value = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(static_cast<std::size_t>(size));
    return value;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

class McapStream final : public BagStream {
 public:
  explicit McapStream(const std::filesystem::path& file) : source_(file) {
    const bool whole = source_.read(record_, kMcapMagic.size());
    if (!whole || record_ != kMcapMagic)
      throw InputError({name(), 0, "no \"MCAP\" of version 0 at its beginning", "an MCAP file", "Is this the right file?"});
  }

  bool next(BagMessage& message) override {
    while (true) {
      while (at_ < chunk_.size())
        if (take_from_chunk(message)) return true;
      const auto op = next_outside();
      if (!op) return false;
      if (*op == McapOp::kChunk)
        open_chunk();
      else if (take(*op, record_, message))
        return true;
    }
  }
  [[nodiscard]] const std::string& name() const override { return source_.name(); }
  [[nodiscard]] record::Events events() const override { return damage_.events(name()); }

 private:
  /// Reads one record of the file; none behind its data.
  [[nodiscard]] std::optional<McapOp> next_outside() {
    if (ended_) return std::nullopt;
    const std::uint64_t start = source_.position();
    const std::uint32_t crc = source_.crc();
    std::string head;
    if (!source_.read(head, kMcapRecordHead)) return end(!head.empty());
    const McapOp op{number_at<std::uint8_t>(head, 0)};
    const auto size = number_at<std::uint64_t>(head, 1);
    if (op == McapOp::kNone) {
      damage_.stopped_at = start;
      ended_ = true;
      return std::nullopt;
    }
    const bool wanted = op == McapOp::kSchema || op == McapOp::kChannel || op == McapOp::kMessage || op == McapOp::kChunk ||
                        op == McapOp::kDataEnd;
    if (!wanted) record_.clear();
    if (!(wanted ? source_.read(record_, size) : source_.skip(size))) return end(true);
    if (op == McapOp::kDataEnd) take_data_end(crc);
    if (op == McapOp::kFooter) ended_ = true;
    return ended_ ? std::nullopt : std::optional(op);
  }
  [[nodiscard]] std::optional<McapOp> end(bool cut_off) {
    damage_.cut_off = cut_off;
    damage_.not_closed = !cut_off;
    ended_ = true;
    return std::nullopt;
  }
  void take_data_end(std::uint32_t crc) {
    const auto stated = McapFields(record_).number<std::uint32_t>();
    if (stated != 0 && stated != crc) damage_.checksums = 1;
    ended_ = true;
  }

  void open_chunk() {
    McapFields fields(record_);
    (void)fields.bytes(2 * sizeof(std::uint64_t));  // times of the first and the last message
    const auto size = fields.number<std::uint64_t>();
    const auto crc = fields.number<std::uint32_t>();
    const std::string_view compression = fields.text();
    const std::string_view packed = fields.bytes(fields.number<std::uint64_t>());
    at_ = 0;
    chunk_.clear();
    bool whole = fields.ok() && size <= BagSource::kMost;
    const auto most = static_cast<std::size_t>(size);
    if (whole && compression.empty()) chunk_ = packed;
    if (whole && compression == "lz4") whole = unpack_lz4(packed, most, chunk_);
    if (whole && compression == "zstd") whole = unpack_zstd(packed, most, chunk_);
    const auto found = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(chunk_.data()), chunk_.size()));  // zlib's, that of the specification
    if (whole && chunk_.size() == size && (crc == 0 || crc == found)) return;
    ++damage_.chunks;
    chunk_.clear();
  }

  [[nodiscard]] bool take_from_chunk(BagMessage& message) {
    McapFields fields(std::string_view(chunk_).substr(at_));
    const McapOp op{fields.number<std::uint8_t>()};
    const std::string_view record = fields.bytes(fields.number<std::uint64_t>());
    if (!fields.ok()) {
      ++damage_.undefined;
      at_ = chunk_.size();
      return false;
    }
    at_ += kMcapRecordHead + record.size();
    return take(op, record, message);
  }

  /// @return true if it is a message
  [[nodiscard]] bool take(McapOp op, std::string_view record, BagMessage& message) {
    McapFields fields(record);
    if (op == McapOp::kSchema) {
      const auto id = fields.number<std::uint16_t>();
      const std::string_view type = fields.text();
      if (fields.ok()) types_.insert_or_assign(id, ros1_type(type));
    } else if (op == McapOp::kChannel) {
      const auto id = fields.number<std::uint16_t>(), schema = fields.number<std::uint16_t>();
      const std::string_view topic = fields.text(), encoding = fields.text();
      const auto type = types_.find(schema);
      if (fields.ok())
        topics_.insert_or_assign(id,
                                 BagTopic{std::string(topic), type == types_.end() ? "" : type->second, encoding_of(encoding)});
    } else if (op == McapOp::kMessage) {
      const auto channel = fields.number<std::uint16_t>();
      (void)fields.number<std::uint32_t>();  // its place in the sequence
      const auto log_ns = fields.number<std::uint64_t>();
      (void)fields.number<std::uint64_t>();  // when it was published
      const auto topic = topics_.find(channel);
      if (fields.ok() && topic != topics_.end()) {
        message = {&topic->second, static_cast<std::int64_t>(log_ns), fields.rest()};
        return true;
      }
      ++damage_.undefined;
    }
    return false;
  }
  static BagEncoding encoding_of(std::string_view name) {
    return name == "cdr" ? BagEncoding::kCdr : name == "ros1" ? BagEncoding::kRos1 : BagEncoding::kOther;
  }

  BagSource source_;
  std::string record_, chunk_;
  std::size_t at_ = 0;  ///< in the chunk
  bool ended_ = false;
  std::map<std::uint16_t, std::string> types_;
  std::map<std::uint16_t, BagTopic> topics_;
  BagDamage damage_;
};

}  // namespace

bool begins_as_mcap(std::string_view head) {
  return head.starts_with(kMcapMagic.substr(0, 5));  // any version
}

std::unique_ptr<BagStream> open_mcap(const std::filesystem::path& file) {
  return std::make_unique<McapStream>(file);
}

}  // namespace coast::io
