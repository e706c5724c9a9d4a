#include "coast/io/results_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "coast/record/error.hpp"

namespace coast::io {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".coast-results";
constexpr std::string_view kBegun = "begun ";  // followed by the name of the file that completes a set of results
constexpr std::string_view kTitle = "# bytes and names of what coast wrote here; it replaces no other file of this folder\n";

// Lines of the mark: "bytes name", and "begun name". Several lengths of one file are kept, so that lines are only
// ever appended.
using Lines = std::set<std::string>;

std::string line_of(const std::string& name, std::uintmax_t bytes) {
  return fmt::format("{} {}", bytes, name);
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::optional<Lines> mark_of(const fs::path& folder) {
  std::ifstream in(folder / kMark);
  if (!in) return std::nullopt;
  Lines lines;
  for (std::string line; std::getline(in, line);) lines.insert(line);
  return lines;
}

void append(const fs::path& mark, const std::string& text, int flags) {
  const int descriptor = ::open(mark.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | flags, 0666);
  const auto size = static_cast<ssize_t>(text.size());
  // In one call: two jobs may write into one folder.
  const bool whole = descriptor >= 0 && ::write(descriptor, text.data(), text.size()) == size;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!whole) throw OutputError(mark.string(), std::strerror(error));
}

/// A path independent of its spelling; a link at its end is not followed.
fs::path place_of(const fs::path& file) {
  std::error_code ignored;
  const fs::path whole = fs::absolute(file, ignored);
  return fs::weakly_canonical(whole.parent_path(), ignored) / whole.filename();
}

// Inputs are recorded per process, wherever they are opened; they are only used for the refusal.
struct ReadFiles {
  std::mutex mutex;
  std::set<fs::path> places;
};
ReadFiles& read_files() {
  static ReadFiles files;
  return files;
}

bool was_read(const fs::path& file) {
  ReadFiles& files = read_files();
  const std::scoped_lock lock(files.mutex);
  return files.places.contains(place_of(file));
}

/// Files that a version without marks wrote next to one of its files; names ending with '*' are prefixes.
struct EarlierResults {
  std::string_view file;
  std::string_view contains;
  std::vector<std::string_view> names;
};

const std::vector<EarlierResults>& earlier_results() {
  static const std::vector<EarlierResults> table = {
      {"report.json",
       "coast.page/",
       {"report.*", "summary.json", "trajectory.*", "trajectory_*", "forward.nav", "innovations.csv", "run.resolved.yaml",
        "ppk.json", "ppk.pos", "ppk.resolved.yaml", "residuals.csv", "outage.json", "outages.csv", "diagnosis.json",
        "run.diagnosed.yaml", "error_model.diagnosed.yaml", "array_study.json", "estimator_study.json"}},
      {"calibration.json", "coast.calibration/", {"calibration.json", "error_model.yaml"}},
      {"synth.json",
       "coast.synth/",
       {"synth.json", "imu.csv", "noise.csv", "members.csv", "error_model.yaml", "array.resolved.yaml"}},
      {"differences.csv", "gps_week,sow_s,north_m,east_m,down_m", {"differences.csv", "comparison.json"}},
      {"run.yaml",
       "reference: {file: truth.nav, format: nav}",
       {"run.yaml", "imu.csv", "imu_*", "gnss.pos", "truth.nav", "error_model.yaml", "error_model_*", "array.yaml",
        "run-rinex.yaml", "rover.obs", "base.obs", "brdc.nav"}},
  };
  return table;
}

bool matches(std::string_view name, std::string_view pattern) {
  if (!pattern.ends_with('*')) return name == pattern;
  pattern.remove_suffix(1);
  return name.starts_with(pattern);
}

Lines lines_of_earlier_version(const fs::path& folder) {
  Lines lines;
  for (const EarlierResults& earlier : earlier_results()) {
    if (content_of(folder / earlier.file).find(earlier.contains) == std::string::npos) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_regular_file() &&
          std::ranges::any_of(earlier.names, [&](std::string_view pattern) { return matches(name, pattern); }))
        lines.insert(line_of(name, entry.file_size()));
    }
  }
  return lines;
}

void require_replaceable(const fs::path& file, const Lines& lines) {
  std::error_code ignored;
  const auto status = fs::symlink_status(file, ignored);
  // A journal identifies its study in its first line, and grows after it was listed.
  if (!fs::exists(status) || file.extension() == ".partial") return;
  if (was_read(file))
    throw InputError({file.string(), 0, "an input of this job would be replaced by its results", "",
                      "Name another folder for the results with --out."});
  if (!fs::is_regular_file(status) && !fs::is_symlink(status)) return;  // AtomicFile handles it
  const bool is_link = fs::is_symlink(status);
  if (!is_link && lines.contains(line_of(file.filename().string(), fs::file_size(file, ignored)))) return;
  throw InputError({file.string(), 0, "this file would be replaced, but coast did not write it, or it was changed since", "",
                    "Name another folder for the results with --out, or move the file away."});
}

/// The process number at the end of NAME.part-NUMBER, and NAME; none for other names.
std::optional<std::pair<std::string, pid_t>> part_of(const std::string& name) {
  constexpr std::string_view kPart = ".part-";
  const std::size_t at = name.rfind(kPart);
  if (at == std::string::npos) return std::nullopt;
  pid_t process = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + at + kPart.size(), end, process);
  if (error != std::errc() || stop != end || process <= 0) return std::nullopt;
  return std::pair{name.substr(0, at), process};
}

void remove_parts_of_dead_processes(const fs::path& folder, const Lines& lines) {
  std::vector<fs::path> dead;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto part = part_of(entry.path().filename().string());
    if (part && lines.contains(line_of(part->first, 0)) && ::kill(part->second, 0) != 0 && errno == ESRCH)
      dead.push_back(entry.path());
  }
  std::error_code ignored;
  for (const fs::path& part : dead) fs::remove(part, ignored);
}

}  // namespace

void open_results_folder(const fs::path& folder, const std::vector<std::string>& files) {
  const std::optional<Lines> mark = mark_of(folder);
  const Lines lines = mark ? *mark : lines_of_earlier_version(folder);
  for (const std::string& name : files) require_replaceable(folder / name, lines);
  remove_parts_of_dead_processes(folder, lines);
  if (!mark) append(folder / kMark, fmt::format("{}{}{}", kTitle, fmt::join(lines, "\n"), lines.empty() ? "" : "\n"), O_CREAT);
}

void begin_results(const fs::path& closing) {
  require_replaceable(closing);
  const std::string line = fmt::format("{}{}", kBegun, closing.filename().string());
  const auto lines = mark_of(closing.parent_path());
  if (lines && !lines->contains(line)) append(closing.parent_path() / kMark, line + '\n', 0);
  std::error_code failed;
  fs::remove(closing, failed);
  if (failed) throw OutputError(closing.string(), failed.message());
}

std::optional<std::string> awaited_result(const fs::path& folder) {
  for (const std::string& line : mark_of(folder).value_or(Lines{})) {
    if (!line.starts_with(kBegun)) continue;
    const std::string name = line.substr(kBegun.size());
    if (!fs::exists(folder / name)) return name;
  }
  return std::nullopt;
}

void require_replaceable(const fs::path& file) {
  if (const auto lines = mark_of(file.parent_path())) require_replaceable(file, *lines);
}

void note_written(const fs::path& file, std::uintmax_t bytes) {
  const std::string line = line_of(file.filename().string(), bytes);
  const auto lines = mark_of(file.parent_path());
  if (lines && !lines->contains(line)) append(file.parent_path() / kMark, line + '\n', 0);
}

void note_read(const fs::path& file) {
  ReadFiles& files = read_files();
  const std::scoped_lock lock(files.mutex);
  files.places.insert(place_of(file));
}

}  // namespace coast::io
