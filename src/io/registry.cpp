#include "coast/io/registry.hpp"

#include "formats/formats.hpp"
#include "text.hpp"

namespace coast::io {

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      novatel_format(),    sbf_format(), rosbag_format(),    mcap_format(), rosbag2_format(),      dataflash_format(),
      rtcm3_format(),      ubx_format(), vectornav_format(), ulog_format(), waypoint_imr_format(), sbet_format(),
      rtklib_pos_format(), nav_format(), kf_gins_format(),   csv_format(),  binary_format(),
  };
  return table;
}

std::vector<std::vector<double>> numeric_rows(const FileHead& head, std::size_t most) {
  std::vector<std::vector<double>> rows;
  std::vector<std::string_view> fields;
  std::string_view text = head.text;
  while (rows.size() < most) {
    const std::size_t stop = text.find('\n');
    if (stop == std::string_view::npos) break;  // the last line of the head may be cut
    const std::string_view line = trimmed(text.substr(0, stop));
    text.remove_prefix(stop + 1);
    if (line.empty() || line.front() == '#' || line.front() == '%') continue;
    split(line, ' ', fields);
    std::vector<double> row;
    for (const std::string_view field : fields) {
      const auto value = parse_number(field);
      if (!value) return {};
      row.push_back(*value);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace coast::io
