// SPDX-License-Identifier: Apache-2.0
// Where exceptions of the database and of frames become diagnostics: they do not leave this room.
// Tested by tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <string>
#include <type_traits>

#include "harness/base/base/result.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/frames/columns.h"

namespace prehend::episode {

/// What `work` returns, or an error about the file. `about`: begins its message.
template <typename Work>
auto Guarded(const std::string& file, const Work& work, const std::string& about = "")
    -> Result<std::invoke_result_t<Work>> {
  const auto wrong = [&](const std::string& message) {
    return tl::unexpected(grammar::Diagnostics{
        {.file = file, .place = {}, .message = about + message, .source_line = {}, .hint = {}}});
  };
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
      work();
      return {};
    } else {
      return work();
    }
  } catch (const DatabaseError& error) {
    return wrong(error.what());
  } catch (const Damage& damage) {
    return wrong(std::string("the file is damaged: ") + damage.what());
  }
}

/// The same as a text: "", or "FILE: what went wrong".
template <typename Work>
std::string ProblemOf(const std::string& file, const Work& work) {
  const auto done = Guarded(file, work);
  return done ? "" : file + ": " + done.error().front().message;
}

}  // namespace prehend::episode
