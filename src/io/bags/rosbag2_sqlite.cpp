// Bags of ROS 2 in SQLite (rosbag2_storage_sqlite3): a table of topics and one of messages.

#include <fmt/format.h>
#include <sqlite3.h>

#include <map>

#include "bag_compression.hpp"
#include "bag_source.hpp"
#include "bag_stream.hpp"
#include "coast/record/error.hpp"
#include "ros_message.hpp"

namespace coast::io {

namespace {

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

class Rosbag2Stream final : public BagStream {
 public:
  explicit Rosbag2Stream(const std::filesystem::path& file) : name_(file.string()) {
    if (!begins_as_sqlite(read_head(file, kSqliteMagic.size()))) refuse("no \"SQLite format 3\" at its beginning");
    open(file);
    require_table("topics");
    require_table("messages");
    rows_ = prepare(query());
  }

  bool next(BagMessage& message) override {
    while (step()) {
      constexpr int kTopic = 0, kTime = 1, kData = 2;
      const auto topic = topics_.find(sqlite3_column_int64(rows_.get(), kTopic));
      if (topic == topics_.end()) {
        ++damage_.undefined;
        continue;
      }
      const auto* data = static_cast<const char*>(sqlite3_column_blob(rows_.get(), kData));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(rows_.get(), kData));
      message = {&topic->second, sqlite3_column_int64(rows_.get(), kTime), data == nullptr ? "" : std::string_view(data, size)};
      unpack(message);
      return true;
    }
    return false;
  }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] record::Events events() const override {
    record::Events events = damage_.events(name_);
    if (!broken_.empty())
      events.push_back({record::Event::Severity::kWarning, "bag_cut_off",
                        fmt::format("{}: damaged behind {} messages, which were read ({})", name_, messages_, broken_),
                        std::nullopt, 1});
    return events;
  }

 private:
  using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

  [[noreturn]] void refuse(std::string found) const {
    throw InputError({name_, 0, std::move(found), "a bag of ROS 2 with tables topics and messages", "Is this the right file?"});
  }

  void open(const std::filesystem::path& file) {
    if (file.extension() == ".gz")
      throw InputError({name_, 0, "a gzip-compressed database", "one that is not", "Unpack it: `gunzip`."});
    sqlite3* base = nullptr;
    const int status = sqlite3_open_v2(file.c_str(), &base, SQLITE_OPEN_READONLY, nullptr);
    base_.reset(base);
    if (status != SQLITE_OK) refuse(fmt::format("cannot be opened by SQLite: {}", sqlite3_errstr(status)));
    // A file of others: nothing that its schema defines is to run, and no message is to fill the memory. With a schema that
    // could be written, a file that is shorter than its header says is read all the same.
    sqlite3_db_config(base, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    sqlite3_db_config(base, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(base, SQLITE_LIMIT_LENGTH, static_cast<int>(BagSource::kMost));
  }

  [[nodiscard]] Statement prepare(const std::string& sql) const {
    sqlite3_stmt* statement = nullptr;
    const int status = sqlite3_prepare_v2(base_.get(), sql.c_str(), -1, &statement, nullptr);
    Statement owned(statement, &sqlite3_finalize);
    if (status != SQLITE_OK) refuse(fmt::format("a database that SQLite cannot read: {}", sqlite3_errmsg(base_.get())));
    return owned;
  }

  void require_table(const char* table) const {
    const Statement found = prepare(
        fmt::format("SELECT 1 FROM sqlite_master WHERE name = '{}' AND type = 'table' AND sql NOT LIKE '%VIRTUAL%'", table));
    const int status = sqlite3_step(found.get());
    if (status == SQLITE_DONE) refuse(fmt::format("an SQLite database without the table `{}`", table));
    if (status != SQLITE_ROW) refuse(fmt::format("a database that SQLite cannot read: {}", sqlite3_errmsg(base_.get())));
  }

  /// Reads the topics; of the messages, the bytes of those that are decoded. What others have may be large.
  [[nodiscard]] std::string query() {
    constexpr int kId = 0, kName = 1, kType = 2, kFormat = 3;
    std::string decoded = "-1";
    const Statement topics = prepare("SELECT id, name, type, serialization_format FROM topics");
    const auto text = [&](int column) {
      const auto* value = reinterpret_cast<const char*>(sqlite3_column_text(topics.get(), column));
      return std::string(value == nullptr ? "" : value);
    };
    while (sqlite3_step(topics.get()) == SQLITE_ROW) {
      const std::int64_t id = sqlite3_column_int64(topics.get(), kId);
      const BagTopic topic{text(kName), ros1_type(text(kType)),
                           text(kFormat) == "cdr" ? BagEncoding::kCdr : BagEncoding::kOther};
      if (is_decoded(topic)) decoded += fmt::format(",{}", id);
      topics_.insert_or_assign(id, topic);
    }
    return fmt::format("SELECT topic_id, timestamp, CASE WHEN topic_id IN ({}) THEN data END FROM messages", decoded);
  }

  [[nodiscard]] bool step() {
    const int status = sqlite3_step(rows_.get());
    if (status == SQLITE_ROW) {
      ++messages_;
      return true;
    }
    if (status != SQLITE_DONE) {
      broken_ = sqlite3_errmsg(base_.get());
      if (messages_ == 0) refuse(fmt::format("a database that SQLite cannot read: {}", broken_));
    }
    return false;
  }

  /// `ros2 bag record --compression-mode message` compresses each; what CDR begins with differs.
  void unpack(BagMessage& message) {
    constexpr std::string_view kZstandard = "\x28\xb5\x2f\xfd";
    if (!message.bytes.starts_with(kZstandard)) return;
    if (!unpack_zstd(message.bytes, BagSource::kMost, unpacked_)) unpacked_.clear();
    message.bytes = unpacked_;
  }

  std::string name_, broken_, unpacked_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> base_{nullptr, &sqlite3_close};
  Statement rows_{nullptr, &sqlite3_finalize};
  std::map<std::int64_t, BagTopic> topics_;
  long messages_ = 0;
  BagDamage damage_;
};

}  // namespace

bool begins_as_sqlite(std::string_view head) {
  return head.starts_with(kSqliteMagic);
}

std::unique_ptr<BagStream> open_rosbag2(const std::filesystem::path& file) {
  return std::make_unique<Rosbag2Stream>(file);
}

}  // namespace coast::io
