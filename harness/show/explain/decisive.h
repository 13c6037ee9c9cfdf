// SPDX-License-Identifier: Apache-2.0
// The decisive clause: the one whose number, changed by the smallest share, makes an event happen
// that did not, or not happen that did. Found by trying: the grammar is compiled with other
// numbers, and the episode watched again. Tested by tests/harness/show/explain/decisive_test.cc
#pragma once

#include <functional>
#include <memory>

#include "grammar/base/timeline.h"
#include "harness/show/explain/clauses.h"
#include "harness/show/explain/query.h"

namespace prehend::show {

/// What a program recognises in the episode; nothing if it cannot.
using Recognise =
    std::function<std::optional<grammar::Timeline>(const std::shared_ptr<const grammar::Program>&)>;

/// Whether an event is an answer to the question: name, entities, moment.
bool Answers(const Ask& ask, const grammar::Program& program, const grammar::EntityTable& entities,
             const grammar::NamedEvent& event);

/// Sets `decisive`. With no such clause, what it says is empty.
void FindDecisive(const grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyMissing& why);
void FindDecisive(const grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyEvent& why);

}  // namespace prehend::show
