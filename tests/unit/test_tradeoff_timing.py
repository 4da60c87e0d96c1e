"""Error against time: fronts, costs of digits, and budgets."""

from math import inf, isnan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beamdyn.studies.tradeoffs import measurements as timing
from beamdyn.studies.tradeoffs.measurements import (
    Diagram,
    Family,
    Measurement,
    TimedCase,
    cost_per_digit,
    measure_families,
    pareto_front,
)
from benchmarks.tradeoff import LEGENDRE, compare_sizes

coarse = st.sampled_from([1e-9, 1e-6, 1e-3, 0.1, 2.0])  # few values, so that ties are drawn
points = st.lists(st.tuples(coarse, coarse | st.just(inf)), max_size=12)


def of(pairs):
    return [Measurement("family", f"setting {i}", i, e, t) for i, (t, e) in enumerate(pairs)]


def beats(a, b):
    return a.error <= b.error and a.time <= b.time and (a.error < b.error or a.time < b.time)


@pytest.fixture(scope="module", autouse=True)
def once():
    """Each case runs once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(timing, "RUNS", 1)
        yield


# Fronts and digits --------------------------------------------------------------------------------


@settings(derandomize=True, deadline=None)
@given(points)
def test_the_front_is_what_nothing_beats(pairs):
    everything = of(pairs)
    front = pareto_front(everything)
    known = [m for m in everything if m.error < inf]
    for m in everything:
        beaten = m.error == inf or any(beats(other, m) for other in known)
        assert (m in front) == (not beaten)
    assert [m.time for m in front] == sorted(m.time for m in front)


@settings(derandomize=True, deadline=None)
@given(points)
def test_a_digit_costs_the_shortest_time_that_reaches_it(pairs):
    everything = of(pairs)
    digits = cost_per_digit(everything)
    reached = min((m.error for m in everything), default=inf)
    assert len(digits) == {1e-9: 9, 1e-6: 6, 1e-3: 3, 0.1: 1, 2.0: 0, inf: 0}[reached]
    for digit in digits:
        assert digit.time == min(m.time for m in everything if m.error <= digit.error)
    assert [d.time for d in digits] == sorted(d.time for d in digits)


def test_the_ratio_is_to_the_digit_before():
    digits = cost_per_digit(of([(1.0, 0.05), (2.0, 0.011), (4.0, 1e-3), (9.0, 1e-2)]))
    assert [d.setting for d in digits] == ["setting 0", "setting 2", "setting 2"]
    assert isnan(digits[0].ratio)
    assert [d.ratio for d in digits[1:]] == [4.0, 1.0]


# Budgets ------------------------------------------------------------------------------------------


class Clock:
    """Time that passes only in the runs."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now

    def case(self, setting, takes, answer=0.5):
        def run(deadline):
            if self.now + takes > deadline:
                self.now = deadline
                raise TimeoutError("half-way")
            self.now += takes
            if isinstance(answer, Exception):
                raise answer
            return answer

        return TimedCase(setting, 1.0, run)


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(timing, "perf_counter", clock)
    monkeypatch.setattr(timing, "process_time", clock)
    return clock


def run(clock, *cases, budget=10.0, resolved=1e-12):
    return measure_families([Family("F", cases)], lambda answer: answer, resolved, budget)


def test_a_cheap_case_is_repeated_and_a_dear_one_is_not(clock, monkeypatch):
    monkeypatch.setattr(timing, "RUNS", 7)
    found, skipped = run(clock, clock.case("a", 0.1), clock.case("b", 5.0))
    assert ([m.time for m in found], skipped) == (pytest.approx([0.1, 5.0], rel=1e-12), [])
    assert clock.now == pytest.approx(7 * 0.1 + 5.0, rel=1e-12)


def test_the_shortest_run_counts(monkeypatch):
    monkeypatch.setattr(timing, "RUNS", 3)
    instants = iter([0.0, 3.0, 3.0, 4.0, 4.0, 6.0])  # the runs take 3, 1 and 2 s
    monkeypatch.setattr(timing, "process_time", lambda: next(instants))
    found, _ = measure_families([Family("F", (TimedCase("a", 1, lambda deadline: 0.5),))], float, 0.0, 1e3)
    assert [m.time for m in found] == [1.0]


def test_a_reference_leaves_half_of_the_budget(clock):
    clock.now = 3.0
    assert [timing.remaining_budget(budget, 1.0) for budget in (10.0, 3.0)] == [8.0, 1.5]


def test_a_run_past_the_budget_is_given_up_and_named(clock):
    found, skipped = run(clock, clock.case("a", 5.0), clock.case("b", 7.0), clock.case("c", 1.0))
    assert [m.setting for m in found] == ["a"]
    assert skipped == ["F: b given up after 5 s half-way, and further settings left out"]
    assert clock.now == 10.0


def test_what_would_not_fit_is_not_begun(clock):
    found, skipped = run(clock, clock.case("a", 6.0), clock.case("b", 1.0))
    assert [m.setting for m in found] == ["a"]
    assert skipped == ["F: left out from b on, as its share of 10 s is used up"]


def test_a_machine_that_was_busy_for_a_moment_ends_no_family(clock, monkeypatch):
    """6 of 10 s pass in a run that computes for 1 s; the next one fits."""
    monkeypatch.setattr(timing, "process_time", lambda: clock.now / 6)
    found, skipped = run(clock, clock.case("a", 6.0), clock.case("b", 1.0))
    assert ([m.setting for m in found], skipped) == (["a", "b"], [])


@pytest.mark.parametrize(("measured", "said"), [
    ([4, 8, 14], "14 functions take\n  3.50 times as long as 4"),
    ([4, 8, 40], "8 functions take\n  2.00 times as long as 4"),
    ([4], "was not measured"),
])  # fmt: skip
def test_the_page_compares_the_sizes_that_were_measured(measured, said):
    points = [Measurement(LEGENDRE, f"{n} functions", n, 1e-3, n / 1000) for n in measured]
    assert said in compare_sizes(Diagram.make("", "", "", 1e-12, points))


def test_a_failure_is_named(clock):
    broken = clock.case("b", 1.0, ArithmeticError("no such luck"))
    found, skipped = run(clock, clock.case("a", 1.0), broken, clock.case("c", 1.0))
    assert [m.setting for m in found] == ["a"]
    assert skipped == ["F: b failed (no such luck), and further settings left out"]


def test_what_a_family_leaves_goes_to_the_next(clock):
    families = [Family("F", (clock.case("a", 4.0),)), Family("G", (clock.case("b", 6.0),))]
    found, skipped = measure_families(families, lambda answer: answer, 0.0, 10.0)
    assert ([m.family for m in found], skipped) == (["F", "G"], [])


def test_errors_are_not_below_what_is_resolved_and_never_nan(clock):
    found, _ = run(clock, clock.case("a", 1.0, 1e-15), clock.case("b", 1.0, float("nan")))
    assert [m.error for m in found] == [1e-12, inf]


# Ties ---------------------------------------------------------------------------------------------


def test_times_within_twice_their_scatter_are_ties():
    each = [(1.0, 0.0), (1.05, 0.03), (1.2, 0.03), (1.5, 0.3)]
    measured = [Measurement("F", f"{i}", i, 0.05, t, scatter) for i, (t, scatter) in enumerate(each)]
    (digit,) = cost_per_digit(measured)
    assert (digit.advice, digit.ties) == ("F, 0", ("F, 1", "F, 3"))


def test_contenders_run_again_in_turns(clock, monkeypatch):
    """So that a drift of the machine does not decide between them; what is far slower does not run again."""
    ran = []
    monkeypatch.setattr(timing, "RUNS", 2)

    def setting(name, takes):
        case = clock.case(name, takes, answer=0.01)
        return TimedCase(name, 1.0, lambda deadline: (ran.append(name), case.run(deadline))[1])

    names = "a", "b", "slow"
    families = [Family(n, (setting(n, t),)) for n, t in zip(names, (0.1, 0.11, 0.5), strict=True)]
    measure_families(families, float, 1e-12, 10.0)
    assert ran == ["a", "a", "b", "b", "slow", "slow", "a", "b", "a", "b"]
