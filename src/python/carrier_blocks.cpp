#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "blocks.hpp"
#include "coast/carrier/differences.hpp"
#include "coast/carrier/integer_least_squares.hpp"
#include "coast/carrier/orbits.hpp"
#include "coast/io/rinex.hpp"

namespace coast::python {

namespace py = pybind11;
namespace fs = std::filesystem;

namespace {

using Vectors = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class Number>
py::array_t<Number> array_of(const std::vector<Number>& values) {
  return py::array_t<Number>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::dict integer_least_squares(const Eigen::VectorXd& a, const Eigen::MatrixXd& Q, int count) {
  carrier::IntegerSolutions found;
  {
    const py::gil_scoped_release released;
    found = carrier::integer_least_squares(a, Q, count);
  }
  py::dict result;
  result["candidates"] = Eigen::MatrixXd(found.candidates.transpose());
  result["squared_norms"] = found.squared_norms;
  result["success_rate"] = found.success_rate;
  result["ratio"] = found.ratio();
  return result;
}

/// Without GLONASS, whose differences have ambiguities of several wavelengths.
carrier::DifferenceOptions options_with(const record::NavigationRecording& navigation, double elevation_mask) {
  carrier::DifferenceOptions options;
  options.systems.erase(record::SatelliteSystem::kGlonass);
  options.elevation_mask = elevation_mask;
  options.air.ionosphere = navigation.gps_ionosphere;
  return options;
}

py::dict single_points(const fs::path& observations, const std::vector<fs::path>& navigation, double elevation_mask) {
  std::vector<std::int64_t> time;
  std::vector<double> clock;
  std::vector<int> satellites;
  Vectors r, sd;
  {
    const py::gil_scoped_release released;
    const record::NavigationRecording messages = io::read_navigation(navigation);
    const record::ObservationRecording receiver = io::read_observations(observations, io::middle_of(messages));
    const auto points =
        carrier::single_points(receiver, carrier::BroadcastOrbits(messages), options_with(messages, elevation_mask));
    r.setConstant(static_cast<Eigen::Index>(points.size()), 3, kNone);
    sd = r;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      time.push_back(receiver.epochs[i].t.nanoseconds());
      clock.push_back(points[i] ? points[i]->clock_s : kNone);
      satellites.push_back(points[i] ? points[i]->satellites : 0);
      if (!points[i]) continue;
      r.row(row) = points[i]->r_e;
      sd.row(row) = points[i]->covariance_e.diagonal().cwiseSqrt();
    }
  }
  py::dict result;
  result["time_ns"] = array_of(time);
  result["r_e"] = r;
  result["sd_e"] = sd;
  result["clock"] = array_of(clock);
  result["satellites"] = array_of(satellites);
  return result;
}

/// Rows of double differences, each satellite's single difference minus that of the highest one of its system on its band.
struct DoubleDifferences {
  std::vector<std::int64_t> time;
  std::vector<std::string> satellite, reference, band;
  std::vector<double> code, phase, wavelength;
  std::vector<int> arc, reference_arc;

  void add(const carrier::DifferenceEpoch& epoch) {
    for (const carrier::SatelliteDifference& one : epoch.satellites)
      for (const carrier::BandDifference& own : one.bands) add(epoch, one, own);
  }

 private:
  struct Reference {
    const carrier::SatelliteDifference* satellite = nullptr;
    const carrier::BandDifference* band = nullptr;
  };
  static Reference reference_of(const carrier::DifferenceEpoch& epoch, const carrier::SatelliteDifference& of, char of_band) {
    Reference highest;
    for (const carrier::SatelliteDifference& one : epoch.satellites)
      for (const carrier::BandDifference& b : one.bands)
        if (one.satellite.system == of.satellite.system && b.band == of_band && b.phase &&
            (highest.satellite == nullptr || one.base_elevation > highest.satellite->base_elevation))
          highest = {&one, &b};
    return highest;
  }
  void add(const carrier::DifferenceEpoch& epoch, const carrier::SatelliteDifference& one, const carrier::BandDifference& own) {
    const Reference other = reference_of(epoch, one, own.band);
    if (other.satellite == nullptr || other.satellite == &one) return;
    const auto difference = [](const std::optional<double>& a, const std::optional<double>& b) {
      return a && b ? *a - *b : kNone;
    };
    time.push_back(epoch.t.nanoseconds());
    satellite.push_back(to_string(one.satellite));
    reference.push_back(to_string(other.satellite->satellite));
    band.emplace_back(1, own.band);
    code.push_back(difference(own.code, other.band->code));
    phase.push_back(difference(own.phase, other.band->phase));
    wavelength.push_back(own.wavelength());
    arc.push_back(own.arc);
    reference_arc.push_back(other.band->arc);
  }
};

py::dict double_differences(const fs::path& rover, const fs::path& base, const std::vector<fs::path>& navigation,
                            const Eigen::VectorXd& base_position, double elevation_mask) {
  if (base_position.size() != 3 || !base_position.allFinite())
    throw std::invalid_argument("base_position has 3 finite numbers");
  DoubleDifferences rows;
  {
    const py::gil_scoped_release released;
    const record::NavigationRecording messages = io::read_navigation(navigation);
    const record::ObservationRecording of_rover = io::read_observations(rover, io::middle_of(messages));
    const record::ObservationRecording of_base = io::read_observations(base, io::middle_of(messages));
    const carrier::DifferenceOptions options = options_with(messages, elevation_mask);
    const Eigen::Vector3d at = base_position;
    for (const carrier::DifferenceEpoch& epoch : carrier::form_differences(
             of_rover, of_base, carrier::choose_signals(of_rover, of_base, options.systems), carrier::BroadcastOrbits(messages),
             [at](geo::GpsTime) { return std::optional(at); }, options))
      rows.add(epoch);
  }
  py::dict result;
  result["time_ns"] = array_of(rows.time);
  result["satellite"] = rows.satellite;
  result["reference"] = rows.reference;
  result["band"] = rows.band;
  result["code"] = array_of(rows.code);
  result["phase"] = array_of(rows.phase);
  result["wavelength"] = array_of(rows.wavelength);
  result["arc"] = array_of(rows.arc);
  result["reference_arc"] = array_of(rows.reference_arc);
  return result;
}

}  // namespace

void register_carrier_blocks(py::module_& module) {
  module.def("integer_least_squares", &integer_least_squares);
  module.def("single_points", &single_points);
  module.def("double_differences", &double_differences);
}

}  // namespace coast::python
