#pragma once
// Loops on all cores. Of no room: as src/eigen/, for all of them.

#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_group.h>

#include <cstddef>
#include <utility>

// oneTBB's loops, each done whole or ended by an exception. Called as they are, a loop inside a task also ends, and silently,
// when a task beside that one has failed: its results are incomplete, and the code behind it reads them. A group that is not
// bound to the outer one goes on.
namespace coast {

template <class... Arguments>
void parallel_for(Arguments&&... arguments) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_for(std::forward<Arguments>(arguments)..., own);
}

template <class... Arguments>
void parallel_for_each(Arguments&&... arguments) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_for_each(std::forward<Arguments>(arguments)..., own);
}

template <class... Functions>
void parallel_invoke(Functions&&... functions) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_invoke(std::forward<Functions>(functions)..., own);
}

template <class Filters>
void parallel_pipeline(std::size_t most_tokens, const Filters& filters) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_pipeline(most_tokens, filters, own);
}

}  // namespace coast
