#include "coast/io/contents.hpp"

#include <algorithm>

#include "coast/io/rinex.hpp"
#include "registry_lookup.hpp"

namespace coast::io {

namespace {

constexpr double kHalfWeek = 302400.0;  // s

class ContentsReader {
 public:
  ContentsReader(const std::filesystem::path& file, std::optional<int> gps_week) : file_(file), gps_week_(gps_week) {}

  /// @return nothing if no reader found anything
  std::optional<FileContents> read() {
    constexpr std::size_t kHead = 4096;
    contents_.source = file_.string();
    if (const auto kind = file_kind(read_head(file_, kHead)); kind && kind->content == FileKind::Content::kRinex)
      read_rinex();
    else
      read_formats();
    return found() ? std::optional(std::move(contents_)) : std::nullopt;
  }
  [[noreturn]] void refuse() const;

 private:
  /// What `read` returns; if it fails, why is noted.
  template <class Read>
  auto attempt(Read&& read) -> std::optional<decltype(read())> {
    try {
      return read();
    } catch (const InputError& error) {
      contents_.refusals.emplace_back(error.what());
      if (!first_) first_ = error;
      return std::nullopt;
    }
  }

  void read_rinex() {
    contents_.format = "RINEX";
    contents_.observations = attempt([&] { return read_observations(file_); });
    if (contents_.observations) {
      if (!contents_.observations->marks.empty())
        contents_.marks = record::TimeMarkRecording{contents_.source, contents_.observations->marks, {}};
      return;
    }
    contents_.navigation = attempt([&] { return read_navigation(file_); });
    if (contents_.navigation) contents_.refusals.clear();  // a file is of one kind
  }

  void read_formats() {
    const FileHead head = head_of(file_);
    for (const Format& format : formats()) {
      if (!format.sniff || !format.sniff(head)) continue;
      read_format(format);
      if (!found()) continue;
      // A table or a trajectory is of one kind: that readers of others refuse it says nothing.
      if (!format.count_messages) contents_.refusals.clear();
      return;
    }
  }

  void read_format(const Format& format) {
    contents_.format = format.description;
    if (format.count_messages) contents_.messages = format.count_messages(file_);
    if (format.read_imu) {
      ImuFileOptions options;
      options.file = file_;
      options.time.gps_week = gps_week_;
      contents_.imu = attempt([&] { return format.read_imu(options, std::nullopt); });
    }
    if (format.read_gnss) {
      GnssFileOptions options;
      options.file = file_;
      options.time.gps_week = gps_week_;
      contents_.gnss = attempt([&] { return format.read_gnss(options, std::nullopt); });
    }
    if (format.read_reference) {
      ReferenceFileOptions options = ReferenceFileOptions::of_file(file_);
      options.time.gps_week = gps_week_;
      contents_.trajectory = attempt([&] { return format.read_reference(options, std::nullopt); });
    }
    const auto near = gps_week_ ? std::optional(geo::GpsTime::from_week(*gps_week_, kHalfWeek)) : std::nullopt;
    if (format.read_observations_near)
      contents_.observations = attempt([&] { return format.read_observations_near(file_, near); });
    else if (format.read_observations)
      contents_.observations = attempt([&] { return format.read_observations(file_); });
    if (format.read_navigation_near)
      contents_.navigation = attempt([&] { return format.read_navigation_near(file_, near); });
    else if (format.read_navigation)
      contents_.navigation = attempt([&] { return format.read_navigation(file_); });
    if (format.read_time_marks) contents_.marks = attempt([&] { return format.read_time_marks(file_); });
  }

  [[nodiscard]] bool found() const {
    return contents_.imu || contents_.gnss || contents_.observations || contents_.navigation || contents_.trajectory ||
           contents_.marks || !contents_.messages.empty();
  }

  const std::filesystem::path& file_;
  std::optional<int> gps_week_;
  FileContents contents_;
  std::optional<InputError> first_;  ///< of the refusals
};

void ContentsReader::refuse() const {
  refuse_other_kind(file_, FileKind::Content::kRinex, "a recording");
  if (first_) throw *first_;
  throw InputError({file_.string(), 0, "not recognised", "a recording of an IMU or of GNSS, RINEX, or a trajectory", ""});
}

}  // namespace

FileContents read_contents(const std::filesystem::path& file, std::optional<int> gps_week) {
  ContentsReader reader(file, gps_week);
  if (auto contents = reader.read()) return std::move(*contents);
  if (gps_week) reader.refuse();
  constexpr int kAnyWeek = 2300;
  ContentsReader with_a_week(file, kAnyWeek);
  if (with_a_week.read())
    throw InputError(
        {file.string(), 0, "seconds of week without a GPS week", "the week as well", "`--gps-week 2374` states it."});
  with_a_week.refuse();
}

}  // namespace coast::io
