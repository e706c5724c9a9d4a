#include "file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "bags/bag_stream.hpp"
#include "coast/io/input.hpp"
#include "coast/record/error.hpp"
#include "novatel/novatel_log.hpp"
#include "rtcm/rtcm_messages.hpp"
#include "sbf/sbf_blocks.hpp"
#include "text.hpp"

namespace coast::io {

namespace {

using Content = FileKind::Content;

bool is_upper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}

/// "$GPGGA,", "$PUBX,": an address of capitals and digits.
bool is_nmea(std::string_view line) {
  if (line.size() < 7 || line[0] != '$' || !is_upper(line[1])) return false;
  const std::size_t comma = line.find(',');
  return comma >= 5 && comma <= 6 &&
         std::ranges::all_of(line.substr(1, comma - 1), [](char c) { return is_upper(c) || (c >= '0' && c <= '9'); });
}

bool is_sp3(std::string_view line) {
  return line.size() > 3 && line[0] == '#' && line[1] >= 'a' && line[1] <= 'd' && (line[2] == 'P' || line[2] == 'V') &&
         line[3] >= '0' && line[3] <= '9';
}

std::optional<FileKind> binary_kind(std::string_view head) {
  if (head.starts_with("\x1f\x8b")) return FileKind{"a gzip file inside a gzip file", "Unpack it once."};
  if (head.starts_with("PK\x03\x04")) return FileKind{"a zip archive", "Unpack it and name the file inside."};
  if (head.starts_with("\x28\xb5\x2f\xfd")) return FileKind{"a Zstandard-compressed file", "Unpack it: `zstd -d`."};
  if (begins_as_rosbag1(head) || begins_as_mcap(head) || begins_as_sqlite(head))
    return FileKind{"a bag of ROS", "It belongs under `gnss: {file: ..}` or `imu: {file: ..}`."};
  if (head.size() > 262 && head.substr(257, 5) == "ustar")
    return FileKind{"a tar archive", "Unpack it and name the file inside."};
  if (begins_as_rtcm3(head))
    return FileKind{"an RTCM 3 file of a base station", "It belongs under `gnss: {ppk: {rover: .., base: .., nav: [..]}}`."};
  constexpr std::string_view kOfReceiver =
      "It belongs under `gnss: {file: ..}`, `imu: {file: ..}`, or `gnss: {ppk: {rover: .., base: .., nav: [..]}}`.";
  if (begins_as_sbf(head)) return FileKind{"an SBF file of a Septentrio receiver", std::string(kOfReceiver)};
  if (begins_as_novatel(head)) return FileKind{"a log of a NovAtel receiver", std::string(kOfReceiver)};
  if (head.find("\xb5\x62") != std::string_view::npos)  // NMEA sentences may be between its messages
    return FileKind{"a UBX file of a u-blox receiver", std::string(kOfReceiver)};
  return std::nullopt;
}

std::optional<FileKind> line_kind(std::string_view line) {
  if (is_nmea(line)) return FileKind{"an NMEA file of positions", "Convert it to a table of positions, or to .pos of RTKLIB."};
  const std::string_view label = line.size() > 60 ? trimmed(line.substr(60)) : std::string_view();
  if (label == "RINEX VERSION / TYPE" || label == "CRINEX VERS   / TYPE")
    return FileKind{"a RINEX file", "Observations become positions under `gnss: {ppk: {rover: .., base: .., nav: [..]}}`.",
                    Content::kRinex};
  if (is_sp3(line))
    return FileKind{"an SP3 file of precise orbits", "It belongs under `sp3`, beside `nav`, where RINEX becomes positions.",
                    Content::kOrbits};
  if (line.starts_with("% program") || line.starts_with("%  GPST") || line.starts_with("%  UTC"))
    return FileKind{"a .pos file of RTKLIB", "It belongs under `gnss: {file: .., format: rtklib-pos}`.", Content::kPositions};
  // A header; configurations name the column too, but with YAML characters on the line.
  if (line.find("gyro_x_radps") != std::string_view::npos && line.find_first_of(":[]{}-") == std::string_view::npos)
    return FileKind{"a table of an IMU", "It belongs under `imu: {file: ..}` of a run.yaml.", Content::kImu};
  if (line.starts_with("schema: coast."))
    return FileKind{fmt::format("a configuration file (`{}`)", excerpt(line)), "", Content::kYaml};
  if (line.starts_with('<')) return FileKind{"an HTML or XML file", "Was it downloaded whole?"};
  return std::nullopt;
}

}  // namespace

std::optional<FileKind> file_kind(std::string_view head) {
  if (auto kind = binary_kind(head)) return kind;
  constexpr int kLines = 20;  // other text may come first, for example comments
  std::size_t at = 0;
  for (int i = 0; i < kLines && at < head.size(); ++i) {
    const std::size_t stop = std::min(head.find('\n', at), head.size());
    if (auto kind = line_kind(head.substr(at, stop - at))) return kind;
    at = stop + 1;
  }
  return std::nullopt;
}

void refuse_other_kind(const std::filesystem::path& file, FileKind::Content own, std::string_view expected) {
  std::optional<FileKind> kind;
  try {
    kind = file_kind(read_head(file, 4096));
  } catch (const InputError&) {
    return;  // reported by the original error
  }
  if (kind && (kind->content == Content::kOther || kind->content != own))
    throw InputError({file.string(), 0, "this is " + kind->name, std::string(expected), kind->what_to_do});
}

}  // namespace coast::io
