// MCAP with messages of ROS 2 (mcap.dev, "MCAP Format Specification"): chunks of messages in the order of time, each with its
// index, and the summary with statistics and the index of the chunks.

#include <zlib.h>

#include <algorithm>
#include <map>

#include "../bags/bag_compression.hpp"
#include "../bags/mcap_records.hpp"
#include "../binary.hpp"
#include "../posix_time.hpp"
#include "coast/geo/units.hpp"
#include "ros_schemas.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

std::uint32_t mcap_crc(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Fields of a record one after another.
class McapRecord {
 public:
  template <class T>
  McapRecord& number(T value) {
    append_number(bytes_, value);
    return *this;
  }
  McapRecord& text(std::string_view value) {
    append_number(bytes_, static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  McapRecord& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& fields() const { return bytes_; }
  [[nodiscard]] std::string record(McapOp op) const {
    std::string whole;
    append_number(whole, static_cast<std::uint8_t>(op));
    append_number(whole, static_cast<std::uint64_t>(bytes_.size()));
    return whole + bytes_;
  }

 private:
  std::string bytes_;
};

/// Numbers in CDR, little endian: each at a multiple of its size behind the encapsulation.
class CdrMessage {
 public:
  template <class T>
  CdrMessage& number(T value) {
    bytes_.resize(kEncapsulation + (bytes_.size() - kEncapsulation + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    append_number(bytes_, value);
    return *this;
  }
  CdrMessage& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value;
    bytes_ += '\0';
    return *this;
  }
  template <class Numbers>
  CdrMessage& numbers(const Numbers& values) {
    for (const double value : values) number(value);
    return *this;
  }
  CdrMessage& header(std::int64_t posix_ns, std::string_view frame) {
    constexpr std::int64_t kNano = 1'000'000'000;
    number(static_cast<std::int32_t>(posix_ns / kNano)).number(static_cast<std::uint32_t>(posix_ns % kNano));
    return text(frame);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;
  std::string bytes_ = std::string("\0\1\0\0", kEncapsulation);
};

/// A topic with its messages' definition.
struct McapChannel {
  std::string_view topic, type, definition;
};

/// Chunks and the summary of one file.
class McapFile {
 public:
  McapFile(const std::filesystem::path& path, std::vector<McapChannel> channels)
      : file_(path), channels_(std::move(channels)), counts_(channels_.size()) {
    put(kMcapMagic);
    put(McapRecord().text("ros2").text("coast").record(McapOp::kHeader));
    chunk_ = definitions();
  }

  /// @param log_ns  not before the message before it
  void message(std::size_t channel, std::int64_t log_ns, std::string_view bytes) {
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    const auto ns = static_cast<std::uint64_t>(log_ns);
    if (index_.empty()) first_in_chunk_ = ns;
    last_ = ns;
    if (messages() == 0) first_ = ns;
    index_[channel].emplace_back(ns, chunk_.size());
    chunk_ += McapRecord()
                  .number(static_cast<std::uint16_t>(channel))
                  .number(static_cast<std::uint32_t>(counts_[channel]++))
                  .number(ns)
                  .number(ns)
                  .raw(bytes)
                  .record(McapOp::kMessage);
    if (chunk_.size() >= kChunk) end_chunk();
  }

  void close() {
    if (!index_.empty()) end_chunk();
    put(McapRecord().number(crc_).record(McapOp::kDataEnd));
    put_summary();
    put(kMcapMagic);
    file_.commit();
  }

 private:
  struct Chunk {
    std::uint64_t first = 0, last = 0, at = 0, size = 0;
    std::map<std::size_t, std::uint64_t> indexes;  ///< their places by channel
    std::uint64_t index_size = 0, packed = 0, unpacked = 0;
  };

  void put(std::string_view bytes) {
    file_.write(bytes);
    crc_ = mcap_crc(bytes, crc_);
    at_ += bytes.size();
  }
  static constexpr std::string_view kCompression = "lz4";
  [[nodiscard]] std::uint64_t messages() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts_) sum += count;
    return sum;
  }

  /// Number 0 is no schema.
  [[nodiscard]] std::string schemas() const {
    std::string records;
    for (std::size_t i = 0; i < channels_.size(); ++i)
      records += McapRecord()
                     .number(static_cast<std::uint16_t>(i + 1))
                     .text(channels_[i].type)
                     .text("ros2msg")
                     .text(std::string(channels_[i].definition) + std::string(kRosHeaderSchema))
                     .record(McapOp::kSchema);
    return records;
  }
  [[nodiscard]] std::string channels() const {
    std::string records;
    for (std::size_t i = 0; i < channels_.size(); ++i)
      records += McapRecord()
                     .number(static_cast<std::uint16_t>(i))
                     .number(static_cast<std::uint16_t>(i + 1))
                     .text(channels_[i].topic)
                     .text("cdr")
                     .number(std::uint32_t{0})  // no metadata
                     .record(McapOp::kChannel);
    return records;
  }
  [[nodiscard]] std::string definitions() const { return schemas() + channels(); }

  void end_chunk() {
    Chunk chunk;
    chunk.first = first_in_chunk_;
    chunk.last = last_;
    chunk.at = at_;
    const std::string packed = pack_lz4(chunk_);
    chunk.packed = packed.size();
    chunk.unpacked = chunk_.size();
    put(McapRecord()
            .number(chunk.first)
            .number(chunk.last)
            .number(chunk.unpacked)
            .number(mcap_crc(chunk_))
            .text(kCompression)
            .number(chunk.packed)
            .raw(packed)
            .record(McapOp::kChunk));
    chunk.size = at_ - chunk.at;
    for (const auto& [channel, places] : index_) {
      McapRecord entries;
      for (const auto& [ns, place] : places) entries.number(ns).number(place);
      chunk.indexes[channel] = at_;
      put(McapRecord().number(static_cast<std::uint16_t>(channel)).text(entries.fields()).record(McapOp::kMessageIndex));
    }
    chunk.index_size = at_ - chunk.at - chunk.size;
    chunks_.push_back(chunk);
    chunk_.clear();
    index_.clear();
  }

  [[nodiscard]] std::string statistics() const {
    McapRecord counts;
    for (std::size_t i = 0; i < counts_.size(); ++i) counts.number(static_cast<std::uint16_t>(i)).number(counts_[i]);
    return McapRecord()
        .number(messages())
        .number(static_cast<std::uint16_t>(channels_.size()))
        .number(static_cast<std::uint32_t>(channels_.size()))
        .number(std::uint32_t{0})  // attachments
        .number(std::uint32_t{0})  // metadata
        .number(static_cast<std::uint32_t>(chunks_.size()))
        .number(first_)
        .number(last_)
        .text(counts.fields())
        .record(McapOp::kStatistics);
  }
  [[nodiscard]] std::string chunk_indexes() const {
    std::string records;
    for (const Chunk& chunk : chunks_) {
      McapRecord places;
      for (const auto& [channel, place] : chunk.indexes) places.number(static_cast<std::uint16_t>(channel)).number(place);
      records += McapRecord()
                     .number(chunk.first)
                     .number(chunk.last)
                     .number(chunk.at)
                     .number(chunk.size)
                     .text(places.fields())
                     .number(chunk.index_size)
                     .text(kCompression)
                     .number(chunk.packed)
                     .number(chunk.unpacked)
                     .record(McapOp::kChunkIndex);
    }
    return records;
  }

  void put_summary() {
    const std::uint64_t start = at_;
    std::string summary, offsets;
    const auto group = [&](McapOp op, const std::string& records) {
      if (records.empty()) return;
      offsets += McapRecord()
                     .number(static_cast<std::uint8_t>(op))
                     .number(start + summary.size())
                     .number(static_cast<std::uint64_t>(records.size()))
                     .record(McapOp::kSummaryOffset);
      summary += records;
    };
    group(McapOp::kSchema, schemas());
    group(McapOp::kChannel, channels());
    group(McapOp::kStatistics, statistics());
    group(McapOp::kChunkIndex, chunk_indexes());
    McapRecord footer;
    footer.number(start).number(start + summary.size());
    // Its checksum covers the summary, and of the footer itself what comes before the checksum.
    const std::string without_crc = McapRecord().raw(footer.fields()).number(std::uint32_t{0}).record(McapOp::kFooter);
    const std::string covered = summary + offsets + without_crc.substr(0, without_crc.size() - sizeof(std::uint32_t));
    put(summary);
    put(offsets);
    put(footer.number(mcap_crc(covered)).record(McapOp::kFooter));
  }

  AtomicFile file_;
  std::vector<McapChannel> channels_;
  std::vector<std::uint64_t> counts_;  ///< messages by channel
  std::uint64_t at_ = 0;
  std::uint32_t crc_ = 0;
  std::string chunk_;
  std::map<std::size_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;  ///< times and places in the chunk
  std::uint64_t first_ = 0, last_ = 0, first_in_chunk_ = 0;
  std::vector<Chunk> chunks_;
};

constexpr std::array<double, 9> kNotKnown{};  // a covariance
constexpr std::array<double, 9> kNotThere{-1.0};

std::string ros_imu_message(const record::ImuSample& s, std::int64_t ns) {
  constexpr std::array<double, 4> kNoTurn{0.0, 0.0, 0.0, 1.0};
  return CdrMessage()
      .header(ns, "imu")
      .numbers(kNoTurn)
      .numbers(kNotThere)
      .numbers(Eigen::Vector3d(s.dtheta / s.dt))
      .numbers(kNotKnown)
      .numbers(Eigen::Vector3d(s.dv / s.dt))
      .numbers(kNotKnown)
      .bytes();
}

/// NavSatStatus has one number for all that needs stations on the ground.
std::int8_t ros_status(record::FixQuality quality) {
  using enum record::FixQuality;
  return quality == kSbas ? 1 : quality == kDgps || quality == kFloat || quality == kFixed ? 2 : 0;
}

std::string ros_fix_message(const record::GnssFix& fix, std::int64_t ns) {
  constexpr std::uint16_t kGps = 1;
  constexpr std::uint8_t kKnown = 3;
  const geo::Geodetic p = geo::geodetic_from_ecef(fix.r_ea_e);
  Eigen::Matrix3d C_ned_enu;
  C_ned_enu << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  const Eigen::Matrix3d cov_enu = C_ned_enu * fix.position_cov_n * C_ned_enu.transpose();
  return CdrMessage()
      .header(ns, "gnss")
      .number(ros_status(fix.quality))
      .number(kGps)
      .number(p.latitude / geo::kDegree)
      .number(p.longitude / geo::kDegree)
      .number(p.height)
      .numbers(cov_enu.reshaped())  // symmetric: by columns is by rows
      .number(kKnown)
      .bytes();
}

}  // namespace

void write_mcap(const std::filesystem::path& path, const record::ImuRecording* imu, const record::GnssRecording* gnss) {
  const bool with_imu = imu != nullptr, with_gnss = gnss != nullptr;
  std::vector<McapChannel> channels;
  if (with_imu) channels.push_back({"/imu", "sensor_msgs/msg/Imu", kRosImuSchema});
  if (with_gnss) channels.push_back({"/fix", "sensor_msgs/msg/NavSatFix", kRosFixSchema});
  McapFile file(path, std::move(channels));
  const std::size_t gnss_channel = with_imu ? 1 : 0;
  std::size_t i = 0, k = 0;
  const std::size_t samples = with_imu ? imu->samples.size() : 0, fixes = with_gnss ? gnss->fixes.size() : 0;
  while (i < samples || k < fixes) {
    if (k == fixes || (i < samples && imu->samples[i].t <= gnss->fixes[k].t)) {
      const std::int64_t ns = posix_nanoseconds(imu->samples[i].t);
      file.message(0, ns, ros_imu_message(imu->samples[i], ns));
      ++i;
    } else {
      const std::int64_t ns = posix_nanoseconds(gnss->fixes[k].t);
      file.message(gnss_channel, ns, ros_fix_message(gnss->fixes[k], ns));
      ++k;
    }
  }
  file.close();
}

}  // namespace coast::io
