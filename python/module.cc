// SPDX-License-Identifier: Apache-2.0
// The library as a Python module: numbers as arrays, events as tuples. python/prehend/ makes of
// them what users see. The interpreter's lock is released while the engine works. Tested by
// tests/python/
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>

#include "grammar/contents.h"
#include "grammar/describe.h"
#include "grammar/language/parser.h"
#include "harness/library/library/frames.h"
#include "harness/library/library/study.h"

namespace py = pybind11;

namespace prehend {
namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;
using Numbers = py::array_t<double, py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// An array that takes the place of a vector, without copying its numbers.
template <typename T>
py::array_t<T> ToArray(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto* owned = new std::vector<T>(std::move(values));
  const py::capsule owner(owned, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), owned->data(), owner);
}

/// (event, [(role, value)], begin, end, decided, open_end, [(name, value, unit)]), in ticks.
py::list ToPython(const grammar::Timeline& timeline) {
  py::list events;
  for (const grammar::NamedEvent& event : timeline.events) {
    py::list roles, values;
    for (const grammar::Role& role : event.roles)
      roles.append(py::make_tuple(role.name, role.value));
    for (const grammar::NamedValue& value : event.values)
      values.append(py::make_tuple(value.name, value.value, value.unit));
    events.append(py::make_tuple(event.event, roles, event.interval.begin, event.interval.end,
                                 event.decided, event.open_end, values));
  }
  return events;
}

using EventTuple = std::tuple<std::string, std::vector<std::pair<std::string, std::string>>,
                              grammar::Tick, grammar::Tick, grammar::Tick>;

/// In the order of `events`.
grammar::Timeline InRows(const std::vector<EventTuple>& events, grammar::Tick per_second) {
  grammar::Timeline timeline{.ticks_per_second = per_second};
  for (const auto& [name, roles, begin, end, decided] : events) {
    grammar::NamedEvent& event = timeline.events.emplace_back();
    event.event = name;
    for (const auto& [role, value] : roles) event.roles.push_back({role, value});
    event.interval = {begin, end};
    event.decided = decided;
  }
  return timeline;
}

grammar::Timeline ToTimeline(const std::vector<EventTuple>& events, grammar::Tick per_second) {
  grammar::Timeline timeline = InRows(events, per_second);
  std::stable_sort(timeline.events.begin(), timeline.events.end(), grammar::ComesBefore);
  return timeline;
}

py::list ToPython(const grammar::EntityTable& table) {
  py::list entities;
  for (const grammar::EntityInfo& one : table.entities) {
    py::dict entity;
    entity["name"] = one.name;
    entity["class"] = one.classes.empty() ? "" : one.classes.front();
    entity["classes"] = one.classes;
    entity["part_of"] = one.part_of == grammar::kNoEntity
                            ? ""
                            : table.entities[static_cast<std::size_t>(one.part_of)].name;
    const Eigen::Vector3d size_m = 2 * one.half_size_m;
    entity["size_m"] = py::make_tuple(size_m.x(), size_m.y(), size_m.z());
    entity["mass_kg"] = one.mass_kg;
    entities.append(entity);
  }
  return entities;
}

/// All frames of an episode: ticks (N), poses (N, E, 7), velocities (N, E, 6), grips (N, E; NaN:
/// no hand), touches as (K, 3) integers frame, a, b and (K, 2) numbers up_on_a, force_n.
py::tuple FramesOf(const Episode& episode) {
  std::vector<std::int64_t> ticks, pairs;
  std::vector<double> poses, velocities, grips, measured;
  const auto entities = static_cast<py::ssize_t>(episode.entities().entities.size());
  std::string failure;
  {
    const py::gil_scoped_release unlocked;
    failure = episode.EachFrame([&](const grammar::Frame& frame) {
      for (const grammar::EntitySample& seen : frame.entities) {
        const grammar::EntitySample look = grammar::IsMeasured(seen) ? seen : grammar::NotTracked();
        poses.insert(poses.end(), look.p_WB_m.begin(), look.p_WB_m.end());
        poses.insert(poses.end(), {look.q_WB.w(), look.q_WB.x(), look.q_WB.y(), look.q_WB.z()});
        velocities.insert(velocities.end(), look.v_WB_m_per_s.begin(), look.v_WB_m_per_s.end());
        velocities.insert(velocities.end(), look.w_WB_rad_per_s.begin(), look.w_WB_rad_per_s.end());
      }
      grips.resize(grips.size() + frame.entities.size(), std::nan(""));
      for (const grammar::HandSample& hand : frame.hands)
        grips[grips.size() - frame.entities.size() + static_cast<std::size_t>(hand.entity)] =
            hand.trigger;
      for (const grammar::Touch& touch : frame.touches) {
        pairs.insert(pairs.end(), {static_cast<std::int64_t>(ticks.size()), touch.a, touch.b});
        measured.insert(measured.end(), {touch.up_on_a, touch.normal_force_n});
      }
      ticks.push_back(frame.tick);
    });
  }
  const auto frames = static_cast<py::ssize_t>(ticks.size());
  const auto touches = static_cast<py::ssize_t>(pairs.size() / 3);
  return py::make_tuple(
      ToArray(std::move(ticks), {frames}), ToArray(std::move(poses), {frames, entities, 7}),
      ToArray(std::move(velocities), {frames, entities, 6}),
      ToArray(std::move(grips), {frames, entities}), ToArray(std::move(pairs), {touches, 3}),
      ToArray(std::move(measured), {touches, 2}), failure);
}

/// Makes an episode of arrays whose shapes python/prehend/frames.py has checked.
Episode EpisodeOf(const std::string& first_line, const Integers& ticks,
                  const std::vector<std::tuple<int, Numbers, py::array>>& columns,
                  const std::vector<std::pair<int, Numbers>>& grips, const Integers& touches,
                  const Numbers& ups, grammar::Tick end) {
  struct Read {
    int entity;
    py::detail::unchecked_reference<double, 2> poses;
    std::optional<py::detail::unchecked_reference<bool, 1>> mentioned;
  };
  std::vector<Read> poses;
  std::vector<std::pair<int, py::detail::unchecked_reference<double, 1>>> grip;
  for (const auto& [entity, values, mentioned] : columns) {
    poses.push_back({entity, values.unchecked<2>(), std::nullopt});
    if (mentioned.size() > 0)
      poses.back().mentioned.emplace(py::array_t<bool>(mentioned).unchecked<1>());
  }
  for (const auto& [hand, values] : grips) grip.emplace_back(hand, values.unchecked<1>());
  const auto tick = ticks.unchecked<1>();
  const auto touch = touches.unchecked<2>();
  const auto up = ups.unchecked<1>();
  const py::gil_scoped_release unlocked;
  FrameBuilder builder(first_line);
  std::vector<PoseSeen> seen;
  std::vector<GripSeen> gripping;
  std::vector<TouchSeen> touching;
  for (py::ssize_t i = 0, k = 0; i < tick.shape(0); ++i) {
    seen.clear();
    gripping.clear();
    touching.clear();
    for (const Read& one : poses) {
      if (one.mentioned && !(*one.mentioned)(i)) continue;
      const auto& p = one.poses;
      PoseSeen& pose = seen.emplace_back(PoseSeen{one.entity, {p(i, 0), p(i, 1), p(i, 2)}});
      if (p.shape(1) == 7) pose.q_wxyz = {p(i, 3), p(i, 4), p(i, 5), p(i, 6)};
    }
    for (const auto& [hand, trigger] : grip) {
      if (!std::isnan(trigger(i))) gripping.push_back({hand, trigger(i)});
    }
    for (; k < touch.shape(0) && touch(k, 0) == i; ++k)
      touching.push_back({static_cast<int>(touch(k, 1)), static_cast<int>(touch(k, 2)), up(k)});
    builder.Take(tick(i), seen, gripping, touching);
  }
  return builder.Finish(end);
}

/// One thread at a time.
class LiveMonitor {
 public:
  LiveMonitor(const Grammar& grammar, const std::string& first_line)
      : monitor_(grammar, first_line) {}

  py::list Take(const std::string& line) {
    return Alone([&] { return monitor_.Take(line); });
  }
  py::list Finish(grammar::Tick end) {
    return Alone([&] { return monitor_.Finish(end); });
  }
  const Monitor& monitor() const { return monitor_; }

 private:
  template <typename Use>
  py::list Alone(const Use& use) {
    if (in_use_.test_and_set())
      throw Error(grammar::Diagnostics{
          {.file = "frames",
           .message = "the monitor is in use by another thread",
           .hint = "a monitor for each thread, or a threading.Lock around it"}});
    const std::unique_ptr<std::atomic_flag, void (*)(std::atomic_flag*)> release(
        &in_use_, [](std::atomic_flag* flag) { flag->clear(); });
    grammar::Timeline timeline;
    {
      const py::gil_scoped_release unlocked;
      timeline = use();
    }
    return ToPython(timeline);
  }

  Monitor monitor_;
  std::atomic_flag in_use_ = ATOMIC_FLAG_INIT;
};

/// An exception of python/prehend/errors.py.
void Translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    py::list diagnostics;
    for (const grammar::Diagnostic& one : error.diagnostics())
      diagnostics.append(py::make_tuple(one.file, one.place.line, one.place.column, one.message,
                                        one.hint, grammar::Format(one)));
    const py::object made = py::module_::import("prehend.errors").attr("of")(diagnostics);
    PyErr_SetObject(py::type::of(made).ptr(), made.ptr());
  }
}

py::list ParametersOf(const Grammar& grammar) {
  py::list parameters;
  for (const grammar::ProgramParam& one : grammar::Describe(*grammar.program()).params)
    parameters.append(py::make_tuple(one.name, grammar::ReadableQuantityText(one.value)));
  return parameters;
}

py::list SignaturesOf(const Grammar& grammar) {
  py::list signatures;
  for (const grammar::EventSignature& one : grammar::EventSignatures(*grammar.program()))
    signatures.append(py::make_tuple(one.name, one.roles, one.classes,
                                     one.drawing.as == grammar::DrawnAs::kPhase));
  return signatures;
}

using At = std::pair<int, int>;
At ToPython(grammar::Place place) { return {place.line, place.column}; }

/// (kind, text, place, begin, end, args)
py::tuple ToPython(const grammar::ast::Expr& expr) {
  static constexpr std::array kKinds = {"quantity", "name",  "text", "call",  "unary",
                                        "binary",   "chain", "edge", "anchor"};
  py::list args;
  for (const grammar::ast::Expr& arg : expr.args) args.append(ToPython(arg));
  return py::make_tuple(kKinds[static_cast<std::size_t>(expr.kind)], expr.text,
                        ToPython(expr.place), ToPython(expr.begin), ToPython(expr.end), args);
}

/// What stands behind each word of a definition, in any order: (word, expression).
py::list WordsOf(const grammar::ast::Definition& d) {
  using Form = grammar::ast::Definition::Form;
  py::list words;
  const auto add = [&](const char* word, const auto& expr) {
    if constexpr (requires { expr.has_value(); }) {
      if (expr) words.append(py::make_tuple(word, ToPython(*expr)));
    } else {
      words.append(py::make_tuple(word, ToPython(expr)));
    }
  };
  if (d.form == Form::kWhile) add("while", d.first);
  if (d.form == Form::kFromTo) add("from", d.first);
  if (d.form == Form::kFromTo) add(d.absence ? "without" : "to", d.second);
  if (d.form == Form::kUntilSince) add("until", d.first);
  if (d.form == Form::kUntilSince) add("since", d.second);
  if (d.form == Form::kUntilSince) add("at most .. back", d.at_most_back);
  if (d.form == Form::kRestOf) add("rest of", d.first);
  if (d.form == Form::kRepeat) add("at least", d.at_least);
  if (d.approach) {
    add("approaching", d.approach->signal);
    add("receding at most", d.approach->slack);
    for (const auto* one :
         {&d.approach->over, &d.approach->still, &d.approach->still_over, &d.approach->onset})
      add("approaching", *one);
    for (const auto* one : {&d.approach->motion, &d.approach->speed, &d.approach->idle})
      add("slower than", *one);
  }
  for (const grammar::ast::Expr& one : d.outside) add("outside", one);
  for (const grammar::ast::Expr& one : d.repeated) add("repeat", one);
  for (const grammar::ast::Part& part : d.parts)
    for (const grammar::ast::Expr& one : part.calls) add("part", one);
  for (const grammar::ast::Relation& relation : d.relations)
    for (const auto& one : relation.alternatives) add("where", one.within);
  add("until", d.until);
  add("within", d.within);
  add("during", d.during);
  add("gap at most", d.gap);
  add("bridging", d.bridging);
  add("lasting", d.lasting);
  add("lasting .. to", d.lasting_to);
  add("requires", d.requirement);
  if (d.confirmed) add("confirmed by", d.confirmed->by);
  if (d.confirmed) add("confirmed within", d.confirmed->within);
  for (const grammar::ast::Attribute& one : d.attributes) add("with", one.value);
  return words;
}

/// Of a grammar's text: (params, definitions), each (name, place) and (name, place, words, places
/// of relations); what is named by `define` stands behind "=".
py::tuple Syntax(const std::string& file, const std::string& text) {
  grammar::Diagnostics wrong;
  const grammar::ast::File tree = grammar::Parse({file, text}, wrong);
  if (!wrong.empty()) throw Error(wrong);
  py::list params, definitions;
  for (const grammar::ast::Param& one : tree.params)
    params.append(py::make_tuple(one.name, ToPython(one.place)));
  for (const grammar::ast::Define& one : tree.defines) {
    py::list words;
    words.append(py::make_tuple("=", ToPython(one.body)));
    definitions.append(py::make_tuple(one.name, ToPython(one.place), words, py::list()));
  }
  for (const grammar::ast::Definition& one : tree.definitions) {
    py::list relations;
    for (const grammar::ast::Relation& relation : one.relations)
      relations.append(ToPython(relation.place));
    definitions.append(py::make_tuple(one.name, ToPython(one.place), WordsOf(one), relations));
  }
  return py::make_tuple(params, definitions);
}

py::tuple Segment(const Episode& episode, const Grammar* grammar) {
  Segmented segmented;
  {
    const py::gil_scoped_release unlocked;
    segmented = episode.Segment(grammar);
  }
  return py::make_tuple(ToPython(segmented.timeline), segmented.end, segmented.warnings,
                        segmented.failure);
}

py::tuple SignalArrays(const Episode& episode, const Grammar* grammar,
                       const std::vector<std::string>& only) {
  Signals signals;
  {
    const py::gil_scoped_release unlocked;
    signals = SignalsOf(episode, grammar, only);
  }
  py::list columns;
  const auto frames = static_cast<py::ssize_t>(signals.ticks.size());
  for (Signals::Signal& one : signals.signals)
    columns.append(py::make_tuple(one.name, one.unit, ToArray(std::move(one.values), {frames})));
  return py::make_tuple(ToArray(std::move(signals.ticks), {frames}), columns);
}

}  // namespace
}  // namespace prehend

PYBIND11_MODULE(_prehend, m) {
  using namespace prehend;  // NOLINT: as short as the table that it is
  using Events = std::vector<EventTuple>;
  m.attr("__version__") = PREHEND_VERSION;
  py::register_exception_translator(&Translate);
  py::class_<Grammar>(m, "Grammar")
      .def(py::init<std::string, grammar::Overrides, std::map<std::string, std::string>>(),
           py::arg("name_or_path"), py::arg("parameters"),
           py::arg("instead") = std::map<std::string, std::string>(), Unlocked())
      .def_property_readonly("files", &Grammar::files)
      .def_property_readonly("name", &Grammar::name)
      .def("parameters", &ParametersOf)
      .def("events", &SignaturesOf)
      .def("describe", [](const Grammar& g) { return Text(grammar::Describe(*g.program())); });
  py::class_<Episode>(m, "Episode")
      .def_property_readonly("name", &Episode::name)
      .def_property_readonly("file", &Episode::file)
      .def_property_readonly("number", &Episode::number)
      .def_property_readonly("was_simulated", &Episode::was_simulated)
      .def_property_readonly("grammar", &Episode::grammar_name)
      .def("end", &Episode::end, Unlocked())
      .def("ticks_per_second", [](const Episode& e) { return e.entities().ticks_per_second; })
      .def("entities", [](const Episode& e) { return ToPython(e.entities()); })
      .def("frames", &FramesOf)
      .def("recorded",
           [](const Episode& e) -> py::object {
             std::optional<grammar::Timeline> recorded;
             {
               const py::gil_scoped_release unlocked;
               recorded = e.Recorded();
             }
             return recorded ? py::object(ToPython(*recorded)) : py::none();
           })
      .def("segment", &Segment)
      .def("signals", &SignalArrays)
      .def(
          "explain",
          [](const Episode& e, const Grammar* grammar, const std::string& event) {
            const Explanation why = Explain(e, grammar, event);
            return std::pair(why.text, why.json);
          },
          Unlocked())
      .def(
          "read_labels",
          [](const Episode& e, const Grammar* grammar, const std::string& file,
             const std::string& map, std::optional<std::size_t> entry) {
            return ToPython(ReadLabels(e, grammar, file, map, entry));
          },
          py::arg("grammar"), py::arg("file"), py::arg("map"), py::arg("entry") = py::none())
      .def("write_frames", &Episode::WriteFrames, Unlocked())
      .def("write_labels", [](const Episode& e, const Events& events, const std::string& file,
                              const Grammar* grammar) {
        e.WriteLabels(ToTimeline(events, e.entities().ticks_per_second), file, grammar);
      });
  py::class_<LiveMonitor>(m, "Monitor")
      .def(py::init<const Grammar&, const std::string&>())
      .def("entities", [](const LiveMonitor& one) { return ToPython(one.monitor().entities()); })
      .def("warnings", [](const LiveMonitor& one) { return one.monitor().warnings(); })
      .def("moved", [](const LiveMonitor& one) { return one.monitor().moved(); })
      .def("take", &LiveMonitor::Take)
      .def("finish", &LiveMonitor::Finish);
  m.def("syntax", &Syntax);
  m.def("open", &OpenEpisodes, Unlocked());
  m.def("format_grammar", &FormatGrammar);
  m.def("check_grammar", [](const std::string& file, const std::string& text) {
    py::list all;
    for (const grammar::Diagnostic& d : CheckText(file, text))
      all.append(
          py::make_tuple(d.file, d.place.line, d.place.column, d.message, d.hint, d.is_warning));
    return all;
  });
  m.def("episode_of", &EpisodeOf);
  m.def("score", [](const Grammar& grammar,
                    const std::vector<std::tuple<Episode, Events, std::string, grammar::Tick>>& all,
                    const std::string& map, std::optional<double> collar_s) {
    std::vector<Compared> episodes;
    for (const auto& [episode, found, labels, end] : all)
      episodes.push_back(
          {episode, InRows(found, episode.entities().ticks_per_second), labels, end});
    return ScoreJson(grammar, episodes, map, collar_s);
  });
  m.def("margins", &MarginsCsv, Unlocked());
  m.def("timeline_svg", [](const Events& events, grammar::Tick per_second, grammar::Tick end,
                           const Grammar* grammar) {
    return TimelineSvg(ToTimeline(events, per_second), end, grammar);
  });
}
