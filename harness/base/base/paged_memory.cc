// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/paged_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <new>

namespace prehend {

static constexpr std::size_t kLeastBytes = 1 << 20;

void* NewPages(std::size_t bytes) {
  if (bytes < kLeastBytes) return ::operator new(bytes);
  const auto size = static_cast<off_t>(bytes);
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0 || posix_fallocate(file, 0, size) != 0) {  // no room there: in memory
    close(file);
    file = memfd_create("pages", MFD_CLOEXEC);
    if (ftruncate(file, size) != 0) throw std::bad_alloc();
  }
  void* const pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  return pages;
}

void DeletePages(void* pages, std::size_t bytes) {
  if (bytes < kLeastBytes)
    ::operator delete(pages);
  else
    munmap(pages, bytes);
}

void LetGoOfPages(const void* pages, std::size_t bytes) {
  if (bytes >= kLeastBytes) madvise(const_cast<void*>(pages), bytes, MADV_DONTNEED);
}

}  // namespace prehend
