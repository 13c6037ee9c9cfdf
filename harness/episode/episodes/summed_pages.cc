// SPDX-License-Identifier: Apache-2.0
#include <sqlite3.h>

#include <array>
#include <cstring>
#include <new>
#include <string_view>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/database.h"

namespace prehend::episode {
namespace {

constexpr int kMostPageBytes = 65536;
constexpr int kHeaderBytes = 100;  ///< of the database, at the begin of its first page

/// An open database; behind it in memory lies the file of the file system below.
struct SummedFile {
  sqlite3_file base;
  int page_bytes;  ///< 0: not known yet, or without checksums
};

sqlite3_file* Below(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<SummedFile*>(file) + 1);
}

/// Of a database with this header; 0 if its pages have no checksums.
int SummedPageBytes(const unsigned char* header) {
  const int bytes = header[16] << 8 | header[17];
  const std::int64_t application =
      std::int64_t{header[68]} << 24 | header[69] << 16 | header[70] << 8 | header[71];
  if (header[20] != kBytesOfSum && application != kApplicationId) return 0;
  return bytes == 1 ? kMostPageBytes : bytes;
}

std::array<unsigned char, kBytesOfSum> SumOf(const unsigned char* page, int bytes,
                                             sqlite3_int64 offset) {
  const std::string_view summed(reinterpret_cast<const char*>(page),
                                static_cast<std::size_t>(bytes - kBytesOfSum));
  std::uint64_t sum = ContentHashAt(static_cast<std::uint64_t>(offset), summed);
  std::array<unsigned char, kBytesOfSum> stored{};
  for (unsigned char& byte : stored) {
    byte = static_cast<unsigned char>(sum);
    sum >>= 8;
  }
  return stored;
}

bool HasItsSum(const unsigned char* page, int bytes, sqlite3_int64 offset) {
  const auto sum = SumOf(page, bytes, offset);
  return std::memcmp(page + bytes - kBytesOfSum, sum.data(), sum.size()) == 0;
}

int Read(sqlite3_file* file, void* to, int amount, sqlite3_int64 offset) {
  sqlite3_file* below = Below(file);
  int& page_bytes = reinterpret_cast<SummedFile*>(file)->page_bytes;
  const int code = below->pMethods->xRead(below, to, amount, offset);
  if (code != SQLITE_OK) return code;
  const auto* bytes = static_cast<const unsigned char*>(to);
  if (offset == 0 && amount >= kHeaderBytes) page_bytes = SummedPageBytes(bytes);
  // The header alone is read before the file is locked, to know how long a page is.
  if (page_bytes == 0 || offset + amount <= kHeaderBytes) return SQLITE_OK;
  if (amount == page_bytes) return HasItsSum(bytes, amount, offset) ? SQLITE_OK : SQLITE_IOERR_DATA;
  std::array<unsigned char, kMostPageBytes> page;
  const sqlite3_int64 begin = offset - offset % page_bytes;
  if (offset + amount > begin + page_bytes) return SQLITE_IOERR_DATA;  // SQLite never does
  const int whole = below->pMethods->xRead(below, page.data(), page_bytes, begin);
  if (whole != SQLITE_OK) return whole;
  return HasItsSum(page.data(), page_bytes, begin) ? SQLITE_OK : SQLITE_IOERR_DATA;
}

int Write(sqlite3_file* file, const void* from, int amount, sqlite3_int64 offset) {
  sqlite3_file* below = Below(file);
  int& page_bytes = reinterpret_cast<SummedFile*>(file)->page_bytes;
  const auto* bytes = static_cast<const unsigned char*>(from);
  if (offset == 0 && amount >= kHeaderBytes) page_bytes = SummedPageBytes(bytes);
  if (page_bytes == 0 || amount != page_bytes)
    return below->pMethods->xWrite(below, from, amount, offset);
  std::array<unsigned char, kMostPageBytes> page;
  std::memcpy(page.data(), bytes, static_cast<std::size_t>(amount - kBytesOfSum));
  const auto sum = SumOf(bytes, amount, offset);
  std::memcpy(page.data() + amount - kBytesOfSum, sum.data(), sum.size());
  return below->pMethods->xWrite(below, page.data(), amount, offset);
}

/// What is left to the file system below.
template <auto method, typename... Arguments>
auto Pass(sqlite3_file* file, Arguments... arguments) {
  sqlite3_file* below = Below(file);
  return (below->pMethods->*method)(below, arguments...);
}

using Methods = sqlite3_io_methods;

/// Files are not mapped into memory, where nobody sees what is read, and have no -wal and -shm
/// beside them: both need a higher version.
constexpr Methods kMethods = {
    .iVersion = 1,
    .xClose = Pass<&Methods::xClose>,
    .xRead = Read,
    .xWrite = Write,
    .xTruncate = Pass<&Methods::xTruncate, sqlite3_int64>,
    .xSync = Pass<&Methods::xSync, int>,
    .xFileSize = Pass<&Methods::xFileSize, sqlite3_int64*>,
    .xLock = Pass<&Methods::xLock, int>,
    .xUnlock = Pass<&Methods::xUnlock, int>,
    .xCheckReservedLock = Pass<&Methods::xCheckReservedLock, int*>,
    .xFileControl = Pass<&Methods::xFileControl, int, void*>,
    .xSectorSize = Pass<&Methods::xSectorSize>,
    .xDeviceCharacteristics = Pass<&Methods::xDeviceCharacteristics>,
};

sqlite3_vfs* SystemBelow(sqlite3_vfs* system) {
  return static_cast<sqlite3_vfs*>(system->pAppData);
}

int Open(sqlite3_vfs* system, sqlite3_filename name, sqlite3_file* file, int flags, int* opened) {
  sqlite3_vfs* below = SystemBelow(system);
  // Journals have checksums of SQLite's own.
  if ((flags & SQLITE_OPEN_MAIN_DB) == 0) return below->xOpen(below, name, file, flags, opened);
  new (file) SummedFile{.base = {.pMethods = nullptr}, .page_bytes = 0};
  const int code = below->xOpen(below, name, Below(file), flags, opened);
  if (Below(file)->pMethods) file->pMethods = &kMethods;
  return code;
}

template <auto method, typename... Arguments>
auto PassOn(sqlite3_vfs* system, Arguments... arguments) {
  sqlite3_vfs* below = SystemBelow(system);
  return (below->*method)(below, arguments...);
}

/// SQLite's own file system, with databases that are opened here. SQLite keeps it in a list.
struct System {
  using Vfs = sqlite3_vfs;
  Vfs* below = sqlite3_vfs_find(nullptr);
  Vfs vfs = {
      .iVersion = 2,
      .szOsFile = below->szOsFile + static_cast<int>(sizeof(SummedFile)),
      .mxPathname = below->mxPathname,
      .pNext = nullptr,
      .zName = "summed_pages",
      .pAppData = below,
      .xOpen = Open,
      .xDelete = PassOn<&Vfs::xDelete, const char*, int>,
      .xAccess = PassOn<&Vfs::xAccess, const char*, int, int*>,
      .xFullPathname = PassOn<&Vfs::xFullPathname, const char*, int, char*>,
      .xDlOpen = PassOn<&Vfs::xDlOpen, const char*>,
      .xDlError = PassOn<&Vfs::xDlError, int, char*>,
      .xDlSym = nullptr,  // nothing is loaded
      .xDlClose = PassOn<&Vfs::xDlClose, void*>,
      .xRandomness = PassOn<&Vfs::xRandomness, int, char*>,
      .xSleep = PassOn<&Vfs::xSleep, int>,
      .xCurrentTime = PassOn<&Vfs::xCurrentTime, double*>,
      .xGetLastError = PassOn<&Vfs::xGetLastError, int, char*>,
      .xCurrentTimeInt64 = PassOn<&Vfs::xCurrentTimeInt64, sqlite3_int64*>,
      .xSetSystemCall = nullptr,
      .xGetSystemCall = nullptr,
      .xNextSystemCall = nullptr,
  };

  System() { sqlite3_vfs_register(&vfs, 0); }
};

}  // namespace

const char* SummedPages() {
  static System system;
  return system.vfs.zName;
}

}  // namespace prehend::episode
