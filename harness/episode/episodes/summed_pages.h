// SPDX-License-Identifier: Apache-2.0
// Checksums of an episode file: each page of the database ends with a hash of the rest of it and of
// its place. So whatever is read was written so, rows, indices and tables alike. SQLite itself
// keeps its hands off the end of a page where a database asks for it when it is made, so that every
// program can read the file. Tested by tests/program/damaged_episodes_test.cc
#pragma once

#include <cstddef>
#include <cstdint>

namespace prehend::episode {

/// Of an episode file, in its header ("preh").
inline constexpr std::int64_t kApplicationId = 0x70726568;
/// Of each page, for its checksum.
inline constexpr int kBytesOfSum = 8;

/// The name of a file system of SQLite that writes checksums and compares them; a page that does
/// not have its own cannot be read (SQLITE_IOERR_DATA). Databases of other programs, which have
/// neither room for them nor the application id of an episode file, are read as they are.
const char* SummedPages();

}  // namespace prehend::episode
