// SPDX-License-Identifier: Apache-2.0
// Memory for what is long: its pages are those of a file without a name, so that nothing of it has
// to stay in memory until it is looked at again. Tested by
// tests/harness/base/base/paged_memory_test.cc
#pragma once

#include <cstddef>
#include <vector>

namespace prehend {

/// Of less than a megabyte they are usual memory.
void* NewPages(std::size_t bytes);
void DeletePages(void* pages, std::size_t bytes);
void LetGoOfPages(const void* pages, std::size_t bytes);

template <class T>
struct PagedAllocator {
  using value_type = T;
  PagedAllocator() = default;
  template <class U>
  PagedAllocator(const PagedAllocator<U>&) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t count) { return static_cast<T*>(NewPages(count * sizeof(T))); }
  void deallocate(T* all, std::size_t count) { DeletePages(all, count * sizeof(T)); }
  bool operator==(const PagedAllocator&) const { return true; }
};

template <class T>
using PagedVector = std::vector<T, PagedAllocator<T>>;

/// It takes no memory until it is looked at again.
template <class T>
void LetGo(const PagedVector<T>& all) {
  LetGoOfPages(all.data(), all.capacity() * sizeof(T));
}

}  // namespace prehend
