#pragma once
// One channel of all sensors, block by block: which sensors are in order. Private to the room.

#include <optional>

#include "coast/array/defects.hpp"
#include "parity_windows.hpp"

namespace coast::array {

/// A defective sensor in one channel; all in blocks.
struct Alarm {
  std::size_t sensor = 0;
  int channel = 0;
  std::size_t onset = 0;
  std::size_t found = 0;
  std::size_t back = 0;  ///< first block in order again
  double statistic = 0.0;
};

class DefectWatch {
 public:
  /// @param recovery  blocks in order before a sensor is used again
  DefectWatch(ChannelWindows& windows, std::size_t blocks, int channel, std::size_t recovery);

  /// First a pass over the record with all sensors, for the size of the statistics in this record; then the detection itself.
  void run();
  [[nodiscard]] const std::vector<Alarm>& alarms() const { return alarms_; }
  /// `found` in blocks.
  [[nodiscard]] const std::vector<Disagreement>& disagreements() const { return disagreements_; }

 private:
  struct Trial {
    std::size_t since = 0;
    double in_motion = 0.0;    ///< blocks, weighted by motion relative to that at the detection
    double needs_power = 0.0;  ///< of the motion at the detection; 0: detected independent of motion
    double most_noise = 0.0;   ///< variance over the usual one, if detected by its noise: root of the detected ratio
    std::size_t alarm = 0;     ///< index
  };
  void learn();
  void step(std::size_t b);
  [[nodiscard]] ChannelWindows::Set there(std::size_t b) const;
  [[nodiscard]] bool stands_out(std::size_t k, ChannelWindows::Set set, const TestValue& test);
  void leave(std::size_t k, std::size_t b, const TestValue& test);
  void contradict(const ChannelWindows::Set& set, std::size_t b, const TestValue& test);
  void follow_trial(std::size_t k, std::size_t b);
  [[nodiscard]] std::size_t onset_of(std::size_t k, std::size_t b, const TestValue& test) const;
  [[nodiscard]] double jump_score(std::size_t k, std::size_t from, std::size_t b) const;
  [[nodiscard]] double burst_score(std::size_t k, std::size_t from, std::size_t b, bool of_samples) const;

  ChannelWindows& windows_;
  std::size_t blocks_;
  int channel_;
  std::size_t recovery_;
  ChannelWindows::Set in_order_;
  std::vector<std::size_t> in_order_from_, windows_from_;
  std::vector<std::optional<Trial>> trials_;
  std::vector<Alarm> alarms_;
  std::vector<Disagreement> disagreements_;
};

}  // namespace coast::array
