// SPDX-License-Identifier: Apache-2.0
// The allocation functions of C do as `new` does: who is refused memory is told by the new handler,
// when there is one. They take the place of the C library's for the whole program, its libraries
// included, and get their memory from it. Tested by tests/harness/worker_pool_test.cc
#include "harness/refused_memory.h"

#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <new>

namespace prehend::harness {

void ExitWhenMemoryIsRefused() {
  std::set_new_handler([] { _exit(kMemoryWasRefused); });
}

}  // namespace prehend::harness

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PREHEND_HAS_OTHER_ALLOCATOR
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define PREHEND_HAS_OTHER_ALLOCATOR
#endif

#ifndef PREHEND_HAS_OTHER_ALLOCATOR

// The C library's own, by names that nobody replaces.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* old, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);

namespace {

void* Told(void* memory, bool wanted) {
  if (memory != nullptr || !wanted) return memory;
  if (const std::new_handler handler = std::get_new_handler()) handler();
  return nullptr;
}

}  // namespace

extern "C" void* malloc(std::size_t size) noexcept { return Told(__libc_malloc(size), true); }

extern "C" void* calloc(std::size_t count, std::size_t size) noexcept {
  return Told(__libc_calloc(count, size), true);
}

extern "C" void* realloc(void* old, std::size_t size) noexcept {
  return Told(__libc_realloc(old, size), size > 0);
}

extern "C" void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return Told(__libc_memalign(alignment, size), true);
}

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

extern "C" int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  const bool is_power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!is_power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* const got = memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *memory = got;
  return 0;
}

#endif
