// RTKLIB's solution file in all forms written by rtkpost, rnx2rtkp and rtkrcv: times as GPST, UTC or JST, calendar or week and
// seconds; positions geodetic in degrees or degrees-minutes-seconds, ECEF, or baseline east-north-up; with or without
// velocities; any field separator. RTKLIB manual 2.4.2, B.1. The header determines the form.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../gnss_builder.hpp"
#include "../position.hpp"
#include "../text.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

constexpr double kJapanStandardTime = 9.0 * geo::kHour;
using Frame = PositionOptions::Frame;

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// Content of the header.
struct PosHeader {
  bool found = false;
  std::string scale = "GPST";
  Frame frame = Frame::kGeodetic;
  bool sexagesimal = false;
  bool velocity = false;
  bool above_mean_sea_level = false;
  std::optional<geo::Geodetic> base;
};

double sexagesimal(double degrees, double minutes, double seconds) {
  // Only the degrees have the sign, also for -0.
  return std::copysign(std::abs(degrees) + (minutes + seconds / 60.0) / 60.0, degrees);
}

/// "% ref pos   : lat lon height" in degrees, or in degrees, minutes, seconds.
std::optional<geo::Geodetic> parse_base(std::string_view text) {
  std::vector<std::string_view> fields;
  split(text.substr(text.find(':') + 1), ' ', fields);
  std::vector<double> v;
  v.reserve(fields.size());
  for (const auto field : fields) v.push_back(parse_number(field).value_or(NAN));
  if (v.size() == 7) v = {sexagesimal(v[0], v[1], v[2]), sexagesimal(v[3], v[4], v[5]), v[6]};
  if (v.size() != 3 || !std::isfinite(v[0] + v[1] + v[2]) || std::abs(v[0]) > 90.0) return std::nullopt;
  return geo::Geodetic{v[0] * geo::kDegree, v[1] * geo::kDegree, v[2]};
}

void read_column_names(std::string_view line, PosHeader& h) {
  h.found = true;
  for (const char* scale : {"UTC", "JST"})
    if (contains(line.substr(0, line.find('(')), scale)) h.scale = scale;
  if (contains(line, "x-ecef")) h.frame = Frame::kEcef;
  if (contains(line, "e-baseline")) h.frame = Frame::kEnu;
  h.sexagesimal = contains(line, "latitude(d'");
  h.velocity = contains(line, "vn(m/s)") || contains(line, "vx(m/s)");
}

PosHeader parse_header(const std::vector<std::string>& comments) {
  PosHeader h;
  for (const std::string& line : comments) {
    if (contains(line, "latitude(") || contains(line, "x-ecef(") || contains(line, "e-baseline(")) read_column_names(line, h);
    if (contains(line, "ref pos")) h.base = parse_base(line);
    if (contains(line, "WGS84/geodetic")) h.above_mean_sea_level = true;
  }
  return h;
}

class PosReader {
 public:
  PosReader(TableReader& table, const GnssFileOptions& options, Format::Near near)
      : table_(table), options_(options), header_(parse_header(table.comments())), builder_(table) {
    GnssFileOptions o = options;
    const auto first = table.first_fields();
    const bool calendar = first[0].find('/') != std::string::npos;
    const bool one_field = calendar && first[0].find(':') != std::string::npos;
    set_time(o, calendar, one_field);
    time_.emplace(table, o.time, o.time_columns, near);
    next_ = one_field ? 2 : 3;
    o.position.frame = header_.frame;
    o.position.above_mean_sea_level |= header_.above_mean_sea_level;
    if (header_.frame == Frame::kEnu && header_.base) o.position.origin = header_.base;
    position_.emplace(o.position, table);
    if (header_.frame == Frame::kEnu) base_.emplace(*o.position.origin);
    take_columns();
  }

  record::GnssRecording read() {
    while (table_.next()) take_row();
    record::Events events = position_->events();
    for (const auto& event : time_->events()) events.push_back(event);
    if (!header_.found)
      events.push_back(
          {record::Event::Severity::kWarning, "pos_header_missing",
           fmt::format("{}: no header; taken as GPST, latitude, longitude [deg], ellipsoidal height", table_.name()),
           std::nullopt, 1});
    return builder_.finish(events);
  }

 private:
  void set_time(GnssFileOptions& o, bool calendar, bool one_field) {
    if (!calendar) {
      if (header_.scale != "GPST")
        throw InputError({table_.name(), table_.line(), fmt::format("week and seconds in {}", header_.scale), "GPST",
                          "Write the solution with GPST (out-timesys)."});
      o.time.kind = TimeKind::kWeekAndSeconds;
    } else {
      o.time.kind = header_.scale == "GPST" ? TimeKind::kGpst : TimeKind::kUtc;
      if (header_.scale == "JST") o.time.offset_s -= kJapanStandardTime;
    }
    o.time_columns = one_field ? std::vector<Column>{1} : std::vector<Column>{1, 2};
  }

  std::size_t take(std::string_view role) { return table_.number_slot(Column(next_++), role); }

  void take_columns() {
    r_.resize(header_.sexagesimal ? 7 : 3);
    for (auto& slot : r_) slot = take("position");
    quality_ = take("Q");
    satellites_ = take("ns");
    for (auto& slot : sd_) slot = take("sd");
    if (table_.columns() < static_cast<std::size_t>(next_) + 1) return;
    age_ = take("age");
    ratio_ = take("ratio");
    if (!header_.velocity || table_.columns() < static_cast<std::size_t>(next_) + 8) return;
    v_.emplace();
    for (auto& slot : *v_) slot = take("velocity");
  }

  [[nodiscard]] double value(std::size_t slot) const { return table_.number(slot); }

  [[nodiscard]] Eigen::Vector3d position() const {
    if (!header_.sexagesimal) return position_->to_ecef(value(r_[0]), value(r_[1]), value(r_[2]));
    return position_->to_ecef(sexagesimal(value(r_[0]), value(r_[1]), value(r_[2])),
                              sexagesimal(value(r_[3]), value(r_[4]), value(r_[5])), value(r_[6]));
  }

  /// Six signed roots in the axes of the file, from consecutive slots, to a covariance in N, E, D.
  [[nodiscard]] Eigen::Matrix3d covariance_ned(std::size_t first, const Eigen::Matrix3d& C_n_e, std::string_view what,
                                               std::string_view key) {
    const Eigen::Matrix3d cov = builder_.covariance(
        {{value(first), value(first + 1), value(first + 2)}, {value(first + 3), value(first + 4), value(first + 5)}}, what,
        key);
    if (header_.frame == Frame::kEcef) return C_n_e.transpose() * cov * C_n_e;
    if (header_.frame == Frame::kGeodetic) return neu_to_ned(cov);
    // Baseline columns are east, north, up at the base; at the rover north and down have slightly different directions.
    Eigen::Matrix3d ned_from_enu;
    ned_from_enu << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
    const Eigen::Matrix3d rotation = C_n_e.transpose() * base_->rotation() * ned_from_enu;
    return rotation * cov * rotation.transpose();
  }

  [[nodiscard]] std::optional<record::GnssFix::Velocity> velocity(const Eigen::Matrix3d& C_n_e) {
    if (!v_) return std::nullopt;
    const Eigen::Vector3d raw(value((*v_)[0]), value((*v_)[1]), value((*v_)[2]));
    const Eigen::Vector3d v_n =
        header_.frame == Frame::kEcef ? Eigen::Vector3d(C_n_e.transpose() * raw) : Eigen::Vector3d(raw.x(), raw.y(), -raw.z());
    if (options_.velocity_sd)
      return record::GnssFix::Velocity{v_n, builder_.covariance({*options_.velocity_sd}, "velocity", "")};
    const std::size_t sd = (*v_)[3];
    if (value(sd) == 0.0 && value(sd + 1) == 0.0 && value(sd + 2) == 0.0) {
      // RTKLIB writes these only if it estimates the motion; the position is valid without them.
      builder_.repairs().add("velocity_left_out",
                             "with velocity standard deviations of zero: velocity left out (`velocity_sd_mps` would use it)",
                             1.0, table_.error("velocity standard deviations 0"), std::nullopt);
      return std::nullopt;
    }
    return record::GnssFix::Velocity{v_n, covariance_ned(sd, C_n_e, "velocity", "velocity_sd_mps")};
  }

  void take_row() {
    if (!table_.finite()) return builder_.leave_out_nan();
    const double quality = value(quality_);
    if (quality < 1.0) {
      builder_.repairs().add("no_solution", "without a solution (Q = 0) left out", 1.0, table_.error("Q = 0"), std::nullopt);
      return;
    }
    record::GnssFix fix;
    fix.t = time_->read();
    fix.r_ea_e = position();
    // Geodetic files have all values in local axes already: no rotation needed, which takes a third of the time.
    const Eigen::Matrix3d C_n_e = header_.frame == Frame::kGeodetic ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                                                    : geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e));
    fix.position_cov_n = options_.sd ? builder_.covariance({*options_.sd}, "position", "sd_m")
                                     : covariance_ned(sd_[0], C_n_e, "position", "sd_m");
    fix.velocity = velocity(C_n_e);
    fix.quality = quality_from(quality);
    fix.satellites = static_cast<int>(std::lround(std::clamp(value(satellites_), 0.0, 999.0)));
    // Zero means "not set" here.
    if (age_ && value(*age_) != 0.0) fix.age_s = value(*age_);
    if (ratio_ && value(*ratio_) != 0.0) fix.ratio = value(*ratio_);
    builder_.add(fix);
  }

  TableReader& table_;
  const GnssFileOptions& options_;
  PosHeader header_;
  GnssBuilder builder_;
  std::optional<TimeColumn> time_;
  std::optional<PositionConverter> position_;
  std::optional<geo::LocalFrame> base_;
  int next_ = 0;  ///< index of the next column
  std::vector<std::size_t> r_;
  std::size_t quality_ = 0, satellites_ = 0;
  std::array<std::size_t, 6> sd_{};
  std::optional<std::size_t> age_, ratio_;
  std::optional<std::array<std::size_t, 9>> v_;
};

bool sniff_pos(const FileHead& head) {
  return contains(head.text, "%  GPST") || contains(head.text, "%  UTC") || contains(head.text, "%  JST") ||
         (head.path.ends_with(".pos") && !head.text.empty() && (head.text[0] == '%' || contains(head.text.substr(0, 40), "/")));
}

record::GnssRecording read_pos(const GnssFileOptions& options, Format::Near near) {
  TableReader table(options.file);
  return PosReader(table, options, near).read();
}

}  // namespace

Format rtklib_pos_format() {
  return {"rtklib-pos", "RTKLIB solution file (.pos), every time and position form", sniff_pos, {}, read_pos, {}};
}

}  // namespace coast::io
