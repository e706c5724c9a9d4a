#pragma once
// The map `ppk` of run.yaml, or a file of its own: what `coast ppk` reads.

#include <filesystem>
#include <optional>
#include <vector>

#include "coast/carrier/base_position.hpp"
#include "coast/carrier/ppk.hpp"
#include "coast/config/node.hpp"

namespace coast::cli {

struct PpkConfig {
  config::Node map;
  std::filesystem::path rover, base;
  std::vector<std::filesystem::path> navigation;
  std::vector<std::filesystem::path> sp3, clocks;  ///< precise orbits; clocks finer than theirs
  std::optional<std::filesystem::path> antex;      ///< phase centres of both antennas
  carrier::BaseAt base_at;
  bool broadcast_ionosphere = true;  ///< of single-point positions
  carrier::PpkOptions options;

  [[nodiscard]] static PpkConfig from(const config::Node& map);
};

/// A run.yaml, whose `gnss: {ppk: ..}` is taken, or a file with these keys alone.
/// @throws InputError  with file and line
[[nodiscard]] PpkConfig read_ppk(const std::filesystem::path& file);

}  // namespace coast::cli
