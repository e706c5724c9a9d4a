#pragma once
// Files that a test writes for a reader.

#include <zlib.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/time_marks.hpp"
#include "coast/io/yaml.hpp"
#include "support/support.hpp"

namespace coast::test {

/// A folder with files, gone at the end of the test.
class Files {
 public:
  std::filesystem::path put(const std::string& name, const std::string& content) const {
    auto path = folder_.path() / name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  std::filesystem::path put_gzip(const std::string& name, const std::string& content) const {
    auto path = folder_.path() / name;
    gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
    gzclose(file);
    return path;
  }
  std::string get(const std::string& name) const {
    std::ifstream file(folder_.path() / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  /// Reads as a run file would have it: `keys` is the map under `imu:`, without the file.
  record::ImuRecording imu(const std::string& name, const std::string& keys = "",
                           std::optional<geo::GpsTime> near = std::nullopt) const {
    return io::read_imu(io::ImuFileOptions::from(node("imu", name, keys)), near);
  }
  record::GnssRecording gnss(const std::string& name, const std::string& keys = "",
                             std::optional<geo::GpsTime> near = std::nullopt) const {
    return io::read_gnss(io::GnssFileOptions::from(node("gnss", name, keys)), near);
  }
  record::Trajectory reference(const std::string& name, const std::string& keys = "",
                               std::optional<geo::GpsTime> near = std::nullopt) const {
    return io::read_reference(io::ReferenceFileOptions::from(node("reference", name, keys)), near);
  }
  record::TimeMarkRecording events(const std::string& name, const std::string& keys = "",
                                   std::optional<geo::GpsTime> near = std::nullopt) const {
    return io::read_time_marks(io::TimeMarkFileOptions::from(node("events", name, keys)), near);
  }

 private:
  config::Node node(const std::string& section, const std::string& name, const std::string& keys) const {
    const std::string text = section + ": {file: " + name + (keys.empty() ? "" : ", " + keys) + "}\n";
    const config::Node root = io::parse_yaml(text, (folder_.path() / "run.yaml").string());
    return root.at(section);
  }
  TemporaryDirectory folder_;
};

/// The lines that a script of this folder prints of a file or for a folder; nothing if it cannot run.
inline std::vector<std::string> lines_of_script(const std::string& script, const std::filesystem::path& argument) {
  const std::string command =
      "/usr/bin/python3 '" COAST_SOURCE_DIR "/tests/io/" + script + "' '" + argument.string() + "' 2>/dev/null";
  std::vector<std::string> lines;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return lines;
  std::array<char, 1024> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) lines.emplace_back(line.data());
  pclose(pipe);
  return lines;
}

/// Number of events of a kind, counts summed.
inline long count_of(const record::Events& events, const std::string& kind) {
  long count = 0;
  for (const auto& event : events)
    if (event.kind == kind) count += event.count;
  return count;
}

/// The message of the InputError that a call throws; empty if it throws none.
template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace coast::test
