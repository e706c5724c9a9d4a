#pragma once
// Counts heap allocations of the scope it lives in.

namespace coast::test {

/// `const MallocGuard guard; work(); EXPECT_EQ(guard.allocations(), 0)`: every malloc, calloc, realloc and operator new of this
/// thread since construction. Under the sanitizers, which have their own malloc, nothing is counted.
class MallocGuard {
 public:
  MallocGuard();
  [[nodiscard]] long allocations() const;
  [[nodiscard]] static bool counts();  ///< not under the sanitizers

 private:
  long before_;
};

}  // namespace coast::test
