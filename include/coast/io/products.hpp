#pragma once
// Products of the analysis centres: precise orbits.

#include <filesystem>
#include <vector>

#include "coast/record/precise_orbits.hpp"

namespace coast::io {

/// SP3-a, -c and -d (Hilla 2016: The extended standard product 3 orbit format). Several files, days in a row, become one table.
/// Positions of zero and clocks of 999999 are no values; lines that cannot be read are left out and counted; of two lines for
/// the same satellite and time the first stays. Velocities are not read.
/// @throws InputError  no SP3 file, no epoch in it, a time that cannot be read; with line
[[nodiscard]] record::PreciseOrbits read_sp3(const std::vector<std::filesystem::path>& files);

}  // namespace coast::io
