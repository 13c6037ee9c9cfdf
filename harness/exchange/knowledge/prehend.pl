% SPDX-License-Identifier: Apache-2.0
% Questions to recorded episodes in the language of Haidu & Beetz (arXiv 2011.13689, section V): entity/2, occurs/2,
% holds/1, show/1,2. It reads what `prehend episode knowledge` wrote; docs/knowledge.md is its manual. In SWI-Prolog:
%
%   ?- use_module('harness/exchange/knowledge/prehend').
%   ?- load_knowledge(kb).
%   ?- entity(Act, [an, action, [type, 'Sliding'], [object, [an, object, [name, Obj], [type, 'CerealBox']]]]).
:- module(prehend,
          [ load_knowledge/1,   % +Folder
            entity/2,           % ?Entity, +Description
            occurs/2,           % ?Event, ?[Begin, End] in seconds
            holds/1,            % +Relation(?Subject, ?Object)
            allen/3,            % ?Event, ?Relation, ?Event
            episode_of/2,       % ?Event, ?Episode
            label_of/2,         % +Individual, -Text
            show/1, show/2,
            '..'/0,
            safe_query/1,       % +Goal
            ask_main/0
          ]).
:- use_module(library(semweb/rdf_db), [rdf/3 as rdf3, rdf_load/2 as load_file]).
:- use_module(library(semweb/turtle)).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(library(aggregate)).
:- use_module(library(solution_sequences)).
:- use_module(library(time)).
:- use_module(library(readutil)).
:- use_module(library(http/json)).

namespace(knowrob, 'http://knowrob.org/kb/knowrob.owl#').
namespace(dul, 'http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#').
namespace(soma, 'http://www.ease-crc.org/ont/SOMA.owl#').
namespace(prehend, 'http://prehend.local/prehend.owl#').
namespace(log, 'http://prehend.local/log.owl#').
namespace(rdf, 'http://www.w3.org/1999/02/22-rdf-syntax-ns#').
namespace(rdfs, 'http://www.w3.org/2000/01/rdf-schema#').

name(Prefix, Local, Iri) :- namespace(Prefix, Base), atom_concat(Base, Local, Iri).

% Statements. Objects that are literals are literal(type(Type, Text)) or literal(Text).
said(S, Prefix:Local, O) :- name(Prefix, Local, P), rdf3(S, P, O).

value(S, Property, Value) :- said(S, Property, literal(L)), plain(L, Value).
plain(type(Type, Text), Value) :- !,
    (   sub_atom(Type, _, _, 0, string) -> Value = Text
    ;   atom_number(Text, Value) -> true
    ;   Value = Text
    ).
plain(Text, Text).

% --- loading ---------------------------------------------------------------------------------------------------------

load_knowledge(Folder) :-
    (   exists_directory(Folder) -> true
    ;   throw(refused("there is no folder ~w"-[Folder]))
    ),
    atom_concat(Folder, '/prehend.ttl', Words),
    (   exists_file(Words) -> true
    ;   throw(refused("~w has no prehend.ttl: 'prehend episode knowledge' writes such a folder"-[Folder]))
    ),
    load_file(Words, [silent(true)]),
    forall(( member(Part, ['/maps/*.ttl', '/episodes/*.ttl']),
             atom_concat(Folder, Part, Pattern), expand_file_name(Pattern, Files), member(File, Files) ),
           load_file(File, [silent(true)])).

% --- descriptions ----------------------------------------------------------------------------------------------------

'..'.
ellipsis(X) :- nonvar(X), ( X == '..' -> true ; X == ['..'] ).

%!  entity(?E, +[a|an, Kind, [Key, Value]..])
entity(E, Description) :-
    (   is_list(Description), Description = [Article, Kind | Pairs0], memberchk(Article, [a, an]) -> true
    ;   throw(refused("found ~q, wanted a description like [an, action, [type, 'Grasping']]"-[Description]))
    ),
    exclude(ellipsis, Pairs0, Pairs),
    maplist(check_pair, Pairs),
    partition(is_pair(type), Pairs, Types, Others0),
    partition(is_pair(name), Others0, Names, Others),
    partition(is_part, Others, Parts, Fields),
    (   Parts \== [], Types = [[type, Type] | _], atom(Type), \+ recorded(Type)
    ->  compose(E, Type, Parts, Fields)
    ;   maplist(named(E), Names),
        typed(E, Kind, Types),
        maplist(field(E), Fields),
        has_parts(E, Parts)
    ).

check_pair(Pair) :-
    (   Pair = [Key, _], nonvar(Key) -> true
    ;   throw(refused("found ~q in a description, wanted [KEY, VALUE] or .."-[Pair]))
    ).
is_pair(Key, [Key0, _]) :- Key == Key0.
is_part([Key, Value]) :- key_words(Key, [sub, action]), is_list(Value).

% A key is written sub_action or sub-action.
key_words(Key, Words) :- atom(Key), !, atomic_list_concat(Words, '_', Key).
key_words(A-B, Words) :- key_words(A, As), key_words(B, Bs), append(As, Bs, Words).

named(E, [name, Name]) :-
    (   var(Name) -> Name = E
    ;   atom(Name), sub_atom(Name, 0, _, _, 'http') -> E = Name
    ;   atom(Name) -> label_literal(Name, Label), said(E, rdfs:label, Label)
    ;   throw(refused("found ~q, wanted a name"-[Name]))
    ).
label_literal(Name, literal(Name)).
label_literal(Name, literal(type('http://www.w3.org/2001/XMLSchema#string', Name))).

kind(action, dul, 'Action').
kind(event, dul, 'Event').
kind(object, knowrob, 'Entity').
kind(episode, knowrob, 'Episode').
kind(task, knowrob, 'Task').
kind(map, knowrob, 'SemanticEnvironmentMap').

typed(E, Kind, []) :- !,
    (   Kind == thing -> ( nonvar(E) -> true ; throw(refused("[a, thing] needs a type or a name"-[])) )
    ;   kind(Kind, Prefix, Local) -> name(Prefix, Local, Class), instance(E, Class)
    ;   findall(K, kind(K, _, _), Kinds),
        throw(refused("found ~q, wanted a kind of thing: ~q"-[Kind, [thing | Kinds]]))
    ).
typed(E, _, Types) :- maplist(of_type(E), Types).
of_type(E, [type, Type]) :- class_named(Type, Class), instance(E, Class).

class_named(Type, Class) :-
    (   atom(Type), sub_atom(Type, 0, _, _, 'http') -> Class = Type
    ;   nonvar(Type), Type = Prefix:Local, atom(Local), namespace(Prefix, _) -> name(Prefix, Local, Class)
    ;   atom(Type) -> name(knowrob, Type, Class)
    ;   throw(refused("found ~q, wanted the name of a class, as in [type, 'Grasping']"-[Type]))
    ),
    (   once(said_class(Class)) -> true
    ;   throw(refused("no class is called ~w in these episodes"-[Type]))
    ).
said_class(Class) :- said(Class, rdf:type, _).
said_class(Class) :- said(Class, rdfs:subClassOf, _).

recorded(Type) :- name(knowrob, Type, Class), once(instance(_, Class)).

instance(E, Class) :- var(E), !, distinct(E, ( below(Class, C), said(E, rdf:type, C) )).
instance(E, Class) :- once(( below(Class, C), said(E, rdf:type, C) )).

below(Class, Class).
below(Class, Below) :- said(C, rdfs:subClassOf, Class), below(C, Below).

field(E, [Key, Value]) :-
    property(Key, Property),
    (   is_list(Value)
    ->  (   nonvar(E) -> rdf3(E, Property, O), entity(O, Value)
        ;   entity(O, Value), rdf3(E, Property, O)
        )
    ;   rdf3(E, Property, O0), ( O0 = literal(L) -> plain(L, O) ; O = O0 ),
        (   atom(Value), \+ sub_atom(Value, 0, _, _, 'http'), label_of(O, Label) -> Value == Label
        ;   Value = O
        )
    ).

property(Prefix:Local, Property) :- !, name(Prefix, Local, Property).
property(Key, Property) :-
    (   key_words(Key, Words) -> true
    ;   throw(refused("found ~q, wanted a key like object or performed_by"-[Key]))
    ),
    atomic_list_concat(Words, '_', Role),
    (   label_literal(Role, Literal), said(Property0, prehend:roleName, Literal) -> Property = Property0
    ;   Words = [First | Rest], maplist(capital, Rest, Capitals),
        atomic_list_concat([First | Capitals], Local), name(knowrob, Local, Property)
    ).
capital(Word, Capital) :-
    sub_atom(Word, 0, 1, _, First), sub_atom(Word, 1, _, 0, Rest), upcase_atom(First, Upper),
    atom_concat(Upper, Rest, Capital).

% --- parts -----------------------------------------------------------------------------------------------------------

% The parts are described in the order in which they begin; others may lie between them.
has_parts(_, []) :- !.
has_parts(E, Parts) :-
    name(knowrob, subAction, P),
    findall(Begin-M, ( rdf3(E, P, M), tick(M, beginTick, Begin) ), Members),
    in_order(Parts, Members, 0).
in_order([], _, _).
in_order([[_, Description] | Parts], Members, NotBefore) :-
    select(Begin-M, Members, Others), Begin >= NotBefore,
    entity(M, Description),
    in_order(Parts, Others, Begin).

% What no grammar has recognised is composed: parts of one hand, one thing and one episode, in the order in which they
% are described; each begins at most so long after the end of the one before.
longest_gap_s(2.0).

compose(composed(Type, Members), Type, Parts, Fields) :-
    maplist(nth1(2), Parts, Descriptions),
    bind_members(Descriptions, Fields, none, Members).
bind_members([], _, _, []).
bind_members([Description | Descriptions], Fields, Before, [M | Members]) :-
    append(Description, Fields, Wanted),
    entity(M, Wanted),
    follows(Before, M),
    bind_members(Descriptions, Fields, M, Members).
follows(none, _) :- !.
follows(A, B) :-
    A \== B,
    same(A, B, inEpisode), same(A, B, performedBy), same(A, B, object),
    seconds(A, BeginA, EndA), seconds(B, BeginB, _),
    BeginB >= BeginA, longest_gap_s(Gap), BeginB =< EndA + Gap.
same(A, B, Local) :- name(knowrob, Local, P), once(( rdf3(A, P, O), rdf3(B, P, O) )).

% --- time ------------------------------------------------------------------------------------------------------------

seconds(E, Begin, End) :- value(E, knowrob:startTime, Begin), value(E, knowrob:endTime, End).
tick(E, Local, Tick) :- value(E, prehend:Local, Tick).

members(composed(_, Members), Members) :- !.
members(E, [E]).

%!  occurs(?E, ?[Begin, End])
%   Times that are known must lie inside the event.
occurs(E, Times) :-
    (   Times = [Begin, End] -> true
    ;   throw(refused("found ~q, wanted [BEGIN, END]"-[Times]))
    ),
    (   nonvar(E) -> true ; name(dul, 'Event', Event), instance(E, Event) ),
    members(E, Members),
    maplist(seconds, Members, Begins, Ends), min_list(Begins, B), max_list(Ends, F),
    (   var(Begin) -> Begin = B ; number(Begin), Begin >= B ),
    (   var(End) -> End = F ; number(End), End =< F ),
    Members = [First | _],
    once(episode_of(First, Episode)), b_setval(prehend_episode, Episode).

episode_of(E, Episode) :- said(E, knowrob:inEpisode, Episode).

%!  allen(?A, ?Relation, ?B)
%   Of two events of one episode; on ticks, the end excluded.
allen(A, Relation, B) :-
    episode_of(A, Episode), episode_of(B, Episode), A \== B,
    tick(A, beginTick, BeginA), tick(A, endTick, EndA), BeginA < EndA,
    tick(B, beginTick, BeginB), tick(B, endTick, EndB), BeginB < EndB,
    relation(BeginA, EndA, BeginB, EndB, Found), Relation = Found.

relation(_, EndA, BeginB, _, before) :- EndA < BeginB, !.
relation(_, EndA, BeginB, _, meets) :- EndA =:= BeginB, !.
relation(BeginA, _, _, EndB, after) :- BeginA > EndB, !.
relation(BeginA, _, _, EndB, met_by) :- BeginA =:= EndB, !.
relation(BeginA, EndA, BeginB, EndB, Relation) :-
    compare(Begins, BeginA, BeginB), compare(Ends, EndA, EndB), overlapping(Begins, Ends, Relation).
overlapping(<, <, overlaps).
overlapping(<, =, finished_by).
overlapping(<, >, contains).
overlapping(=, <, starts).
overlapping(=, =, equals).
overlapping(=, >, started_by).
overlapping(>, <, inside).
overlapping(>, =, finishes).
overlapping(>, >, overlapped_by).

% --- relations of things ---------------------------------------------------------------------------------------------

%!  holds(part_of(X, Y)) : directly or not. Of other relations: as they are said.
holds(Relation) :-
    (   compound(Relation), Relation = Prefix:Inner, compound(Inner) -> true
    ;   compound(Relation) -> Inner = Relation, Prefix = none
    ;   throw(refused("found ~q, wanted a relation like part_of(X, Y)"-[Relation]))
    ),
    (   Inner =.. [Key, S, O] -> true
    ;   throw(refused("found ~q, wanted a relation of two, like part_of(X, Y)"-[Inner]))
    ),
    (   Prefix == none -> property(Key, Property) ; name(Prefix, Key, Property) ),
    (   name(knowrob, partOf, Property) -> part_of(S, O, Property) ; rdf3(S, Property, O) ).
part_of(S, O, Property) :- rdf3(S, Property, O).
part_of(S, O, Property) :- rdf3(S, Property, Between), part_of(Between, O, Property).

% --- pictures --------------------------------------------------------------------------------------------------------

% What is to be drawn is collected with the answer; `prehend episode ask --show` draws it by replay.
show(What) :- show(What, none).
show(What, When) :-
    (   shown(What, When, Shown) -> true
    ;   throw(refused("found show(~q, ~q), wanted show(world(T)), show(trajectory(X), [S, E]) or show(marker(X), T)"
                      -[What, When]))
    ),
    (   nb_current(prehend_episode, Episode), Episode \== none -> true
    ;   throw(refused("show: in which episode? occurs(Event, [S, E]) before it says so"-[]))
    ),
    ( nb_current(prehend_shown, Before) -> true ; Before = [] ),
    b_setval(prehend_shown, [Shown.put(episode, Episode) | Before]).

shown(world(T), none, _{what: world, from: T, to: T}) :- number(T).
shown(trajectory(X), [S, E], _{what: trajectory, of: Label, from: S, to: E}) :-
    number(S), number(E), label_of(X, Label).
shown(marker(X), T, _{what: marker, of: Label, from: T, to: T}) :- number(T), label_of(X, Label).

label_of(X, Label) :- atom(X), once(value(X, rdfs:label, Label)).

% --- queries as text -------------------------------------------------------------------------------------------------

%!  safe_query(+Goal) throws refused(..) unless it consists of what a question needs.
safe_query(G) :- var(G), !, throw(refused("a goal is unknown when the query begins"-[])).
safe_query(G) :- ellipsis(G), !.
safe_query(G) :- control(G, Inner), !, maplist(safe_query, Inner).
safe_query(G) :- callable(G), functor(G, Name, Arity), allowed(Name/Arity), !.
safe_query(G) :-
    (   callable(G) -> functor(G, Name, Arity), What = Name/Arity ; What = G ),
    throw(refused("~q is not allowed in a query"-[What])).

control((A, B), [A, B]).
control((A ; B), [A, B]).
control((A -> B), [A, B]).
control(\+ A, [A]).
control(once(A), [A]).
control(forall(A, B), [A, B]).
control(findall(_, A, _), [A]).
control(aggregate_all(_, A, _), [A]).
control(distinct(_, A), [A]).
control(limit(_, A), [A]).

allowed(true/0). allowed(fail/0). allowed((=)/2). allowed((\=)/2). allowed((==)/2). allowed((\==)/2).
allowed((<)/2). allowed((>)/2). allowed((=<)/2). allowed((>=)/2). allowed((=:=)/2). allowed((=\=)/2). allowed((is)/2).
allowed(between/3). allowed(member/2). allowed(memberchk/2). allowed(length/2). allowed(msort/2). allowed(nth1/3).
allowed(sum_list/2). allowed(max_list/2). allowed(min_list/2).
allowed(entity/2). allowed(occurs/2). allowed(holds/1). allowed(allen/3). allowed(episode_of/2). allowed(label_of/2).
allowed(show/1). allowed(show/2).

% Without the ellipses, which as goals would load a file of that name.
without_ellipses(G, true) :- ellipsis(G), !.
without_ellipses((A, B), (C, D)) :- !, without_ellipses(A, C), without_ellipses(B, D).
without_ellipses((A ; B), (C ; D)) :- !, without_ellipses(A, C), without_ellipses(B, D).
without_ellipses((A -> B), (C -> D)) :- !, without_ellipses(A, C), without_ellipses(B, D).
without_ellipses(\+ A, \+ B) :- !, without_ellipses(A, B).
without_ellipses(G, G).

%!  ask_main reads a query from standard input. Arguments: folder, number of answers, seconds. Prints a JSON object per
%   answer, and a last one that says how it ended.
ask_main :-
    current_prolog_flag(argv, Arguments),
    append(_, [Folder, Most0, Seconds0], Arguments), !,
    atom_number(Most0, Most), atom_number(Seconds0, Seconds),
    catch(ask_all(Folder, Most, Seconds, End), Error, ( why(Error, Why), End = _{end: refused, why: Why} )),
    put_line(End).

ask_all(Folder, Most, Seconds, End) :-
    read_string(user_input, _, Text),
    read_query(Text, Goal0, Names),
    safe_query(Goal0),
    without_ellipses(Goal0, Goal),
    load_knowledge(Folder),
    State = count(0),
    catch(call_with_time_limit(Seconds, answers(Goal, Names, Most, State)), Error, true),
    (   var(Error) -> arg(1, State, Count), End = _{end: done, answers: Count}
    ;   Error == time_limit_exceeded
    ->  format(string(Why), "the query took more than ~w s", [Seconds]), End = _{end: refused, why: Why}
    ;   throw(Error)
    ).

read_query(Text, Goal, Names) :-
    catch(term_string(Goal, Text, [variable_names(Names), module(prehend), syntax_errors(error)]), Error, true),
    (   var(Error) -> true
    ;   Error = error(syntax_error(What), Context)
    ->  (   Context = string(_, At) -> true ; At = 0 ),
        throw(refused("the query is no Prolog term: ~w, at its character ~w"-[What, At]))
    ;   throw(Error)
    ).

answers(Goal, Names, Most, State) :-
    b_setval(prehend_episode, none), b_setval(prehend_shown, []),
    (   call(prehend:Goal),
        arg(1, State, Before), Count is Before + 1, nb_setarg(1, State, Count),
        foldl(put_binding, Names, _{}, Bindings),
        b_getval(prehend_shown, Shown), reverse(Shown, InOrder), maplist(with_episode, InOrder, Pictures),
        put_line(_{bindings: Bindings, show: Pictures}),
        Count >= Most
    ->  true
    ;   true
    ).

with_episode(Shown, Shown.put(_{file: File, number: Number})) :-
    once(value(Shown.episode, prehend:recordedIn, File)),
    once(value(Shown.episode, prehend:recordNumber, Number)).

put_binding(Name = _, Bindings, Bindings) :- sub_atom(Name, 0, 1, _, '_'), !.
put_binding(Name = Value, Bindings, Bindings.put(Name, Said)) :- in_json(Value, Said).
in_json(Value, '_') :- var(Value), !.
in_json(Value, Value) :- number(Value), !.
in_json(Value, _{iri: Value, text: Text}) :- atom(Value), sub_atom(Value, 0, _, _, 'http'), !, text_of(Value, Text).
in_json(Value, Value) :- atom(Value), !.
in_json(Value, Value) :- string(Value), !.
in_json(composed(Type, Members), _{text: Text, parts: Parts}) :- !,
    maplist(in_json, Members, Parts), format(string(Text), "~w", [Type]).
in_json(Value, Values) :- is_list(Value), !, maplist(in_json, Value, Values).
in_json(Value, Text) :- format(string(Text), "~q", [Value]).

% An event is called as in a timeline: Sliding(right_hand, milk).
text_of(Iri, Text) :- label_of(Iri, Text), !.
text_of(Iri, Text) :-
    episode_of(Iri, _), said(Iri, rdf:type, Class), sub_atom(Class, Before, _, _, 'knowrob.owl#'), !,
    Start is Before + 12, sub_atom(Class, Start, _, 0, Name),
    findall(Label, ( rdf3(Iri, _, O), atom(O), said(O, knowrob:inMap, _), label_of(O, Label) ), Labels),
    atomic_list_concat(Labels, ', ', Participants), format(string(Text), "~w(~w)", [Name, Participants]).
text_of(Iri, Text) :- atom_string(Iri, Text).

why(refused(Format-Arguments), Why) :- !, format(string(Why), Format, Arguments).
why(error(resource_error(What), _), Why) :- !, format(string(Why), "the query needs too much ~w", [What]).
why(error(type_error(Type, Found), _), Why) :- !, format(string(Why), "found ~q, wanted a ~w", [Found, Type]).
why(error(instantiation_error, _), Why) :- !, Why = "a variable has no value where one is needed".
why(error(Formal, _), Why) :- !, format(string(Why), "~p", [Formal]).
why(Error, Why) :- format(string(Why), "~p", [Error]).

put_line(Dict) :- with_output_to(string(Line), json_write_dict(current_output, Dict, [width(0)])), writeln(Line).
