// `.nav` of KF-GINS: week sow lat lon h vn ve vd roll pitch yaw. Some 1 million epochs/s.

#include "../state_columns.hpp"
#include "coast/geo/units.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class NavWriter final : public TextTrajectory {
 public:
  explicit NavWriter(const std::filesystem::path& path) : TextTrajectory(path) {}

  void write(const record::TrajectoryEpoch& epoch) override {
    const LocalState s = local_state(epoch.nav);
    text().put_integer(epoch.nav.t.week(), 4);
    text().put(' ');
    text().put_fixed(epoch.nav.t.sow(), 9, 16);
    text().put(' ');
    text().put_fixed(s.p.latitude / geo::kDegree, 11, 15);
    text().put(' ');
    text().put_fixed(s.p.longitude / geo::kDegree, 11, 16);
    text().put(' ');
    text().put_fixed(s.p.height, 5, 11);
    for (const double v : s.v_eb_n) {
      text().put(' ');
      text().put_fixed(v, 6, 11);
    }
    for (const double angle : {s.attitude.roll, s.attitude.pitch, s.attitude.yaw}) {
      text().put(' ');
      text().put_fixed(angle / geo::kDegree, 9, 14);
    }
    text().end_line();
  }
};

}  // namespace

TrajectoryFormat nav_trajectory() {
  TrajectoryFormat format{"nav", "KF-GINS text: week, seconds of week, position, velocity, attitude"};
  format.velocity = format.attitude = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions&) { return std::make_unique<NavWriter>(file); };
  return format;
}

}  // namespace coast::io
