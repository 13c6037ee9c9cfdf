// SPDX-License-Identifier: Apache-2.0
// where_plays_part mirror|turn NOT_BEFORE_S SCENARIO..: plays each scenario and its image
// (mirrored, or turned by 37 degrees) tick by tick, and prints when, and in which body or link,
// they are first farther apart than a nanometre, a micrometre and a millimetre, and which contact
// then has other points. Exit status 1 if a nanometre is exceeded before NOT_BEFORE_S. A short run
// is in ctest.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "physics/scene/geometry.h"
#include "physics/simulation.h"
#include "tests/witnesses/metamorphic/move_scenario.h"

namespace prehend::witnesses {
namespace {

using Eigen::Vector3d;
using physics::ContactPoint;
using physics::ContactSide;
using physics::Snapshot;

const std::string kRoot = PREHEND_SOURCE_DIR;
constexpr std::array kSteps_m = {1e-9, 1e-6, 1e-3};
/// Contact points that are farther from any point of the image are others.
constexpr double kSamePoint_m = 1e-5;

/// Where a point of the image is in the original.
Vector3d Back(const WorldMotion& motion, const Vector3d& p_W_m) {
  Vector3d back_m = motion.X.inverse() * p_W_m;
  if (motion.mirrors) back_m.y() = -back_m.y();
  return back_m;
}

std::string NameOf(const physics::Scene& scene, const ContactSide& side) {
  if (side.hand == physics::kNone) return scene.body(side.body).name;
  const physics::Hand& hand = scene.hand(side.hand);
  return hand.name + " " + (side.link == physics::kNone ? "palm" : hand.model.link(side.link).name);
}

/// Centres of all bodies, palms and links, and what they are called.
std::vector<std::pair<ContactSide, Vector3d>> Places(const Snapshot& now) {
  std::vector<std::pair<ContactSide, Vector3d>> places;
  for (std::size_t i = 0; i < now.bodies.size(); ++i)
    places.push_back({{.body = physics::BodyIndex(i)}, now.bodies[i].X_WB.p_m});
  for (std::size_t h = 0; h < now.hands.size(); ++h) {
    const physics::HandIndex index(h);
    const physics::HandState& hand = now.hands[h];
    places.push_back({{.hand = index}, hand.palm.X_WB.p_m});
    for (std::size_t l = 0; l < hand.X_WL.size(); ++l)
      places.push_back({{.hand = index, .link = physics::LinkIndex(l)}, hand.X_WL[l].p_m});
  }
  return places;
}

/// Of two plays.
class Comparison {
 public:
  Comparison(const physics::Scene& scene, const WorldMotion& motion)
      : scene_(scene), motion_(motion) {}

  /// Prints what is new. False once they are a millimetre apart.
  bool Look(const Snapshot& here, const Snapshot& there) {
    const auto places = Places(here), images = Places(there);
    double farthest_m = 0;
    ContactSide where;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double apart_m = (places[i].second - Back(motion_, images[i].second)).norm();
      if (apart_m <= farthest_m) continue;
      farthest_m = apart_m;
      where = places[i].first;
    }
    const double now_s = static_cast<double>(here.tick) / scene_.world.rate_hz;
    if (step_ < kSteps_m.size() && farthest_m > kSteps_m[step_]) {
      if (step_ == 0) parted_s_ = now_s;
      while (step_ < kSteps_m.size() && farthest_m > kSteps_m[step_]) ++step_;
      std::printf("  %.4f s: %s is %.1e m off\n", now_s, NameOf(scene_, where).c_str(), farthest_m);
    }
    if (!contact_differs_) LookAtContacts(here, there, now_s);
    return step_ < kSteps_m.size();
  }
  /// When they were first a nanometre apart.
  double parted_s() const { return parted_s_; }

 private:
  void LookAtContacts(const Snapshot& here, const Snapshot& there, double now_s) {
    struct Points {
      std::vector<Vector3d> here, there;
    };
    std::map<std::pair<ContactSide, ContactSide>, Points> pairs;
    for (const ContactPoint& point : here.contacts)
      pairs[{point.a, point.b}].here.push_back(point.p_W_m);
    for (const ContactPoint& point : there.contacts)
      pairs[{point.a, point.b}].there.push_back(Back(motion_, point.p_W_m));
    for (const auto& [sides, points] : pairs) {
      const auto has_partner = [&](const Vector3d& p_m) {
        return std::ranges::any_of(points.there, [&](const Vector3d& other_m) {
          return (p_m - other_m).norm() < kSamePoint_m;
        });
      };
      if (points.here.size() == points.there.size() &&
          std::ranges::all_of(points.here, has_partner))
        continue;
      contact_differs_ = true;
      std::printf("  %.4f s: %s and %s touch at %zu points, in the image at %zu\n", now_s,
                  NameOf(scene_, sides.first).c_str(), NameOf(scene_, sides.second).c_str(),
                  points.here.size(), points.there.size());
      return;
    }
  }

  const physics::Scene& scene_;
  const WorldMotion motion_;
  std::size_t step_ = 0;
  bool contact_differs_ = false;
  double parted_s_ = 1e9;
};

/// When play and image are first a nanometre apart.
double PartedAt_s(const std::string& name, const WorldMotion& motion) {
  const auto loaded =
      episode::LoadRun({.scenario_file = kRoot + "/scenarios/" + name + ".yaml"}, kRoot);
  if (!loaded) {
    std::printf("%s", grammar::Format(loaded.error()).c_str());
    std::exit(2);
  }
  std::printf("%s\n", name.c_str());
  const scenario::Scenario image = Moved(loaded->scenario, motion);
  physics::Simulation here(loaded->scenario.scene, loaded->scenario.script);
  physics::Simulation there(image.scene, image.script);
  Comparison comparison(loaded->scenario.scene, motion);
  while (here.Step() && there.Step() && comparison.Look(here.snapshot(), there.snapshot())) {
  }
  return comparison.parted_s();
}

}  // namespace
}  // namespace prehend::witnesses

int main(int argc, char** argv) {
  using prehend::witnesses::WorldMotion;
  const std::string how = argc > 3 ? argv[1] : "";
  WorldMotion motion{.mirrors = how == "mirror", .X = {}};
  if (how == "turn") motion.X.q = prehend::physics::FromRollPitchYaw({0, 0, 37});
  if (how != "turn" && how != "mirror") {
    std::printf("usage: where_plays_part mirror|turn NOT_BEFORE_S SCENARIO..\n");
    return 2;
  }
  bool in_time = true;
  for (int i = 3; i < argc; ++i)
    in_time = prehend::witnesses::PartedAt_s(argv[i], motion) >= std::atof(argv[2]) && in_time;
  return in_time ? 0 : 1;
}
