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
:- use_module(library(semweb/rdf_db), [rdf/3 as rdf3, rdf_load/2 as load_rdf]).
:- use_module(library(semweb/turtle)).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(library(filesex), [directory_file_path/3]).
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
namespace(owl, 'http://www.w3.org/2002/07/owl#').

name(Prefix, Local, Iri) :- namespace(Prefix, Base), atom_concat(Base, Local, Iri).

% A name that is written out: 'http://..', or knowrob:'Grasping'.
written(Iri, Iri) :- is_iri(Iri), !.
written(Word, Iri) :-
    nonvar(Word), Word = Prefix:Local, atom(Prefix), atom(Local),
    (   namespace(Prefix, _) -> name(Prefix, Local, Iri)
    ;   findall(P, namespace(P, _), Known), throw(unknown(namespace, Prefix, Known))
    ).
is_iri(X) :- atom(X), sub_atom(X, 0, _, _, 'http').

% As a question writes it: Grasping, or soma:State.
short(Iri, Word) :-
    namespace(Prefix, Base), atom_concat(Base, Local, Iri), !,
    ( Prefix == knowrob -> Word = Local ; atomic_list_concat([Prefix, Local], ':', Word) ).

% Statements. Objects that are literals are literal(type(Type, Text)) or literal(Text).
said(S, Prefix:Local, O) :- name(Prefix, Local, P), rdf3(S, P, O).

value(S, Property, Value) :- said(S, Property, literal(L)), plain(L, Value).
plain(type(Type, Text), Value) :- !,
    (   sub_atom(Type, _, _, 0, string) -> Value = Text
    ;   atom_number(Text, Value) -> true
    ;   Value = Text
    ).
plain(lang(_, Text), Text) :- !.
plain(Text, Text).

% --- loading ---------------------------------------------------------------------------------------------------------

load_knowledge(Folder) :-
    place(Folder, Place),
    (   exists_directory(Place) -> true
    ;   throw(refused("there is no folder ~w"-[Folder]))
    ),
    atom_concat(Place, '/prehend.ttl', Words),
    (   exists_file(Words) -> true
    ;   throw(refused("~w has no prehend.ttl: 'prehend episode knowledge' writes such a folder"-[Folder]))
    ),
    load_file(Words),
    forall(( member(Part, [maps, episodes]), directory_file_path(Place, Part, Below), exists_directory(Below),
             directory_files(Below, Names), msort(Names, Sorted), member(Name, Sorted),
             file_name_extension(_, ttl, Name), directory_file_path(Below, Name, File) ),
           ( exists_file(File) -> load_file(File) ; throw(refused("~w is no file"-[File])) )).
load_file(File) :-
    ( nb_current(prehend_tells, true) -> put_line(_{end: loading, file: File}) ; true ),
    catch(load_rdf(File, [silent(true), on_error(error)]), error(Error, Context),
          (   Error = syntax_error(What), Context = stream(_, Line, Column, _)
          ->  throw(refused("~w:~w:~w: it is no Turtle, or is cut off: ~w"-[File, Line, Column, What]))
          ;   throw(refused("~w cannot be read: ~p"-[File, Error]))
          )),
    ( size_file(File, 0) -> throw(refused("~w is empty: it says nothing"-[File])) ; true ).
% A relative name could be a scheme of Prolog's, as in http://x.
place(Name, Place) :-
    working_directory(Here, Here), ( sub_atom(Name, 0, _, _, '/') -> Place = Name ; atom_concat(Here, Name, Place) ).

% --- descriptions ----------------------------------------------------------------------------------------------------

'..'.
ellipsis(X) :- nonvar(X), ( X == '..' -> true ; X == ['..'] ).

%!  entity(?E, +[a|an, Kind, [Key, Value]..]) : each answer once.
entity(E, Description) :-
    term_variables(E-Description, Variables),
    (   Variables == [] -> once(described(E, Description))
    ;   distinct(Variables, described(E, Description))
    ).

described(E, Description) :-
    pairs_of(Description, Kind, Pairs),
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

pairs_of(Description, Kind, Pairs) :-
    (   is_list(Description), Description = [Article, Kind | Pairs0], memberchk(Article, [a, an]) -> true
    ;   throw(refused("found ~q, wanted a description like [an, action, [type, 'Grasping']]"-[Description]))
    ),
    exclude(ellipsis, Pairs0, Pairs),
    maplist(check_pair, Pairs).
check_pair(Pair) :-
    (   nonvar(Pair), Pair = [Key, _], nonvar(Key) -> true
    ;   throw(refused("found ~q in a description, wanted [KEY, VALUE] or .."-[Pair]))
    ).
is_pair(Key, [Key0, _]) :- Key == Key0.
is_part([Key, Value]) :- key_words(Key, [sub, action]), is_list(Value).

% A key is written sub_action or sub-action.
key_words(Key, Words) :- atom(Key), !, atomic_list_concat(Words, '_', Key).
key_words(A-B, Words) :- key_words(A, As), key_words(B, Bs), append(As, Bs, Words).
key_word(Key, Word) :-
    (   key_words(Key, Words) -> atomic_list_concat(Words, '_', Word)
    ;   throw(refused("found ~q, wanted a word like object or performed_by"-[Key]))
    ).

named(E, [name, Name]) :-
    (   var(Name) -> Name = E
    ;   written(Name, Iri) -> E = Iri
    ;   atom(Name) -> label_known(Name), said(E, rdfs:label, literal(Name))
    ;   throw(refused("found ~q, wanted a name"-[Name]))
    ).

% A name that nothing has is no error, but nobody should wonder.
label_known(Name) :- once(said(_, rdfs:label, literal(Name))), !.
label_known(Name) :-
    ( nb_current(prehend_notes, Notes) -> true ; Notes = [] ),
    (   memberchk(Name-_, Notes) -> true
    ;   findall(Label, ( said(E, rdfs:label, literal(Label)), said(E, knowrob:inMap, _) ), Labels0),
        sort(Labels0, Labels), nb_setval(prehend_notes, [Name-Labels | Notes])
    ).

kind(action, dul, 'Action').
kind(event, dul, 'Event').
kind(object, knowrob, 'Entity').
kind(episode, knowrob, 'Episode').
kind(task, knowrob, 'Task').
kind(map, knowrob, 'SemanticEnvironmentMap').
kind(thing, dul, 'Entity').
kind_class(Kind, Class) :-
    (   kind(Kind, Prefix, Local) -> name(Prefix, Local, Class)
    ;   findall(K, kind(K, _, _), Known), throw(unknown('kind of thing', Kind, Known))
    ).

typed(E, Kind, Types) :-
    kind_class(Kind, Class),
    partition(is_open, Types, Open, Known),
    (   Known \== [] -> maplist(of_type(E), Known)
    ;   Kind == thing, Open == []
    ->  ( nonvar(E) -> true ; throw(refused("[a, thing] needs a type or a name"-[])) )
    ;   instance(E, Class)
    ),
    maplist(own_type(E), Open).
is_open([_, Value]) :- var(Value).
own_type(E, [type, Type]) :- own_class(E, Class), short(Class, Type).
of_type(E, [type, Type]) :- class_named(Type, Class), instance(E, Class).

% The most special of its classes. That a thing can be moved is said of it besides.
own_class(E, Class) :-
    findall(C, a_class(E, C), Classes),
    findall(C, ( member(C, Classes), \+ ( member(D, Classes), D \== C, below(C, D), \+ below(D, C) ) ), Lowest),
    name(knowrob, 'Thing', Thing),
    findall(C, ( member(C, Lowest), \+ below(Thing, C) ), Named),
    ( Named == [] -> member(Class, Lowest) ; member(Class, Named) ).
a_class(E, Class) :- name(rdf, type, Type), related(Type, E, Class).

class_named(Type, Class) :-
    (   written(Type, Class) -> true
    ;   atom(Type) -> name(knowrob, Type, Class)
    ;   throw(refused("found ~q, wanted the name of a class, as in [type, 'Grasping']"-[Type]))
    ),
    (   said_class(Class) -> true
    ;   name(owl, 'Class', Classes),
        findall(Word, ( said(C, rdf:type, Classes), once(instance(_, C)), short(C, Word) ), Known),
        ( atom(Type) -> Word = Type ; short(Class, Word) ), throw(unknown(class, Word, Known))
    ).
said_class(Class) :- once(( said(Class, rdf:type, _) ; said(Class, rdfs:subClassOf, _) )).

recorded(Type) :- name(knowrob, Type, Class), once(instance(_, Class)).

instance(E, Class) :- var(E), !, distinct(E, ( below(Class, C), said(E, rdf:type, C) )).
instance(E, Class) :- once(( below(Class, C), said(E, rdf:type, C) )).

% A file of somebody else may say that a class is below itself, or a thing part of itself.
below(Class, Below) :- below(Class, Below, [Class]).
below(Class, Class, _).
below(Class, Below, Seen) :- said(C, rdfs:subClassOf, Class), \+ memberchk(C, Seen), below(C, Below, [C | Seen]).

field(E, [Key, Value]) :-
    property(Key, Property),
    (   is_list(Value)
    ->  (   nonvar(E) -> rdf3(E, Property, O), entity(O, Value)
        ;   entity(O, Value), rdf3(E, Property, O)
        )
    ;   value_known(Property, Value),
        rdf3(E, Property, O),
        ( Key == style, var(Value) -> style_word(O, Value) ; means(Value, O) )
    ).

%!  means(?Given, +Said) : a name that is written out, a label, the word of a style or of a class, a number, a text.
means(Given, literal(L)) :- !, plain(L, Value), ( number(Given), number(Value) -> Given =:= Value ; Given = Value ).
means(Given, O) :- var(Given), !, Given = O.
means(Given, O) :- written(Given, Iri), !, Iri == O.
means(Given, O) :- once(( said(O, rdfs:label, literal(Given)) ; style_word(O, Given) ; short(O, Given) )).

value_known(Property, Value) :-
    (   ( var(Value) ; is_list(Value) ; is_iri(Value) ) -> true
    ;   name(rdf, type, Property) -> class_named(Value, _)
    ;   ( written(Value, _) ; \+ atom(Value) ) -> true
    ;   name(knowrob, graspType, Property)
    ->  (   style_word(_, Value) -> true
        ;   name(knowrob, Value, Style), style(Style) -> true
        ;   findall(Word, style_word(_, Word), Known), throw(unknown(style, Value, Known))
        )
    ;   name(owl, 'ObjectProperty', Kind), said(Property, rdf:type, Kind) -> label_known(Value)
    ;   true
    ).
style(Style) :- name(knowrob, 'GraspStyle', Class), said(Style, rdf:type, Class).
style_word(Style, Word) :-
    style(Style),
    (   said(Style, prehend:styleName, literal(Named)) -> Word = Named
    ;   short(Style, Local), atom_concat(Name, 'Style', Local), snake(Name, Word)
    ).

property(Key, Property) :-
    (   written(Key, Property) -> true
    ;   key_word(Key, Word),
        (   also_called(Word, Prefix:Local) -> name(Prefix, Local, Property)
        ;   said(Property0, prehend:roleName, literal(Word)) -> Property = Property0
        ;   atomic_list_concat([First | Rest], '_', Word), maplist(capital, Rest, Capitals),
            atomic_list_concat([First | Capitals], Local), member(Prefix, [knowrob, prehend]),
            name(Prefix, Local, Property), is_property(Property)
        )
    ),
    ( is_property(Property) ; also_called(_, Prefix:Local), name(Prefix, Local, Property) ), !.
property(Key, _) :-
    findall(W, property_word(W), Known),
    ( Key = _:Local -> snake(Local, Word) ; key_word(Key, Word) ),
    throw(unknown('role or property', Word, Known)).
also_called(style, knowrob:graspType).
also_called(type, rdf:type).
also_called(name, rdfs:label).
also_called(label, rdfs:label).
is_property(P) :- member(K, ['ObjectProperty', 'DatatypeProperty']), name(owl, K, Kind), said(P, rdf:type, Kind), !.
property_word(Word) :- also_called(Word, _).
property_word(Word) :- said(P, prehend:roleName, literal(Word)), once(rdf3(_, P, _)).
property_word(Word) :-
    member(Prefix, [knowrob, prehend]), namespace(Prefix, Base),
    member(K, ['ObjectProperty', 'DatatypeProperty']), name(owl, K, Kind), said(P, rdf:type, Kind),
    atom_concat(Base, Local, P), once(rdf3(_, P, _)), snake(Local, Word).

capital(Word, Capital) :-
    sub_atom(Word, 0, 1, _, First), sub_atom(Word, 1, _, 0, Rest), upcase_atom(First, Upper),
    atom_concat(Upper, Rest, Capital).
% medium_wrap of MediumWrap, performed_by of performedBy.
snake(Camel, Word) :-
    atom_chars(Camel, Chars),
    findall(C, ( nth1(N, Chars, C0), ( char_type(C0, upper(L)) -> ( N > 1, C = '_' ; C = L ) ; C = C0 ) ), Snake),
    atom_chars(Word, Snake).

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

members(E, Members) :- nonvar(E), E = composed(_, Members), !.
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
    (   var(Begin) -> Begin = B ; number(Begin), Begin >= B, Begin =< F ),
    (   var(End) -> End = F ; number(End), End =< F, End >= B ),
    Members = [First | _],
    once(episode_of(First, Episode)), b_setval(prehend_episode, Episode).

episode_of(E0, Episode) :- nonvar(E0), E0 = composed(_, [E | _]), !, episode_of(E, Episode).
episode_of(E, Episode) :- said(E, knowrob:inEpisode, Episode).

%!  allen(?A, ?Relation, ?B)
%   Of two events of one episode; on ticks, the end excluded.
allen(A, Relation, B) :-
    ( var(Relation) -> Found = Relation ; relation_named(Relation, Found) ),
    episode_of(A, Episode), episode_of(B, Episode), A \== B,
    ticks(A, BeginA, EndA), ticks(B, BeginB, EndB), BeginA < EndA, BeginB < EndB,
    relation(BeginA, EndA, BeginB, EndB, Relation0), Found = Relation0.

ticks(E, Begin, End) :-
    members(E, Members), findall(T, ( member(M, Members), tick(M, beginTick, T) ), Begins),
    findall(T, ( member(M, Members), tick(M, endTick, T) ), Ends), min_list(Begins, Begin), max_list(Ends, End).

relation_named(Given, Relation) :-
    key_word(Given, Word), ( also_allen(Word, Relation0) -> true ; Relation0 = Word ),
    Known = [before, meets, overlaps, starts, inside, during, finishes, equals, finished_by, contains, started_by,
             overlapped_by, met_by, after],
    ( memberchk(Relation0, Known) -> Relation = Relation0 ; throw(unknown('relation of Allen\'s', Word, Known)) ).
also_allen(during, inside).
also_allen(equal, equals).

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

%!  holds(part_of(X, Y)) : directly or not. Of other relations: as they are said. Each answer once.
holds(Relation) :-
    related(Relation, Key, S, O),
    property(Key, Property), subject_known(S), value_known(Property, O),
    (   nonvar(O), name(rdf, type, Property)
    ->  class_named(O, Class), distinct(S, ( subject(S, S0), instance(S0, Class) ))
    ;   distinct(S-O, ( subject(S, S0), related(Property, S0, O0), means(O, O0) ))
    ).
subject_known(S) :- ( atom(S), \+ written(S, _) -> label_known(S) ; true ).
subject(S, S0) :- ( var(S) -> S0 = S ; written(S, Iri) -> S0 = Iri ; said(S0, rdfs:label, literal(S)) ).
related(Relation, Key, S, O) :-
    (   nonvar(Relation), Relation = Prefix:Inner, atom(Prefix), compound(Inner), Inner =.. [Local, S, O]
    ->  Key = Prefix:Local
    ;   compound(Relation), Relation =.. [Key, S, O], Key \== (:) -> true
    ;   throw(refused("found ~q, wanted a relation of two, like part_of(X, Y)"-[Relation]))
    ).
related(Property, S, O) :- name(knowrob, partOf, Property), !, part_of(S, O, Property, []).
related(Property, S, O) :- rdf3(S, Property, O), O \== 'http://www.w3.org/2002/07/owl#NamedIndividual'.
part_of(S, O, Property, _) :- rdf3(S, Property, O).
part_of(S, O, Property, Seen) :-
    rdf3(S, Property, Between), \+ memberchk(Between, Seen), part_of(Between, O, Property, [Between | Seen]).

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

shown(world(T), none, _{what: world, from: T, to: T}) :- exact_in_json(T).
shown(trajectory(X), [S, E], _{what: trajectory, of: Label, from: S, to: E}) :-
    maplist(exact_in_json, [S, E]), label_of(X, Label).
shown(marker(X), T, _{what: marker, of: Label, from: T, to: T}) :- exact_in_json(T), label_of(X, Label).

label_of(X, _) :- var(X), throw(refused("found ~q, wanted an individual: entity(X, ..) before it says which"-[X])).
label_of(X, Label) :- atom(X), once(( value(X, rdfs:label, Label), atom(Label) )).

% --- queries as text -------------------------------------------------------------------------------------------------

:- include(queries).

% Words that are known before the question is asked.
known_words(G) :- control(G, Inner), !, maplist(known_words, Inner).
known_words(entity(_, D)) :- nonvar(D), !, known_description(D).
known_words(allen(_, R, _)) :- nonvar(R), !, relation_named(R, _).
known_words(holds(R)) :- nonvar(R), !, related(R, Key, S, O), property(Key, P), subject_known(S), value_known(P, O).
known_words(_).
known_description(D) :-
    pairs_of(D, Kind, Pairs), kind_class(Kind, _),
    ( member(Part, Pairs), is_part(Part) -> Composed = true ; Composed = false ),
    forall(member([Key, Value], Pairs), known_pair(Key, Value, Composed)).
known_pair(Key, _, _) :- Key == name, !.
known_pair(Key, Value, Composed) :- Key == type, !, ( ( var(Value) ; Composed == true ) -> true ; class_named(Value, _) ).
known_pair(Key, Value, _) :-
    ( key_words(Key, [sub, action]) -> true ; property(Key, P), value_known(P, Value) ),
    ( is_list(Value) -> known_description(Value) ; true ).

%!  ask_main reads a query from standard input. Arguments: folder, number of answers, seconds. Prints a JSON object per
%   answer, and a last one that says how it ended.
ask_main :-
    maplist(in_utf8, [user_input, user_output]),
    current_prolog_flag(argv, Arguments),
    append(_, [Folder, Most0, Seconds0], Arguments), !,
    atom_number(Most0, Most), atom_number(Seconds0, Seconds),
    catch(ask_all(Folder, Most, Seconds, End), Error, refusal(Error, End)),
    ( nb_current(prehend_notes, Notes) -> true ; Notes = [] ),
    forall(member(Word-Known, Notes), put_line(_{end: note, word: Word, known: Known})),
    put_line(End).

in_utf8(Stream) :- set_stream(Stream, encoding(utf8)).

refusal(unknown(What, Word, Known0), End) :- !,
    sort(Known0, Known), format(string(Why), "no ~w is called ~w", [What, Word]),
    End = _{end: refused, why: Why, word: Word, known: Known}.
refusal(Error, _{end: refused, why: Why}) :- why(Error, Why).

ask_all(Folder, Most, Seconds, End) :-
    read_string(user_input, _, Text),
    read_query(Text, Goal, Names),
    safe_query(Goal),
    nb_setval(prehend_tells, true), load_knowledge(Folder),
    put_line(_{end: loaded}),
    State = count(0),
    catch(call_with_time_limit(Seconds, ( known_words(Goal), answers(Goal, Names, Most, State) )), Error, true),
    (   var(Error) -> arg(1, State, Count), End = _{end: done, answers: Count}
    ;   Error == time_limit_exceeded
    ->  format(string(Why), "the query took more than ~w s", [Seconds]), End = _{end: refused, why: Why}
    ;   throw(Error)
    ).

read_query(Text, Goal, Names) :-
    catch(read_goal(Text, Goal0, Names), Error, true),
    (   var(Error), Goal0 == end_of_file -> throw(refused("the query is empty"-[]))
    ;   var(Error) -> ( nonvar(Goal0), Goal0 = (?- Goal1) -> Goal = Goal1 ; Goal = Goal0 )
    ;   Error = error(syntax_error(What), Context)
    ->  ( Context = stream(_, _, _, At) -> true ; At = 0 ),
        (   string_chars(Text, Chars), bracket_fault(Chars, 1, [], Fault) -> throw(refused(Fault))
        ;   throw(refused("the query is no Prolog term: ~w, at its character ~w"-[What, At]))
        )
    ;   throw(Error)
    ).
read_goal(Text, Goal, Names) :-
    Options0 = [module(prehend), syntax_errors(error)], Options = [quasi_quotations(Quoted) | Options0],
    open_string(Text, Stream),
    catch(read_term(Stream, Goal0, [variable_names(Names0) | Options]), error(syntax_error(end_of_file), _), true),
    (   nonvar(Names0) -> Goal = Goal0, Names = Names0
    ;   string_concat(Text, " .", Ended), open_string(Ended, Again),
        read_term(Again, Goal, [variable_names(Names) | Options])
    ),
    character_count(Stream, At),
    catch(read_term(Stream, More, [quasi_quotations(_) | Options0]), error(syntax_error(_), _), true),
    ( Quoted == [] -> true ; throw(refused("quasi quotations are not allowed in a query"-[])) ),
    (   ( var(Names0) ; More == end_of_file ) -> true
    ;   throw(refused("there is more after the first full stop, at character ~w: one question at a time"-[At]))
    ).

% Which bracket or quote is not closed.
bracket_fault([], _, [Open-At | _], "the query is no Prolog term: it ends, but the '~w' at its character ~w is open: '~w' is missing"-[Open, At, Close]) :-
    bracket(Open, Close).
bracket_fault(['0', '\'', _ | Cs], N, Open, Why) :- !, M is N + 3, bracket_fault(Cs, M, Open, Why).
bracket_fault(['%' | Cs], N, Open, Why) :- append(Comment, ['\n' | Rest], Cs), !,
    length(Comment, Length), M is N + Length + 2, bracket_fault(Rest, M, Open, Why).
bracket_fault([Q | Cs], N, Open, Why) :- memberchk(Q, ['\'', '"', '`']), !,
    (   append(Inside, [Q | Rest], Cs) -> length(Inside, Length), M is N + Length + 2, bracket_fault(Rest, M, Open, Why)
    ;   Why = "the quote ~w at character ~w of the query is not closed"-[Q, N]
    ).
bracket_fault([C | Cs], N, Open, Why) :- bracket(C, _), !, M is N + 1, bracket_fault(Cs, M, [C-N | Open], Why).
bracket_fault([C | Cs], N, Open, Why) :- bracket(_, C), !,
    (   Open = [O-_ | Rest], bracket(O, C) -> M is N + 1, bracket_fault(Cs, M, Rest, Why)
    ;   Open = [O-At | _]
    ->  bracket(O, Close),
        Why = "found '~w' at character ~w of the query, but the '~w' at ~w is open: '~w' is missing"-[C, N, O, At, Close]
    ;   Why = "found '~w' at character ~w of the query, and no bracket is open"-[C, N]
    ).
bracket_fault([_ | Cs], N, Open, Why) :- M is N + 1, bracket_fault(Cs, M, Open, Why).
bracket('(', ')').
bracket('[', ']').
bracket('{', '}').

% A variable that begins with _ is not told, and what is told is told once.
answers(Goal, Names, Most, State) :-
    b_setval(prehend_episode, none), b_setval(prehend_shown, []),
    exclude(is_hidden, Names, Told),
    (   distinct(Key-Shown, ( ask(Goal), key(Told, Key), b_getval(prehend_shown, Shown) )),
        arg(1, State, Before), Count is Before + 1, nb_setarg(1, State, Count),
        foldl(put_binding, Told, _{}, Bindings),
        reverse(Shown, InOrder), maplist(with_episode, InOrder, Pictures),
        put_line(_{bindings: Bindings, show: Pictures}),
        Count >= Most
    ->  true
    ;   true
    ).

% Sets hold no cycles.
key(Told, Key) :- ( acyclic_term(Told) -> Key = Told ; as_text("~q", [Told], Key) ).

is_hidden(Name = _) :- sub_atom(Name, 0, 1, _, '_').

with_episode(Shown, Shown.put(_{file: File, number: Number})) :-
    (   value(Shown.episode, prehend:recordedIn, File), atom(File),
        value(Shown.episode, prehend:recordNumber, Number), integer(Number) -> true
    ;   throw(refused("~w cannot be shown: wanted a text recordedIn and an integer recordNumber"-[Shown.episode]))
    ).

put_binding(Name = Value, Bindings, Bindings.put(Name, Said)) :- in_json(Value, Said).
in_json(Value, '_') :- var(Value), !.
in_json(Value, Text) :- cyclic_term(Value), !, as_text("~q", [Value], Text).
in_json(Value, Value) :- number(Value), exact_in_json(Value), !.
in_json(Value, Said) :- float(Value), !, ( Value > 0 -> Said = inf ; Value < 0 -> Said = '-inf' ; Said = nan ).
in_json(Value, _{iri: Value, text: Text}) :- is_iri(Value), !, text_of(Value, Text).
in_json(Value, Value) :- ( atom(Value) ; string(Value) ), !.
in_json(composed(Type, Members), _{text: Text, parts: Parts}) :- is_list(Members), !,
    maplist(in_json, Members, Parts), as_text("~w", [Type], Text).
in_json(Value, Values) :- is_list(Value), !, maplist(in_json, Value, Values).
in_json(Value, Text) :- as_text("~q", [Value], Text).
exact_in_json(Value) :- ( float(Value) -> abs(Value) < inf ; integer(Value), abs(Value) < 1 << 53 ).

% An event is called as in a timeline: Sliding(right_hand, milk).
text_of(Iri, Text) :- label_of(Iri, Text), !.
text_of(Iri, Text) :-
    episode_of(Iri, _), said(Iri, rdf:type, Class), sub_atom(Class, Before, _, _, 'knowrob.owl#'), !,
    Start is Before + 12, sub_atom(Class, Start, _, 0, Name),
    findall(Label, ( rdf3(Iri, _, O), atom(O), said(O, knowrob:inMap, _), label_of(O, Label) ), Labels),
    atomic_list_concat(Labels, ', ', Participants), format(string(Text), "~w(~w)", [Name, Participants]).
text_of(Iri, Text) :- style_word(Iri, Text), !.
text_of(Iri, Text) :- short(Iri, Text), \+ sub_atom(Iri, _, _, _, 'log.owl#'), !.
text_of(Iri, Text) :- atom_string(Iri, Text).

% Variables are written as _.
as_text(Format, Arguments0, Text) :-
    copy_term(Arguments0, Arguments), term_variables(Arguments, Variables), maplist(=('$VAR'('_')), Variables),
    format(string(Text), Format, Arguments).

told(Format, Arguments, Text) :-
    catch(as_text(Format, Arguments, Text), error(resource_error(_), _), Text = "a term is too deep to be written").

why(refused(Format-Arguments), Why) :- !, told(Format, Arguments, Why).
why(error(resource_error(What), _), Why) :- !, format(string(Why), "the query needs too much ~w", [What]).
why(error(type_error(evaluable, Found), _), Why) :- !, told("found ~q, wanted a number", [Found], Why).
why(error(type_error(Type, Found), _), Why) :- !, told("found ~q, wanted a ~w", [Found, Type], Why).
why(error(evaluation_error(What), _), Why) :- !, format(string(Why), "a number cannot be computed: ~w", [What]).
why(error(instantiation_error, _), Why) :- !, Why = "a variable has no value where one is needed".
why(error(Formal, _), Why) :- !, format(string(Why), "~p", [Formal]).
why(Error, Why) :- format(string(Why), "~p", [Error]).

% An atom is a text, also null, true and false.
put_line(Dict) :-
    Options = [width(0), null(no(null)), true(no(true)), false(no(false))],
    with_output_to(string(Line), json_write_dict(current_output, Dict, Options)), writeln(Line), flush_output.
