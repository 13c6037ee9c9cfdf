// SPDX-License-Identifier: Apache-2.0
// What is behind an Episode of the library. Tested by tests/python/test_events.py
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "harness/base/base/result.h"
#include "harness/episode/episode/episode.h"
#include "harness/library/library/episode.h"

namespace prehend {

/// A result's value, or its diagnostics as an exception.
template <typename T>
T Unwrap(Result<T> result) {
  if (!result) throw Error(std::move(result.error()));
  return std::move(*result);
}

[[noreturn]] void Refuse(std::string file, std::string message, std::string hint = {});

/// The project whose grammars have names.
std::string ProjectRoot();

/// What episodes that were opened together share.
struct Opener {
  Opener() : opener(ProjectRoot()) {}
  std::recursive_mutex mutex;
  episode::EpisodeOpener opener;
};

struct Episode::Impl {
  episode::EpisodeName name;
  std::string file;
  std::shared_ptr<Opener> shared = std::make_shared<Opener>();
  /// Recordings of no episode file; what is in one is opened each time, as its frames are many.
  std::optional<episode::Episode> kept = std::nullopt;
  std::shared_ptr<const grammar::Program> own = nullptr;     ///< of what is kept
  std::optional<grammar::EntityTable> table = std::nullopt;  ///< since it was opened first
  grammar::Tick end = 0;                                     ///< likewise

  /// Calls `use` with the open episode, whichever grammar it has.
  template <typename Use>
  auto WithFrames(const Use& use) {
    const std::lock_guard lock(shared->mutex);
    if (kept) return use(Known(*kept));
    episode::Episode opened = Open();
    if (name.number) return use(Known(opened));
    kept = std::move(opened);
    return use(Known(*kept));
  }
  /// Calls `use` with the open episode and this grammar; null: its own.
  template <typename Use>
  auto With(const Grammar* grammar, const Use& use) {
    return WithFrames([&](episode::Episode& episode) {
      Choose(episode, grammar);
      return use(episode);
    });
  }

 private:
  episode::Episode Open();
  episode::Episode& Known(episode::Episode& episode);
  void Choose(episode::Episode& episode, const Grammar* grammar);
};

}  // namespace prehend
