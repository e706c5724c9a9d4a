#include "bag_source.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <optional>

#include "bag_stream.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

bool BagSource::append(std::string& to, std::size_t size) {
  const std::size_t before = to.size();
  to.resize(before + size);
  const std::size_t n = source_.read(to.data() + before, size);
  to.resize(before + n);
  position_ += n;
  crc_ = static_cast<std::uint32_t>(crc32_z(crc_, reinterpret_cast<const Bytef*>(to.data() + before), n));
  return n == size;
}

bool BagSource::read(std::string& to, std::uint64_t size) {
  constexpr std::size_t kStep = std::size_t{1} << 20;  // a damaged length must not reserve what the file does not have
  if (size > kMost && source_.expected_size() >= position_ + size)
    throw InputError({name(), 0, fmt::format("a chunk or message of {} MiB at byte {}", size >> 20, position_),
                      fmt::format("at most {} MiB", kMost >> 20), "Record with smaller chunks."});
  to.clear();
  for (std::uint64_t left = std::min(size, kMost); left > 0;) {
    const std::size_t step = static_cast<std::size_t>(std::min<std::uint64_t>(left, kStep));
    if (!append(to, step)) return false;
    left -= step;
  }
  return size <= kMost;
}

bool BagSource::skip(std::uint64_t size) {
  constexpr std::size_t kStep = std::size_t{1} << 16;
  std::string part;
  while (size > 0) {
    const std::size_t step = static_cast<std::size_t>(std::min<std::uint64_t>(size, kStep));
    part.clear();
    if (!append(part, step)) return false;
    size -= step;
  }
  return true;
}

record::Events BagDamage::events(const std::string& file) const {
  record::Events events;
  const auto warn = [&](long number, const char* kind, std::string text) {
    if (number > 0)
      events.push_back({record::Event::Severity::kWarning, kind, fmt::format("{}: {}", file, text), std::nullopt, number});
  };
  warn(chunks, "bag_chunk_damaged", fmt::format("{} damaged chunk{} left out", chunks, chunks == 1 ? "" : "s"));
  warn(undefined, "bag_undefined",
       fmt::format("{} messages without a definition, or records that are none, left out", undefined));
  warn(checksums, "bag_checksum", "the checksum of the file is wrong");
  warn(cut_off ? 1 : 0, "bag_cut_off", "the end of the file cuts a record off; what is before it was read");
  warn(not_closed ? 1 : 0, "bag_not_closed", "the recorder did not end the file; what is there was read");
  warn(stopped_at > 0 ? 1 : 0, "bag_garbage",
       fmt::format("no record begins at byte {}; what is behind it was not read", stopped_at));
  return events;
}

std::string ros1_type(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  const std::size_t at = type.find(kMiddle);
  if (at == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, at)) + "/" + std::string(type.substr(at + kMiddle.size()));
}

}  // namespace coast::io
