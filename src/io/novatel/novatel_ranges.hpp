#pragma once
// Measurements of NovAtel's logs of ranges, in one form. Private to the room.

#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "novatel_log.hpp"
#include "novatel_signals.hpp"

namespace coast::io {

/// One signal at one epoch.
struct NovAtelRange {
  record::Satellite satellite;
  record::Signal signal;
  std::optional<double> code_m;
  std::optional<double> phase_cycles;  ///< grows with range
  std::optional<double> doppler_hz;
  double cn0_dbhz = 0.0;
  double lock_s = 0.0, lock_up_to_s = 0.0;  ///< tracked without interruption for a time between these
  bool half_cycle_known = true, half_cycle_added = false;
  std::optional<int> glonass_channel;
};

/// The measurements of one log.
struct NovAtelRanges {
  std::vector<NovAtelRange> ranges;
  long unknown = 0;    ///< of a satellite or a signal without a name here
  long reference = 0;  ///< differences from an epoch that is not there (RANGECMP4)
  bool whole = true;   ///< false: the body contradicts itself
};

inline constexpr double kNovAtelLightSpeed = 299792458.0;                        ///< m/s
inline constexpr int kNovAtelChannelOffset = 7;                                  ///< of the frequency number of GLONASS
inline constexpr double kEndlessLock = std::numeric_limits<double>::infinity();  ///< the field of the lock time is at its end

[[nodiscard]] bool is_range_log(std::uint32_t id);

/// What differences of RANGECMP4 are from.
struct RangeReference {
  unsigned id = 0;
  int glonass_channel = 0;
  double code_m = 0.0, phase_m = 0.0, rate_mps = 0.0;
};
using RangeReferences = std::map<std::pair<record::Satellite, record::Signal>, RangeReference>;

/// The packed part of RANGECMP4, or of RANGECMP5, whose numbers have other widths.
/// @param since_s     since the last whole second of GPS time, of which the references are
/// @param references  as seen so far
[[nodiscard]] NovAtelRanges decode_rangecmp4(std::string_view bytes, bool five, double since_s, RangeReferences& references);

/// Decodes RANGE, RANGECMP, RANGECMP2, RANGECMP4 and RANGECMP5.
class NovAtelRangeDecoder {
 public:
  [[nodiscard]] NovAtelRanges decode(const NovAtelLog& log);

 private:
  std::map<int, int> channels_;  ///< of GLONASS by slot, as seen so far
  RangeReferences references_;
};

}  // namespace coast::io
