// SPDX-License-Identifier: Apache-2.0
// prehend::episode: episodes that were recorded, of any kind, and what grammars recognise in them.
// Metres, radians, seconds, newtons; z is up; quaternions as in Eigen. Ticks are whole numbers,
// EntityTable::ticks_per_second of them a second; intervals are [begin, end). Functions throw
// prehend::Error. Threads may share what is here: they take turns. Source: ARCHITECTURE.md, "The
// flow". Tested by tests/python/test_events.py and tests/install/installed.py
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/frame.h"
#include "grammar/base/source.h"
#include "grammar/base/timeline.h"

#define PREHEND_API __attribute__((visibility("default")))

namespace prehend {

namespace grammar {
struct Program;  // grammar/program/program.h
}

/// Wrong input. what() is all diagnostics as the program prints them: `file:line:column: error:
/// message`, the line with a caret, and the remedy.
class PREHEND_API Error : public std::runtime_error {
 public:
  explicit Error(grammar::Diagnostics diagnostics);
  Error(const Error&);
  ~Error() override;
  /// Never empty.
  const grammar::Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  grammar::Diagnostics diagnostics_;
};

/// A grammar, compiled; immutable.
class PREHEND_API Grammar {
 public:
  /// `name_or_path`: of the library or of the project, or a file ("my/rules.grammar"); several with
  /// '+' between them are compiled as one. `parameters`: name -> value with unit as in the text,
  /// {"reach_radius", "25 cm"}. `instead`: path -> what is compiled in place of the file's text.
  explicit Grammar(std::string name_or_path, grammar::Overrides parameters = {},
                   const std::map<std::string, std::string>& instead = {});
  Grammar(const Grammar&);
  ~Grammar();

  /// As in the text.
  const std::string& name() const;
  const std::string& name_or_path() const { return name_or_path_; }
  const grammar::Overrides& parameters() const { return parameters_; }
  /// What it was looked for in; those that exist are its texts, its own first.
  const std::vector<std::string>& files() const { return files_; }
  /// For grammar::Monitor, grammar::Describe(), grammar::EventSignatures().
  const std::shared_ptr<const grammar::Program>& program() const { return program_; }

 private:
  std::string name_or_path_;
  grammar::Overrides parameters_;
  std::vector<std::string> files_;
  std::shared_ptr<const grammar::Program> program_;
};

/// What a grammar recognises in an episode.
struct Segmented {
  grammar::Timeline timeline;
  grammar::Tick end = 0;  ///< the first tick after the episode
  /// Lines: what the episode does not have of what the rules ask for, each rule with its place.
  std::string warnings;
  std::string failure;  ///< "", or why its simulation ended early
};

/// An episode of a file, or one made of frames (FrameBuilder). Copies are the same episode.
class PREHEND_API Episode {
 public:
  /// "skill/name" of a simulated one; of a recording its name, or that of the file.
  const std::string& name() const;
  const std::string& file() const;             ///< "": of no file
  std::optional<std::int64_t> number() const;  ///< in an episode file
  bool was_simulated() const;                  ///< otherwise a recording
  const std::string& grammar_name() const;     ///< that it names for itself
  grammar::EntityTable entities() const;       ///< who takes part
  grammar::Tick end() const;                   ///< the first tick after it
  /// Calls `look` with each frame that a grammar sees. Returns "", or why its simulation ended
  /// early.
  std::string EachFrame(const std::function<void(const grammar::Frame&)>& look) const;

  /// What was recognised when it was recorded; nothing if no events were recorded with it.
  std::optional<grammar::Timeline> Recorded() const;
  /// What the grammar recognises, as `prehend episode resegment` does; by default its own.
  Segmented Segment(const Grammar* grammar = nullptr) const;
  /// Writes its frames as a recording (docs/recording-format.md), NAME.jsonl.
  void WriteFrames(const std::string& file) const;
  /// Writes events for people's tools: ELAN (.eaf), Praat (.TextGrid) or .csv. `grammar` says which
  /// roles are hands; without it those called "hand".
  void WriteLabels(const grammar::Timeline& timeline, const std::string& file,
                   const Grammar* grammar = nullptr) const;

  struct __attribute__((visibility("hidden"))) Impl;
  explicit Episode(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<Impl> impl_;
};

/// Episode files (NAME.episodes) and recordings as JSON Lines. Of episode files those that `which`
/// selects: a number, a scenario ("name", "skill/name") or a glob; "": all. Never empty.
PREHEND_API std::vector<Episode> OpenEpisodes(const std::vector<std::string>& files,
                                              const std::string& which = "");

}  // namespace prehend
