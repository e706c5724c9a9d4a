#include "support/malloc_guard.hpp"

#include <cstddef>

namespace {
// What malloc does has no other place to be kept.
thread_local long allocations_so_far = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
}  // namespace

#ifdef COAST_COUNT_ALLOCATIONS
// glibc's own entries stand behind ours; operator new and Eigen come through malloc.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the names are glibc's
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++allocations_so_far;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocations_so_far;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  ++allocations_so_far;
  return __libc_realloc(old, size);
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
#endif

namespace coast::test {

bool MallocGuard::counts() {
#ifdef COAST_COUNT_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

MallocGuard::MallocGuard() : before_(allocations_so_far) {}
long MallocGuard::allocations() const {
  return allocations_so_far - before_;
}

}  // namespace coast::test
