// SPDX-License-Identifier: Apache-2.0
// The recording as the oracle reads it: frames by index, time in ticks. Entities are the scene's
// bodies, then its hands. Tested by tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <algorithm>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::truth {

// Intervals of frames and what can be done with them.

/// Half-open, indices into the recording. `end` may be the number of frames: then it never ended.
struct Span {
  int begin = 0;
  int end = 0;
  bool empty() const { return begin >= end; }
  bool Contains(int frame) const { return begin <= frame && frame < end; }
  auto operator<=>(const Span&) const = default;
};
using Spans = std::vector<Span>;  ///< sorted, disjoint, none empty

inline Span Common(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

/// Whether one of the spans contains the frame.
bool Covers(const Spans& spans, int frame);

/// The parts of the spans that lie in `window`.
Spans Within(const Spans& spans, Span window);

/// What the spans leave uncovered of `window`.
Spans Rest(const Spans& spans, Span window);

/// Everything that is covered by one or the other.
Spans Union(const Spans& a, const Spans& b);

/// Maximal intervals of frames of the spans for which it holds; it is asked of each, in order.
template <class Holds>
Spans Where(const Spans& spans, const Holds& holds) {
  Spans found;
  for (const Span& span : spans) {
    for (int i = span.begin; i < span.end; ++i) {
      if (!holds(i)) continue;
      if (found.empty() || found.back().end < i) found.push_back({i, i});
      found.back().end = i + 1;
    }
  }
  return found;
}

struct Recording {
  const physics::Scene& scene;
  std::span<const physics::Snapshot> frames;
  std::vector<grammar::Tick> ticks;  ///< one per frame

  int size() const { return static_cast<int>(frames.size()); }
  int body_count() const { return static_cast<int>(scene.bodies.size()); }
  double Seconds(int from_frame, int to_frame) const {
    return static_cast<double>(ticks[to_frame] - ticks[from_frame]) / scene.world.rate_hz;
  }
  double Lasts_s(Span span) const;
  /// Joins spans whose gap lasts so long or less.
  Spans Bridged(const Spans& spans, double gap_s) const;

  const physics::BodyState& body(int body, int frame) const { return frames[frame].bodies[body]; }
  const physics::HandState& hand(int hand, int frame) const { return frames[frame].hands[hand]; }
  const Eigen::Vector3d& place(int body, int frame) const {
    return frames[frame].bodies[body].X_WB.p_m;
  }
  const std::string& name(int entity) const;
};

Recording MakeRecording(const physics::Scene& scene, std::span<const physics::Snapshot> frames);

/// Velocity of the body's material at a point.
Eigen::Vector3d VelocityAt(const physics::BodyState& body, const Eigen::Vector3d& p_W_m);

/// Two entities in the order in which the fact names them.
using Pair = std::pair<int, int>;

// One choice of the numbers in the definitions, and the bands that the page of definitions,
// docs/events.md, gives them. Tested by tests/harness/truth/oracle/oracle_test.cc

/// What contacts and supports depend on.
struct SupportSettings {
  double contact_bridge_s = 0.100;      ///< a gap in contact or support that is bridged
  double support_up = 0.5;              ///< upward component of the direction of the bearing force
  double support_share = 0.02;          ///< of the object's weight that is borne, at least
  double support_speed_m_per_s = 0.02;  ///< vertical, of the object's middle or of its load
  double support_minimum_s = 0.02;      ///< a blow is over sooner
  auto operator<=>(const SupportSettings&) const = default;
};

/// What grasps depend on.
struct GraspSettings {
  double grasp_bridge_s = 0.060;   ///< a loss of grip on the object that is bridged
  double grasp_minimum_s = 0.02;   ///< a brush of two sensor sets is over sooner
  double commanded_trigger = 0.3;  ///< from here on the grip is commanded, 0..1
  int grasp_sensor_sets = 2;       ///< of one hand on the object
  double hook_force_n = 20;        ///< what pulls with this holds on with one sensor set
  double hook_slip_m_per_s = 0.3;  ///< unless it slips out of the hand
  double opening_per_s = 1;        ///< a grip that opens as fast takes hold of nothing
  double press_force_n = 2;        ///< of each side of what is pressed between two hands
  double press_facing_rad =
      2 * std::numbers::pi / 3;  ///< between the backs of their palms, at least
  auto operator<=>(const GraspSettings&) const = default;
};

/// What the begin of a reach depends on.
struct ReachSettings {
  double idle_speed_m_per_s = 0.01;    ///< slower is standing still,
  double idle_excursion_m = 0.0025;    ///< and so is getting no farther than this
  double idle_window_s = 0.5;          ///< within half of this before or after
  double onset_speed_m_per_s = 0.001;  ///< a movement begins slowly; slower is not moving yet
  double turn_pause_s = 0.1;           ///< standing still for longer before returning is a pause

  double reach_radius_m = 0.30;      ///< ball that lies ahead of the palm and touches its centre
  double reach_dead_band_m = 0.025;  ///< moving away by less is not moving away
  double reach_idle_s = 0.5;         ///< standing still for longer ends a reach
  double reach_look_back_s = 10;
  auto operator<=>(const ReachSettings&) const = default;
};

/// What slides, pick-ups and put-downs depend on, beside how a movement begins. A cylinder is a
/// region around an anchor: so far sideways, so far up and down.
struct CarrySettings {
  double slide_speed_m_per_s = 0.01;  ///< along the support, where the two touch
  double slide_window_s = 0.1;        ///< it has to be faster than that on average over this, too
  double slide_moment_s = 0.05;       ///< it has to move for that long; a dip is no longer
  double slide_pause_s = 0.150;       ///< a pause in the motion that is bridged
  double slide_displacement_m = 0.02;

  double pick_up_rise_m = 0.03;
  double pick_up_radius_m = 0.09, pick_up_height_m = 0.12;

  double put_down_drop_m = 0.02;  ///< from the highest place of the approach to the landing place
  double put_down_radius_m = 0.09, put_down_height_m = 0.08;
  double put_down_look_back_s = 3.3;
  double put_down_dead_band_m = 0.005;  ///< moving away by less is not moving away
  double put_down_window_s = 0.1;       ///< distances are medians over it
  double put_down_slip_s = 0.02;        ///< what lands so soon after it is let go was put down

  double carry_way_m = 0.005;  ///< what gets no farther until it stands again was not carried
  auto operator<=>(const CarrySettings&) const = default;
};

/// What motions of furniture depend on. A fraction of a joint's range has no unit.
struct FurnitureSettings {
  double part_speed_per_s = 0.05;  ///< slower is standing still,
  double part_window_s = 0.1;      ///< on average over this
  double part_onset = 0.001;       ///< it moves when it has got so far, until there is no more left
  double part_halt_s = 0.2;        ///< a shorter one is bridged
  double part_way = 0.1;           ///< what gets no farther has not been opened or closed
  double part_touch_s = 0.1;       ///< a shorter touch counts if the motion begins in it
  auto operator<=>(const FurnitureSettings&) const = default;
};

struct OracleSettings : SupportSettings,
                        GraspSettings,
                        ReachSettings,
                        CarrySettings,
                        FurnitureSettings {
  double reach_minimum_s = 0.1;
  double reach_brush_s = 0.05;  ///< a shorter touch on the way does not end a reach
};

// The bands of the definitions' numbers. A definition such as "short gaps are bridged" has no sharp
// number: any within the band is a fair reading of it. The bands are those of the table in
// docs/events.md. Tested by tests/harness/truth/oracle/bands_test.cc

struct Band {
  std::string_view number;  ///< its name in the table of docs/events.md
  double OracleSettings::*setting = nullptr;
  double low = 0, high = 0;  ///< SI units, both allowed
};

/// One per number, in the order of the table.
std::span<const Band> DefinitionBands();

/// The numbers of the table first; then each number at the low and at the high end of its band, the
/// others as in the table.
std::vector<OracleSettings> DefinitionChoices();

}  // namespace prehend::truth
