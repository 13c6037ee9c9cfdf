// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/import_poses.h: what is read, what a recording has before its
// frames, and what is told of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/import/import_poses.h"
#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kLongestEpisode = 64;  ///< of the recording format

std::string EpisodeName(const ImportMap& map, const std::string& path) {
  if (!map.episode.empty()) return map.episode;
  std::string name = std::filesystem::path(path).stem().string();
  for (char& c : name) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_plain) c = '_';
  }
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name = "take_" + name;
  // Takes differ at the beginning or at the end, by date or by number.
  if (name.size() > kLongestEpisode) name.erase(kLongestEpisode / 2, name.size() - kLongestEpisode);
  return name;
}

}  // namespace

episode::EpisodeHeader HeaderOf(const MapFile& file, const std::string& poses_path) {
  const ImportMap& map = file.map;
  episode::EpisodeHeader header;
  header.episode = EpisodeName(map, poses_path);
  header.grammar = map.grammar.value;
  if (file.document.root.Find("grammar"))
    header.grammar_named = ErrorAt(file.document, map.grammar.where);
  header.bridge_s = map.bridge_s;
  header.entity_table.ticks_per_second = map.ticks_per_second;
  for (const Named<MappedEntity>& entity : map.entities) {
    const MappedEntity& e = entity.value;
    grammar::EntityInfo& info = header.entity_table.entities.emplace_back();
    info.name = entity.name;
    info.half_size_m = e.size_m / 2;
    if (e.part_of)
      info.part_of = static_cast<int>(
          std::ranges::find(map.entities, e.part_of->value, &Named<MappedEntity>::name) -
          map.entities.begin());
    if (e.hand) {
      info.classes = {"Hand", "Entity"};
      info.sensor_sets = {"fingers", "thumb", "palm"};
    } else {
      info.classes = RootsOf(e);
      info.classes.insert(info.classes.begin(), e.class_name.value);
    }
  }
  return header;
}

std::vector<std::string> UnknownOfBodies(const ImportMap& map, const PoseFile& file) {
  std::vector<std::string> texts;
  if (!file.has_orientations)
    texts.push_back(
        fmt::format("the file has positions only, of {} {}, and no orientations: every tilt(..) "
                    "is 0, so no pouring is recognised, hold_tips cannot tell what is tipped in a "
                    "hand from what was put down, and up is always up in a thing (boxes, offset_m)",
                    file.bodies.size(), file.bodies.size() == 1 ? "body" : "bodies"));
  std::vector<std::string> names, flat;
  bool has_hand = false;
  for (const Named<MappedEntity>& entity : map.entities) {
    has_hand |= entity.value.hand;
    if (entity.value.guesses_size) names.push_back("'" + entity.name + "'");
    if (!entity.value.hand && (entity.value.size_m.array() == 0).any())
      flat.push_back("'" + entity.name + "'");
  }
  if (!has_hand)
    texts.push_back(
        "no entity is a hand (hand: true), so nothing is reached for, grasped or moved by one");
  if (!flat.empty())
    texts.push_back(
        fmt::format("size_m has an edge of 0 m, and to be filled in, of {}: things rest on and "
                    "touch what has a size",
                    fmt::join(flat, ", ")));
  if (!names.empty())
    texts.push_back(
        fmt::format("size_m is unknown, and to be filled in, of {}: a box as such things often "
                    "are is assumed",
                    fmt::join(names, ", ")));
  return texts;
}

std::string ImportTable(const Imported& imported) {
  const episode::Recording& episode = imported.episode;
  std::string table = fmt::format("{}: {}, {:.3f} s\n", episode.header.episode,
                                  grammar::CountOf(imported.frames, "frame"), imported.duration_s);
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

Result<MapFile> ReadMapFor(const std::string& poses_path, PoseFormat format,
                           Result<YamlDocument> map) {
  if (format == PoseFormat::kCsv) return ReadMapOfTable(std::move(map), poses_path);
  if (format != PoseFormat::kC3d) return ReadImportMap(std::move(map), format);
  PREHEND_TRY(TableLayout layout, LayoutOfC3d(poses_path));  // it says its unit and rate
  return ReadMapWith(std::move(map), format, std::move(layout));
}

Result<PoseFile> ReadPoses(const std::string& poses_path, PoseFormat format, const MapFile& map) {
  using Reader = Result<PoseFile> (*)(const std::string&, const MapFile&);
  constexpr std::array<Reader, 7> kReaders = {ReadCsvPoses,  ReadBvhPoses, ReadMcapPoses, nullptr,
                                              ReadJsonPoses, ReadNpzPoses, ReadC3dPoses};
  return kReaders.at(static_cast<std::size_t>(format))(poses_path, map);
}

Result<Imported> ImportPoses(const std::string& poses_path, const std::string& map_path) {
  PREHEND_TRY(const PoseFormat format, PoseFormatOf(poses_path));
  if (format == PoseFormat::kHdf5)
    return tl::unexpected(ErrorOfFile(
        poses_path, "demonstrations in HDF5 are imported alone: all of one file in one call"));
  PREHEND_TRY(const MapFile map, ReadMapFor(poses_path, format, ReadYamlFile(map_path)));
  PREHEND_TRY(PoseFile poses, ReadPoses(poses_path, format, map));
  return ImportPoses(std::move(poses), map);
}

}  // namespace prehend::exchange
