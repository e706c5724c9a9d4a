// VectorNav messages of known content, and recorded ones against the table that another program made of them.

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/receiver_messages.hpp"

namespace coast::io {
namespace {

using test::Bytes;
using test::Files;
using test::refusal;

/// Groups, masks and fields of a message in their frame.
std::string vectornav(unsigned groups, const std::vector<unsigned>& masks, const std::string& fields) {
  Bytes b;
  b.u1(groups);
  for (const unsigned mask : masks) b.u2(mask);
  b.text(fields);
  const std::uint32_t crc = test::crc_bit_by_bit(b.str(), 0x1021, 16);
  return "\xfa" + b.str() + Bytes().u1(crc >> 8).u1(crc & 255U).str();
}

constexpr unsigned kCommonGroup = 1, kTimeGroup = 2, kImuGroup = 4, kGnss1Group = 8, kGnss2Group = 64;
constexpr std::uint64_t kVectorNavStart = (2165ULL * 604'800 + 200'000) * 1'000'000'000;  // ns
const geo::GpsTime kVectorNavTime = geo::GpsTime::from_week(2165, 200'000.0);

Bytes& put_vector(Bytes& b, float x, float y, float z) {
  return b.r4(x).r4(y).r4(z);
}

/// TimeGps in the time group, then the IMU group.
std::string imu_message(int i, unsigned imu_mask, const std::string& imu_fields) {
  Bytes b;
  b.put<std::uint64_t>(kVectorNavStart + 10'000'000ULL * static_cast<unsigned>(i)).u1(7);
  return vectornav(kTimeGroup | kImuGroup, {1U << 1 | 1U << 9, imu_mask}, b.str() + imu_fields);
}

TEST(VectorNavImu, TakesIncrementsBeforeRates) {
  constexpr unsigned kMask = 1U << 2 | 1U << 3 | 1U << 4 | 1U << 6 | 1U << 7 | 1U << 9 | 1U << 10;
  std::string content = "$VNRRG,01,VN-310*58\r\n";
  for (int i = 0; i < 5; ++i) {
    Bytes b;
    put_vector(b, 9.0F, 9.0F, 9.0F);
    put_vector(b, 8.0F, 8.0F, 8.0F).r4(31.5F).r4(0.01F);
    put_vector(b, 0.5F, -1.0F, 1.5F);
    put_vector(b, 0.01F, 0.02F, -0.098F);
    put_vector(b, 7.0F, 7.0F, 7.0F);
    put_vector(b, 6.0F, 6.0F, 6.0F);
    content += imu_message(i, kMask, b.str());
  }
  const Files files;
  files.put("imu.vnb", content);
  const auto recording = files.imu("imu.vnb");
  ASSERT_EQ(recording.samples.size(), 5U);
  EXPECT_EQ(recording.samples[3].t, kVectorNavTime + 0.03);
  EXPECT_LT((recording.samples[3].dtheta - geo::kDegree * Eigen::Vector3d(0.5, -1.0, 1.5)).norm(), 1e-15);
  EXPECT_LT((recording.samples[3].dv - Eigen::Vector3d(0.01F, 0.02F, -0.098F)).norm(), 1e-15);
  EXPECT_EQ(recording.temperature, std::vector<float>(5, 31.5F));
}

TEST(VectorNavImu, TakesRatesThatTheOwnFilterHasNotTouchedBeforeOthers) {
  const Files files;
  std::string both, own;
  for (int i = 0; i < 3; ++i) {
    Bytes raw, filtered;
    put_vector(raw, 1.0F, 2.0F, -9.0F);
    put_vector(raw, 0.25F, 0.5F, -0.75F);
    put_vector(filtered, 3.0F, 3.0F, 3.0F);
    put_vector(filtered, 4.0F, 4.0F, 4.0F);
    both += imu_message(i, 1U << 2 | 1U << 3 | 1U << 9 | 1U << 10, raw.str() + filtered.str());
    own += imu_message(i, 1U << 9 | 1U << 10, filtered.str());
  }
  files.put("both.vnb", both);
  files.put("own.vnb", own);
  const auto first = files.imu("both.vnb").samples[1];
  EXPECT_LT((first.dtheta / first.dt - Eigen::Vector3d(0.25, 0.5, -0.75)).norm(), 1e-12);
  EXPECT_LT((first.dv / first.dt - Eigen::Vector3d(1.0, 2.0, -9.0)).norm(), 1e-12);
  const auto second = files.imu("own.vnb");
  EXPECT_LT((second.samples[1].dv / second.samples[1].dt - Eigen::Vector3d(3.0, 3.0, 3.0)).norm(), 1e-12);
  EXPECT_EQ(test::count_of(second.events, "imu_compensated"), 3);
}

TEST(VectorNavImu, OfTheCommonGroupIsTheSame) {
  const Files files;
  const auto file_of = [&](unsigned mask, auto&& fields) {
    std::string content;
    for (int i = 0; i < 3; ++i) {
      Bytes b;
      b.put<std::uint64_t>(kVectorNavStart + 10'000'000ULL * static_cast<unsigned>(i));
      fields(b);
      content += vectornav(kCommonGroup, {1U << 1 | mask}, b.str());
    }
    files.put("common.vnb", content);
    return files.imu("common.vnb").samples[1];
  };
  const auto increments = file_of(1U << 11, [](Bytes& b) {
    b.r4(0.01F);
    put_vector(b, 0.5F, 1.0F, 2.0F);
    put_vector(b, 0.25F, 0.5F, 0.75F);
  });
  EXPECT_LT((increments.dtheta - geo::kDegree * Eigen::Vector3d(0.5, 1.0, 2.0)).norm(), 1e-15);
  EXPECT_LT((increments.dv - Eigen::Vector3d(0.25, 0.5, 0.75)).norm(), 1e-15);
  const auto raw = file_of(1U << 9, [](Bytes& b) {
    put_vector(b, 1.0F, 2.0F, 3.0F);
    put_vector(b, 4.0F, 5.0F, 6.0F);
  });
  EXPECT_LT((raw.dv / raw.dt - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-12);
  EXPECT_LT((raw.dtheta / raw.dt - Eigen::Vector3d(4.0, 5.0, 6.0)).norm(), 1e-12);
  const auto own = file_of(1U << 5 | 1U << 8, [](Bytes& b) {
    put_vector(b, 4.0F, 5.0F, 6.0F);
    put_vector(b, 1.0F, 2.0F, 3.0F);
  });
  EXPECT_LT((own.dv / own.dt - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-12);
}

TEST(VectorNavImu, WithoutTimeOrSamplesIsRefused) {
  const Files files;
  Bytes zero;
  put_vector(zero, 0.0F, 0.0F, 0.0F);
  std::string untimed, invalid;
  for (int i = 0; i < 3; ++i) {
    untimed += vectornav(kImuGroup, {1U << 2 | 1U << 3}, zero.str() + zero.str());
    Bytes b;
    b.put<std::uint64_t>(kVectorNavStart + static_cast<unsigned>(i)).u1(1);  // the time is known, the date is not
    invalid += vectornav(kTimeGroup | kImuGroup, {1U << 1 | 1U << 9, 1U << 2 | 1U << 3}, b.str() + zero.str() + zero.str());
  }
  files.put("untimed.vnb", untimed);
  files.put("invalid.vnb", invalid);
  files.put("time.vnb", vectornav(kTimeGroup, {1U << 9}, "\x07"));
  for (const char* name : {"untimed.vnb", "invalid.vnb"})
    EXPECT_NE(refusal([&] { (void)files.imu(name); }).find("3 IMU samples, 3 of them without GPS time"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.imu("time.vnb"); }).find("0 IMU samples in VectorNav messages"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.gnss("time.vnb"); }).find("without a position of GNSS"), std::string::npos);
}

/// Tow, Week, NumSats, Fix, PosLla, VelNed, PosU, VelU of a GNSS group.
constexpr unsigned kGnssMask = 1U << 1 | 1U << 2 | 1U << 3 | 1U << 4 | 1U << 5 | 1U << 7 | 1U << 9 | 1U << 10;
std::string gnss_fields(double second, unsigned fix, double latitude, float sd_north) {
  Bytes b;
  b.put<std::uint64_t>(static_cast<std::uint64_t>(second * 1e9)).u2(2165).u1(12).u1(fix).r8(latitude).r8(9.0).r8(500.0);
  put_vector(b, 1.0F, 2.0F, 3.0F);
  put_vector(b, sd_north, 0.5F, 2.0F).r4(0.3F);
  return b.str();
}

TEST(VectorNavGnss, HasItsFixesOnceEach) {
  const Files files;
  std::string content;
  for (const std::string& fields :
       {gnss_fields(200'000.0, 8, 48.0, 0.25F), gnss_fields(200'000.0, 8, 48.0, 0.25F), gnss_fields(200'000.2, 7, 48.0, 0.25F),
        gnss_fields(200'000.4, 2, 48.0, 0.25F), gnss_fields(200'000.6, 4, 95.0, 0.25F), gnss_fields(200'000.8, 3, 48.0, 0.0F)})
    content += vectornav(kGnss1Group | kGnss2Group, {kGnssMask, kGnssMask}, fields + gnss_fields(1.0, 3, 1.0, 1.0F));
  files.put("gnss.vnb", content);
  const auto recording = files.gnss("gnss.vnb");
  ASSERT_EQ(recording.fixes.size(), 2U);
  const record::GnssFix& fix = recording.fixes[0];
  EXPECT_EQ(fix.t, kVectorNavTime);
  EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic({48.0 * geo::kDegree, 9.0 * geo::kDegree, 500.0})).norm(), 1e-6);
  EXPECT_LT((fix.position_cov_n.diagonal() - Eigen::Vector3d(0.0625, 0.25, 4.0)).norm(), 1e-12);
  EXPECT_EQ(fix.velocity->v_ea_n, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(fix.velocity->cov_n.trace(), 0.09, 1e-7);
  EXPECT_EQ(fix.quality, record::FixQuality::kFixed);
  EXPECT_EQ(recording.fixes[1].quality, record::FixQuality::kFloat);
  EXPECT_EQ(fix.satellites, 12);
  EXPECT_EQ(test::count_of(recording.events, "no_solution"), 1);
  EXPECT_EQ(test::count_of(recording.events, "fix_no_accuracy"), 2);  // one without PosU, one not on the Earth
  EXPECT_EQ(files.gnss("gnss.vnb", "sd_m: [1, 1, 1], velocity_sd_mps: [1, 1, 1]").fixes.size(), 3U);
  files.put("second.vnb", vectornav(kGnss2Group, {kGnssMask}, gnss_fields(200'000.0, 3, 48.0, 1.0F)));
  EXPECT_EQ(files.gnss("second.vnb").fixes.size(), 1U);
}

TEST(VectorNavMessages, WithSatelliteInformationHaveItsLength) {
  const Files files;
  Bytes satellites;
  satellites.u1(3).u1(0).zeros(24);
  Bytes zero;
  put_vector(zero, 0.0F, 0.0F, 0.0F);
  std::string content;
  for (int i = 0; i < 4; ++i) {
    Bytes time;
    time.put<std::uint64_t>(kVectorNavStart + 10'000'000ULL * static_cast<unsigned>(i));
    content += vectornav(kTimeGroup | kImuGroup | kGnss1Group, {1U << 1, 1U << 2 | 1U << 3, 1U << 14},
                         time.str() + zero.str() + zero.str() + satellites.str());
  }
  files.put("imu.vnb", content);
  const auto recording = files.imu("imu.vnb");
  EXPECT_EQ(recording.samples.size(), 4U);
  EXPECT_EQ(test::count_of(recording.events, "message_garbage"), 0);
}

TEST(VectorNavMessages, DamagedOrOfUnknownFieldsAreSkipped) {
  Bytes zero;
  put_vector(zero, 0.0F, 0.0F, 0.0F);
  const auto one = [&](int i) { return imu_message(i, 1U << 2 | 1U << 3, zero.str() + zero.str()); };
  std::string damaged = one(2);
  damaged[20] = 'x';
  const Files files;
  files.put("imu.vnb", one(0) + one(1) + damaged + vectornav(kImuGroup, {1U << 13}, "abcd") + vectornav(0x80 | 1, {1}, "x") +
                           vectornav(kImuGroup, {0x8001}, "x") + one(3) + one(4) + one(5).substr(0, 20));
  const auto recording = files.imu("imu.vnb");
  EXPECT_EQ(recording.samples.size(), 4U);
  for (const char* kind : {"message_checksum", "message_garbage", "message_cut_off", "imu_gap"})
    EXPECT_EQ(test::count_of(recording.events, kind) > 0, true) << kind;
}

/// A table by its column names, as numbers; without the last row if it is cut off.
std::vector<std::map<std::string, double>> table_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line, field;
  std::getline(stream, line);
  std::vector<std::string> names;
  for (std::stringstream header(line); std::getline(header, field, ',');) names.push_back(field.substr(0, field.find(" [")));
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(stream, line)) {
    std::stringstream fields(line);
    std::map<std::string, double> row;
    bool whole = true;
    for (const std::string& name : names) {
      whole = static_cast<bool>(std::getline(fields, field, ','));
      if (whole && !field.empty()) row[name] = std::stod(field);
    }
    if (whole) rows.push_back(row);
  }
  return rows;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A file of records with the time since the GPS epoch, and rates and forces of the IMU group.
std::string records(int messages) {
  Bytes file;
  for (const std::uint32_t mask : {1U << 1, 1U << 2 | 1U << 3, 0U, 0U, 0U, 0U}) file.put<std::uint32_t>(mask);
  for (int i = 0; i < messages; ++i) {
    file.put<std::uint32_t>(2);
    file.put<std::uint32_t>(117);
    file.put<double>(200'000.0 + 0.01 * i);
    file.put<std::uint64_t>(kVectorNavStart + 10'000'000ULL * static_cast<unsigned>(i));
    put_vector(file, 0.1F * static_cast<float>(i), 0.0F, -9.8F);
    put_vector(file, 0.0F, 0.01F, 0.0F);
  }
  return file.str();
}

TEST(VectorNavMessages, AreReadFromRecordsWithoutFrames) {
  const Files files;
  files.put("imu.vnb", records(50));
  const auto recording = files.imu("imu.vnb");
  ASSERT_EQ(recording.samples.size(), 50U);
  EXPECT_NEAR(recording.samples[20].dv.x() / recording.samples[20].dt, 2.0, 1e-6);
  EXPECT_EQ(test::count_of(recording.events, "message_cut_off"), 0);
  const std::string whole = records(50);
  files.put("cut.vnb", whole.substr(0, whole.size() - 7));
  const auto cut = files.imu("cut.vnb");
  EXPECT_EQ(cut.samples.size(), 49U);
  EXPECT_EQ(test::count_of(cut.events, "message_cut_off"), 1);
  std::string broken = whole;  // seven bytes are missing within the thirtieth record
  broken.erase(24 + 29 * 48 + 28, 7);
  files.put("broken.vnb", broken);
  const auto rest = files.imu("broken.vnb");
  EXPECT_GE(rest.samples.size(), 29U);
  EXPECT_LE(rest.samples.size(), 30U);
  EXPECT_GT(test::count_of(rest.events, "message_garbage"), 0);
}

/// One signal of RawMeas.
struct RawSignal {
  unsigned system, satellite, frequency, channel;
  double code, wavelength;  ///< m
  unsigned flags = 0x1E;    ///< tracked, time valid, code and phase locked
  unsigned slot = 0;
};

const std::vector<RawSignal> kRawSignals = {{0, 5, 1, 1, 21'677'841.77, 0.190293672798},    // GPS L1 C/A
                                            {0, 5, 2, 11, 21'677'821.12, 0.244210213425},   // GPS L2C, L
                                            {2, 13, 7, 9, 21'728'895.11, 0.248349369584},   // E5b Q, by the band of RINEX
                                            {2, 15, 5, 9, 22'580'472.24, 0.248349369584},   // E5b Q, by the list of the ICD
                                            {3, 20, 1, 8, 23'000'000.0, 0.192039486310},    // B1I
                                            {1, 136, 1, 1, 36'567'578.62, 0.190293672798},  // SBAS
                                            {6, 7, 1, 1, 20'000'000.0, 0.187465483566, 0x1E, 251},  // slot -5 of GLONASS
                                            {2, 21, 3, 1, 21'986'495.8, 0.190293672798},        // the carrier of E1 called E5a
                                            {0, 9, 1, 1, 22'000'000.0, 0.190293672798, 0x0E}};  // no lock on the phase

/// @param reserved  bytes behind the number of signals
std::string raw_meas(double tow, const std::vector<RawSignal>& signals, std::size_t reserved = 1) {
  Bytes b;
  b.r8(tow).u2(2165).u1(static_cast<unsigned>(signals.size())).zeros(reserved);
  for (const RawSignal& s : signals) {
    b.u1(s.system).u1(s.satellite).u1(s.frequency).u1(s.channel).u1(s.slot).u1(45).u2(s.flags);
    b.r8(s.code).r8(s.code / s.wavelength).r4(-417.5F);
  }
  return b.str();
}

/// GNSS 1 with one reserved word of satellite information and RawMeas: its bit is in a second word of the mask.
std::string raw_message(double tow, const std::vector<RawSignal>& signals) {
  constexpr unsigned kSatInfoBit = 1U << 14, kExtended = 1U << 15, kRawMeasInSecondWord = 1U;
  const std::string fields = Bytes().u1(1).u1(0).zeros(8).str() + raw_meas(tow, signals);
  return vectornav(kGnss1Group, {kSatInfoBit | kExtended, kRawMeasInSecondWord}, fields);
}

record::ObservationRecording raw_observations(const std::string& content) {
  const Files files;
  return read_observations(files.put("raw.vnb", content));
}

TEST(VectorNavObservations, AreReadFromRawMeas) {
  const auto recording = raw_observations(raw_message(200'000.5, kRawSignals) + raw_message(200'000.5, kRawSignals) +
                                          raw_message(200'001.5, kRawSignals));
  ASSERT_EQ(recording.epochs.size(), 2U);
  EXPECT_EQ(recording.epochs[1].t, geo::GpsTime::from_week(2165, 200'001.5));
  std::string found;
  for (const record::Observation& o : recording.epochs[0].observations) {
    found += to_string(o.satellite) + ":" + o.signal.band + o.signal.tracking + " ";
    EXPECT_TRUE(o.lost_lock);
    EXPECT_FALSE(o.half_cycle);
    EXPECT_EQ(o.cn0_dbhz, 45.0);
    EXPECT_EQ(o.doppler_hz, -417.5);
  }
  EXPECT_EQ(found, "G05:1C G05:2L R07:1C E13:7Q E15:7Q C20:2I S36:1C ");
  EXPECT_EQ(recording.glonass_channels.at(7), -5);
  const record::Observation& first = recording.epochs[1].observations.front();
  EXPECT_EQ(first.code_m, 21'677'841.77);
  EXPECT_EQ(first.phase_cycles, 21'677'841.77 / 0.190293672798);
  EXPECT_FALSE(first.lost_lock);
  EXPECT_EQ(test::count_of(recording.events, "vectornav_unknown_signal"), 2);
}

TEST(VectorNavObservations, LoseTheirLockBySlipsAndByPauses) {
  constexpr unsigned kHalfCycle = 1U << 5, kSlip = 1U << 7;
  const std::vector<RawSignal> both = {kRawSignals[0], kRawSignals[1]}, one = {kRawSignals[0]};
  std::vector<RawSignal> slipped = both, half = both;
  slipped[0].flags |= kSlip;
  half[0].flags |= kHalfCycle;
  std::string content;
  double tow = 200'000.0;
  for (const auto& signals : {both, slipped, one, both, half, both}) content += raw_message(tow++, signals);
  std::string lost;
  for (const record::ObservationEpoch& epoch : raw_observations(content).epochs)
    for (const record::Observation& o : epoch.observations) lost += o.half_cycle ? 'h' : o.lost_lock ? 'x' : '-';
  EXPECT_EQ(lost,
            "xx"
            "x-"
            "-"
            "-x"
            "h-"
            "x-");
}

TEST(VectorNavObservations, AreReadFromRecords) {
  constexpr std::uint32_t kMask = 1U << 14 | 1U << 15 | 1U << 16;
  Bytes file;
  for (const std::uint32_t mask : {0U, 0U, kMask, 0U, 0U, 0U}) file.put<std::uint32_t>(mask);
  for (int i = 0; i < 3; ++i) {
    file.put<std::uint32_t>(2).put<std::uint32_t>(117).put<double>(200'000.0 + i);
    file.u1(2).zeros(16).text(raw_meas(200'000.0 + i, kRawSignals, 0));
  }
  const auto recording = raw_observations(file.str());
  ASSERT_EQ(recording.epochs.size(), 3U);
  EXPECT_EQ(recording.epochs[2].observations.size(), 7U);
}

TEST(VectorNavObservations, AreMissedWithAReason) {
  EXPECT_NE(refusal([] { (void)raw_observations(raw_message(200'000.0, {})); }).find("Add RawMeas"), std::string::npos);
}

class VectorNavRecording : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  }
  static std::filesystem::path file(const char* name) { return *test::data_dir() / "vectornav-vn310" / name; }
  Files files_;
};

TEST_F(VectorNavRecording, HasTheImuOfItsTable) {
  const auto rows = table_of(file("vn310-imu.csv"));
  files_.put("imu.vnb", content_of(file("vn310-imu.vnb")));
  const auto recording = files_.imu("imu.vnb");
  ASSERT_EQ(rows.size(), 18U);
  ASSERT_EQ(recording.samples.size(), 18U);
  constexpr double kFloat = 6e-8;  // nine digits of a number of 24 bits
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const record::ImuSample& s = recording.samples[i];
    EXPECT_EQ(s.t.week(), 2165);
    EXPECT_NEAR(s.t.sow(), 1e-9 * row.at("Time::GpsTow"), 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string suffix = std::string("::") + "XYZ"[axis];
      const double theta = row.at("IMU::DeltaTheta" + suffix), v = row.at("IMU::DeltaVel" + suffix);
      EXPECT_NEAR(s.dtheta[axis] / geo::kDegree, theta, kFloat * std::abs(theta));
      EXPECT_NEAR(s.dv[axis], v, kFloat * std::abs(v));
    }
    EXPECT_NEAR(recording.temperature[i], row.at("IMU::Temp"), 1e-5);
  }
}

TEST_F(VectorNavRecording, HasTheFixesOfItsTable) {
  const auto rows = table_of(file("vn310-gnss.csv"));
  files_.put("gnss.vnb", content_of(file("vn310-gnss.vnb")));
  const auto recording = files_.gnss("gnss.vnb");
  ASSERT_GE(rows.size(), 11U);
  ASSERT_EQ(recording.fixes.size(), 12U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const record::GnssFix& fix = recording.fixes[i];
    EXPECT_NEAR(fix.t.sow(), 1e-9 * row.at("GNSS1::Tow"), 1e-9);
    const geo::Geodetic p{row.at("GNSS1::PosLla::latitude") * geo::kDegree, row.at("GNSS1::PosLla::longitude") * geo::kDegree,
                          row.at("GNSS1::PosLla::altitude")};
    EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic(p)).norm(), 1e-6);
    // The receiver rounds its Cartesian coordinates to centimetres.
    const Eigen::Vector3d r(row.at("GNSS1::PosEcef::X"), row.at("GNSS1::PosEcef::Y"), row.at("GNSS1::PosEcef::Z"));
    EXPECT_LT((fix.r_ea_e - r).norm(), 0.01);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string suffix = std::string("::") + "NED"[axis];
      EXPECT_NEAR(fix.velocity->v_ea_n[axis], row.at("GNSS1::VelNed" + suffix), 1e-6);
      EXPECT_NEAR(std::sqrt(fix.position_cov_n(axis, axis)), row.at("GNSS1::PosU" + suffix), 1e-6);
    }
    EXPECT_NEAR(std::sqrt(fix.velocity->cov_n.trace()), row.at("GNSS1::VelU"), 1e-7);
    EXPECT_EQ(fix.satellites, static_cast<int>(row.at("GNSS1::NumSats")));
    EXPECT_EQ(fix.quality, record::FixQuality::kSbas);
  }
}

}  // namespace
}  // namespace coast::io
