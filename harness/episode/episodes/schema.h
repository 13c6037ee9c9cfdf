// SPDX-License-Identifier: Apache-2.0
// The tables of an episode file (docs/episodes.md), and which files are such. Tested by
// tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <cstdint>
#include <string>

#include "harness/episode/episodes/database.h"

namespace prehend::episode {

inline constexpr std::int64_t kSchemaVersion = 1;  ///< of the format

/// Of files that are parts of something larger (harness/episode/episodes/plan.h); made when they
/// are needed.
extern const char* const kPlanTables;

/// Whether a file is meant to be an episode file: it is an SQLite database, or does not exist yet
/// and ends with `.episodes`.
bool IsEpisodeFile(const std::string& path);

/// Opens a file for writing; creates it with its tables if it is not there. Throws DatabaseError.
Database OpenToWrite(const std::string& path);

/// Opens a file for reading. Throws DatabaseError with the reason why it is no episode file.
Database OpenToRead(const std::string& path);

/// A random one (version 4, RFC 9562).
std::string NewUuid();
/// The same for the same text (version 8).
std::string UuidOf(const std::string& text);
/// Of the event that stands at this place of an episode's timeline.
std::string UuidOfEvent(const std::string& episode_uuid, std::size_t index);

}  // namespace prehend::episode
