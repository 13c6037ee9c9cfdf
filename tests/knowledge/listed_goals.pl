% SPDX-License-Identifier: Apache-2.0
% Runs the queries of standard input, one a line, and prints the name of each predicate that is called meanwhile, as the
% tracer sees it. tests/knowledge/listed_goals.py makes the queries and looks at the names.
%
%   swipl -g main -t halt listed_goals.pl -- PREHEND.PL FOLDER < QUERIES
:- dynamic seen/1.
:- initialization(set_prolog_flag(verbose, silent)).

user:prolog_trace_interception(_, Frame, _, continue) :-
    prolog_frame_attribute(Frame, predicate_indicator, P), ( seen(P) -> true ; assertz(seen(P)) ).

main :-
    current_prolog_flag(argv, Arguments), append(_, [Module, Folder], Arguments), !,
    use_module(Module, []), prehend:load_knowledge(Folder),
    visible(-all), visible(+call), leash(-all), set_prolog_flag(access_level, system),
    State = counts(0, 0, 0),
    repeat, read_line_to_string(user_input, Line),
    (   Line == end_of_file -> ! ; with_output_to(string(_), asked(Line, State)), fail ),
    forall(seen(P), ( writeq(called(P)), nl )),
    writeq(State), nl.

% counts(all, traced, traced to their end). What ends within a number of inferences is run again for the tracer, which
% knows no limits. Every second one is run without the check before it.
asked(Line, State) :-
    count(1, State, N),
    catch(prehend:read_query(Line, Goal, Names), _, fail),
    catch(call_with_inference_limit(\+ \+ run(N, Goal, Names), 5000, Ended), Ended, true), \+ is_long(Ended), !,
    count(2, State, _),
    (   catch(( trace, run(N, Goal, Names), notrace ), _, ( notrace, fail )) -> count(3, State, _) ; true ),
    notrace, nodebug.
asked(_, _).
is_long(Ended) :- ( compound(Ended) -> functor(Ended, Name, _) ; Name = Ended ), Name == inference_limit_exceeded.
is_long(error(resource_error(_), _)).
count(I, State, N) :- arg(I, State, Before), N is Before + 1, nb_setarg(I, State, N).

run(N, Goal, Names) :-
    ( N mod 2 =:= 0 -> true ; prehend:safe_query(Goal) ),
    prehend:known_words(Goal), prehend:answers(Goal, Names, 3, count(0)).
