// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/paged_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <new>

namespace prehend {
namespace {

constexpr std::size_t kLeastBytes = 1 << 20;

/// A file without a name; where there is no room for one, such a file in memory.
int NewFile(std::size_t bytes) {
  std::error_code error;
  const std::string folder = std::filesystem::temp_directory_path(error).string();
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 && posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0) return file;
  if (file >= 0) close(file);
  const int in_memory = memfd_create("pages", MFD_CLOEXEC);
  if (in_memory < 0 || ftruncate(in_memory, static_cast<off_t>(bytes)) != 0) throw std::bad_alloc();
  return in_memory;
}

}  // namespace

void* NewPages(std::size_t bytes) {
  if (bytes < kLeastBytes) return ::operator new(bytes);
  const int file = NewFile(bytes);
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
