#include "hatanaka.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "coast/record/error.hpp"
#include "rinex_lines.hpp"
#include "text.hpp"

namespace coast::io {

namespace {

/// A blank keeps the previous character, '&' is a blank.
void merge(std::string& text, std::string_view difference) {
  if (text.size() < difference.size()) text.resize(difference.size(), ' ');
  for (std::size_t i = 0; i < difference.size(); ++i)
    if (difference[i] != ' ') text[i] = difference[i] == '&' ? ' ' : difference[i];
}

std::optional<std::int64_t> whole(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  // Nine orders of differences of such numbers stay in range.
  constexpr std::int64_t kLargest = 1'000'000'000'000'000;
  if (value > kLargest || value < -kLargest) return std::nullopt;
  return value;
}

}  // namespace

void Hatanaka::Arc::begin(int highest_order, std::int64_t value) {
  order = 0;
  highest = highest_order;
  differences[0] = value;
}

void Hatanaka::Arc::continue_with(std::int64_t difference) {
  if (order < highest) ++order;
  differences[static_cast<std::size_t>(order)] = difference;
  for (int i = order - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    // In a damaged file the sum may overflow: unsigned, this is harmless.
    differences[at] = static_cast<std::int64_t>(static_cast<std::uint64_t>(differences[at]) +
                                                static_cast<std::uint64_t>(differences[at + 1]));
  }
}

bool Hatanaka::begins(std::string_view first_line) {
  return label_of(first_line) == "CRINEX VERS   / TYPE";
}

Hatanaka::Hatanaka(LineReader& lines, std::string_view first_line) : lines_(lines) {
  const std::string version(trimmed(first_line.substr(0, 20)));
  if (version != "1.0" && version != "3.0" && version != "3.1") refuse(fmt::format("CRINEX version {}", version), "1.0 or 3.0");
  compact3_ = version != "1.0";
  std::string_view program;
  if (!raw(program)) refuse("the end of the file", "a header");
}

bool Hatanaka::next(std::string_view& line) {
  if (ready_.empty()) {
    std::string_view read;
    if (in_header_) {
      if (!raw(read)) return false;
      pass_header(read);
    } else if (!decode_epoch()) {
      return false;
    }
  }
  given_ = std::move(ready_.front());
  ready_.pop_front();
  line = given_;
  return true;
}

bool Hatanaka::raw(std::string_view& line) {
  return lines_.next(line);
}

void Hatanaka::refuse(std::string found, std::string expected) const {
  throw InputError({lines_.name(), lines_.line_number(), std::move(found), std::move(expected),
                    "The file is damaged here; get it again, or decompress it with crx2rnx."});
}

void Hatanaka::pass_header(std::string_view line) {
  const std::string_view label = label_of(line);
  if (label == "SYS / # / OBS TYPES" && line[0] != ' ')
    types_[line[0]] = static_cast<std::size_t>(whole(trimmed(line.substr(1, 5))).value_or(0));
  if (label == "# / TYPES OF OBSERV" && !trimmed(line.substr(0, 6)).empty())
    types_[' '] = static_cast<std::size_t>(whole(trimmed(line.substr(0, 6))).value_or(0));
  constexpr std::size_t kMostTypes = 999;
  for (const auto& [system, count] : types_)
    if (count > kMostTypes) refuse(fmt::format("{} types of observations", count), "999 at most");
  if (label == "END OF HEADER") in_header_ = false;
  ready_.emplace_back(line);
}

std::size_t Hatanaka::types_of(const std::string& id) const {
  const auto found = types_.find(compact3_ ? id[0] : ' ');
  if (found == types_.end()) refuse(fmt::format("a satellite {}", excerpt(id)), "one of a system in the header");
  return found->second;
}

bool Hatanaka::decode_epoch() {
  std::string_view line;
  if (!raw(line)) return false;
  const bool whole_line = !line.empty() && line[0] == (compact3_ ? '>' : '&');
  if (whole_line) {
    epoch_ = line;
    if (!compact3_) epoch_[0] = ' ';
    arcs_.clear();
  } else {
    if (epoch_.empty()) refuse("a difference to nothing", "a whole epoch line behind the header");
    merge(epoch_, line);
  }
  const std::size_t flag_at = compact3_ ? 31 : 28;
  const std::size_t first_id = compact3_ ? 41 : 32;
  if (epoch_.size() < flag_at + 4) refuse(fmt::format("an epoch line of {} characters", epoch_.size()), "flag and count");
  const auto count = whole(trimmed(std::string_view(epoch_).substr(flag_at + 1, 3)));
  if (!count || *count < 0) refuse(in_quotes(epoch_.substr(flag_at + 1, 3)), "a number of satellites");
  const auto satellites = static_cast<std::size_t>(*count);
  const char flag = epoch_[flag_at];
  if (flag != '0' && flag != '1' && flag != ' ') {  // header lines, or slips: unchanged
    ready_.push_back(epoch_);
    for (std::size_t i = 0; i < satellites && raw(line); ++i) {
      pass_header(line);
      in_header_ = false;
    }
    return true;
  }
  if (epoch_.size() < first_id + 3 * satellites)
    refuse("an epoch line that ends early", fmt::format("{} satellites", satellites));
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < satellites; ++i) ids.push_back(epoch_.substr(first_id + 3 * i, 3));
  if (!raw(line)) refuse("the end of the file", "the receiver's clock offset, or an empty line");
  give_epoch_line(satellites);
  std::map<std::string, SatelliteArcs> now;
  for (const std::string& id : ids) {
    if (!raw(line)) return true;  // cut off: the reader finds an incomplete epoch
    SatelliteArcs arcs;
    if (const auto before = arcs_.find(id); before != arcs_.end()) arcs = std::move(before->second);
    decode_satellite(id, line, arcs);
    give_numbers(id, arcs);
    now[id] = std::move(arcs);
  }
  arcs_ = std::move(now);
  return true;
}

void Hatanaka::decode_satellite(const std::string& id, std::string_view line, SatelliteArcs& arcs) {
  arcs.numbers.resize(types_of(id));
  std::size_t at = 0;
  for (Arc& arc : arcs.numbers) {
    const std::size_t end = std::min(line.find(' ', at), line.size());
    const std::string_view token = at < line.size() ? line.substr(at, end - at) : std::string_view();
    at = end + 1;
    if (token.empty()) {
      arc.order = -1;
      continue;
    }
    const bool begins = token.size() > 1 && token[1] == '&';
    const auto value = whole(begins ? token.substr(2) : token);
    if (!value) refuse(in_quotes(token), "a whole number");
    if (begins) {
      if (token[0] < '0' || token[0] > '9') refuse(in_quotes(token), "an order of differences from 0 to 9");
      arc.begin(token[0] - '0', *value);
    } else if (arc.order < 0) {
      refuse(fmt::format("the difference {} of {}", in_quotes(token), id), "a number that a series begins with");
    } else {
      arc.continue_with(*value);
    }
  }
  if (at < line.size()) merge(arcs.flags, line.substr(at));
  arcs.flags.resize(2 * arcs.numbers.size(), ' ');
}

void Hatanaka::give_epoch_line(std::size_t satellites) {
  if (compact3_) {
    ready_.push_back(epoch_.substr(0, 35));
    return;
  }
  // RINEX 2 has twelve satellites per line.
  constexpr std::size_t kPerLine = 12;
  constexpr std::size_t kFirst = 32;
  ready_.push_back(epoch_.substr(0, kFirst + 3 * std::min(kPerLine, satellites)));
  for (std::size_t i = kPerLine; i < satellites; i += kPerLine)
    ready_.push_back(std::string(kFirst, ' ') + epoch_.substr(kFirst + 3 * i, 3 * std::min(kPerLine, satellites - i)));
}

void Hatanaka::give_numbers(const std::string& id, const SatelliteArcs& arcs) {
  constexpr std::size_t kPerLine = 5;
  std::string line = compact3_ ? id : "";
  for (std::size_t i = 0; i < arcs.numbers.size(); ++i) {
    if (!compact3_ && i > 0 && i % kPerLine == 0) ready_.push_back(std::exchange(line, ""));
    const Arc& arc = arcs.numbers[i];
    if (arc.order < 0)
      line += std::string(16, ' ');
    else
      line += fmt::format("{:14.3f}{}{}", static_cast<double>(arc.differences[0]) / 1000.0, arcs.flags[2 * i],
                          arcs.flags[2 * i + 1]);
  }
  ready_.push_back(std::move(line));
}

}  // namespace coast::io
