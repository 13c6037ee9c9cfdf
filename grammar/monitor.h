// SPDX-License-Identifier: Apache-2.0
// From text to events: Compile() a grammar, then feed a Monitor one Frame after another.
// Tested by tests/grammar/monitor_test.cc and the corpus in tests/grammar/corpus/
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/diagnostic.h"
#include "grammar/frame.h"

namespace prehend::grammar {

struct Program;  // grammar/program.h

/// Text of the file that `use NAME` asks for, with the file name to report in diagnostics; nullopt:
/// no such file.
struct GrammarText {
  std::string file;
  std::string text;
};
using Includer = std::function<std::optional<GrammarText>(std::string_view name)>;

/// Parameter overrides, `name` -> `value with unit` as it would stand in the grammar ("25 cm",
/// "0.3").
using Overrides = std::map<std::string, std::string>;

struct CompileResult {
  std::shared_ptr<const Program> program;  ///< null when there are errors
  Diagnostics diagnostics;
  Diagnostics warnings;  ///< what is allowed and yet looks like a mistake
};

CompileResult Compile(const GrammarText& grammar, const Includer& includer,
                      const Overrides& overrides = {});

inline constexpr int kMaxRoles = 4;
inline constexpr int kMaxAttributes = 4;

/// One recognised event. Names are in Program::events[rule].
struct Event {
  int rule = 0;
  std::array<int, kMaxRoles> roles = {kNobody, kNobody, kNobody, kNobody};  ///< entity ids
  Interval interval;
  Tick decided = 0;       ///< the tick of the frame at which it became certain
  int style = kNobody;    ///< value of `with style = style(hand)`, index into Cast::styles
  bool open_end = false;  ///< closed by Finish(), not by what happened
  /// Values of `with name = value`, SI units, in the order of Program::events[rule].attributes.
  std::array<double, kMaxAttributes> attributes = {};
};

/// Watches one episode. Allocates nothing per frame after warm-up.
class Monitor {
 public:
  /// Errors (e.g. more bindings than the limit) are thrown away nowhere: see error().
  Monitor(std::shared_ptr<const Program> program, Cast cast);
  ~Monitor();
  Monitor(Monitor&&) noexcept;
  Monitor& operator=(Monitor&&) noexcept;

  /// Empty, or why this program can't watch this cast.
  const std::string& error() const;

  /// Looks at one frame and appends the events that became certain, ordered by (decided, begin,
  /// rule, roles).
  void Advance(const Frame& frame, std::vector<Event>& out);
  /// The same for a frame that is given by what is new in it; costs time for changes only. Both
  /// kinds may be mixed.
  void AdvanceBy(const FrameChanges& changes, std::vector<Event>& out);

  /// The episode ends at `end`, the first tick that no longer belongs to it: closes what is open.
  void Finish(Tick end, std::vector<Event>& out);

  /// Bindings that take memory now, of all rules.
  int lanes_in_use() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prehend::grammar
