#pragma once
// Words of NovAtel's logs of positions. Private to the room.

#include <array>

#include "novatel_log.hpp"

namespace coast::io {

/// "Solution status".
inline constexpr std::array<NovAtelWord, 11> kSolutionStatus = {{{"SOL_COMPUTED", 0},
                                                                 {"INSUFFICIENT_OBS", 1},
                                                                 {"NO_CONVERGENCE", 2},
                                                                 {"SINGULARITY", 3},
                                                                 {"COV_TRACE", 4},
                                                                 {"TEST_DIST", 5},
                                                                 {"COLD_START", 6},
                                                                 {"V_H_LIMIT", 7},
                                                                 {"VARIANCE", 8},
                                                                 {"RESIDUALS", 9},
                                                                 {"INTEGRITY_WARNING", 13}}};

/// "Position or velocity type".
inline constexpr std::array<NovAtelWord, 41> kPositionType = {{{"NONE", 0},
                                                               {"FIXEDPOS", 1},
                                                               {"FIXEDHEIGHT", 2},
                                                               {"DOPPLER_VELOCITY", 8},
                                                               {"SINGLE", 16},
                                                               {"PSRDIFF", 17},
                                                               {"WAAS", 18},
                                                               {"SBAS", 18},
                                                               {"PROPAGATED", 19},
                                                               {"OMNISTAR", 20},
                                                               {"L1_FLOAT", 32},
                                                               {"IONOFREE_FLOAT", 33},
                                                               {"NARROW_FLOAT", 34},
                                                               {"L1_INT", 48},
                                                               {"WIDE_INT", 49},
                                                               {"NARROW_INT", 50},
                                                               {"RTK_DIRECT_INS", 51},
                                                               {"INS", 52},
                                                               {"INS_SBAS", 52},
                                                               {"INS_PSRSP", 53},
                                                               {"INS_PSRDIFF", 54},
                                                               {"INS_RTKFLOAT", 55},
                                                               {"INS_RTKFIXED", 56},
                                                               {"INS_OMNISTAR", 57},
                                                               {"INS_OMNISTAR_HP", 58},
                                                               {"INS_OMNISTAR_XP", 59},
                                                               {"OMNISTAR_HP", 64},
                                                               {"OMNISTAR_XP", 65},
                                                               {"CDGPS", 66},
                                                               {"EXT_CONSTRAINED", 67},
                                                               {"PPP_CONVERGING", 68},
                                                               {"PPP", 69},
                                                               {"OPERATIONAL", 70},
                                                               {"WARNING", 71},
                                                               {"OUT_OF_BOUNDS", 72},
                                                               {"INS_PPP_CONVERGING", 73},
                                                               {"INS_PPP", 74},
                                                               {"PPP_BASIC_CONVERGING", 77},
                                                               {"PPP_BASIC", 78},
                                                               {"INS_PPP_BASIC_CONVERGING", 79},
                                                               {"INS_PPP_BASIC", 80}}};

/// "Inertial solution status".
inline constexpr std::array<NovAtelWord, 14> kInsStatus = {{{"INS_INACTIVE", 0},
                                                            {"INS_ALIGNING", 1},
                                                            {"INS_HIGH_VARIANCE", 2},
                                                            {"INS_SOLUTION_NOT_GOOD", 2},  // OEM4 to OEM6
                                                            {"INS_SOLUTION_GOOD", 3},
                                                            {"INS_SOLUTION_FREE", 6},
                                                            {"INS_ALIGNMENT_COMPLETE", 7},
                                                            {"DETERMINING_ORIENTATION", 8},
                                                            {"WAITING_INITIALPOS", 9},
                                                            {"WAITING_AZIMUTH", 10},
                                                            {"INITIALIZING_BIASES", 11},
                                                            {"MOTION_DETECT", 12},
                                                            {"WAITING_ALIGNMENTORIENTATION", 14},
                                                            {"INS_BAD_GPS_AGREEMENT", 4}}};

}  // namespace coast::io
