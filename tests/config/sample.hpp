#pragma once
// The tree of this text, built by hand:
//
//   1  imu:
//   2    file: data/imu.csv
//   3    rate_hz: 100
//   4    lever_arm_m: [1, 2.5, -1e-3]
//   5    axes: [x, y]
//   6    filtered: false
//   7  start: auto
//   8  outages:
//   9    - {start_s: 10.5}
//  10  empty:

#include "coast/config/builder.hpp"

namespace coast::config {

inline Node sample(const std::string& file = "runs/run.yaml") {
  TreeBuilder b(file);
  const auto root = b.root_map(1);
  const auto imu = b.add_map(root, "imu", 1);
  b.add_scalar(imu, "file", "data/imu.csv", 2);
  b.add_scalar(imu, "rate_hz", "100", 3);
  const auto arm = b.add_list(imu, "lever_arm_m", 4);
  for (const char* value : {"1", "2.5", "-1e-3"}) b.add_scalar(arm, "", value, 4);
  const auto axes = b.add_list(imu, "axes", 5);
  for (const char* value : {"x", "y"}) b.add_scalar(axes, "", value, 5);
  b.add_scalar(imu, "filtered", "false", 6);
  b.add_scalar(root, "start", "auto", 7);
  const auto outages = b.add_list(root, "outages", 8);
  b.add_scalar(b.add_map(outages, "", 9), "start_s", "10.5", 9);
  b.add_null(root, "empty", 10);
  return b.finish();
}

template <typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no InputError";
}

}  // namespace coast::config
