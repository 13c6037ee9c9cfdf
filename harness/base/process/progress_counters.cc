// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/progress_counters.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

namespace prehend {

ProgressCounters::ProgressCounters(std::size_t count) : count_(std::max<std::size_t>(1, count)) {
  static_assert(Tick::is_always_lock_free);  // otherwise it would not work between processes
  void* memory = mmap(nullptr, count_ * sizeof(Tick), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  ticks_ = static_cast<Tick*>(memory);
  for (std::size_t i = 0; i < count_; ++i) new (&ticks_[i]) Tick(kNone);
}

ProgressCounters::~ProgressCounters() { munmap(ticks_, count_ * sizeof(Tick)); }

}  // namespace prehend
