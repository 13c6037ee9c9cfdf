// SPDX-License-Identifier: Apache-2.0
// See harness/templates/verbs.h
#include "harness/templates/verbs.h"

namespace prehend::harness {
namespace {

constexpr std::string_view kAllNouns =
    "carton milk box bottle cup mug glass can jar ball apple orange cube block sponge";
constexpr std::string_view kUprightNouns =
    "carton milk box bottle cup mug glass can jar cube block";
constexpr std::string_view kOpenWords = "open opens opened opening pulled";
constexpr std::string_view kShutWords = "close closes closed closing shut shuts pushed";
constexpr std::string_view kPutWords = "put puts place placed places laid set drop dropped stands";
constexpr std::string_view kDoorWords = "door doors fridge cupboard";
constexpr std::string_view kDrawerWords = "drawer drawers";

constexpr std::string_view kRightHand =
    "  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}\n";

constexpr std::string_view kOnTable =
    R"(  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  @o@: {@body@, on: table, at_m: [0.2, 0.1]}
)";
/// The table is slippery, so that what is pressed onto it moves.
constexpr std::string_view kOnSmoothTable =
    R"(  table: {class: Table, fixed: true, friction: 0.4, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  @o@: {@body@, on: table, at_m: [0.1, 0.1]}
)";
constexpr std::string_view kDrawer =
    R"(  cabinet: {class: Cabinet, fixed: true, shelf: {size_m: [0.45, 0.40, 0.60]}, at_m: [0.525, 0, 0.70]}
  drawer:
    class: Drawer
    part_of: cabinet
    parts:                                              # its at_m is in the middle of its front
      - {box: {size_m: [0.02, 0.36, 0.16]}}
      - {box: {size_m: [0.36, 0.34, 0.01]}, at_m: [0.19, 0, -0.07]}
      - {box: {size_m: [0.36, 0.01, 0.10]}, at_m: [0.19, 0.165, -0.02]}
      - {box: {size_m: [0.36, 0.01, 0.10]}, at_m: [0.19, -0.165, -0.02]}
      - {box: {size_m: [0.01, 0.34, 0.10]}, at_m: [0.365, 0, -0.02]}
      - {box: {size_m: [0.076, 0.01, 0.01]}, at_m: [-0.048, 0.075, 0]}   # two posts carry the handle
      - {box: {size_m: [0.076, 0.01, 0.01]}, at_m: [-0.048, -0.075, 0]}
    mass_kg: 1.9
    at_m: [0.32, 0, 0.85]
    slider: {to: cabinet, axis: [-1, 0, 0], range_m: [0, 0.30], friction_n: 2}   # as placed it is at 0
  handle: {class: Handle, part_of: drawer, fixed_to: drawer, box: {size_m: [0.014, 0.16, 0.014]}, mass_kg: 0.1, at_m: [0.24, 0, 0.85]}
)";
constexpr std::string_view kDoor =
    R"(  cupboard: {class: Cupboard, fixed: true, shelf: {size_m: [0.40, 0.44, 0.64]}, at_m: [0.52, 0, 0.9]}
  door:
    class: Door
    part_of: cupboard
    parts:
      - {box: {size_m: [0.02, 0.40, 0.60]}}
      - {box: {size_m: [0.076, 0.01, 0.01]}, at_m: [-0.048, 0.14, 0.075]}   # two posts carry the handle
      - {box: {size_m: [0.076, 0.01, 0.01]}, at_m: [-0.048, 0.14, -0.075]}
    mass_kg: 3.9
    at_m: [0.31, 0, 0.9]
    hinge: {to: cupboard, at_m: [0.31, -0.2, 0.9], axis: [0, 0, 1], range_deg: [0, 100], friction_nm: 0.4}
  handle: {class: Handle, part_of: door, fixed_to: door, box: {size_m: [0.014, 0.014, 0.16]}, mass_kg: 0.1, at_m: [0.23, 0.14, 0.9]}
)";
constexpr std::string_view kHandAtFurniture =
    "  right_hand: {hand: human_right, at_m: [-0.1, -0.1, 0.95]}\n";

}  // namespace

const std::vector<Verb>& Verbs() {
  static const std::vector<Verb> verbs = {
      {"open_door", kOpenWords, kDoorWords, "", "", "a door is opened by its handle",
       R"(  - one grasping(right_hand, handle)
  - one opening(door)
  - one opened_by(door, right_hand)
  - closed(door) meets half_closed(door) meets half_open(door)
)",
       "grammar: [pick_and_place, furniture]", kDoor, kHandAtFurniture,
       R"(  - right_hand: {reach: handle, style: hook, from: side}
  - right_hand: {close_to: 1}
  - right_hand: {follow_joint: door, to: 0.6, over_s: 2}   # to this fraction of its range
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "opening.end"},
      {"shut_door", kShutWords, kDoorWords, "", "", "a door is opened by its handle and shut again",
       R"(  - one grasping(right_hand, handle)
  - one opening(door)
  - one closing(door)
  - one closed_by(door, right_hand)
  - half_open(door) meets half_closed(door) meets closed(door)
)",
       "grammar: [pick_and_place, furniture]", kDoor, kHandAtFurniture,
       R"(  - right_hand: {reach: handle, style: medium_wrap, from: side}
  - right_hand: {close_to: 1}
  - right_hand: {follow_joint: door, to: 0.6, over_s: 2}   # to this fraction of its range
  - right_hand: {wait_s: 0.3}
  - right_hand: {follow_joint: door, to: 0, over_s: 2}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "closing.begin"},
      {"open_drawer", kOpenWords, kDrawerWords, "", "", "a drawer is opened by its handle",
       R"(  - one grasping(right_hand, handle)
  - one opening(drawer)
  - one opened_by(drawer, right_hand)
  - closed(drawer) meets half_closed(drawer) meets half_open(drawer)
)",
       "grammar: [pick_and_place, furniture]", kDrawer, kHandAtFurniture,
       R"(  - right_hand: {reach: handle, style: hook, from: side}
  - right_hand: {close_to: 1}
  - right_hand: {follow_joint: drawer, to: 0.8, over_s: 1.2}   # to this fraction of its range
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "opening.end"},
      {"shut_drawer", kShutWords, kDrawerWords, "", "",
       "a drawer is opened by its handle and shut again",
       R"(  - one grasping(right_hand, handle)
  - one opening(drawer)
  - one closing(drawer)
  - one closed_by(drawer, right_hand)
  - half_open(drawer) meets half_closed(drawer) meets closed(drawer)
)",
       "grammar: [pick_and_place, furniture]", kDrawer, kHandAtFurniture,
       R"(  - right_hand: {reach: handle, style: medium_wrap, from: side}
  - right_hand: {close_to: 1}
  - right_hand: {follow_joint: drawer, to: 0.8, over_s: 1.5}   # to this fraction of its range
  - right_hand: {wait_s: 0.3}
  - right_hand: {follow_joint: drawer, to: 0, over_s: 1.5}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "closing.begin"},
      {"put_in", kPutWords, "in into inside", "cube ball apple orange block can", "in",
       "@a@ is taken from the table and put into the @d@",
       R"(  - one pick_and_place(right_hand, @o@)
  - putting_down(right_hand, @o@) then supported_by(@o@, @d@)
  - one supported_by(@o@, @d@)
  - no sliding
)",
       "grammar: pick_and_place",
       R"(  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  @d@: {@destination@, on: table, at_m: [0.2, -0.2]}
  @o@: {@body@, on: table, at_m: [0.2, 0.15]}
)",
       kRightHand,
       R"(  - right_hand: {reach: @o@, from: above}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.2}
  - right_hand: {carry_to_m: [0.2, -0.2]}
  - right_hand: {place_on: @d@}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "putting_down.end"},
      {"put_on", kPutWords, "on onto", kUprightNouns, "on",
       "@a@ is taken from the table and put onto the @d@",
       R"(  - one pick_and_place(right_hand, @o@)
  - putting_down(right_hand, @o@) meets supported_by(@o@, @d@)
  - one supported_by(@o@, @d@)
  - no sliding
)",
       "grammar: pick_and_place",
       R"(  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  @d@: {@destination@, on: table, at_m: [0.2, -0.2]}
  @o@: {@body@, on: table, at_m: [0.2, 0.15]}
)",
       kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.25}
  - right_hand: {carry_to_m: [0.2, -0.2]}
  - right_hand: {place_on: @d@}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "putting_down.end"},
      {"hand_over", "hand handed hands given gives passed passes", "", "bottle carton milk", "",
       "@a@ goes from the right hand to the left one in the air",
       R"(  - one grasping(right_hand, @o@)
  - one grasping(left_hand, @o@)
  - grasping(right_hand, @o@) overlaps grasping(left_hand, @o@)
  - one picking_up(right_hand, @o@)
  - no picking_up(left_hand, @o@)
  - one putting_down(left_hand, @o@)
)",
       "grammar: pick_and_place", kOnTable,
       R"(  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.0]}
  left_hand: {hand: human_left, at_m: [-0.2, 0.35, 1.1]}
)",
       R"(  - right_hand: {reach: @o@, from: side, point_m: [-0.008, 0, -0.05]}   # below its middle, on the near side
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.2}
  - left_hand: {reach: @o@, from: side, point_m: [-0.008, 0, 0.06]}   # above it
  - left_hand: {close_to: 1}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
  - left_hand: {carry_to_m: [0.1, 0.25]}
  - left_hand: {place_on: table}
  - left_hand: {open_to: 0}
)",
       "3.6"},
      {"stack", "stack stacked stacks tower", "", "cube block can box", "",
       "a second @o@ is put onto the first one, and a third onto the second",
       R"(  - one pick_and_place(right_hand, second_@o@)
  - one pick_and_place(right_hand, third_@o@)
  - one supported_by(second_@o@, first_@o@)
  - one supported_by(third_@o@, second_@o@)
  - supported_by(second_@o@, first_@o@) overlaps|contains|finished_by supported_by(third_@o@, second_@o@)
)",
       "grammar: pick_and_place",
       R"(  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  first_@o@: {@body@, on: table, at_m: [0.2, 0]}
  second_@o@: {@body@, on: table, at_m: [0.2, 0.25]}
  third_@o@: {@body@, on: table, at_m: [0.2, -0.25]}
)",
       kRightHand,
       R"(  - right_hand:                       # a list: one step after another
      - {reach: second_@o@, from: above}
      - {close_to: 1}
      - {lift_by_m: 0.25}
      - {carry_to_m: [0.2, 0]}
      - {place_on: first_@o@}
      - {open_to: 0}
      - {lift_by_m: 0.25}
  - right_hand:
      - {reach: third_@o@, from: above}
      - {close_to: 1}
      - {lift_by_m: 0.35}
      - {carry_to_m: [0.2, 0]}
      - {place_on: second_@o@}
      - {open_to: 0}
      - {lift_by_m: 0.25}
)",
       "9.5"},
      {"pour", "pour pours poured", "", "mug cup glass", "",
       "beans are poured from @a@ into a bowl",
       R"(  - one grasping(right_hand, @o@)
  - one pouring(right_hand, @o@, bowl)
  - pouring(right_hand, @o@, bowl) inside grasping(right_hand, @o@)
)",
       "grammar: pouring",
       R"(  table: {class: Table, fixed: true, box: {size_m: [0.8, 0.8, 0.04]}, at_m: [0.1, 0, 0.74]}
  @o@: {@body@, on: table, at_m: [0.2, 0.1]}
  bowl: {class: Bowl, bowl: {radius_m: 0.11, height_m: 0.07}, mass_kg: 0.5, on: table, at_m: [0.15, -0.2]}
  beans: {class: Beans, grains: {count: 40, radius_m: 0.007}, mass_kg: 0.06, friction: 0.4, rolling_friction: 0, in: @o@}
)",
       "  right_hand: {hand: human_right, at_m: [-0.1, 0.0, 0.9]}\n",
       R"(  - right_hand: {reach: @o@, from: side}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.15}
  - right_hand: {carry_to_m: [0.15, -0.1]}
  - right_hand: {turn_by_deg: [110, 0, 0], over_s: 1}    # about the world's x axis: towards the bowl
  - right_hand: {wait_s: 0.4}
  - right_hand: {turn_by_deg: [-110, 0, 0], over_s: 1}
  - right_hand: {carry_to_m: [0.2, 0.1]}
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
)",
       "pouring.end"},
      {"wipe", "wipe wipes wiped scrubbed cleaned", "", "sponge", "",
       "@a@ is pressed onto a table and wipes it to and fro without leaving it",
       R"(  - one sliding(right_hand, @o@)
  - no picking_up
  - no transporting
  - one supported_by(@o@, table)
)",
       "grammar: pick_and_place", kOnSmoothTable,
       "  right_hand: {hand: human_right, at_m: [-0.3, 0, 1.0]}\n",
       R"(  - right_hand: {reach: @o@, from: above}
  - right_hand: {close_to: 0.6}                          # a soft grip
  - right_hand: {press_n: 6, against: table, over_s: 0.6}   # it stays on the table
  - repeat: 2
    steps:
      - right_hand: {move_by_m: [0, -0.25, 0]}
      - right_hand: {move_by_m: [0, 0.25, 0]}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "sliding.begin"},
      {"shake", "shake shakes shaken", "", "bottle carton milk can jar box", "",
       "@a@ is lifted and shaken three times",
       R"(  - one grasping(right_hand, @o@)
  - picking_up(right_hand, @o@) meets transporting(right_hand, @o@) meets putting_down(right_hand, @o@)
  - one pick_and_place(right_hand, @o@)
  - no sliding
)",
       "grammar: pick_and_place", kOnTable, kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.25}
  - repeat: 3                        # this block is played three times
    steps:
      - right_hand: {move_by_m: [0, 0, 0.08], over_s: 0.25}
      - right_hand: {move_by_m: [0, 0, -0.08], over_s: 0.25}
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "2.4"},
      {"stir", "stir stirs stirred", "", "", "", "a spoon in a pot is moved in three circles",
       R"(  - one grasping(right_hand, spoon, style=pinch)
  - one stirring(right_hand, spoon, pot)
  - stirring(right_hand, spoon, pot) inside grasping(right_hand, spoon)
)",
       "grammar: stirring",
       R"(  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  pot: {class: Pot, bowl: {radius_m: 0.16, height_m: 0.08}, mass_kg: 1.5, on: table, at_m: [0.2, 0]}
  spoon: {class: Spoon, cylinder: {radius_m: 0.02, length_m: 0.26}, mass_kg: 0.15, on: pot, at_m: [0.2, 0]}
)",
       kRightHand,
       R"(  - right_hand: {reach: spoon, style: pinch, from: above}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.03, over_s: 0.3}
  - right_hand: {move_by_m: [0.04, 0, 0], over_s: 0.4}
  - repeat: 3                        # one circle of 4 cm, three times
    steps:
      - right_hand:
          relative_to: hand          # way-points from where the hand is when the step begins, in its own axes
          poses:
            - {t_s: 0.125, at_m: [-0.012, 0.028, 0]}
            - {t_s: 0.25, at_m: [-0.04, 0.04, 0]}
            - {t_s: 0.375, at_m: [-0.068, 0.028, 0]}
            - {t_s: 0.5, at_m: [-0.08, 0, 0]}
            - {t_s: 0.625, at_m: [-0.068, -0.028, 0]}
            - {t_s: 0.75, at_m: [-0.04, -0.04, 0]}
            - {t_s: 0.875, at_m: [-0.012, -0.028, 0]}
            - {t_s: 1, at_m: [0, 0, 0]}
  - right_hand: {move_by_m: [-0.04, 0, 0], over_s: 0.4}
  - right_hand: {place_on: pot}
  - right_hand: {open_to: 0}
)",
       "stirring.begin"},
      {"push", "push pushes pushed shoved", "", kUprightNouns, "",
       "an open hand pushes @a@ along the table",
       R"(  - contact(right_hand, @o@)
  - no grasping
  - no sliding
  - no picking_up
  - supported_by(@o@, table)
)",
       "grammar: pick_and_place", kOnSmoothTable,
       "  right_hand: {hand: human_right, at_m: [-0.2, 0.1, 0.83], rpy_deg: [90, 0, 0]}   # the "
       "thumb is up\n",
       R"(  - right_hand: {move_by_m: [0.4, 0, 0], over_s: 2, until: touching(@o@)}
  - right_hand: {move_by_m: [0.15, 0, 0], over_s: 1.5}
  - right_hand: {move_by_m: [-0.15, 0, 0]}
)",
       "2"},
      {"press", "press presses pressed", "", "box carton milk can jar cube block sponge", "",
       "an open hand presses @a@ onto the table",
       R"(  - contact(right_hand, @o@)
  - one supported_by(@o@, table)
  - no grasping
  - no picking_up
)",
       "grammar: pick_and_place", kOnTable,
       "  right_hand: {hand: human_right, at_m: [0.2, 0.1, 1.1]}\n",
       R"(  - right_hand: {move_by_m: [0, 0, -0.35], over_s: 3, until: touching(@o@)}
  - right_hand: {press_n: 8, against: @o@, over_s: 1}
  - right_hand: {lift_by_m: 0.1}
)",
       "2.5"},
      {"slide", "slide slides slid dragged", "", kUprightNouns, "",
       "@a@ is grasped and slides along the table",
       R"(  - one grasping(right_hand, @o@)
  - one sliding(right_hand, @o@)
  - no picking_up
  - one supported_by(@o@, table)
)",
       "grammar: pick_and_place", kOnSmoothTable,
       "  right_hand: {hand: human_right, at_m: [-0.3, -0.1, 1.05]}\n",
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 0.9}
  - right_hand: {press_n: 3, against: table, over_s: 0.4}   # closing fingers may have raised it a little
  - right_hand: {move_by_m: [0.2, 0, 0], over_s: 1}
  - right_hand: {wait_s: 0.3}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "sliding.begin"},
      {"turn", "turn turns turned rotated", "", kUprightNouns, "",
       "@a@ is lifted, turned by a quarter and put back",
       R"(  - one pick_and_place(right_hand, @o@)
  - one grasping(right_hand, @o@)
  - no sliding
)",
       "grammar: pick_and_place", kOnTable, kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.2}
  - right_hand: {turn_by_deg: [0, 0, 90]}                # about the vertical
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)",
       "transporting.end"},
      {"drop", "drop drops dropped falls", "", kAllNouns, "",
       "a hand opens in the air and @a@ falls onto the table",
       R"(  - one grasping(right_hand, @o@)
  - transporting(right_hand, @o@) finishes grasping(right_hand, @o@)
  - no putting_down
)",
       "grammar: pick_and_place", kOnTable, kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.2}
  - right_hand: {move_by_m: [0, -0.15, 0]}
  - right_hand: {open_to: 0, over_s: 0.15}
)",
       "transporting.end"},
      {"throw", "throw throws thrown tossed", "", "ball apple orange carton milk cube block can",
       "", "a hand swings forwards and opens, and @a@ flies",
       R"(  - one grasping(right_hand, @o@)
  - transporting(right_hand, @o@) finishes grasping(right_hand, @o@)
  - no putting_down
)",
       "grammar: pick_and_place", kOnTable, kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.3}
  - right_hand: {move_by_m: [-0.15, 0, 0]}
  - right_hand:
      relative_to: hand              # way-points from where the hand is when the step begins,
      axes: world                    # along the world's axes
      poses:
        - {t_s: 0.2, at_m: [0.1, 0, 0]}
        - {t_s: 0.35, at_m: [0.3, 0, 0.04], trigger: 1}
        - {t_s: 0.4, at_m: [0.38, 0, 0.06], trigger: 0}   # it opens during the swing
        - {t_s: 0.8, at_m: [0.5, 0, 0.06]}
)",
       "transporting.end, camera: hand"},
      {"carry", "carry carries carried moved moves brought placed transported placed put puts", "",
       kAllNouns, "", "@a@ is picked up, carried and put down on the table",
       R"(  - one pick_and_place(right_hand, @o@)
  - picking_up(right_hand, @o@) meets transporting(right_hand, @o@) meets putting_down(right_hand, @o@)
  - no sliding
)",
       "grammar: pick_and_place", kOnTable, kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.25}
  - right_hand: {carry_to_m: [0.2, -0.25]}               # its centre goes to this x, y; the height stays
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}                      # back the way it came
)",
       "transporting.begin"},
      {"lift", "lift lifts lifted raised raises picked picks taken held holds grasped shown", "",
       kAllNouns, "", "@a@ is grasped and lifted, and still in the hand at the end",
       R"(  - one grasping(right_hand, @o@)
  - picking_up(right_hand, @o@) meets transporting(right_hand, @o@)
  - no putting_down
)",
       "grammar: pick_and_place", kOnTable, kRightHand,
       R"(  - right_hand: {reach: @o@}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.25}
  - right_hand: {wait_s: 0.5}
)",
       "transporting.begin"},
  };
  return verbs;
}

}  // namespace prehend::harness
