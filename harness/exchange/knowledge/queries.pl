% SPDX-License-Identifier: Apache-2.0
% The interpreter of queries, a part of prehend.pl. Tested by tests/program/knowledge_test.cc and
% tests/knowledge/listed_goals.py

%!  safe_query(+Goal) throws refused(..) unless each of its goals has a clause below.
safe_query(G) :- var(G), !, throw(refused("a goal is unknown when the query begins"-[])).
safe_query(G) :- ellipsis(G), !.
safe_query(G) :-
    (   compound(G) -> compound_name_arity(G, Name, Arity), compound_name_arity(H, Name, Arity)
    ;   H = G, Name = G, Arity = 0
    ),
    (   clause(asked(H), _) -> true
    ;   ( callable(G) -> What = Name/Arity ; What = G ), throw(refused("~q is not allowed in a query"-[What]))
    ),
    ( control(G, Inner) -> maplist(safe_query, Inner) ; true ).

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

%!  ask(+Goal) interprets a query. Its goals are never called: what runs is the body of a clause of asked/1, and the
%   goals that Prolog's own predicates get are ask(..).
ask(G) :- nonvar(G), ( ellipsis(G) -> true ; asked(G) ).

asked(true).
asked(fail) :- fail.
asked((A, B)) :- ask(A), ask(B).
asked((A ; B)) :- nonvar(A), A = (If -> Then), !, ( ask(If) -> ask(Then) ; ask(B) ).
asked((A ; B)) :- ( ask(A) ; ask(B) ).
asked((A -> B)) :- ( ask(A) -> ask(B) ).
asked(\+ A) :- \+ ask(A).
asked(once(A)) :- once(ask(A)).
asked(forall(A, B)) :- forall(ask(A), ask(B)).
asked(findall(X, A, L)) :- findall(X, ask(A), L).
asked(aggregate_all(T0, A, X)) :-
    measured(T0, T, Measures), aggregate_all(T, ( ask(A), maplist(measure, Measures) ), X).
asked(distinct(W, A)) :- distinct(W, ask(A)).
asked(limit(N0, A)) :- ( N0 == infinite -> N = N0 ; number_of(N0, N) ), limit(N, ask(A)).
asked(A = B) :- A = B.
asked(A \= B) :- A \= B.
asked(A == B) :- A == B.
asked(A \== B) :- A \== B.
asked(A < B) :- number_of(A, X), number_of(B, Y), X < Y.
asked(A > B) :- number_of(A, X), number_of(B, Y), X > Y.
asked(A =< B) :- number_of(A, X), number_of(B, Y), X =< Y.
asked(A >= B) :- number_of(A, X), number_of(B, Y), X >= Y.
asked(A =:= B) :- number_of(A, X), number_of(B, Y), X =:= Y.
asked(A =\= B) :- number_of(A, X), number_of(B, Y), X =\= Y.
asked(X is E) :- number_of(E, X).
asked(between(A, B, X)) :- between(A, B, X).
asked(member(X, L)) :- member(X, L).
asked(memberchk(X, L)) :- memberchk(X, L).
asked(length(L, N)) :- length(L, N).
asked(msort(L, M)) :- msort(L, M).
asked(nth1(N, L, X)) :- nth1(N, L, X).
asked(sum_list(L, X)) :- maplist(number_of, L, Ns), sum_list(Ns, X).
asked(max_list(L, X)) :- maplist(number_of, L, Ns), max_list(Ns, X).
asked(min_list(L, X)) :- maplist(number_of, L, Ns), min_list(Ns, X).
asked(entity(E, D)) :- entity(E, D).
asked(occurs(E, T)) :- occurs(E, T).
asked(holds(R)) :- holds(R).
asked(allen(A, R, B)) :- allen(A, R, B).
asked(episode_of(E, Episode)) :- episode_of(E, Episode).
asked(label_of(E, L)) :- label_of(E, L).
asked(show(W)) :- show(W).
asked(show(W, T)) :- show(W, T).

% What aggregate_all measures is measured before it sees it: max(X * 2) as max(N), with N of X * 2.
measured(T, T, []) :- ( \+ compound(T) ; compound_name_arity(T, F, _), memberchk(F, [bag, set, count]) ), !.
measured(T0, T, [E-N]) :- T0 =.. [F, E | W], memberchk(F, [sum, max, min]), !, T =.. [F, N | W].
measured(T0, T, Measures) :-
    T0 =.. [F | Ts0], maplist(measured, Ts0, Ts, Each), append(Each, Measures), T =.. [F | Ts].
measure(E-N) :- number_of(E, N).

%!  number_of(+Expression, ?Number) : of listed functions, and of no number beyond a size.
number_of(E, N) :- number(E), !, bits(E, Bits), of_size(Bits), N = E.
number_of(E, _) :- var(E), !, throw(error(instantiation_error, _)).
number_of(E, N) :-
    (   callable(E), \+ is_dict(E), E =.. [F | Es], length(Es, Arity), function(Arity, Fs), memberchk(F, Fs) -> true
    ;   throw(error(type_error(evaluable, E), _))
    ),
    maplist(number_of, Es, Ns),
    ( growth(F, Ns, Grown) -> of_size(Grown) ; true ),
    Applied =.. [F | Ns], M is Applied, bits(M, Bits), of_size(Bits), N = M.
function(0, [pi, e, inf, nan, epsilon]).
function(1, [-, +, abs, sign, min, max, sqrt, exp, log, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh,
             acosh, atanh, float, integer, truncate, round, floor, ceiling, float_integer_part, float_fractional_part,
             rational, rationalize, numerator, denominator, \, msb]).
function(2, [+, -, *, /, //, mod, rem, div, rdiv, min, max, **, ^, >>, <<, /\, \/, xor, gcd, atan, atan2, copysign, log,
             truncate]).
growth(F, [A, B], Bits) :- memberchk(F, [**, ^]), \+ float(A), \+ float(B), abs(A) =\= 1, bits(A, As), !,
    ( B =:= 0 -> Bits = 0 ; Bits is (As - 1) * min(abs(B), 1 << 20) ).
growth(<<, [A, B], Bits) :- integer(A), integer(B), bits(A, As), Bits is As + B.
growth(>>, [A, B], Bits) :- integer(A), integer(B), bits(A, As), Bits is As - B.
bits(N, 0) :- ( float(N) ; N =:= 0 ), !.
bits(N, Bits) :- integer(N), !, Bits is msb(abs(N)) + 1.
bits(N, Bits) :- A is numerator(N), B is denominator(N), bits(A, As), bits(B, Bs), Bits is As + Bs.
of_size(Bits) :-
    ( Bits =< 65536 -> true ; throw(refused("the query needs an integer of more than 65536 bits"-[])) ).
