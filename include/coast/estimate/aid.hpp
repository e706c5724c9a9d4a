#pragma once
// Aiding sensors: measurements besides GNSS, each kind in one file of src/estimate/aids and one line of the table of kinds.

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/estimate/filter_state.hpp"
#include "coast/estimate/update.hpp"
#include "coast/record/aid.hpp"
#include "coast/record/gnss.hpp"

namespace coast::estimate {

/// An aiding sensor's measurement model. Immutable: what depends on the recording is in its samples.
class Aid {
 public:
  Aid() = default;
  Aid(const Aid&) = delete;
  Aid& operator=(const Aid&) = delete;
  virtual ~Aid() = default;

  /// Errors of the sensor that the filter estimates, e.g. the scale factor of an odometer.
  [[nodiscard]] virtual std::vector<AidState> states() const { return {}; }
  /// The samples of the filter from the rows of the file: SI units, standard deviations filled in, at the rate that the filter
  /// uses. Constants that the configuration leaves open (scale of an odometer, its delay, zero of a barometer) are found from
  /// the fixes and told as events.
  /// @param gnss  fixes at their times of validity
  /// @throws InputError  nothing of it can be used
  [[nodiscard]] virtual std::vector<record::AidSample> samples(const record::AidRecording& rows,
                                                               const record::GnssRecording& gnss,
                                                               record::Events& told) const = 0;
  /// @param first_state  index of the first of its states
  /// @return  nothing if the sample does not apply at this state
  [[nodiscard]] virtual std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                            const UpdateContext& context, int first_state) const = 0;
};

/// An aid with its samples. Copies share both.
struct AidStream {
  std::string name;  ///< of the kind, with a number where there are several
  std::shared_ptr<const Aid> aid;
  std::shared_ptr<const std::vector<record::AidSample>> samples;  ///< ascending in time
};
/// In mirrored time. No measured quantity changes its sign: speeds are unsigned, the others are positions and directions.
[[nodiscard]] std::vector<AidStream> reversed(const std::vector<AidStream>& aids, geo::GpsTime mirror);

/// A kind of aid, for the configuration.
struct AidKind {
  std::string_view name;                     ///< `kind:` of the configuration, e.g. "odometer"
  std::vector<std::string_view> columns;     ///< default names of the values' columns, 1 to 3
  std::vector<std::string_view> sd_columns;  ///< default names of their standard deviations, used where the header has them
  /// @param node  the aid's map; keys of the file are read elsewhere
  std::function<std::shared_ptr<const Aid>(const config::Node& node)> from;
};
[[nodiscard]] const std::vector<AidKind>& aid_kinds();

}  // namespace coast::estimate
