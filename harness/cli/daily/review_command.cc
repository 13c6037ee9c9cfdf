// SPDX-License-Identifier: Apache-2.0
// prehend review: what is to be accepted. Tested by tests/program/golden_workflow_test.cc
#include <nlohmann/json.hpp>

#include "harness/cli/command/command.h"
#include "harness/suite/accept/review.h"

namespace prehend::cli {
namespace {

ExitCode RunReview(const ParsedOptions& options, const CommandContext& context) {
  const auto reviews =
      suite::Reviews(options.All("names"), options.Text("--grammar"), context.root);
  if (!reviews) return Complain(context, reviews.error().exit_code, reviews.error().why);
  if (options.Has("--json"))
    context.out << suite::ReviewsJson(*reviews).dump(2) << "\n";
  else
    context.out << suite::ReviewsText(*reviews);
  return reviews->empty() ? ExitCode::kAgrees : ExitCode::kPending;
}

}  // namespace

Command ReviewCommand() {
  return {
      .name = "review",
      .summary = "Show what is pending, and how it differs from the goldens",
      .examples = {"review", "review milk_carton_wrap 'slide/*'"},
      .options = {{.name = "names",
                   .help =
                       "names, skill/name, globs, or files of recordings of trackers; default: all "
                       "that is pending",
                   .repeatable = true},
                  {.name = "--grammar",
                   .help =
                       "of recordings of trackers: this grammar instead of the one that they name",
                   .placeholder = "NAME|FILE"},
                  JsonOption()},
      .run = RunReview};
}

}  // namespace prehend::cli
