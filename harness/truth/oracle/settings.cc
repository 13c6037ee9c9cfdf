// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/settings.h"

#include <array>
#include <numbers>

namespace prehend::truth {

std::span<const Band> DefinitionBands() {
  using S = OracleSettings;
  constexpr double kDegree = std::numbers::pi / 180;
  static constexpr std::array kBands = {
      Band{"contact gap", &S::contact_bridge_s, 0.080, 0.120},
      Band{"grip gap", &S::grasp_bridge_s, 0.045, 0.080},
      Band{"support direction", &S::support_up, 0.35, 0.64},
      Band{"support share", &S::support_share, 0.001, 0.10},
      Band{"support settled", &S::support_speed_m_per_s, 0.01, 0.04},
      Band{"support minimum", &S::support_minimum_s, 0.015, 0.030},
      Band{"grip minimum", &S::grasp_minimum_s, 0.015, 0.030},
      Band{"grip command", &S::commanded_trigger, 0.2, 0.4},
      Band{"hook force", &S::hook_force_n, 15, 25},
      Band{"hook slip", &S::hook_slip_m_per_s, 0.2, 0.4},
      Band{"grip opening", &S::opening_per_s, 0.7, 1.5},
      Band{"press force", &S::press_force_n, 1, 4},
      Band{"press facing", &S::press_facing_rad, 110 * kDegree, 130 * kDegree},
      Band{"reach region", &S::reach_radius_m, 0.25, 0.35},
      Band{"reach dead-band", &S::reach_dead_band_m, 0.020, 0.030},
      Band{"reach idle speed", &S::idle_speed_m_per_s, 0.007, 0.015},
      Band{"reach idle way", &S::idle_excursion_m, 0.002, 0.0035},
      Band{"reach idle window", &S::idle_window_s, 0.4, 0.6},
      Band{"reach idle time", &S::reach_idle_s, 0.4, 0.6},
      Band{"onset", &S::onset_speed_m_per_s, 0.0005, 0.003},
      Band{"turn pause", &S::turn_pause_s, 0.05, 0.2},
      Band{"reach look-back", &S::reach_look_back_s, 8, 12},
      Band{"reach minimum", &S::reach_minimum_s, 0.08, 0.12},
      Band{"reach brush", &S::reach_brush_s, 0.04, 0.06},
      Band{"slide speed", &S::slide_speed_m_per_s, 0.007, 0.015},
      Band{"slide window", &S::slide_window_s, 0.08, 0.12},
      Band{"slide jerk", &S::slide_moment_s, 0.04, 0.06},
      Band{"slide pause", &S::slide_pause_s, 0.12, 0.18},
      Band{"slide way", &S::slide_displacement_m, 0.015, 0.025},
      Band{"lift rise", &S::pick_up_rise_m, 0.025, 0.035},
      Band{"lift radius", &S::pick_up_radius_m, 0.08, 0.10},
      Band{"lift height", &S::pick_up_height_m, 0.10, 0.14},
      Band{"put drop", &S::put_down_drop_m, 0.015, 0.025},
      Band{"put radius", &S::put_down_radius_m, 0.08, 0.10},
      Band{"put height", &S::put_down_height_m, 0.07, 0.09},
      Band{"put look-back", &S::put_down_look_back_s, 3.0, 4.0},
      Band{"put dead-band", &S::put_down_dead_band_m, 0.004, 0.006},
      Band{"put window", &S::put_down_window_s, 0.08, 0.12},
      Band{"put slip", &S::put_down_slip_s, 0.015, 0.025},
      Band{"carry way", &S::carry_way_m, 0.004, 0.006},
      Band{"part speed", &S::part_speed_per_s, 0.04, 0.06},
      Band{"part window", &S::part_window_s, 0.08, 0.12},
      Band{"part onset", &S::part_onset, 0.0005, 0.002},
      Band{"part halt", &S::part_halt_s, 0.16, 0.24},
      Band{"part way", &S::part_way, 0.08, 0.12},
      Band{"part touch", &S::part_touch_s, 0.08, 0.12},
  };
  return kBands;
}

std::vector<OracleSettings> DefinitionChoices() {
  std::vector<OracleSettings> choices = {{}};
  for (const Band& band : DefinitionBands()) {
    for (const double value : {band.low, band.high}) {
      OracleSettings choice;
      choice.*band.setting = value;
      choices.push_back(choice);
    }
  }
  return choices;
}

}  // namespace prehend::truth
