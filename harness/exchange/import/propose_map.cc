// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/import_poses.h.
//
// The map is written as text, read as any map is, and tried on the file: once to see which bodies
// it has, once to look at how they move, and at last for the warnings of the import.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/cells/column_names.h"
#include "harness/exchange/doubts/plausibility.h"
#include "harness/exchange/import/import_poses.h"
#include "harness/exchange/import/track.h"
#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kMostEntities = 40, kLongestName = 200;
constexpr std::size_t kLongestOwn = 54;  ///< of an entity, before body_ and a number
constexpr double kTableMoves_m = 0.02;   ///< what stays within is fixed, if it is called a table
constexpr double kFromZero_m = 0.05;     ///< from a pose that stands for none

std::string Quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string QuotedList(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(Quoted(text));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

/// A body of the file, as the map will have it.
struct Draft {
  std::string from, name, keys = {};  ///< of arrays and paths, in the place of `from`
  bool hand = false, fixed = false;
  std::optional<double> upright_at_s;

  std::string Line() const {
    std::string text =
        fmt::format("  {}: {{{}", name, keys.empty() ? "from: " + Quoted(from) : keys);
    if (hand) text += ", hand: true";
    if (!hand && !grammar::IsRootClass(ClassOf())) text += ", class: " + ClassOf();
    if (fixed) text += ", fixed: true";
    if (upright_at_s) text += fmt::format(", upright_at_s: {:g}", *upright_at_s);
    return text + ", size_m: unknown}\n";
  }

 private:
  /// "milk_carton_2" -> MilkCarton.
  std::string ClassOf() const {
    std::string text;
    for (std::string word : WordsIn(name)) {
      if (!text.empty() && std::isdigit(static_cast<unsigned char>(word[0]))) continue;
      word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
      text += word;
    }
    return text;
  }
};

class MapProposer {
 public:
  MapProposer(std::string path, PoseFormat format) : path_(std::move(path)), format_(format) {}

  Result<std::string> Propose() {
    const bool has_rows = format_ == PoseFormat::kJson || format_ == PoseFormat::kNpz;
    if (format_ == PoseFormat::kCsv || format_ == PoseFormat::kC3d)
      if (grammar::Diagnostics why = TakeHead(); !why.empty()) return tl::unexpected(why);
    if (layout_) head_ = layout_->name;
    if (format_ == PoseFormat::kBvh || head_.ends_with("of Motive") || head_.ends_with("TRC file"))
      axes_ = "axes: y_up", axes_why_ = "as such files have it, unless exported otherwise";
    if (format_ == PoseFormat::kMcap) unit_why_ = axes_why_ = "as ROS has it";
    if (head_.ends_with("KITTI"))
      axes_ = "up: [0, -1, 0]", axes_why_ = "of a camera that looks ahead";
    const grammar::Diagnostics why = has_rows ? TakeRows() : FindBodies();
    if (!why.empty()) return tl::unexpected(why);
    // What is guessed of how they move asks for the next guess: the unit, then the axes.
    for (int guesses = 0; guesses < 6; ++guesses) {
      PREHEND_TRY(MapFile map, Read());
      map.map.is_draft = true;
      Result<PoseFile> poses = ReadPoses(path_, format_, map);
      // What is no number, or no orientation, is tried as not tracked.
      if (!poses && !nans_ && Format(poses.error()).find("missing: [nan]") != std::string::npos) {
        nans_ = true;
        continue;
      }
      if (!poses && !std::exchange(zeros_, true)) continue;
      if (!poses) return tl::unexpected(std::move(poses.error()));
      if (!Improve(*poses, map.map)) break;
    }
    Try();
    return MapText(true);
  }

 private:
  /// Bodies of what is called as poses are.
  grammar::Diagnostics TakeRows() {
    PREHEND_TRY(const FoundPoses found,
                format_ == PoseFormat::kJson ? FindJsonPoses(path_) : FindNpzPoses(path_));
    keys_ = found.keys, needs_rate_ = found.needs_rate, aside_ = found.aside;
    if (found.is_of_unity)
      doubts_.push_back(
          "vectors are texts, as Unity writes them: its axes are left-handed, handed: left");
    const auto is_bone = [](const FoundBody& body) { return IsBone(WordsIn(body.called)); };
    const bool all_bones = std::ranges::all_of(found.bodies, is_bone);
    std::set<std::string> taken;
    for (const FoundBody& body : found.bodies) ++alike_[StemOf(body.called)];
    for (const FoundBody& body : found.bodies) {
      if (body.From().empty() || bodies_.size() >= kMostEntities || (!all_bones && is_bone(body)) ||
          IsLandmark(body.called)) {
        aside_.push_back(body.From().empty() ? body.rotation : body.From());
        continue;
      }
      if (!body.has_order) order_ = "xyzw";
      Draft draft = DraftOf(body.called, taken);
      draft.from = body.From(), draft.keys = body.Keys();
      bodies_.push_back(std::move(draft));
    }
    if (!bodies_.empty()) return {};
    return ErrorOfFile(path_, "nothing in it is called as a position or a pose of something is");
  }

  grammar::Diagnostics TakeHead() {
    Result<std::string> text = std::string();
    if (format_ == PoseFormat::kC3d) {
      PREHEND_TRY(layout_, LayoutOfC3d(path_));
    } else {
      text = ReadTextFile(path_, kMaxPoseFileBytes);
      if (!text) return text.error();
      PREHEND_TRY(layout_, LayoutOfTable(path_));
    }
    if (layout_) {
      says_unit_ = layout_->unit && layout_->says_unit;
      if (layout_->unit && !says_unit_)
        unit_ = *layout_->unit == Unit::kMillimetre ? "unit: mm" : "unit: m";
      if (!layout_->columns.axis_angle.empty())
        doubts_.push_back(
            "three angles are read as axis times angle; if they are Euler angles, the map says "
            "euler_order: XYZ");
      needs_rate_ = !layout_->columns.time && !layout_->rate_hz;
      return {};
    }
    columns_ = ColumnsOf(*text);
    if (!columns_)
      return {{.file = ReadableName(path_),
               .message = "no columns are called x, y and z of something, and its head is not one "
                          "of those that are known",
               .hint = "the map says which columns have what: docs/motion-capture.md"}};
    if (!columns_->unit.empty()) unit_ = "unit: " + columns_->unit, unit_why_ = "";
    says_unit_ = false;
    needs_rate_ = columns_->time.empty() || columns_->time_unit == "frame";
    if (const auto& others = columns_->others; !others.empty()) {
      constexpr std::size_t kNamed = 12;
      doubts_.push_back(fmt::format(
          "columns that are left aside: {}{}",
          fmt::join(std::span(others).first(std::min(kNamed, others.size())), ", "),
          others.size() > kNamed ? fmt::format(" and {} more", others.size() - kNamed) : ""));
    }
    return {};
  }

  /// By a map without entities: then none of them is used.
  grammar::Diagnostics FindBodies() {
    bodies_ = {{.from = "?", .name = "body"}};
    PREHEND_TRY(MapFile map, Read());
    map.map.entities.clear();
    map.map.is_draft = true;
    PREHEND_TRY(const PoseFile poses, ReadPoses(path_, format_, map));
    std::vector<std::string> names = poses.unused;
    if (format_ == PoseFormat::kCsv && map.map.columns.IsOfOneBody())
      names = {std::filesystem::path(path_).stem().string()};
    bodies_.clear();
    std::set<std::string> taken;
    const bool has_skeleton = std::ranges::count_if(names, [](const std::string& name) {
                                return IsBone(WordsIn(name));
                              }) >= 5;
    for (const std::string& name : names) ++alike_[StemOf(name)];
    for (const std::string& name : names) {
      const Words words = WordsIn(name);
      if (name.size() > kLongestName || bodies_.size() >= kMostEntities ||
          (has_skeleton && IsBone(words)) || IsLandmark(name))
        aside_.push_back(name);
      else
        bodies_.push_back(DraftOf(name, taken));
    }
    if (bodies_.empty()) return ErrorOfFile(path_, "it has no bodies with poses");
    if (!poses.has_orientations) DoubtMarkers();
    return {};
  }

  /// "Right/" of "Right/9".
  static std::string StemOf(const std::string& name) {
    return name.substr(0, name.find_last_not_of("0123456789") + 1);
  }

  /// A hand has many: its middle finger's knuckle, the ninth, stands for it.
  bool IsLandmark(const std::string& name) const {
    constexpr std::size_t kLandmarks = 21;
    const std::string stem = StemOf(name);
    return stem != name && alike_.at(stem) >= kLandmarks && name != stem + "9" &&
           AnyOf(WordsIn(stem), {"left", "right", "hand"});
  }

  /// "cup_1, cup_2, cup_3" without orientations may be one body.
  void DoubtMarkers() {
    std::map<std::string, std::vector<std::string>> groups;
    for (const Draft& body : bodies_)
      if (const std::string stem = StemOf(body.from); stem != body.from)
        groups[stem].push_back(Quoted(body.from));
    for (const auto& [name, markers] : groups) {
      if (markers.size() < 3) continue;
      has_markers_ = true;
      doubts_.push_back(
          fmt::format("are these markers of one body? markers: [{}], in the place of from, gives "
                      "it orientations",
                      fmt::join(markers, ", ")));
    }
  }

  Draft DraftOf(const std::string& from, std::set<std::string>& taken) {
    if (const std::string stem = StemOf(from); alike_[stem] > 20 && IsLandmark(stem + "0")) {
      Draft draft = DraftOf(stem + "hand", taken);
      draft.from = from;
      return draft;
    }
    const std::size_t last = from.find_last_of("[:");
    Words words = WordsIn(last == std::string::npos ? from : from.substr(last + 1));
    const bool is_side = words.size() == 1 && (words[0] == "left" || words[0] == "right");
    if (words.empty() || is_side || taken.contains(fmt::format("{}", fmt::join(words, "_"))))
      words = WordsIn(from);
    if (words.empty()) words = {"body"};  // of letters that names of entities do not have
    Draft draft{.from = from, .hand = IsHand(words)};
    if (draft.hand && !IsHand({words.back()}) && !IsSide(words.back()))
      doubts_.push_back("'" + from +
                        "' is a hand by its name; if it is none: class, not hand: true");
    draft.name = fmt::format("{}", fmt::join(words, "_"));
    for (const char* side : {"right", "left"}) {
      const std::string name = side + std::string("_hand");
      const std::string letter(1, side[0]);
      if (draft.hand && !taken.contains(name) &&
          AnyOf(words, {side, letter, letter + "h", letter + "hand", side + std::string("hand")}))
        draft.name = name;
    }
    static const std::set<std::string> kNoNames = {"y",   "n",    "yes",   "no",   "on",
                                                   "off", "true", "false", "null",  // in YAML
                                                   "any"};
    if (draft.name.size() > kLongestOwn)
      draft.name.erase(kLongestOwn / 2, draft.name.size() - kLongestOwn);
    if (std::isdigit(static_cast<unsigned char>(draft.name[0])) || kNoNames.contains(draft.name))
      draft.name = "body_" + draft.name;
    const std::string name = draft.name;
    for (int i = 2; !taken.insert(draft.name).second; ++i)
      draft.name = fmt::format("{}_{}", name, i);
    return draft;
  }

  /// Whether anything was guessed anew.
  bool Improve(const PoseFile& poses, ImportMap& map) {
    std::vector<Draft> present;
    for (std::size_t i = 0; i < poses.bodies.size(); ++i)
      if (poses.bodies[i].samples.size() >= 2) present.push_back(bodies_[i]);
    if (present.empty() || present.size() < bodies_.size()) {
      for (const Draft& body : bodies_)
        if (std::ranges::find(present, body.from, &Draft::from) == present.end())
          doubts_.push_back("'" + body.from + "' is never tracked");
      bodies_ = present;
      return !present.empty();
    }
    const auto guessed = [](std::string& key, const Guess& guess) {
      if (guess.signs.empty() || guess.remedy == key || !guess.remedy.starts_with(key.substr(0, 4)))
        return false;
      key = guess.remedy;
      return true;
    };
    if (poses.stature && unit_why_ == "not in the file") {
      constexpr std::array<std::pair<const char*, double>, 4> kHeightUnits = {
          {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"inch", 0.0254}}};
      const double height = poses.stature->norm();
      const auto fits = std::ranges::find_if(kHeightUnits, [&](const auto& unit) {
        return height * unit.second > 0.8 && height * unit.second < 2.2;
      });
      unit_ = fits != kHeightUnits.end() ? fmt::format("unit: {}", fits->first)
                                         : fmt::format("metres_per_unit: {:.4g}", 1.6 / height);
      unit_why_ = fmt::format("from feet to head {:.2f} m",
                              height * (fits != kHeightUnits.end() ? fits->second : 1.6 / height));
      return true;
    }
    if (!says_unit_ && guessed(unit_, GuessUnit(poses, map))) {
      unit_why_ = "by how far and how fast hands move";
      if (unit_.ends_with(" cm"))
        doubts_.push_back("unit: cm or inch: hands move as far and as fast in both");
      return true;
    }
    Guess axes = GuessAxes(poses, map, /*any_sign=*/true);
    if (axes.signs.empty() && unit_.ends_with(" cm") &&
        unit_why_.starts_with("by")) {  // too near to each other, perhaps
      ImportMap larger = map;
      larger.unit->value = Unit::kInch;
      axes = GuessAxes(poses, larger, /*any_sign=*/true);
    }
    if (guessed(axes_, axes)) {
      axes_why_ = axes.signs.front();
      return true;
    }
    if (std::string order = "quaternion_order: " + order_;
        !order_.empty() && poses.quaternion_order && guessed(order, GuessOrder(poses, map))) {
      order_ = order.substr(order.find(' ') + 1);
      return true;
    }
    if (std::string askew = LiftedAskew(poses, map); !askew.empty())
      doubts_.push_back(std::move(askew));
    LookAt(poses, map);
    return false;
  }

  /// "left", "r", "2".
  static bool IsSide(const std::string& word) {
    return word.size() == 1 || word == "left" || word == "right" ||
           std::isdigit(static_cast<unsigned char>(word[0]));
  }

  /// Where things stand upright; what is a table; whether 0, 0, 0 is a place.
  void LookAt(const PoseFile& poses, const ImportMap& map) {
    const double scale = map.MetresPerUnit();
    const MotionSeen seen = MotionIn(poses, map, scale);
    bool has_table = false;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Draft& body = bodies_[i];
      const PoseSeries& samples = poses.bodies[i].samples;
      const auto rest = std::ranges::find_if(
          seen.rests, [&](const Rest& one) { return one.body == i && one.stands; });
      if (poses.has_orientations && !poses.stature && rest != seen.rests.end())
        body.upright_at_s = std::round(10 * seen.look_s * static_cast<double>(rest->begin)) / 10;
      for (std::size_t k = 0; k < samples.size(); ++k)
        for (const std::size_t next : {k - 1, k + 1})
          zeros_ = zeros_ || (samples[k].p.isZero(0) && next < samples.size() &&
                              samples[next].p.norm() * scale > kFromZero_m);
      const bool is_table = !body.hand && IsTable(WordsIn(body.name));
      body.fixed = is_table && WayOf(samples) * scale < kTableMoves_m;
      LetGo(samples);
      has_table = has_table || is_table;
      hands_ = hands_ || body.hand;
    }
    if (!has_table) GuessTable(seen, map.WorldTurn());
  }

  /// Below the lowest places at which things rest.
  void GuessTable(const MotionSeen& seen, const Eigen::Quaterniond& turn) {
    constexpr double kLevel_m = 0.05, kHalf_m = 0.05, kMargin_m = 0.3;  // of a size that is unknown
    Eigen::AlignedBox3d all, low;
    for (const Rest& rest : seen.rests)
      if (rest.stands) all.extend(turn * rest.p_m);
    for (const Rest& rest : seen.rests)
      if (const Eigen::Vector3d p = turn * rest.p_m;
          rest.stands && p.z() < all.min().z() + kLevel_m)
        low.extend(p);
    if (low.isEmpty()) return;
    const Eigen::Vector3d middle = low.center(), size = low.sizes().array() + 2 * kMargin_m;
    table_ = fmt::format(
        "table: {{at_m: [{:.2f}, {:.2f}, {:.2f}], fixed: true, class: Table, size_m: [{:.1f}, "
        "{:.1f}, 0.04]}}",
        middle.x(), middle.y(), low.min().z() - kHalf_m - 0.02, size.x(), size.y());
  }

  /// Imports, and keeps what was doubtful.
  void Try() {
    imported_.clear();
    const Result<MapFile> map = Read();
    if (!map) return;
    Result<PoseFile> poses = ReadPoses(path_, format_, *map);
    if (!poses) return;
    zero_count_ = poses->zeros;
    const Result<Imported> imported = ImportPoses(std::move(*poses), *map);
    if (!imported) {
      for (const grammar::Diagnostic& error : imported.error())
        imported_.push_back(error.message + (error.hint.empty() ? "" : "; " + error.hint));
      return;
    }
    for (const std::string& warning : imported->warnings)
      if (!warning.starts_with("size_m is unknown") && !warning.ends_with("does not mention") &&
          !(has_markers_ && warning.find(" rest") != warning.npos))  // each alone rests on nothing
        imported_.push_back(warning);
    summary_ = fmt::format("{:.1f} s, {}", imported->duration_s,
                           grammar::CountOf(imported->frames, "frame"));
  }

  Result<MapFile> Read() const {
    return ReadMapFor(path_, format_, ParseYaml("the proposed map", MapText(false)));
  }

  static std::string Key(const std::string& line, const std::string& why) {
    return why.empty() ? line + "\n" : fmt::format("{:<24}# {}\n", line, why);
  }

  std::string MapText(bool commented) const {
    std::string text;
    if (commented) {
      text += fmt::format(
          "# Proposed from {}{}. Fill in: {}each size_m, the edges of its box along x, y and z "
          "(up), in metres,\n# like [0.08, 0.08, 0.1]. Are names, classes and hands right?\n",
          Comment(std::filesystem::path(path_).filename().string()),
          head_.empty() ? "" : ", " + head_, needs_rate_ ? "rate_hz; " : "");
      if (!summary_.empty()) text += "# " + summary_ + "\n";
    }
    text += "import: 1\n";
    if (!says_unit_) text += Key(unit_, unit_why_);
    text += Key(axes_, axes_why_);
    if (!order_.empty()) text += "quaternion_order: " + order_ + "\n";
    if (needs_rate_) text += Key("rate_hz: 30", "fill in: nothing in the file says it");
    text += keys_ + ColumnsText();
    if (nans_) text += Key("missing: [nan]", "some poses are no numbers");
    if (zeros_)
      text += Key("zero_is_missing: true", zero_count_ == 0
                                               ? "bodies jump to exactly 0, 0, 0"
                                               : grammar::CountOf(zero_count_, "pose") +
                                                     " at exactly 0, 0, 0, which count as lost");
    text += "lost: unknown\nentities:\n";
    for (const Draft& body : bodies_) text += body.Line();
    if (!table_.empty()) text += fmt::format("  {}  # guessed, below what rests\n", table_);
    if (!commented) return text;
    if (!hands_)
      text += "# doubt: no body is called a hand; who moves things has hand: true, and no class\n";
    for (const auto* list : {&doubts_, &imported_})
      for (const std::string& doubt : *list) text += "# doubt: " + Comment(doubt) + "\n";
    if (!aside_.empty())
      text += "# also in the file: " + Comment(fmt::format("{}", fmt::join(aside_, ", "))) + "\n";
    return text;
  }

  std::string ColumnsText() const {
    if (!columns_) return "";
    const NamedColumns& c = *columns_;
    std::string text;
    if (c.separator != Separator::kComma)
      text += fmt::format("separator: {}\n", c.separator == Separator::kSemicolon ? "semicolon"
                                             : c.separator == Separator::kTab     ? "tab"
                                                                                  : "space");
    if (c.decimal_comma) text += "decimal: comma\n";
    if (c.header_line > 1) text += fmt::format("header_line: {}\n", c.header_line);
    if (!c.time.empty()) text += Key("time_unit: " + c.time_unit, c.time_doubt);
    const bool quaternion = c.form == OrientationForm::kQuaternion;
    if (!c.orientation.empty())
      text += quaternion     ? "quaternion_order: xyzw\n"
              : c.roll_first ? Key("euler_order: xyz", "fill in: as ROS has roll, pitch and yaw")
                             : Key("euler_order: XYZ", "fill in: the order of the turns");
    if (!c.orientation.empty() && !quaternion)
      text += Key(c.in_degrees ? "angle_unit: deg" : "angle_unit: rad", "by their values");
    text += "columns:\n";
    if (!c.time.empty()) text += "  time: " + Quoted(c.time) + "\n";
    if (!c.keys.empty()) text += "  body: " + QuotedList(c.keys) + "\n";
    text += "  position: " + QuotedList(c.position) + "\n";
    if (!c.orientation.empty())
      text += (quaternion ? "  quaternion: " : "  euler: ") + QuotedList(c.orientation) + "\n";
    return text + "missing: [nan, NaN, \"null\"]\n";
  }

  /// Of a file: in one line.
  static std::string Comment(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return ReadableName(text);
  }

  const std::string path_;
  const PoseFormat format_;
  std::optional<TableLayout> layout_;
  std::optional<NamedColumns> columns_;
  std::string head_, summary_, table_, order_, keys_;
  std::string unit_ = "unit: m", unit_why_ = "not in the file", axes_ = "axes: z_up",
              axes_why_ = "not in the file";
  std::size_t zero_count_ = 0;
  bool says_unit_ = false, needs_rate_ = false, zeros_ = false, nans_ = false, hands_ = false,
       has_markers_ = false;
  std::map<std::string, std::size_t> alike_;  ///< how many names differ by a number in the end
  std::vector<Draft> bodies_;
  std::vector<std::string> aside_, doubts_, imported_;
};

}  // namespace

Result<std::string> ProposedMap(const std::string& poses_path) {
  PREHEND_TRY(const PoseFormat format, PoseFormatOf(poses_path));
  if (format == PoseFormat::kHdf5) return ProposedMapOfDemonstrations(poses_path);
  return MapProposer(poses_path, format).Propose();
}

}  // namespace prehend::exchange
