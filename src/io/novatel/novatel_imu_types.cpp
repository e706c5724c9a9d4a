#include "novatel_imu_types.hpp"

#include <algorithm>
#include <array>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

constexpr double kFoot = 0.3048;  // m
constexpr double kArcsecond = geo::kDegree / 3600.0;
constexpr double kMilliG = 9.80665e-3;  // m/s^2
constexpr double kTo26 = 1.0 / (1 << 26), kTo16 = 1.0 / (1 << 16), kTo15 = 1.0 / (1 << 15);
constexpr double kHoneywellGyro = kTo26 / 128.0;         // 2^-33 rad
constexpr double kHoneywellAccel = kFoot * kTo26 / 2.0;  // 2^-27 ft/s
constexpr double kKvhGyro = 0.1 / (3600.0 * 256.0);      // rad, see the table
constexpr double kImarAccel = 0.05 * kTo15;

/// OEM7 manual, RAWIMUSX, "raw IMU scale factors", and INSCONFIG, "IMU type"; the same factors are in NovAtel's
/// novatel_oem7_driver. That of the gyros of KVH is stated in rad; 0.1 arcsec / 256 of others would be in degrees the same
/// number, but then a CPT at rest would have 1/60 of its noise. The Epson IMUs count rates, here times the interval of their
/// own rate.
constexpr std::array<NovAtelImuType, 26> kNovAtelImuTypes = {{
    {1, "HG1700_AG11", kHoneywellGyro, kHoneywellAccel},
    {4, "HG1700_AG17", kHoneywellGyro, 2.0 * kHoneywellAccel},
    {5, "HG1900_CA29", kHoneywellGyro, kHoneywellAccel},
    {8, "LN200", 1.0 / (1 << 19), 1.0 / (1 << 14)},
    {11, "HG1700_AG58", kHoneywellGyro, kHoneywellAccel},
    {12, "HG1700_AG62", kHoneywellGyro, 2.0 * kHoneywellAccel},
    {13, "IMAR_FSAS", 0.1 / 256.0 * kArcsecond, kImarAccel},
    {16, "KVH_COTS", kKvhGyro, kImarAccel},
    {19, "LITEF_LCI1"},
    {20, "HG1930_AA99", kHoneywellGyro, kHoneywellAccel},
    {26, "ISA100C", 1e-9, 2e-8},
    {27, "HG1900_CA50", kHoneywellGyro, kHoneywellAccel},
    {28, "HG1930_CA50", kHoneywellGyro, kHoneywellAccel},
    {31, "ADIS16488", 720.0 * kTo26 / 32.0 * geo::kDegree, 200.0 * kTo26 / 32.0},
    {32, "STIM300", geo::kDegree / (1 << 21), 1.0 / (1 << 22)},
    {33, "KVH_1750", kKvhGyro, kImarAccel},
    {41, "EPSON_G320", 0.008 * kTo16* geo::kDegree / 125.0, 0.2 * kTo16* kMilliG / 125.0},
    {45, "KVH_1725"},
    {52, "LITEF_MICROIMU", 1e-9, 2e-8},
    {56, "STIM_300D", geo::kDegree / (1 << 21), 1.0 / (1 << 22)},
    {58, "HG4930_AN01", kHoneywellGyro, kTo26 / 8.0},
    {61, "EPSON_G370", 0.0151515 * kTo16* geo::kDegree / 200.0, 0.4 * kTo16* kMilliG / 200.0},
    {62, "EPSON_G320_200HZ", 0.008 * kTo16* geo::kDegree / 200.0, 0.2 * kTo16* kMilliG / 200.0},
    {68, "HG4930_AN04", kHoneywellGyro, kTo26 / 8.0},
    {69, "HG4930_AN04_400HZ", kHoneywellGyro, kTo26 / 8.0},
    {0, "UNKNOWN"},
}};

}  // namespace

std::optional<NovAtelImuType> novatel_imu_type(std::uint32_t number) {
  const auto found = std::ranges::find(kNovAtelImuTypes, number, &NovAtelImuType::number);
  if (found == kNovAtelImuTypes.end()) return std::nullopt;
  return *found;
}

std::optional<NovAtelImuType> novatel_imu_type(std::string_view name) {
  constexpr std::string_view kPrefix = "IMU_";
  if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
  const auto found = std::ranges::find(kNovAtelImuTypes, name, &NovAtelImuType::name);
  if (found == kNovAtelImuTypes.end()) return std::nullopt;
  return *found;
}

}  // namespace coast::io
