"""The letters' evaluation: its oracle knows what a reach takes, and its rows are over letters."""

import math
from collections import Counter
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import REACH
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.domains.arm.letters import font
from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.tools.evaluations.arm import letter_figures, letters, perfect_greedy
from tailor.tools.evaluations.arm.letter_figures import ORACLES, Figures
from tailor.tools.evaluations.arm.perfect_greedy import Leg, _best, _durations
from tailor.tools.evaluations.arm.perfect_reach import PerfectReach
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.seeds import Seeds
from tailor.tools.main import main
from tailor.tools.writing.writing_track import writing_track


def test_the_oracle_predicts_what_the_controller_plans():
    rng = np.random.default_rng(5)
    states = rng.uniform(-0.9, 0.9, (400, 8)) * [1, 0.7, 1, 0.7, 1, 0.7, 1, 0.7]
    rows = np.hstack([states, rng.uniform(0.8, 1.4, (400, 2))])
    planned = []
    for row in rows:
        now = tuple(row[0:4:2].tolist()), tuple(row[1:4:2].tolist())
        belief = ArmBelief(0, *now, 0, friction=tuple(row[8:].tolist()))
        planned.append(REACH.controller(None, 0, belief, row).state.cubic.duration_s - PERIOD_S)
    predicted, spread = PerfectReach().predict(rows)
    assert np.abs(predicted - planned).mean() < 0.04  # whole periods are planned
    assert (np.abs(predicted - planned) < 0.11).mean() > 0.95  # two that cost alike may be told apart
    assert not spread.any()


def figures(duration_s):
    return Figures(True, duration_s, 1.0, 5.0, 1.0, 1.0, 0.0)


def found(n_letters=6, n_seeds=3):
    """Refined letters take 0.9 of greedy, 0.8 of stopping, 0.95 of perfect greedy ones; letters differ, seeds not."""
    shares = {"stopping": 1 / 0.8, "greedy": 1 / 0.9, "refined": 1.0, "perfect greedy": 1 / 0.95}
    keys = [(letter, seed) for seed in range(n_seeds) for letter in "ABCDEFGHIJ"[:n_letters]]
    rng = np.random.default_rng(0)
    off = {mode: dict(zip("ABCDEFGHIJ", rng.normal(0.0, 0.02, 10).tolist(), strict=True)) for mode in shares}
    return {mode: {key: figures(5.0 * (share + off[mode][key[0]])) for key in keys} for mode, share in shares.items()}


def test_a_row_compares_with_stopping_learned_greedy_and_perfect_greedy():
    refined = next(row for row in letters.rows_of(found()) if row["mode"] == "refined")
    assert (refined["n"], refined["letters"]) == (18, 6)
    for column, gain_pct in (("improvement", 10), ("against_stopping", 20), ("against_perfect_greedy", 5)):
        assert abs(refined[f"{column}_pct"] - gain_pct) < 2
    assert refined["against_stopping_ci95"][0] > 0


def test_costs_are_compared_with_those_of_learned_greedy_over_letters():
    some = found()
    for mode, energy_j in (("greedy", 4.0), ("refined", 5.0)):
        for letter, seed in some[mode]:
            own = 0.1 * (ord(letter) % 3) * (mode == "refined")
            costs = Costs(0, energy_j + own + 0.01 * seed, (("position_rad", 0.02),))
            some[mode][letter, seed] = replace(some[mode][letter, seed], costs=costs)
    rows = {row["mode"]: row for row in letters.rows_of(some)}
    refined = rows["refined"]
    assert refined["energy_j"] == pytest.approx(5.11)
    low, high = refined["energy_j_more_ci95"]
    assert 1.0 < low < 1.1 < high < 1.2
    assert refined["arrival_position_rad"] == pytest.approx(0.02)
    assert rows["greedy"]["energy_j"] == pytest.approx(4.01)
    assert "energy_j" not in rows["stopping"]  # not known there


def test_letters_that_are_faster_and_take_less_energy_are_the_fastest():
    row = {"ci95": (1.0, 3.0), "against_stopping_ci95": (2.0, 4.0), "energy_j_more_ci95": (-2.0, -1.0)}
    assert letters.is_fastest(row)
    assert not letters.is_fastest({**row, "against_stopping_ci95": (-0.1, 4.0)})
    assert not letters.is_fastest({**row, "ci95": (-0.1, 4.0)})


def test_more_seeds_of_equal_letters_make_no_interval_narrower():
    few, many = (next(row for row in letters.rows_of(found(n_seeds=n)) if row["mode"] == "refined") for n in (1, 10))
    assert np.ptp(many["ci95"]) == pytest.approx(np.ptp(few["ci95"]))


def test_a_letter_that_one_mode_failed_counts_for_none():
    some = found()
    some["greedy"]["A", 0] = replace(figures(1.0), achieved=False)
    rows = letters.rows_of(some)
    assert {row["n"] for row in rows} == {17}
    assert [row["failed"] for row in rows if row["mode"] == "greedy"] == [1]


def test_perfect_greedy_is_at_least_as_fast_to_the_first_waypoint_as_stopping_there():
    body, leg = PowerCubeBody(), Leg((-0.8, 0.0, -0.6, 0.0), (-0.2, 0.1), 0.6, (1.0, 1.0), (7, 0))
    chosen = _best(body, leg, [(0.0, 0.0), (0.6, 0.3), (-0.6, -0.3)])
    assert chosen == (0.6, 0.3)
    assert sum(_durations(body, leg, chosen, [])) < sum(_durations(body, leg, (0.0, 0.0), []))


@pytest.mark.parametrize(("succeeds", "expected"), [(0.2, (0.2, 0.0)), (0.9, (-0.1, 0.0))])
def test_perfect_greedy_leaves_out_a_choice_that_failed(succeeds, expected, monkeypatch):
    """Where the first one did, a limit without end for the others ended the evaluation in a traceback."""

    def ran(body, domain, action, arguments, rng, *, limit_s):
        assert math.isfinite(limit_s)
        return SimpleNamespace(success=arguments[5] >= succeeds, duration_s=1.0)

    monkeypatch.setattr(perfect_greedy, "run_action", ran)
    leg = Leg((0.0, 0.0, 0.0, 0.0), (0.3, 0.2), 0.5, (1.0, 1.0), (7, 0))
    assert _best(None, leg, [(-0.1, 0.0), (0.2, 0.0)]) == expected


def test_no_two_letters_have_the_same_start():
    """A start decides on the temperature of the gears: one for all letters would be one unit, not 26."""
    keys = letters.keys_of(Seeds(1000, {}), 3)
    assert Counter(letter for letter, _ in keys) == dict.fromkeys(font(), 3)
    assert sorted(seed for _, seed in keys) == list(range(1000, 1000 + 3 * len(font())))


def test_some_letters_are_written_from_the_starts_that_they_have_among_all(monkeypatch, capsys):
    asked = []

    def measured(modes, keys, zoo, jobs):
        asked.extend(keys)
        return {mode.name: dict.fromkeys(keys, figures(5.0)) for mode in modes}

    monkeypatch.setattr(letters, "measure_letters", measured)
    command = ["evaluate", "letters", "--seeds", "2", "--no-oracle", "--json"]
    main([*command, "--seed", "1000", "--letters", "BZ"])
    assert asked == [key for key in letters.keys_of(Seeds(1000, {}), 2) if key[0] in "BZ"]
    assert main([*command, "--letters", "BÄ"]) == 2
    assert main([*command, "--letters", "BB"]) == 2
    assert "--letters is 'BB', expected some of ABC" in capsys.readouterr().err
    asked.clear()
    assert main([*command, "--letters", "B"]) == 2
    assert "--letters is 'B', expected at least two letters" in capsys.readouterr().err
    assert not asked, "nothing is written for an interval that does not exist"


def test_where_nothing_could_be_gained_there_is_no_share_of_it():
    """Durations are whole periods: a few letters take the same in every mode."""
    some = found(n_letters=2, n_seeds=1)
    equal = {mode: dict.fromkeys(some["greedy"], figures(2.0)) for mode in (*some, *(each.name for each in ORACLES))}
    assert all(math.isnan(row["share_of_gain_pct"]) for row in letters.rows_of(equal))


def test_a_letter_without_any_waypoint_has_failed(monkeypatch):
    """It ended the evaluation, and with it all letters that were written."""
    nothing = writing_track("refined", "T", [])
    monkeypatch.setattr(letter_figures, "_written", lambda *key: (nothing, None))
    failed = letter_figures._figures(letter_figures.REFINED, ("T", 1), "")
    assert (failed.achieved, failed.duration_s) == (False, 0.0)
    some = found()
    some["greedy"]["A", 0] = failed
    assert {row["n"] for row in letters.rows_of(some)} == {17}
