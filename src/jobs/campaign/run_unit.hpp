#pragma once

#include <filesystem>
#include <string>

#include "campaign/unit_result.hpp"
#include "campaign/units.hpp"

namespace coast::jobs {

/// What became of a unit.
struct UnitOutcome {
  enum class State { kFound, kDone, kFailed, kUnwritten };
  State state = State::kDone;
  std::string error = {};  ///< of the last two
  UnitCost cost = {};
};

/// Computes one unit and stores its result, with its error if it fails. Any other trouble, such as a full disk, leaves no
/// result.
/// @param alone  nothing else runs: the memory of the process is that of the unit
[[nodiscard]] UnitOutcome run_unit(Campaign& campaign, const CampaignUnit& unit, bool alone);

/// Whether a unit has a result; whether that is an error. @throws InputError  it can have none: its input is wrong
[[nodiscard]] bool is_done(Campaign& campaign, const CampaignUnit& unit);
[[nodiscard]] bool has_failed(Campaign& campaign, const CampaignUnit& unit);

}  // namespace coast::jobs
