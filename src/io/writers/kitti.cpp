// KITTI odometry poses: the first three rows of the 4 x 4 matrix that takes the axes of a camera (right, down, forward) to
// those of the first pose. The times stand in a file beside it, seconds since the first.

#include <Eigen/Geometry>

#include "../text_buffer.hpp"
#include "local_pose.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class KittiWriter final : public TrajectoryWriter {
 public:
  KittiWriter(const std::filesystem::path& poses, const std::filesystem::path& times)
      : file_(poses), text_(file_), times_file_(times), times_(times_file_) {}

  void write(const record::TrajectoryEpoch& epoch) override {
    const Eigen::Matrix3d C_s_e = epoch.nav.q_b_e.toRotationMatrix() * right_down_forward();
    if (!first_) first_ = First{epoch.nav.t, epoch.nav.r_eb_e, C_s_e.transpose()};
    Eigen::Matrix<double, 3, 4> pose;
    pose << first_->C_e_s * C_s_e, first_->C_e_s * (epoch.nav.r_eb_e - first_->r_e);
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < 4; ++j) {
        if (i + j > 0) text_.put(' ');
        text_.put_fixed(pose(i, j), j == 3 ? 6 : 12);
      }
    text_.end_line();
    times_.put_fixed(epoch.nav.t - first_->t, 9);
    times_.end_line();
  }
  void close() override {
    text_.flush();
    times_.flush();
    file_.commit();
    times_file_.commit();
  }

 private:
  struct First {
    geo::GpsTime t;
    Eigen::Vector3d r_e;
    Eigen::Matrix3d C_e_s;
  };
  AtomicFile file_;
  TextBuffer text_;
  AtomicFile times_file_;
  TextBuffer times_;
  std::optional<First> first_;
};

}  // namespace

TrajectoryFormat kitti_trajectory() {
  TrajectoryFormat format{"kitti", "KITTI odometry poses, and their times beside it"};
  format.companion = "times";
  format.attitude = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions&) {
    return std::make_unique<KittiWriter>(file, companion_of(file, "times"));
  };
  return format;
}

}  // namespace coast::io
