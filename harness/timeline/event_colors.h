// SPDX-License-Identifier: Apache-2.0
// The phases of a manipulation as they are pictured: which events colour a hand's path, and how.
// Colours follow Haidu & Beetz (arXiv 2011.13689), figures 1 and 6.
// Tested by tests/program/acceptance_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace prehend::harness {

struct Phase {
  std::string_view event;
  std::uint32_t color;  ///< 0xRRGGBB
};

/// In the order in which a legend lists them. Events of one hand and object that never overlap.
inline constexpr std::array<Phase, 6> kPhases = {{
    {"reaching", 0xD62728},
    {"fixation", 0xF2B705},
    {"sliding", 0x8E44AD},
    {"picking_up", 0x2CA02C},
    {"transporting", 0x12A5A5},
    {"putting_down", 0x2B5FD9},
}};

/// For everything that is not a phase: contacts, supports, grasps, user's events.
inline constexpr std::uint32_t kGraspColor = 0x8C6D46;
inline constexpr std::uint32_t kContactColor = 0xB8A100;
inline constexpr std::uint32_t kSupportColor = 0x5E9E5A;
inline constexpr std::uint32_t kOtherColor = 0x7A828C;

constexpr std::uint32_t EventColor(std::string_view event) {
  for (const Phase& phase : kPhases) {
    if (phase.event == event) return phase.color;
  }
  if (event == "grasping") return kGraspColor;
  if (event == "contact") return kContactColor;
  if (event == "supported_by") return kSupportColor;
  return kOtherColor;
}

constexpr bool IsPhase(std::string_view event) {
  for (const Phase& phase : kPhases) {
    if (phase.event == event) return true;
  }
  return false;
}

}  // namespace prehend::harness
