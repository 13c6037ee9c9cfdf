// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/frame_tree.h. Tested by tests/program/import_mcap_test.cc
#include "harness/exchange/import/frame_tree.h"

#include <algorithm>

namespace prehend::exchange {
namespace {

/// Of a link, over increasing times.
class LinkWalk {
 public:
  LinkWalk(const FrameLink& link, std::int64_t bridge_ns)
      : LinkWalk(link, bridge_ns, link.UsualStep_ns()) {}

  std::optional<TimedPose> At(std::int64_t ns) {
    const std::vector<TimedPose>& poses = link_.poses;
    if (poses.empty()) return std::nullopt;
    if (link_.fixed) return poses.back();
    while (next_ < poses.size() && poses[next_].ns < ns) ++next_;
    if (next_ == poses.size()) return std::nullopt;
    const TimedPose& after = poses[next_];
    if (after.ns == ns) return after;
    if (next_ == 0) return std::nullopt;
    const TimedPose& before = poses[next_ - 1];
    if (after.ns - before.ns > most_gap_ns_) return std::nullopt;
    const double part =
        static_cast<double>(ns - before.ns) / static_cast<double>(after.ns - before.ns);
    return TimedPose{
        .ns = ns, .p = before.p + part * (after.p - before.p), .q = before.q.slerp(part, after.q)};
  }

 private:
  LinkWalk(const FrameLink& link, std::int64_t bridge_ns, std::int64_t step_ns)
      : link_(link), most_gap_ns_(std::max(bridge_ns, step_ns + step_ns / 2)) {}

  const FrameLink& link_;
  const std::int64_t most_gap_ns_;
  std::size_t next_ = 0;
};

/// All links of a way, the innermost first.
std::optional<TimedPose> Along(std::vector<LinkWalk>& way, std::int64_t ns) {
  TimedPose pose{.ns = ns};
  for (LinkWalk& link : way) {
    const std::optional<TimedPose> outer = link.At(ns);
    if (!outer) return std::nullopt;
    pose.p = outer->p + outer->q * pose.p;
    pose.q = outer->q * pose.q;
  }
  return pose;
}

}  // namespace

std::optional<std::int64_t> FrameLink::Sort() {
  std::ranges::stable_sort(poses, {}, &TimedPose::ns);
  std::optional<std::int64_t> contradiction;
  const auto repeats = [&](const TimedPose& a, const TimedPose& b) {
    if (a.ns != b.ns) return false;
    if (!fixed && ((a.p - b.p).norm() > 1e-6 || a.q.angularDistance(b.q) > 1e-4))
      contradiction = contradiction ? std::min(*contradiction, a.ns) : a.ns;
    return true;
  };
  poses.erase(std::unique(poses.begin(), poses.end(), repeats), poses.end());
  return contradiction;
}

std::int64_t FrameLink::UsualStep_ns() const {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) steps.push_back(poses[i].ns - poses[i - 1].ns);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

std::string FrameTree::RootOf(const std::string& frame) const {
  std::string root = frame;
  for (std::size_t depth = 0; depth <= links.size() && links.contains(root); ++depth)
    root = links.at(root).parent;
  return root;
}

std::vector<const FrameLink*> FrameTree::WayUp(const FrameLink& body) const {
  std::vector<const FrameLink*> way = {&body};
  while (way.size() <= links.size()) {
    const auto parent = links.find(way.back()->parent);
    if (parent == links.end()) break;
    way.push_back(&parent->second);
  }
  return way;
}

std::vector<TimedPose> FrameTree::InFrame(const FrameLink& body, const std::string& world,
                                          std::int64_t bridge_ns) const {
  std::vector<const FrameLink*> up = WayUp(body), from_world;
  if (const auto link = links.find(world); link != links.end()) from_world = WayUp(link->second);
  while (!up.empty() && !from_world.empty() && up.back() == from_world.back()) {
    up.pop_back();
    from_world.pop_back();
  }
  const FrameLink* fastest = nullptr;
  std::vector<LinkWalk> inner, outer;
  for (const auto* way : {&up, &from_world}) {
    for (const FrameLink* link : *way) {
      (way == &up ? inner : outer).emplace_back(*link, bridge_ns);
      if (!link->fixed && (!fastest || link->poses.size() > fastest->poses.size())) fastest = link;
    }
  }
  const auto at = [&](std::int64_t ns) -> std::optional<TimedPose> {
    std::optional<TimedPose> pose = Along(inner, ns);
    const std::optional<TimedPose> of_world = Along(outer, ns);
    if (!pose || !of_world) return std::nullopt;
    const Eigen::Quaterniond back = of_world->q.conjugate();
    pose->p = back * (pose->p - of_world->p);
    pose->q = (back * pose->q).normalized();
    return pose;
  };
  std::vector<TimedPose> poses;
  if (!fastest) {
    if (const std::optional<TimedPose> pose = at(0)) poses.push_back(*pose);
    return poses;
  }
  for (const TimedPose& sample : fastest->poses) {
    if (const std::optional<TimedPose> pose = at(sample.ns)) poses.push_back(*pose);
  }
  return poses;
}

}  // namespace prehend::exchange
