// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/arrays/read_hdf5_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/hdf5/hdf5_file.h"
#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {
namespace {

/// Words, or JSON with words in it, as in LIBERO's problem_info and RoboCasa's ep_meta.
std::string LanguageOf(const std::string& text) {
  std::string words = text;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  for (const char* key : {"language_instruction", "lang"})
    if (json.is_object() && json.contains(key) && json[key].is_string()) words = json[key];
  return ReadableName(words.substr(0, episode::kMaxLanguageBytes / 3));
}

class GroupRows : public RowSource {
 public:
  GroupRows(const Hdf5File& file, std::string group) : file_(file), group_(std::move(group)) {
    knows_angles = true;
  }

  std::optional<Rows> Read(const Located<std::string>& name, DiagnosticList& errors) override {
    const Hdf5Part part = *Hdf5PartOf(name.value);
    const std::string path = group_ + "/" + part.dataset;
    const auto described = file_.Describe(path);
    const auto values = file_.Read(path, part);
    if (!described || !values) {
      const grammar::Diagnostic why = (described ? values.error() : described.error()).front();
      errors.Add(name.where, why.message, why.hint);
      return std::nullopt;
    }
    Rows rows{.count = described->Rows(), .shape = described->Text(), .values = *values};
    if (rows.count > 0) rows.width = rows.values.size() / rows.count;
    if (rows.width == 0 || (part.count != UINT64_MAX && rows.width != part.count)) {
      errors.Add(name.where, fmt::format("'{}' has nothing there: the dataset is {}", name.value,
                                         described->Text()));
      return std::nullopt;
    }
    rows.is_matrix = described->shape.size() == 3 && described->shape[1] == 4 && rows.width == 16;
    return rows;
  }

 private:
  const Hdf5File& file_;
  const std::string group_;
};

/// "@success" is an attribute of the group, "success" a dataset, whose last value counts.
std::optional<Hdf5Value> ValueOf(const Hdf5File& file, const std::string& group,
                                 const std::optional<Located<std::string>>& key, PoseFile& poses) {
  if (!key) return std::nullopt;
  std::optional<Hdf5Value> value;
  if (key->value.starts_with('@')) {
    value = file.Attribute(group, key->value.substr(1));
  } else if (auto text = file.LastText(group + "/" + key->value)) {
    value = std::move(*text);
  } else if (const auto read = file.Read(group + "/" + key->value); read && !read->empty()) {
    value = read->back();
  }
  if (!value) poses.notes.push_back(fmt::format("it has no '{}'", key->value));
  return value;
}

// Tested by tests/program/import_hdf5.py

constexpr std::size_t kMostListed = 200;

/// The groups of a file whose map is not written yet.
Result<std::pair<std::string, std::vector<std::string>>> GuessGroups(const Hdf5File& file) {
  std::string pattern = file.Has("data") ? "data/*" : file.Has("traj_0") ? "traj_*" : "*";
  PREHEND_TRY(auto groups, GroupsLike(file, pattern));
  return std::pair(std::move(pattern), std::move(groups));
}

/// Every dataset below a group, by its path below it.
void CollectDatasets(const Hdf5File& file, const std::string& group, const std::string& below,
                     std::vector<Hdf5Object>& all) {
  const auto names = file.NamesIn(group + (below.empty() ? "" : "/" + below));
  for (std::size_t i = 0; names && i < names->size() && all.size() < kMostListed; ++i) {
    const std::string path = below.empty() ? (*names)[i] : below + "/" + (*names)[i];
    auto object = file.Describe(group + "/" + path);
    if (!object) continue;
    if (object->kind == Hdf5Kind::kGroup && std::ranges::count(path, '/') < 8)
      CollectDatasets(file, group, path, all);
    object->name = path;
    if (object->kind != Hdf5Kind::kGroup) all.push_back(std::move(*object));
  }
}

std::string LastOf(const std::string& path) { return path.substr(path.rfind('/') + 1); }

constexpr double kSize_m = 0.05;  ///< of things, which the file does not say

class Proposal {
 public:
  Proposal(const Hdf5File& file, std::string pattern, const std::vector<std::string>& groups)
      : file_(file), pattern_(std::move(pattern)), group_(groups.front()) {
    CollectDatasets(file, group_, "", datasets_);
  }

  std::string Text() {
    Things("object_pose/", "");
    if (things_.empty()) Things("object_poses/", "");
    if (things_.empty()) Things("actors/", "[0:7]");
    if (things_.empty()) States();
    if (things_.empty()) Observed();
    const std::string hand = Hand();
    std::string text;
    for (const Hdf5Object& one : datasets_)
      text += fmt::format("#   {:<52} {}\n", one.name, one.Text());
    text += "import: 1\nunit: m\naxes: z_up\n";
    if (!ControlRateOf(file_, group_))
      text += "rate_hz: 20                # not in the file: the rate of its actions\n";
    if (asks_order_)
      text += fmt::format("quaternion_order: {:<10}# {}\n", order_,
                          "not in the file: Isaac Lab up to 2 and ManiSkill wxyz, Isaac Lab from 3 "
                          "on and robosuite xyzw");
    text += fmt::format("hdf5: {{episodes: \"{}\"{}}}\n", pattern_,
                        file_.Attribute(group_, "success") ? ", success: \"@success\""
                        : Has("success")                   ? ", success: success"
                                                           : "");
    text +=
        "grammar: robot_pick_and_place\nentities:                  # sizes are not in the file\n";
    text += fmt::format(
        "  table: {{at_m: [{:.3g}, {:.3g}, {:.4g}], fixed: true, class: Table, size_m: [1.2, 1.6, "
        "0.04]}}{}\n",
        lowest_[0], lowest_[1], lowest_[2] - kSize_m / 2 - 0.02,
        things_.empty() ? "" : "  # below the lowest thing, if that is 5 cm high");
    return text + things_ + hand;
  }

 private:
  const Hdf5Object* Find(std::string_view part) const {
    const auto found = std::ranges::find_if(datasets_, [&](const Hdf5Object& one) {
      return ("/" + one.name).find("/" + std::string(part)) != std::string::npos;
    });
    return found == datasets_.end() ? nullptr : &*found;
  }
  bool Has(const std::string& path) const {
    return std::ranges::find(datasets_, path, &Hdf5Object::name) != datasets_.end();
  }

  /// `order`: whether its pose has quaternions. `dataset`: where it is first.
  void Thing(const std::string& name, const std::string& keys, bool order,
             const Hdf5Object& dataset) {
    if (name.starts_with("table") || name.starts_with("ground")) return;
    const bool is_matrix = dataset.shape.size() == 3;
    const auto at = file_.Read(group_ + "/" + dataset.name);
    const std::size_t step = is_matrix ? 4 : 1, first = is_matrix ? 3 : 0;
    if (at && at->size() > first + 2 * step &&
        (things_.empty() || (*at)[first + 2 * step] < lowest_[2]))
      lowest_ = {(*at)[first], (*at)[first + step], (*at)[first + 2 * step]};
    things_ += fmt::format("  {}: {{{}, size_m: [0.05, 0.05, 0.05]}}\n", name, keys);
    asks_order_ = asks_order_ || order;
  }

  void Things(const std::string& below, const std::string& slice) {
    for (const Hdf5Object& one : datasets_)
      if (("/" + one.name).find("/" + below) != std::string::npos)
        Thing(LastOf(one.name), "pose: \"" + one.name + slice + '"', !slice.empty(), one);
  }

  /// Of Isaac Lab: they are written after the action.
  void States() {
    for (const Hdf5Object& one : datasets_) {
      if (!one.name.starts_with("states/rigid_object/") || LastOf(one.name) != "root_pose")
        continue;
      const std::string name = LastOf(one.name.substr(0, one.name.rfind('/')));
      Thing(
          name,
          fmt::format("pose: {0}, first: initial_state{1}, shift: 1", one.name, one.name.substr(6)),
          true, one);
    }
  }

  /// Of robosuite: obs/NAME_pos with obs/NAME_quat, seen from nowhere but the world.
  void Observed() {
    for (const Hdf5Object& one : datasets_) {
      const std::string name = LastOf(one.name).substr(0, LastOf(one.name).rfind("_pos")),
                        turn = one.name.substr(0, one.name.rfind("_pos")) + "_quat";
      const bool is_thing = one.name.ends_with("_pos") && Has(turn) && one.shape.size() == 2 &&
                            one.shape[1] == 3 && name.find("eef") == std::string::npos &&
                            name != "ee" && name.find("_to_") == std::string::npos;
      if (is_thing)
        Thing(name, fmt::format("position: {}, quaternion: {}", one.name, turn), true, one);
      if (is_thing) order_ = "xyzw";
    }
  }

  std::string Hand() {
    struct Way {
      std::string_view place, turn, key;
    };
    std::string keys;
    for (const auto& [place, turn, key] : {Way{"eef_pose", "", ""},
                                           {"tcp_pose", "", ""},
                                           {"eef_pos", "eef_quat", "quaternion"},
                                           {"robot0_eef_pos", "robot0_eef_quat", "quaternion"},
                                           {"ee_pos", "ee_ori", "axis_angle"}}) {
      const Hdf5Object *at = Find(place), *turned = Find(turn);
      if (!at || !turned || !keys.empty()) continue;
      keys = turn.empty() ? "pose: " + at->name
                          : fmt::format("position: {}, {}: {}", at->name, key, turned->name);
      asks_order_ = asks_order_ || key == "quaternion" || (turn.empty() && at->shape.size() < 3);
      if (place.starts_with("robot0")) order_ = "xyzw";
    }
    if (keys.empty()) return "  # gripper: no dataset is called as poses of grippers are\n";
    std::string grip;
    for (const char* name : {"gripper_pos", "robot0_gripper_qpos", "gripper_states"})
      if (const Hdf5Object* one = Find(name); one && grip.empty())
        grip = fmt::format(
            ",\n            grip: {{from: {}, sum_abs: true, open: 0.08, closed: 0}}", one->name);
    // Of ManiSkill: thirteen numbers of the root, then joints, the last two of them fingers, and
    // how fast these are.
    if (const Hdf5Object* arm = Find("env_states/articulations/panda");
        arm && grip.empty() && arm->Width() > 17)
      grip = fmt::format(
          ",\n            grip: {{from: \"{0}[{1}:{2}]\", sum_abs: true, open: 0.08, closed: 0}}",
          arm->name, (arm->Width() + 13) / 2 - 2, (arm->Width() + 13) / 2);
    return fmt::format(
        "  gripper: {{{}, hand: true, ahead: [0, 0, 1], size_m: [0.02, 0.1, 0.06]{}}}\n", keys,
        grip);
  }

  const Hdf5File& file_;
  const std::string pattern_, group_;
  std::vector<Hdf5Object> datasets_;
  std::string things_, order_ = "wxyz";
  bool asks_order_ = false;
  std::array<double, 3> lowest_ = {0.5, 0, kSize_m / 2};  ///< where the lowest thing is first
};

// See harness/exchange/arrays/read_array_poses.h: a zip file of arrays of NumPy (.npy, versions 1
// to 3), stored or deflated. Tested by tests/program/import_arrays.py

constexpr std::size_t kMostEntries = 10'000, kMostHeaderBytes = 10'000;
constexpr std::size_t kEndBytes = 22, kMostCommentBytes = 65'535;
/// Of an array, to find out what it is.
constexpr std::size_t kFoundNumbers = 50, kFoundBytes = kMostHeaderBytes + 12 + 8 * kFoundNumbers;

/// A file in the zip file.
struct ZipEntry {
  std::uint16_t method = 0;
  std::uint32_t checksum = 0, packed = 0, size = 0, at = 0;
};

struct NumpyArray {
  char kind = ' ';  ///< f, i, u, b
  int bytes = 0;    ///< of a value
  bool big_endian = false;
  std::vector<std::size_t> shape;
  std::string_view data;
  std::string text;  ///< "(300, 7) <f8"

  std::size_t Rows() const { return shape.empty() ? 1 : shape[0]; }
};

/// What stands behind 'key': in the header of an array.
std::string_view ValueOfKey(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  header.remove_prefix(at + key.size());
  header.remove_prefix(std::min(header.find_first_not_of("': "), header.size()));
  return header;
}

/// `most`: numbers of its data. Returns what is wrong, or "".
std::string ReadNumpy(std::string_view bytes, NumpyArray& array, std::size_t most = SIZE_MAX) {
  ByteReader reader{.bytes = bytes};
  if (reader.Bytes(6) != "\x93NUMPY") return "it is no array of NumPy";
  const auto major = reader.Number<std::uint8_t>();
  reader.Number<std::uint8_t>();
  const std::size_t size =
      major == 1 ? reader.Number<std::uint16_t>() : reader.Number<std::uint32_t>();
  const std::string_view header = reader.Bytes(size);
  if (!reader.ok || size > kMostHeaderBytes) return "its header is cut off, or too long";
  const std::string_view type = ValueOfKey(header, "'descr'");
  array.big_endian = type.starts_with('>');
  array.kind = type.size() > 2 ? type[1] : ' ';
  array.bytes = type.size() > 2 ? type[2] - '0' : 0;
  const bool is_whole = type.size() > 3 && type[3] == '\'';
  const bool is_real = array.kind == 'f' && (array.bytes == 4 || array.bytes == 8);
  const bool is_integer =
      (array.kind == 'i' || array.kind == 'u' || array.kind == 'b') &&
      (array.bytes == 1 || array.bytes == 2 || array.bytes == 4 || array.bytes == 8);
  if (!is_whole || (!is_real && !is_integer))
    return fmt::format("its values are of the type {}; numbers are read: f4, f8, integers, bool",
                       ReadableName(type.substr(0, type.find_first_of(",}"))));
  std::string_view shape = ValueOfKey(header, "'shape'");
  shape = shape.substr(0, shape.find(')'));
  if (shape.find_first_not_of("(0123456789, ") != std::string_view::npos)
    return fmt::format("its shape is {})", ReadableName(shape));
  std::size_t count = 1;
  while ((shape.remove_prefix(std::min(shape.find_first_of("0123456789"), shape.size())),
          !shape.empty())) {
    const std::size_t end = std::min(shape.find_first_not_of("0123456789"), shape.size());
    const std::string number(shape.substr(0, end));
    array.shape.push_back(number.size() > 9 ? kMostRowNumbers + 1 : std::stoul(number));
    count *= array.shape.back();
    if (count > kMostRowNumbers) return fmt::format("more than {} numbers", kMostRowNumbers);
    shape.remove_prefix(end);
  }
  if (ValueOfKey(header, "'fortran_order'").starts_with("True") && array.shape.size() > 1)
    return "its columns stand one after another: numpy.ascontiguousarray turns them into rows";
  array.data = reader.Bytes(std::min(count, most) * static_cast<std::size_t>(array.bytes));
  if (!reader.ok) return fmt::format("it is cut off: {} numbers are wanted", count);
  array.text = fmt::format("({}) {}", fmt::join(array.shape, ", "), type.substr(0, 3));
  return "";
}

double NumberAt(const NumpyArray& array, std::size_t index) {
  const auto bytes = static_cast<std::size_t>(array.bytes);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    bits = bits << 8 | static_cast<unsigned char>(
                           array.data[index * bytes + (array.big_endian ? i : bytes - 1 - i)]);
  if (array.kind == 'f')
    return bytes == 8 ? std::bit_cast<double>(bits)
                      : std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  const std::size_t unused = 64 - 8 * bytes;
  return array.kind == 'i'
             ? static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused)
             : static_cast<double>(bits);
}

class NpzRows : public RowSource {
 public:
  explicit NpzRows(std::string bytes) : bytes_(std::move(bytes)) {}

  /// The list of files. Returns what is wrong, or "".
  std::string Load() {
    const std::size_t tail = bytes_.size() - std::min(bytes_.size(), kEndBytes + kMostCommentBytes);
    const std::size_t end = bytes_.rfind("PK\x05\x06");
    if (!bytes_.starts_with("PK") || end == std::string::npos || end < tail ||
        end + kEndBytes > bytes_.size())
      return "it is no .npz file, or is cut off: a zip file ends with its list of files";
    ByteReader reader{.bytes = bytes_, .at = end + 10};
    const auto count = reader.Number<std::uint16_t>();
    reader.Number<std::uint32_t>();
    reader.at =
        reader.ok ? std::min<std::size_t>(reader.Number<std::uint32_t>(), bytes_.size()) : 0;
    for (std::size_t i = 0; i < count && i < kMostEntries; ++i) {
      const std::size_t at = reader.at;
      const bool is_entry = reader.Bytes(4) == "PK\x01\x02";
      reader.Bytes(6);
      ZipEntry entry{.method = reader.Number<std::uint16_t>()};
      reader.Bytes(4);
      entry.checksum = reader.Number<std::uint32_t>();
      entry.packed = reader.Number<std::uint32_t>();
      entry.size = reader.Number<std::uint32_t>();
      const auto name = reader.Number<std::uint16_t>(), extra = reader.Number<std::uint16_t>(),
                 comment = reader.Number<std::uint16_t>();
      reader.Bytes(8);
      entry.at = reader.Number<std::uint32_t>();
      std::string key(reader.Bytes(name));
      reader.Bytes(std::size_t{extra} + comment);
      if (!reader.ok || !is_entry)
        return fmt::format("at byte {}: its list of files is damaged", at);
      if (key.ends_with(".npy")) key.resize(key.size() - 4);
      if (!entries_.emplace(ReadableName(key), entry).second)
        return fmt::format("at byte {}: a second array is called '{}'", at, ReadableName(key));
    }
    return "";
  }

  /// What looks like times and poses.
  FoundPoses Find() const {
    FoundPoses found;
    std::map<std::string, std::vector<std::string>> values;
    for (const auto& [name, entry] : entries_) {
      std::string content;
      NumpyArray array;
      if (!Unpack(entry, content, kFoundBytes).empty() ||
          !ReadNumpy(content, array, kFoundNumbers).empty())
        continue;
      std::vector<std::size_t> shape = array.shape;
      for (std::size_t i = 0; shape.size() < 2 && i < std::min(array.Rows(), kFoundNumbers); ++i)
        values[name].push_back(fmt::format("{}", NumberAt(array, i)));
      std::size_t of_row = 1, width = shape.empty() ? 0 : shape.back();
      for (std::size_t i = 1; i < shape.size(); ++i) of_row *= shape[i];
      if (shape.size() > 2 && (width == 3 || width == 4) && shape[shape.size() - 2] == width)
        width *= width;
      for (std::size_t at = 0; width > 0 && at + width <= of_row && at < 50 * width; at += width)
        found.Add(of_row == width ? "" : fmt::format("body {}", at / width + 1), name,
                  of_row == width ? name : fmt::format("{}[{}:{}]", name, at, at + width), width,
                  false);
    }
    found.AddTime(values);
    return found;
  }

  std::optional<Rows> Read(const Located<std::string>& name, DiagnosticList& errors) override {
    const Hdf5Part part = Hdf5PartOf(name.value).value_or(Hdf5Part{.dataset = name.value});
    const auto entry = entries_.find(part.dataset);
    if (entry == entries_.end()) {
      std::vector<std::string> names;
      for (const auto& [key, one] : entries_) names.push_back(key);
      errors.AddUnknownName(name.where, fmt::format("no array is called '{}'", part.dataset),
                            part.dataset, names);
      return std::nullopt;
    }
    auto& [content, array] = unpacked_[part.dataset];
    std::string why;
    if (content.empty()) {
      const std::size_t size = entry->second.size;
      bytes_unpacked_ += size;
      if (bytes_unpacked_ > kMostRowNumbers * sizeof(double) + unpacked_.size() * kMostHeaderBytes)
        why = fmt::format("more than {} numbers{}", kMostRowNumbers,
                          bytes_unpacked_ == size ? "" : ", with the arrays before it");
      if (why.empty()) why = Unpack(entry->second, content, size);
      if (why.empty()) why = ReadNumpy(content, array);
    }
    if (!why.empty()) {
      errors.Add(name.where, fmt::format("'{}', at byte {} of the file: {}", part.dataset,
                                         entry->second.at, why));
      return std::nullopt;
    }
    Rows rows{.count = array.Rows(), .shape = array.text, .values = {}};
    std::size_t of_row = 1;
    for (std::size_t i = 1; i < array.shape.size(); ++i) of_row *= array.shape[i];
    if (part.first < of_row) rows.width = std::min<std::size_t>(part.count, of_row - part.first);
    if (rows.width == 0 || rows.count == 0 ||
        (part.count != UINT64_MAX && rows.width != part.count)) {
      errors.Add(name.where,
                 fmt::format("'{}' has nothing there: the array is {}", name.value, array.text));
      return std::nullopt;
    }
    for (std::size_t row = 0; row < rows.count; ++row)
      for (std::size_t i = 0; i < rows.width; ++i)
        rows.values.push_back(NumberAt(array, row * of_row + part.first + i));
    rows.is_matrix = array.shape.size() == 3 && array.shape[1] == 4 && rows.width == 16;
    return rows;
  }

 private:
  /// At most the first `most` bytes; the checksum is that of all.
  std::string Unpack(const ZipEntry& entry, std::string& content, std::size_t most) const {
    ByteReader reader{.bytes = bytes_, .at = std::min<std::size_t>(entry.at, bytes_.size())};
    const bool is_entry = reader.Bytes(4) == "PK\x03\x04";
    reader.Bytes(22);
    const auto name = reader.Number<std::uint16_t>(), extra = reader.Number<std::uint16_t>();
    reader.Bytes(std::size_t{name} + extra);
    const std::string_view packed = reader.Bytes(entry.packed);
    if (!reader.ok || !is_entry) return "it is damaged, or cut off";
    if (entry.method != 0 && entry.method != 8)
      return fmt::format("it is packed by the method {}; 0 and 8 are read", entry.method);
    const bool is_whole = entry.size <= most;
    content.resize(is_whole ? entry.size : most);
    if (entry.method == 0) {
      content.assign(packed.substr(0, content.size()));
    } else {
      z_stream stream{};
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream.avail_in = entry.packed;
      stream.next_out = reinterpret_cast<Bytef*>(content.data());
      stream.avail_out = static_cast<uInt>(content.size());
      if (inflateInit2(&stream, -15) != Z_OK) return "it cannot be unpacked";
      const int state = inflate(&stream, Z_FINISH);
      content.resize(stream.total_out);
      inflateEnd(&stream);
      if (state != Z_STREAM_END && (is_whole || state != Z_BUF_ERROR))
        return "it is damaged: it cannot be unpacked";
    }
    if (!is_whole) return "";
    const auto* data = reinterpret_cast<const Bytef*>(content.data());
    if (content.size() != entry.size || crc32_z(0, data, content.size()) != entry.checksum)
      return "it is damaged: its checksum is wrong";
    return "";
  }

  const std::string bytes_;
  std::map<std::string, ZipEntry> entries_;
  /// Many bodies may lie in one array.
  struct Unpacked {
    std::string content;
    NumpyArray array;
  };
  std::map<std::string, Unpacked> unpacked_;
  std::size_t bytes_unpacked_ = 0;
};

}  // namespace

Result<std::vector<std::string>> GroupsLike(const Hdf5File& file, const std::string& pattern) {
  const std::size_t slash = pattern.rfind('/'), star = pattern.find('*');
  const std::string parent = slash == std::string::npos ? "" : pattern.substr(0, slash);
  const std::string before =
      pattern.substr(parent.empty() ? 0 : slash + 1, star - (parent.empty() ? 0 : slash + 1));
  const std::string after = star == std::string::npos ? "" : pattern.substr(star + 1);
  if (star == std::string::npos) return std::vector<std::string>{pattern};
  PREHEND_TRY(const auto names, file.NamesIn(parent));
  std::vector<std::string> groups;
  for (const std::string& name : names) {
    if (name.size() < before.size() + after.size() || !name.starts_with(before) ||
        !name.ends_with(after))
      continue;
    const std::string path = parent.empty() ? name : parent + "/" + name;
    if (const auto member = file.Describe(path); !member || member->kind == Hdf5Kind::kGroup)
      groups.push_back(path);
  }
  if (groups.empty())
    return tl::unexpected(file.Error(
        fmt::format("no group is like '{}': '{}' has {}", pattern, parent.empty() ? "/" : parent,
                    names.empty() ? "nothing" : names.front() + (names.size() > 1 ? " .." : ""))));
  return groups;
}

std::optional<double> ControlRateOf(const Hdf5File& file, const std::string& group) {
  const std::size_t slash = group.rfind('/');
  const auto text =
      file.Attribute(slash == std::string::npos ? "" : group.substr(0, slash), "env_args");
  if (!text || !std::holds_alternative<std::string>(*text)) return std::nullopt;
  const auto json = nlohmann::json::parse(std::get<std::string>(*text), nullptr, false);
  if (!json.is_object() || !json.contains("env_kwargs") || !json["env_kwargs"].is_object())
    return std::nullopt;
  const auto rate = json["env_kwargs"].find("control_freq");
  if (rate == json["env_kwargs"].end() || !rate->is_number()) return std::nullopt;
  return rate->get<double>() > 0 ? std::optional(rate->get<double>()) : std::nullopt;
}

Result<Demonstrations> Demonstrations::Open(const std::string& path, const MapFile& map) {
  PREHEND_TRY(auto file, Hdf5File::Open(path));
  Demonstrations all(std::move(file), map);
  PREHEND_TRY(all.groups_, GroupsLike(all.file_, map.map.hdf5.episodes.value));
  const auto& said = map.map.rate_hz;
  const std::optional<double> rate_hz = ControlRateOf(all.file_, all.groups_.front());
  DiagnosticList errors(map.document);
  if (!said && !rate_hz)
    errors.Add(map.document.root.where, "'rate_hz' is missing: the file does not say it",
               "the rate at which actions are given, often rate_hz: 20");
  if (said && rate_hz && std::abs(said->value / *rate_hz - 1) > 0.05 &&
      !map.map.IsSure(Warning::kTime))
    errors.Add(said->where,
               fmt::format("rate_hz: {:g}, but env_args of the file has control_freq {:g}",
                           said->value, *rate_hz),
               "leave out rate_hz; or, if it is right, sure: [time]");
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  all.rate_hz_ = said ? said->value : *rate_hz;
  return all;
}

Result<PoseFile> Demonstrations::Read(const std::string& group) const {
  GroupRows rows(file_, group);
  Result<PoseFile> poses = ReadRowPoses(rows, *map_, file_.path() + "/" + group, rate_hz_);
  if (!poses) return poses;
  if (const auto value = ValueOf(file_, group, map_->map.hdf5.success, *poses);
      value && std::holds_alternative<double>(*value))
    poses->attributes.success = std::get<double>(*value) != 0;
  if (const auto value = ValueOf(file_, group, map_->map.hdf5.language, *poses);
      value && std::holds_alternative<std::string>(*value))
    poses->attributes.language = LanguageOf(std::get<std::string>(*value));
  return poses;
}

Result<std::string> ProposedMapOfDemonstrations(const std::string& path) {
  PREHEND_TRY(const auto file, Hdf5File::Open(path));
  PREHEND_TRY(auto groups, GuessGroups(file));
  const std::vector<std::string>& all = groups.second;
  return fmt::format("# {}: {} demonstrations, '{}' to '{}'; the first has\n", file.path(),
                     all.size(), all.front(), all.back()) +
         Proposal(file, groups.first, all).Text();
}

Result<FoundPoses> FindNpzPoses(const std::string& path) {
  PREHEND_TRY(std::string bytes, ReadBytes(path));
  NpzRows rows(std::move(bytes));
  if (const std::string why = rows.Load(); !why.empty())
    return tl::unexpected(ErrorOfFile(path, why));
  return rows.Find();
}

Result<PoseFile> ReadNpzPoses(const std::string& path, const MapFile& map) {
  PREHEND_TRY(std::string bytes, ReadBytes(path));
  NpzRows rows(std::move(bytes));
  if (const std::string why = rows.Load(); !why.empty())
    return tl::unexpected(ErrorOfFile(path, why));
  return ReadRowPoses(rows, map, path, map.map.rate_hz ? map.map.rate_hz->value : 1);
}

}  // namespace prehend::exchange
