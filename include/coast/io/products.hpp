#pragma once
// Products of the analysis centres: precise orbits, clocks, phase centres of antennas.

#include <filesystem>
#include <vector>

#include "coast/record/antenna.hpp"
#include "coast/record/precise_orbits.hpp"

namespace coast::io {

/// SP3-a, -c and -d (Hilla 2016: The extended standard product 3 orbit format). Several files of consecutive days are joined
/// into one table. Positions of zero and clocks of 999999 are missing values; lines that cannot be read are left out and
/// counted; of two lines for the same satellite and time the first is kept. Velocities are not read.
/// @throws InputError  not an SP3 file, no epoch in it, a time that cannot be read; with line
[[nodiscard]] record::PreciseOrbits read_sp3(const std::vector<std::filesystem::path>& files);

/// RINEX clocks 2.0 to 3.04 (Ray & Gurtner 2017), of satellites; receiver clocks are skipped. Several files are joined into one
/// table.
/// @throws InputError  not a clock file, no satellite in it; with line
[[nodiscard]] record::PreciseClocks read_clocks(const std::vector<std::filesystem::path>& files);

/// ANTEX 1.3 and 1.4 (Rothacher & Schmid 2010). Antennas that cannot be read are left out and counted.
/// @throws InputError  not an ANTEX file, relative calibrations, nothing in it that can be used; with line
[[nodiscard]] record::AntennaTable read_antex(const std::filesystem::path& file);

}  // namespace coast::io
