// SPDX-License-Identifier: Apache-2.0
// Tested by tests/program/import_hdf5.py
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/exchange/arrays/read_hdf5_poses.h"

namespace prehend::exchange {
namespace {

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

}  // namespace

Result<std::string> ProposedMapOfDemonstrations(const std::string& path) {
  PREHEND_TRY(const auto file, Hdf5File::Open(path));
  PREHEND_TRY(auto groups, GuessGroups(file));
  const std::vector<std::string>& all = groups.second;
  return fmt::format("# {}: {} demonstrations, '{}' to '{}'; the first has\n", file.path(),
                     all.size(), all.front(), all.back()) +
         Proposal(file, groups.first, all).Text();
}

}  // namespace prehend::exchange
