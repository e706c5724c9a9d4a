#pragma once
// For loops of oneTBB inside the tasks of other loops.

#include <tbb/task_group.h>

namespace coast {

/// `OwnGroup().group()` as the last argument of tbb::parallel_for and its like. Where a task fails, oneTBB ends the tasks
/// beside it, and with them the loops inside those, without an exception: their results would be incomplete and would be used.
/// In a group of its own a loop is done whole, or throws.
class OwnGroup {
 public:
  [[nodiscard]] tbb::task_group_context& group() { return context_; }

 private:
  tbb::task_group_context context_{tbb::task_group_context::isolated};
};

}  // namespace coast
