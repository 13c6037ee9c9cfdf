// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/import_poses.h. Tested by tests/program/import_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/exchange/import/import_poses.h"

namespace prehend::exchange {

std::string ImportTable(const Imported& imported) {
  const episode::Recording& episode = imported.episode;
  std::string table = fmt::format("{}: {} frames, {:.3f} s\n", episode.header.episode,
                                  episode.frames.size(), imported.duration_s);
  std::size_t width = 16;
  for (const EntityReport& one : imported.entities) width = std::max(width, one.from.size());
  table += fmt::format("{:<16} {:<{}} {:>7} {:>7} {:>8} {:>9} {:>5} {:>7}  {:<14} {:<14} {}\n",
                       "entity", "from", width, "poses", "Hz", "bridged", "s", "lost", "s", "x, m",
                       "y, m", "z, m");
  for (const EntityReport& one : imported.entities) {
    const auto range = [&](int axis) {
      return fmt::format("{:.2f}..{:.2f}", one.extent.min()[axis], one.extent.max()[axis]);
    };
    table += fmt::format(
        "{:<16} {:<{}} {:>7} {:>7.1f} {:>8} {:>9.3f} {:>5} {:>7.3f}  {:<14} {:<14} {}\n", one.name,
        one.from.empty() ? "(the map)" : one.from, width, one.poses, one.rate_hz, one.bridged,
        one.bridged_s, one.lost, one.lost_s, range(0), range(1), range(2));
  }
  table += imported.openings;
  for (const EntityReport& one : imported.entities) {
    if (!one.axes) continue;
    const double sign = one.axes->w() < 0 ? -1 : 1;
    // Without "-0.00000".
    const Eigen::Vector4d q = (one.axes->coeffs() * (1e5 * sign)).array().round() / 1e5 + 0.0;
    table += fmt::format(
        "{}: upright_at_s of this file is axes_quat_wxyz: [{:.5f}, {:.5f}, {:.5f}, {:.5f}]\n",
        one.name, q.w(), q.x(), q.y(), q.z());
  }
  return table;
}

}  // namespace prehend::exchange
