// Readers and writers, file to records and back, beside a plain pass over the same bytes: getline and strtod.

#include <benchmark/benchmark.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/registry.hpp"
#include "coast/io/rinex.hpp"
#include "coast/io/writers.hpp"

namespace {

using namespace coast;  // NOLINT(google-build-using-namespace): one program, no header

constexpr int kSamples = 500'000;
constexpr int kRate = 200;
constexpr int kEpochs = 5'000;  // of RINEX
const geo::GpsTime kStart = geo::GpsTime::from_week(2300, 1000.0);

/// Files of one random recording, made once, removed at the end.
class Files {
 public:
  static const Files& get() {
    static const Files files;
    return files;
  }
  [[nodiscard]] std::filesystem::path path(const char* name) const { return folder_ / name; }
  [[nodiscard]] const std::vector<record::TrajectoryEpoch>& epochs() const { return epochs_; }
  ~Files() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

 private:
  Files() : folder_(std::filesystem::temp_directory_path() / ("coast-io-bench-" + std::to_string(std::random_device()()))) {
    std::filesystem::create_directories(folder_);
    std::mt19937 generator(1);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)); };
    record::ImuRecording imu;
    record::GnssRecording gnss;
    for (int i = 1; i <= kSamples; ++i) {
      const geo::GpsTime t = kStart + static_cast<double>(i) / kRate;
      imu.samples.push_back({t, 1.0 / kRate, 1e-3 * vector(), Eigen::Vector3d(0.0, 0.0, -9.8 / kRate) + 1e-2 * vector()});
      record::TrajectoryEpoch epoch;
      epoch.nav = {t, geo::ecef_from_geodetic({0.7, 0.1 + 1e-9 * i, 200.0}), vector(),
                   geo::quaternion_from_rotation_vector(vector())};
      epoch.cov = {Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};
      epochs_.push_back(epoch);
      record::GnssFix fix;
      fix.t = t;
      fix.r_ea_e = epoch.nav.r_eb_e;
      fix.position_cov_n = 1e-4 * Eigen::Matrix3d::Identity();
      if (i % 4 == 0) gnss.fixes.push_back(fix);
    }
    io::write_imu_csv(folder_ / "imu.csv", imu);
    io::write_gnss_pos(folder_ / "gnss.pos", gnss);
    const auto nav = io::trajectory_format("nav").make(folder_ / "a.nav", {});
    for (const auto& epoch : epochs_) nav->write(epoch);
    nav->close();
    io::write_observations(folder_ / "a.obs", observations(generator));
    std::ifstream text(folder_ / "imu.csv", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(text), std::istreambuf_iterator<char>()};
    gzFile zipped = gzopen((folder_ / "imu.csv.gz").c_str(), "wb");
    gzwrite(zipped, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(zipped);
  }

  /// Twenty satellites on three bands, code, phase, Doppler and C/N0.
  static record::ObservationRecording observations(std::mt19937& generator) {
    std::uniform_real_distribution<double> range(2.0e7, 2.6e7);
    record::ObservationRecording recording;
    for (int i = 0; i < kEpochs; ++i) {
      record::ObservationEpoch& epoch = recording.epochs.emplace_back();
      epoch.t = kStart + static_cast<double>(i);
      for (std::uint8_t number = 1; number <= 20; ++number)
        for (const char band : {'1', '2', '5'}) {
          const double code = range(generator);
          epoch.observations.push_back({{record::SatelliteSystem::kGps, number}, {band, 'C'}, code, 5.0 * code, -1234.5, 45.5});
        }
    }
    return recording;
  }

  std::filesystem::path folder_;
  std::vector<record::TrajectoryEpoch> epochs_;
};

void count_bytes(benchmark::State& state, const std::filesystem::path& path, std::int64_t rows) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  state.SetItemsProcessed(state.iterations() * rows);
}

void plain_pass(benchmark::State& state) {
  const auto path = Files::get().path("imu.csv");
  for (auto _ : state) {
    std::ifstream file(path);
    std::string line;
    double sum = 0.0;
    while (std::getline(file, line)) {
      const char* p = line.c_str();
      for (int column = 0; column < 7; ++column) {
        char* end = nullptr;
        sum += std::strtod(p, &end);
        p = *end == ',' ? end + 1 : end;
      }
    }
    benchmark::DoNotOptimize(sum);
  }
  count_bytes(state, path, kSamples);
}

void read_imu_csv(benchmark::State& state, const char* name) {
  io::ImuFileOptions options;
  options.file = Files::get().path(name);
  options.time.gps_week = 2300;
  for (auto _ : state) benchmark::DoNotOptimize(io::read_imu(options).samples.size());
  count_bytes(state, Files::get().path("imu.csv"), kSamples);  // gzip too: bytes of text
}

void read_pos(benchmark::State& state) {
  io::GnssFileOptions options;
  options.file = Files::get().path("gnss.pos");
  for (auto _ : state) benchmark::DoNotOptimize(io::read_gnss(options).fixes.size());
  count_bytes(state, options.file, kSamples / 4);
}

void read_nav(benchmark::State& state) {
  const auto options = io::ReferenceFileOptions::of_file(Files::get().path("a.nav"));
  for (auto _ : state) benchmark::DoNotOptimize(io::read_reference(options).states.size());
  count_bytes(state, options.file, kSamples);
}

void read_rinex(benchmark::State& state) {
  const auto path = Files::get().path("a.obs");
  for (auto _ : state) benchmark::DoNotOptimize(io::read_observations(path).epochs.size());
  count_bytes(state, path, kEpochs);
}

void write_trajectory(benchmark::State& state, const char* format) {
  const auto path = Files::get().path("written");
  for (auto _ : state) {
    const auto writer = io::trajectory_format(format).make(path, {});
    for (const auto& epoch : Files::get().epochs()) writer->write(epoch);
    writer->close();
  }
  count_bytes(state, path, kSamples);
}

/// Finds and checks every message of 64 MB of a receiver's own file: a sample of the fuzzers' again and again.
void frame(benchmark::State& state, const char* name, const char* sample) {
  constexpr std::size_t kBytes = 64'000'000;
  const auto path = Files::get().path(name);
  std::ifstream file(std::string(COAST_SOURCE_DIR "/tests/fuzz/corpus/") + sample, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (bytes.empty()) return state.SkipWithError("no sample");
  std::ofstream repeated(path, std::ios::binary);
  for (std::size_t written = 0; written < kBytes; written += bytes.size()) repeated << bytes;
  repeated.close();
  const auto format = std::ranges::find(io::formats(), std::string_view(name), &io::Format::name);
  std::int64_t messages = 0;
  for (auto _ : state) {
    messages = 0;
    for (const io::MessageCount& count : format->count_messages(path)) messages += count.number;
  }
  count_bytes(state, path, messages);
}

BENCHMARK(plain_pass)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_imu_csv, text, "imu.csv")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_imu_csv, gzip, "imu.csv.gz")->Unit(benchmark::kMillisecond);
BENCHMARK(read_pos)->Unit(benchmark::kMillisecond);
BENCHMARK(read_nav)->Unit(benchmark::kMillisecond);
BENCHMARK(read_rinex)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, ubx, "ubx", "ubx/observations.ubx")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, sbf, "sbf", "sbf/observations.sbf")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, novatel, "novatel", "novatel/gnss.gps")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, rtcm3, "rtcm3", "rtcm/msm.rtcm3")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, vectornav, "vectornav", "vectornav/imu.vnb")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_trajectory, nav, "nav")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_trajectory, csv, "csv")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_trajectory, sbet, "sbet")->Unit(benchmark::kMillisecond);

}  // namespace
