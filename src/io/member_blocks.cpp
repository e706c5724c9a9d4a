#include "coast/io/member_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/io/table.hpp"
#include "coast/io/writers.hpp"
#include "week_time.hpp"

namespace coast::io {

namespace {

using record::MemberBlocks;

constexpr std::array kValues{"gyro_x_radps", "gyro_y_radps", "gyro_z_radps", "accel_x_mps2", "accel_y_mps2", "accel_z_mps2"};

/// Rows of the table, one block after another.
class BlockReader {
 public:
  BlockReader(TableReader& table, MemberBlocks& members)
      : table_(table),
        members_(members),
        week_(table.number_slot("gps_week", "the week")),
        from_(table.number_slot("from_sow_s", "the beginning")),
        span_(table.number_slot("span_s", "the length")),
        member_(table.text_slot("member", "the name")) {
    for (std::size_t i = 0; i < kValues.size(); ++i) values_[i] = table.number_slot(kValues[i], "a mean");
  }

  void take_row() {
    const geo::GpsTime from = week_time(table_, week_, from_);
    const double span = table_.number(span_);
    if (!table_.finite()) throw table_.error("a value that is not a number", "numbers; a member without means has no row");
    if (!(span >= 1e-3 && span <= 1e5)) throw table_.error(fmt::format("a span of {} s", span), "1e-3 to 1e5 s");
    if (members_.blocks.empty() || members_.blocks.back().from != from) begin_block(from, span);
    MemberBlocks::Block& block = members_.blocks.back();
    if (std::abs(block.to - from - span) > kSame) throw table_.error("another span in one block", "the same");
    std::optional<MemberBlocks::Means>& means = block.means[member_index()];
    if (means) throw table_.error("a member twice in one block", "each once");
    means.emplace();
    for (std::size_t i = 0; i < values_.size(); ++i)
      (i < 3 ? means->gyro : means->accel)(static_cast<Eigen::Index>(i % 3)) = table_.number(values_[i]);
  }

 private:
  static constexpr double kSame = 1e-6;  // s

  void begin_block(geo::GpsTime from, double span) {
    if (!members_.blocks.empty() && members_.blocks.back().to - from > kSame)
      throw table_.error("a block that begins before the one before has ended", "blocks in order, none over another");
    members_.blocks.push_back({from, from + span, {}});
    members_.blocks.back().means.resize(members_.names.size());
  }
  [[nodiscard]] std::size_t member_index() const {
    const auto found = std::ranges::find(members_.names, table_.text(member_));
    if (found == members_.names.end())
      throw table_.error(fmt::format("member {}", table_.text(member_)),
                         fmt::format("one that the error model has shares of: {}", fmt::join(members_.names, ", ")));
    return static_cast<std::size_t>(found - members_.names.begin());
  }

  TableReader& table_;
  MemberBlocks& members_;
  std::size_t week_, from_, span_, member_;
  std::array<std::size_t, kValues.size()> values_{};
};

}  // namespace

MemberBlocks read_member_blocks(const std::filesystem::path& file, const std::vector<std::string>& names) {
  TableReader table(file);
  MemberBlocks members;
  members.source = table.name();
  members.names = names;
  BlockReader reader(table, members);
  while (table.next()) reader.take_row();
  if (members.blocks.empty()) throw table.error("no block", "means of the members");
  return members;
}

void write_member_blocks(const std::filesystem::path& file, const MemberBlocks& members) {
  std::string text = fmt::format("gps_week,from_sow_s,span_s,member,{}\n", fmt::join(kValues, ","));
  for (const MemberBlocks::Block& block : members.blocks)
    for (std::size_t k = 0; k < block.means.size(); ++k) {
      if (!block.means[k]) continue;
      const MemberBlocks::Means& means = *block.means[k];
      text += fmt::format("{},{:.6f},{:.6f},{}", block.from.week(), block.from.sow(), block.to - block.from, members.names[k]);
      for (const double value : means.gyro) text += fmt::format(",{:.13f}", value);
      for (const double value : means.accel) text += fmt::format(",{:.12f}", value);
      text += '\n';
    }
  write_text(file, text);
}

}  // namespace coast::io
