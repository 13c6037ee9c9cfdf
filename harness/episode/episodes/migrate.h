// SPDX-License-Identifier: Apache-2.0
// Episode files of an older version of the format -> of this one. Tested by
// tests/harness/episode/episodes/migrate_test.cc
#pragma once

#include <string>

#include "harness/base/base/result.h"

namespace prehend::episode {

struct Migrated {
  std::size_t episodes = 0;
  std::size_t from_bytes = 0, to_bytes = 0;
};

/// Writes a new file with everything of the old one, which stays as it is. Each frame is read,
/// checked by the state hashes, and coded anew. On an error there is no new file.
Result<Migrated> MigrateFile(const std::string& old_file, const std::string& new_file,
                             const std::string& root);

}  // namespace prehend::episode
