// SPDX-License-Identifier: Apache-2.0
// Explanations for programs. Tested by tests/harness/show/explain/explain_test.cc
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/show/explain/explain.h"

namespace prehend::show {
namespace {

using Json = nlohmann::ordered_json;
using grammar::Tick;

const char* Name(Reason::Mark mark) {
  switch (mark) {
    case Reason::Mark::kTurned:
      return "turned";
    case Reason::Mark::kHeld:
      return "held";
    case Reason::Mark::kFailed:
      return "failed";
    case Reason::Mark::kNote:
      return "note";
  }
  return "";
}

double Seconds(Tick tick, Tick ticks_per_second) {
  return static_cast<double>(tick) / static_cast<double>(ticks_per_second);
}

// JSON has no infinity.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ToJson(const Reasons& reasons, Tick ticks_per_second) {
  Json list = Json::array();
  for (const Reason& reason : reasons) {
    Json json = {{"is", Name(reason.mark)}, {"clause", reason.what}, {"text", reason.how}};
    if (!reason.where.empty()) json["rule"] = reason.where;
    if (reason.tick) json["tick"] = *reason.tick;
    if (reason.tick) json["time_s"] = Seconds(*reason.tick, ticks_per_second);
    if (reason.reading) {
      json["value"] = Number(reason.reading->value);
      json["limit"] = Number(reason.reading->limit);
      json["unit"] = reason.reading->unit;
    }
    if (!reason.because.empty()) json["because"] = ToJson(reason.because, ticks_per_second);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

Json ToJson(const WhyEvent& why, Tick ticks_per_second) {
  return {{"event", why.event},
          {"rule", why.where},
          {"begin_tick", why.interval.begin},
          {"end_tick", why.interval.end},
          {"begin_s", Seconds(why.interval.begin, ticks_per_second)},
          {"end_s", Seconds(why.interval.end, ticks_per_second)},
          {"decided_tick", why.decided},
          {"open_end", why.open_end},
          {"began", ToJson(why.began, ticks_per_second)},
          {"ended", ToJson(why.ended, ticks_per_second)},
          {"counts", ToJson(why.counted, ticks_per_second)},
          {"waited", ToJson(why.waited, ticks_per_second)}};
}

Json ToJson(const WhyMissing& why, Tick ticks_per_second) {
  Json json = {{"event", why.event}, {"rule", why.where}, {"happened", false}};
  if (why.expected_at) json["expected_s"] = Seconds(*why.expected_at, ticks_per_second);
  json["because"] = why.because;
  json["reasons"] = ToJson(why.reasons, ticks_per_second);
  Json nearest = Json::array();
  for (const WhyEvent& other : why.nearest) {
    nearest.push_back({{"begin_s", Seconds(other.interval.begin, ticks_per_second)},
                       {"end_s", Seconds(other.interval.end, ticks_per_second)}});
  }
  json["happened_at"] = std::move(nearest);
  return json;
}

}  // namespace prehend::show
