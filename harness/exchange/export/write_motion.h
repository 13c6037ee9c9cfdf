// SPDX-License-Identifier: Apache-2.0
// Motion in the formats of other programs (docs/episodes.md). Tested by
// tests/program/exported.py
#pragma once

#include <ostream>
#include <string>

#include "harness/exchange/export/motion.h"

namespace prehend::exchange {

void WriteLines(const Motion& motion, std::ostream& out);
void WriteCsv(const Motion& motion, std::ostream& out);
void WriteNpz(const Motion& motion, std::ostream& out);
/// Returns the metadata.yaml that rosbag2 wants beside it. `name`: of the file.
std::string WriteMcap(const Motion& motion, const std::string& name, std::ostream& out);

/// Events with their UUIDs, a row for each.
std::string EventsCsv(const Motion& motion);
/// The roles of an event, as JSON.
std::string RolesJson(const grammar::NamedEvent& event);
/// The map with which `import` reads the poses again. `ending`: .csv or .mcap.
std::string MapText(const Motion& motion, const std::string& ending);
/// The frame of coordinates that is the world's; no entity is called so.
std::string WorldName(const grammar::EntityTable& table);

}  // namespace prehend::exchange
