#pragma once
// What trajectory writers of text share; private to the room.

#include "../text_buffer.hpp"
#include "coast/io/writers.hpp"

namespace coast::io {

/// A trajectory as text in one file, which appears when it is closed.
class TextTrajectory : public TrajectoryWriter {
 public:
  explicit TextTrajectory(const std::filesystem::path& path) : file_(path), text_(file_) {}
  void close() override {
    finish();
    text_.flush();
    file_.commit();
  }

 protected:
  [[nodiscard]] TextBuffer& text() { return text_; }
  /// What stands behind the last epoch.
  virtual void finish() {}

 private:
  AtomicFile file_;
  TextBuffer text_;
};

}  // namespace coast::io
