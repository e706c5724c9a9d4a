#include "coast/geo/reference_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include "coast/geo/earth.hpp"
#include "coast/geo/nearest_word.hpp"
#include "coast/geo/units.hpp"

namespace coast::geo {

namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kPartPerBillion = 1e-9;
constexpr double kMilliarcsecond = kArcMinute / 60.0 * 1e-3;  // rad

// T1 T2 T3 [mm], D [ppb], R1 R2 R3 [mas], in the order and the signs of the ITRF's tables; rates in the same per year.
using Parameters = std::array<double, 7>;

struct Frame {
  std::string_view name;
  std::string_view parent;  // the parameters transform from it to this frame; empty at the root
  double epoch;             // decimal year at which `value` holds
  Parameters value;
  Parameters rate;
};

// Each row as printed by its authority, for comparison with the paper:
// - ITRFyy: "Transformation parameters from ITRF2020 to past ITRFs" (itrf.ign.fr, Transfo-ITRF2020_TRFs.txt), epoch 2015.0.
// - ETRF2020, ETRF2014: the definition, a rotation with Eurasia since 1989.0; ETRF2000: EUREF TN 1, from ITRF2014 (EPSG 10572,
//   8366, 8405). TN 1 writes R as here.
// - NAD83: NGS, 2010.0, from ITRF2020 (EPSG 10334, 10336, 10338); GDA2020 from ITRF2014 at 2020.0 (EPSG 8049). Both authorities
//   print rotations of the coordinate frame instead of the position vector: R1, R2, R3 and their rates here have the opposite
//   sign of what they print.
constexpr std::array<Frame, 17> kFrames = {{
    {"ITRF2020", "", 2015.0, {}, {}},
    {"ITRF2014", "ITRF2020", 2015.0, {-1.4, -0.9, 1.4, -0.42, 0, 0, 0}, {0.0, -0.1, 0.2, 0.00, 0, 0, 0}},
    {"ITRF2008", "ITRF2020", 2015.0, {0.2, 1.0, 3.3, -0.29, 0, 0, 0}, {0.0, -0.1, 0.1, 0.03, 0, 0, 0}},
    {"ITRF2005", "ITRF2020", 2015.0, {2.7, 0.1, -1.4, 0.65, 0, 0, 0}, {0.3, -0.1, 0.1, 0.03, 0, 0, 0}},
    {"ITRF2000", "ITRF2020", 2015.0, {-0.2, 0.8, -34.2, 2.25, 0, 0, 0}, {0.1, 0.0, -1.7, 0.11, 0, 0, 0}},
    {"ITRF97", "ITRF2020", 2015.0, {6.5, -3.9, -77.9, 3.98, 0, 0, 0.36}, {0.1, -0.6, -3.1, 0.12, 0, 0, 0.02}},
    {"ITRF96", "ITRF2020", 2015.0, {6.5, -3.9, -77.9, 3.98, 0, 0, 0.36}, {0.1, -0.6, -3.1, 0.12, 0, 0, 0.02}},
    {"ITRF94", "ITRF2020", 2015.0, {6.5, -3.9, -77.9, 3.98, 0, 0, 0.36}, {0.1, -0.6, -3.1, 0.12, 0, 0, 0.02}},
    {"ITRF93", "ITRF2020", 2015.0, {-65.8, 1.9, -71.3, 4.47, -3.36, -4.33, 0.75}, {-2.8, -0.2, -2.3, 0.12, -0.11, -0.19, 0.07}},
    {"ITRF92", "ITRF2020", 2015.0, {14.5, -1.9, -85.9, 3.27, 0, 0, 0.36}, {0.1, -0.6, -3.1, 0.12, 0, 0, 0.02}},
    {"ETRF2020", "ITRF2020", 1989.0, {}, {0, 0, 0, 0, 0.086, 0.519, -0.753}},
    {"ETRF2014", "ITRF2014", 1989.0, {}, {0, 0, 0, 0, 0.085, 0.531, -0.770}},
    {"ETRF2000",
     "ITRF2014",
     2010.0,
     {54.7, 52.2, -74.1, 2.12, 1.701, 10.290, -16.632},
     {0.1, 0.1, -1.9, 0.11, 0.081, 0.490, -0.792}},
    {"NAD83(2011)",
     "ITRF2020",
     2010.0,
     {1003.90, -1909.61, -541.17, -0.05109, -26.78138, 0.42027, -10.93206},
     {0.79, -0.70, -1.24, -0.07201, -0.06667, 0.75744, 0.05133}},
    {"NAD83(PA11)",
     "ITRF2020",
     2010.0,
     {909.5, -2013.3, -585.9, 1.70, -22.749, -26.560, 25.706},
     {0.1, 0.0, -1.7, 0.11, 0.384, -1.007, 2.186}},
    {"NAD83(MA11)",
     "ITRF2020",
     2010.0,
     {909.5, -2013.3, -585.9, 1.70, -28.711, -11.785, -4.417},
     {0.1, 0.0, -1.7, 0.11, 0.020, -0.105, 0.347}},
    {"GDA2020", "ITRF2014", 2020.0, {}, {0, 0, 0, 0, -1.50379, -1.18346, -1.20716}},
}};

struct Alias {
  std::string_view name;
  std::string_view frame;
};

// IGS: EPSG 9028 to 9032, 9034, 9037, 9381 and 9382, all null; IGS20: IGSMAIL-8238; IGb20: IGSMAIL-8542 (aligned to ITRF2020).
// WGS84: EPSG 7666, 7669, 7670 and 9757, all null; G2296 was aligned to IGS20.
constexpr std::array<Alias, 17> kAliases = {{
    {"IGS20", "ITRF2020"},
    {"IGb20", "ITRF2020"},
    {"IGS14", "ITRF2014"},
    {"IGb14", "ITRF2014"},
    {"IGS08", "ITRF2008"},
    {"IGb08", "ITRF2008"},
    {"IGS05", "ITRF2005"},
    {"IGS00", "ITRF2000"},
    {"IGb00", "ITRF2000"},
    {"IGS97", "ITRF97"},
    {"WGS84", "ITRF2020"},
    {"WGS84(G2296)", "ITRF2020"},
    {"WGS84(G2139)", "ITRF2014"},
    {"WGS84(G1762)", "ITRF2008"},
    {"WGS84(G1674)", "ITRF2008"},
    {"WGS84(G1150)", "ITRF2000"},
    {"NAD83(CSRS)", "NAD83(2011)"},
}};

struct Plate {
  std::string_view name;
  std::array<double, 3> omega;  // mas/year, ECEF
};

// Altamimi et al. (2023), table 1, and table 2 for the origin rate bias.
constexpr std::array<Plate, 13> kPlates = {{
    {"AMUR", {-0.131, -0.551, 0.837}},
    {"ANTA", {-0.269, -0.312, 0.678}},
    {"ARAB", {1.129, -0.146, 1.438}},
    {"AUST", {1.487, 1.175, 1.223}},
    {"CARB", {0.207, -1.422, 0.726}},
    {"EURA", {-0.085, -0.519, 0.753}},
    {"INDI", {1.137, 0.013, 1.444}},
    {"NAZC", {-0.327, -1.561, 1.605}},
    {"NOAM", {0.045, -0.666, -0.098}},
    {"NUBI", {0.090, -0.585, 0.717}},
    {"PCFC", {-0.404, 1.021, -2.154}},
    {"SOAM", {-0.261, -0.282, -0.157}},
    {"SOMA", {-0.081, -0.719, 0.864}},
}};
constexpr std::array<double, 3> kOriginRateBias = {0.37, 0.35, 0.74};  // mm/year

// Upper case without spaces: "WGS 84 (g2139)" and "WGS84(G2139)" are one name.
std::string folded(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isspace(byte) == 0) text += static_cast<char>(std::toupper(byte));
  }
  return text;
}

template <typename Table>
auto find(const Table& table, std::string_view name) {
  return std::find_if(table.begin(), table.end(), [&](const auto& row) { return folded(row.name) == folded(name); });
}

const Frame* find_frame(std::string_view name) {
  const auto alias = find(kAliases, name);
  const auto frame = find(kFrames, alias == kAliases.end() ? name : alias->frame);
  return frame == kFrames.end() ? nullptr : &*frame;
}

const Frame& known_frame(std::string_view name) {
  const Frame* found = find_frame(name);
  if (found == nullptr) {
    const std::string near = nearest_word(folded(name), frames());
    throw std::invalid_argument(fmt::format("reference frame '{}' is unknown{}; known are {}", name,
                                            near.empty() ? "" : fmt::format(" (the nearest is {})", near),
                                            fmt::join(frames(), ", ")));
  }
  return *found;
}

// Shift and linear part of a similarity in SI; r -> translation + scale r + rotation x r.
struct Similarity {
  Eigen::Vector3d translation;  // m
  double scale;
  Eigen::Vector3d rotation;  // rad

  [[nodiscard]] Eigen::Vector3d of(const Eigen::Vector3d& r) const { return translation + scale * r + rotation.cross(r); }
};

Similarity si(const Parameters& p) {
  return {kMillimetre * Eigen::Vector3d(p[0], p[1], p[2]), kPartPerBillion * p[3],
          kMilliarcsecond * Eigen::Vector3d(p[4], p[5], p[6])};
}

Similarity at(const Frame& f, double year) {
  Parameters p = f.value;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] += f.rate[i] * (year - f.epoch);
  return si(p);
}

// Both transformations accumulate the shift from r, of metres, and not the position, which is rounded to 1e-9 m per addition.
Eigen::Vector3d shift_to_root(const Frame& f, double year, const Eigen::Vector3d& r, Eigen::Vector3d shift) {
  if (f.parent.empty()) return shift;
  const Similarity s = at(f, year);
  // r_parent + s.of(r_parent) = r, by fixed point: each iteration gains a factor |D| + |R| < 1e-6, so three are below 1e-15 m.
  Eigen::Vector3d parent_shift = shift;
  for (int i = 0; i < 3; ++i) parent_shift = shift - s.of(r + parent_shift);
  return shift_to_root(known_frame(f.parent), year, r, parent_shift);
}

Eigen::Vector3d shift_from_root(const Frame& f, double year, const Eigen::Vector3d& r, const Eigen::Vector3d& shift) {
  if (f.parent.empty()) return shift;
  const Eigen::Vector3d parent_shift = shift_from_root(known_frame(f.parent), year, r, shift);
  return parent_shift + at(f, year).of(r + parent_shift);
}

// Velocity of the ITRF2020 in f: the sum of the rates along the path.
Eigen::Vector3d drift_from_root(const Frame& f, const Eigen::Vector3d& r) {
  if (f.parent.empty()) return Eigen::Vector3d::Zero();
  return drift_from_root(known_frame(f.parent), r) + si(f.rate).of(r);
}

void require_year(double year) {
  // A two-digit year or a modified Julian date would otherwise pass, and move the station by metres. Negated for NaN.
  if (!(year >= 1980.0 && year <= 2100.0)) {
    throw std::invalid_argument(fmt::format("epoch {}, must be a year in 1980 to 2100", year));
  }
}

}  // namespace

std::vector<std::string> frames() {
  std::vector<std::string> names;
  for (const Frame& f : kFrames) names.emplace_back(f.name);
  for (const Alias& a : kAliases) names.emplace_back(a.name);
  return names;
}

std::optional<std::string> frame_of(std::string_view name) {
  const Frame* found = find_frame(name);
  return found == nullptr ? std::nullopt : std::optional<std::string>(found->name);
}

Eigen::Vector3d transform(const Eigen::Vector3d& r, const FrameEpoch& from, const FrameEpoch& to,
                          const Eigen::Vector3d& velocity_mpy) {
  require_year(from.year);
  require_year(to.year);
  const Frame& source = known_frame(from.frame);
  const Frame& target = known_frame(to.frame);
  const Eigen::Vector3d moved = velocity_mpy * (to.year - from.year);
  // By the root and back would be the identity only to rounding.
  if (&source == &target) return r + moved;
  return r + shift_from_root(target, to.year, r, shift_to_root(source, to.year, r, moved));
}

Eigen::Vector3d velocity_in_frame(const Eigen::Vector3d& velocity_mpy, const Eigen::Vector3d& r, std::string_view from,
                                  std::string_view to) {
  return velocity_mpy + drift_from_root(known_frame(to), r) - drift_from_root(known_frame(from), r);
}

std::vector<std::string> plates() {
  std::vector<std::string> names;
  for (const Plate& p : kPlates) names.emplace_back(p.name);
  return names;
}

std::optional<Eigen::Vector3d> plate_velocity(std::string_view plate, const Eigen::Vector3d& r, std::string_view frame) {
  const auto found = find(kPlates, plate);
  if (found == kPlates.end()) return std::nullopt;
  const Eigen::Vector3d omega = kMilliarcsecond * Eigen::Vector3d(found->omega[0], found->omega[1], found->omega[2]);
  const Eigen::Vector3d bias = kMillimetre * Eigen::Vector3d(kOriginRateBias[0], kOriginRateBias[1], kOriginRateBias[2]);
  const Eigen::Vector3d down = C_n_e(geodetic_from_ecef(r)).col(2);
  const Eigen::Vector3d rigid = omega.cross(r) + bias;
  return velocity_in_frame(rigid - down * down.dot(rigid), r, "ITRF2020", frame);
}

}  // namespace coast::geo
