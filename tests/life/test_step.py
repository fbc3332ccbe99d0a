"""One step: its parts in their order, how acts end, and every way to die."""

import math
from itertools import product

import numpy as np
import pytest
import shapely

from animat.life.life import live
from animat.life.scenario import bring_together
from animat.life.state import NO_SITE
from animat.mind.behaviours import ACT, LEAVE, WANDER
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.arena import Arena
from animat.world.layout import Layout, Placement
from animat.world.world import World

VARIABLES = ("nutrition", "stamina", "restlessness")
NEEDS = list(product(VARIABLES, ("deficit", "excess")))
SERVED_BY = {"nutrition": "eat", "stamina": "shelter", "restlessness": "interact"}
DRIVE_OF = {"nutrition": "hunger", "stamina": "fatigue", "restlessness": "curiosity"}

SMALL = Arena(width=560.0, height=560.0)

REACH = 57.5  # mm, of the robot's radius and the encounter range


def mirrored(value, kind):
    """A place in [0, 1] as one of the deficit kind means it: near 1 is satisfied."""
    return value if kind == "deficit" else 1.0 - value


# --- the parts in their order -----------------------------------------------------------------


def test_a_step_senses_then_metabolises_then_decides_then_acts(small, columns):
    life = live(Mind(), small, steps=400, record="all")
    c = columns(life)
    birth = columns(live(Mind(), small, steps=1, record="all"))
    assert birth["x"][0] == c["x"][0]  # senses where it was born
    assert c["nutrition"][0] == pytest.approx(0.5 * math.exp(-1e-4), rel=1e-14)
    assert c["hunger"][0] == pytest.approx(0.9 - c["nutrition"][0], rel=1e-14)
    moved = np.hypot(np.diff(c["x"]), np.diff(c["y"]))
    first = np.flatnonzero(c["left"] + c["right"] > 0)[0]
    assert moved[first] > 1.0  # the motors of a row lead to the next


def test_who_dies_of_metabolism_decides_and_does_nothing_more(small, caring_for, step_by_step):
    variables = caring_for("nutrition", law="linear", kind="deficit", rate=0.01)
    states = [state for state, _ in step_by_step(Mind(variables=variables), small, 60)]
    alive = [state for state in states if not state.dead]
    dead = states[-1]
    assert dead.dead
    assert (dead.x, dead.y, dead.heading) == (alive[-1].x, alive[-1].y, alive[-1].heading)
    assert dead.mode_steps == alive[-1].mode_steps
    assert dead.step == alive[-1].step + 1


def test_an_act_that_kills_still_ends(small, affording, caring_for):
    variables = caring_for("nutrition", rate=1e-7, start=0.1)
    life = live(Mind(variables=variables), affording(0.0), steps=20_000)
    assert life.death == "nutrition low, failure"
    assert (life.state.acts, life.state.mode, life.state.reward) == (1, LEAVE, -1)


# --- death ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("variable", "kind"), NEEDS)
def test_death_by_metabolism(variable, kind, small, caring_for, columns):
    rate, value, steps = 0.01, 0.5, 0
    while 0.0 <= value <= 1.0:
        value += -rate if kind == "deficit" else rate
        steps += 1
    variables = caring_for(variable, law="linear", kind=kind, rate=rate, set_point=0.5)
    mind = Mind(variables=variables, success_effect=0.0, failure_effect=0.0)
    life = live(mind, small, steps=1_000, record="all")
    side = "low" if kind == "deficit" else "high"
    assert life.death == f"{variable} {side}, metabolism"
    assert life.lifespan == steps
    assert columns(life)["event"][-1] == "death"
    told = life.summary
    assert (told["death_variable"], told["death_side"]) == (variable, side)
    assert (told["death_cause"], told["censored"]) == ("metabolism", False)


@pytest.mark.parametrize(("variable", "kind"), NEEDS)
def test_death_by_a_failed_act(variable, kind, affording, caring_for, columns):
    start, satisfied = mirrored(0.15, kind), mirrored(0.9, kind)
    settings = {
        "variables": caring_for(
            variable, law="linear", kind=kind, rate=1e-7, start=start, set_point=satisfied
        )
    }
    world = affording(0.0)
    life = live(Mind(**settings), world, steps=20_000, record="all")
    side = "low" if kind == "deficit" else "high"
    assert life.death == f"{variable} {side}, failure"
    assert (life.summary["death_cause"], life.state.acts) == ("failure", 1)
    last = columns(life)
    assert last["event"][-1] == "failure death"
    assert (last["behaviour"][-1], last["reward"][-1]) == (SERVED_BY[variable], -1)
    held = live(Mind(**settings, failed_act="clamp"), world, steps=20_000)
    assert held.death == f"{variable} {side}, metabolism"
    assert held.lifespan == life.lifespan + 1  # at its bound, which the next drift crosses
    spared = live(Mind(**settings, failure_effect=0.1), world, steps=life.lifespan)
    assert not spared.dead


@pytest.mark.parametrize(("variable", "kind"), NEEDS)
def test_death_by_a_successful_act(variable, kind, affording, caring_for, columns):
    settings = {
        "variables": caring_for(
            variable,
            law="linear",
            kind=kind,
            rate=1e-7,
            start=mirrored(0.85, kind),
            set_point=mirrored(0.9, kind),
        )
    }
    world = affording(1.0)
    life = live(Mind(**settings, overflow="lethal"), world, steps=20_000, record="all")
    side = "high" if kind == "deficit" else "low"
    assert life.death == f"{variable} {side}, success"
    assert life.summary["death_cause"] == "success"
    last = columns(life)
    assert last["event"][-1] == "success death"
    assert (last["behaviour"][-1], last["reward"][-1]) == (SERVED_BY[variable], 1)
    held = live(Mind(**settings), world, steps=life.lifespan)
    assert not held.dead
    v = VARIABLES.index(variable)
    assert held.state["values"][v] == mirrored(1.0, kind)


@pytest.mark.parametrize("variable", VARIABLES)
def test_a_variable_that_is_not_lethal_stops_at_its_bound(variable, small, caring_for):
    change = {"law": "linear", "kind": "excess", "rate": 0.01}
    mind = Mind(variables=caring_for(variable, **change, lethal=False), success_effect=0.0)
    life = live(mind, small, steps=200)
    assert not life.dead
    assert life.state["values"][VARIABLES.index(variable)] == 1.0
    assert live(Mind(variables=caring_for(variable, **change)), small, steps=200).dead


@pytest.mark.parametrize("law", ["decay", "relax"])
def test_a_law_that_never_reaches_its_bound_kills_at_the_lethal_margin(law, small, caring_for):
    factor, margin, value, steps = math.exp(-0.02), 0.05, 0.5, 0
    while value > margin:
        value *= factor
        steps += 1
    set_point = 0.5
    variables = caring_for("stamina", law=law, rate=0.02, set_point=set_point, lethal_margin=margin)
    life = live(Mind(variables=variables, success_effect=0.0, failure_effect=0.0), small)
    assert life.lifespan == steps
    assert life.death == f"stamina {'low' if law == 'decay' else 'high'}, metabolism"


def test_of_two_variables_outside_at_once_the_first_is_the_cause(small):
    change = {"law": "linear", "kind": "excess", "rate": 0.01}
    life = live(Mind(variables=dict.fromkeys(("stamina", "restlessness"), change)), small)
    assert life.death == "stamina high, metabolism"


def test_a_life_without_death_goes_on_with_its_variables_at_their_bounds(affording, columns):
    variables = {key: {"law": "linear", "kind": "deficit", "rate": 0.01} for key in VARIABLES}
    life = live(Mind(death=False, variables=variables), affording(0.0), steps=3_000, record="all")
    c = columns(life)
    assert not life.dead
    assert life.lifespan == 3_000
    assert life.state.acts > 0
    assert c["nutrition"].min() == 0.0


# --- encounters -------------------------------------------------------------------------------


def test_nobody_is_met_while_every_drive_is_satisfied(small, columns):
    content = {name: {**QUIET_AT[name], "rate": 1e-9} for name in VARIABLES}
    closed = live(Mind(variables=content), small, steps=5_000, record="all")
    assert closed.state.encounters == 0
    assert set(columns(closed)["behaviour"]) == {"wander"}
    always = live(Mind(variables=content, gate="always"), small, steps=5_000)
    assert always.state.encounters > 5
    assert live(Mind(), small, steps=1_000).state.encounters > 0


QUIET_AT = {
    "nutrition": {"start": 0.95},
    "stamina": {"start": 0.1},
    "restlessness": {"start": 0.05},
}
"""Past their set points, so that every drive is negative."""


def test_a_drive_at_zero_does_not_open_the_gate(small):
    still = {name: {**QUIET_AT[name], "rate": 1e-300} for name in VARIABLES}
    still["nutrition"] = {"start": 0.9, "rate": 1e-300}
    life = live(Mind(variables=still), small, steps=2_000)
    assert life.state.drives.max() == 0.0
    assert life.state.encounters == 0


def test_the_choice_holds_until_the_interaction_ends(small, columns):
    variables = {"restlessness": {"law": "linear", "kind": "excess", "rate": 5e-3}}
    mind = Mind(variables=variables, death=False, interaction_steps=100, success_effect=0.9)
    c = columns(live(mind, small, steps=30_000, record="all"))
    acting = ~np.isin(c["behaviour"], ["wander", "approach", "leave"])
    chosen = [c["behaviour"][first] for first, _ in c.runs(acting)]
    assert len(set(chosen)) > 1
    for first, last in c.runs(acting):
        assert len(set(c["behaviour"][first : last + 1])) == 1
    wins = np.array([DRIVE_OF[v] for v in VARIABLES])
    served = {behaviour: wins[n] for n, behaviour in enumerate(SERVED_BY.values())}
    latched = [c["winning_drive"][n] != served[c["behaviour"][n]] for n in np.flatnonzero(acting)]
    assert any(latched)  # another drive grew stronger meanwhile, and the act went on


@pytest.mark.parametrize("interaction_steps", [1, 7, 20])
def test_the_outcome_comes_at_the_end_of_the_interaction(interaction_steps, small, columns):
    mind = Mind(death=False, interaction_steps=interaction_steps)
    c = columns(live(mind, small, steps=8_000, record="all"))
    acting = ~np.isin(c["behaviour"], ["wander", "approach", "leave"])
    ended = [run for run in c.runs(acting) if run[1] < len(acting) - 1]
    assert len(ended) > 5
    outcomes = np.flatnonzero(c.happened("success") | c.happened("failure"))
    for first, last in ended:
        assert last - first + 1 == interaction_steps
        assert c.happened("reached")[first - 1]
        assert last in outcomes
        assert (c["reward"][first:last] == 0).all()
        assert np.ptp(c["x"][first : last + 2]) == 0.0
    assert (c["reward"][outcomes] != 0).all()
    assert np.count_nonzero(c["reward"]) == len(outcomes)


def test_who_does_not_reach_an_object_in_time_gives_up_without_an_outcome(small, columns):
    life = live(Mind(death=False, approach_steps=4), small, steps=8_000, record="all")
    c = columns(life)
    approaches = [run for run in c.runs(c["behaviour"] == "approach") if run[1] < 7_999]
    assert len(approaches) > 10
    for first, last in approaches:
        assert last - first + 1 == 4
        assert c.happened("encounter")[first]
        assert c["event"][last].split()[0] == "unreached"
        assert c["behaviour"][last + 1] == "leave"
        assert c["site"][last + 1] == c["site"][last]
    assert life.state.unreached == np.count_nonzero(c.happened("unreached")) == len(approaches)
    assert (life.state.acts, np.count_nonzero(c["reward"])) == (0, 0)
    served = c["nutrition"] * np.exp(1e-4 * (c["step"] + 1))
    assert served == pytest.approx(0.5, rel=1e-9)  # no outcome moved it


def test_leaving_turns_the_back_on_the_object_on_the_spot(small, columns):
    life = live(Mind(death=False), small, steps=20_000, record="all")
    c = columns(life)
    left = [run for run in c.runs(c["behaviour"] == "leave") if run[1] < 19_999]
    assert len(left) > 20
    raster = life.setting.raster
    behind = 0
    for first, last in left:
        assert np.ptp(c["x"][first : last + 2]) == 0.0
        assert (c["left"][first : last + 1] == -c["right"][first : last + 1]).all()
        assert last - first + 1 <= 40
        assert c["site"][last + 1] == NO_SITE
        site = c["site"][last]
        to_site = math.atan2(
            raster.site_y[site] - c["y"][last + 1], raster.site_x[site] - c["x"][last + 1]
        )
        away = abs(math.remainder(to_site - c["heading"][last + 1], math.tau))
        behind += away > 0.75 * math.pi - 1e-9
    assert behind == len(left)


def test_leaving_takes_no_longer_than_leave_steps(small, columns):
    c = columns(live(Mind(death=False, leave_steps=6), small, steps=8_000, record="all"))
    lengths = [
        last - first + 1 for first, last in c.runs(c["behaviour"] == "leave") if last < 7_999
    ]
    assert len(lengths) > 5
    assert set(lengths) == {6}


@pytest.mark.parametrize("seed", range(3))
def test_an_abandoned_object_is_met_again_only_after_it_was_out_of_range(seed, columns, crowded):
    """Who is met, and when, follows from the poses of the trace alone."""
    life = live(Mind(death=False), crowded, seed=seed, steps=20_000, record="all")
    c = columns(life)
    raster = life.setting.raster
    rows = (c["y"] / raster.resolution + raster.border).astype(int)
    places = (c["x"] / raster.resolution + raster.border).astype(int)
    near = raster.near_site[rows, places]
    away = raster.near_distance[rows, places]
    met = c.happened("encounter")
    abandoned: set[int] = set()
    blocked_by_memory = 0
    for t in range(len(met)):
        in_reach = [int(s) for s, d in zip(near[t], away[t], strict=True) if d <= REACH]
        abandoned &= set(in_reach)
        free = [site for site in in_reach if site not in abandoned]
        searching = c["behaviour"][t] == "wander" or met[t]
        if searching and max(c["hunger"][t], c["fatigue"][t], c["curiosity"][t]) > 0.0:
            assert met[t] == bool(free), t
            blocked_by_memory += bool(in_reach) and not free
            if met[t]:
                assert c["site"][t] == free[0]  # the nearest
        if set(c["event"][t].split()) & {"success", "failure", "unreached"}:
            abandoned.add(int(c["site"][t]))
    assert met.sum() > 50
    assert blocked_by_memory > 50


@pytest.fixture(scope="module")
def crowded():
    counts = {"TS": 3, "TL": 2, "CS": 3, "CL": 2}
    return World.random(counts, seed=4, arena=Arena(width=760.0, height=760.0), gap=64.0)


# --- consumed objects -------------------------------------------------------------------------


def test_objects_that_were_used_up_stand_elsewhere_out_of_sight(spared, step_by_step):
    mind = Mind(death=False, consumed=True, gate="always")
    site_type = spared.layout.site_types()
    outlines = spared.polygons()
    moves = 0
    before = None
    for state, present in step_by_step(mind, spared, 12_000):
        if before is not None and not np.array_equal(before[1], present):
            gone = np.flatnonzero(before[1] & ~present)
            new = np.flatnonzero(present & ~before[1])
            assert (len(gone), len(new)) == (1, 1)
            assert gone[0] == before[0].site
            assert site_type[gone[0]] == site_type[new[0]]
            assert state.successes == before[0].successes + 1
            corners = outlines[new[0]]
            assert np.hypot(corners[:, 0] - state.x, corners[:, 1] - state.y).min() > REACH
            moves += 1
        elif before is not None:
            assert state.successes == before[0].successes
        before = (state, present)
    assert moves > 10


def test_no_object_appears_within_sight(step_by_step):
    """Of two spare places one lies beside the object that is used up."""
    layout = Layout(
        placements=(Placement(type="CS", x=200.0, y=280.0),),
        spares=(Placement(type="CS", x=270.0, y=280.0), Placement(type="CS", x=450.0, y=280.0)),
        arena=SMALL,
        minimum_gap=25.0,
    )
    world = World(layout=layout)
    outlines = [shapely.Polygon(corners) for corners in world.polygons()]
    mind = Mind(death=False, consumed=True, gate="always", selector="random")
    before, moves = None, 0
    for state, present in step_by_step(mind, world, 20_000):
        if before is not None and not np.array_equal(before, present):
            [new] = np.flatnonzero(present & ~before)
            assert shapely.distance(outlines[new], shapely.Point(state.x, state.y)) > REACH
            moves += 1
        before = present
    assert moves > 10


def test_objects_persist_unless_consumed(spared, step_by_step):
    states = list(step_by_step(Mind(death=False), spared, 6_000))
    assert states[-1][0].successes > 0
    assert all(np.array_equal(present, states[0][1]) for _, present in states)
    assert states[0][1].tolist() == [1] * spared.n_objects + [0] * (
        spared.n_sites - spared.n_objects
    )


# --- judgement --------------------------------------------------------------------------------


def constant_networks(likelihood):
    """Networks that say the same of every object: all weights 0 but the output's bias."""
    weights = np.zeros((3, 9))
    weights[:, 6] = math.log(likelihood / (1.0 - likelihood)) if likelihood != 0.5 else 0.0
    return Networks(("eat", "shelter", "interact"), ("shape", "size"), 2, weights)


@pytest.mark.parametrize(
    ("likelihood", "threshold", "accepts"),
    [(0.5, 0.5, True), (0.5, 0.5000001, False), (0.8, 0.75, True), (0.8, 0.85, False)],
)
def test_an_object_is_accepted_from_the_likelihood_threshold_on(
    likelihood, threshold, accepts, small
):
    networks = constant_networks(likelihood)
    mind = Mind(agent="AF", networks=networks, likelihood_threshold=threshold, death=False)
    state = live(mind, small, steps=6_000).state
    assert state.encounters > 5
    assert state.disregarded == (0 if accepts else state.encounters)
    assert (state.acts > 0) == accepts


def test_a_likelihood_holds_its_last_value_while_its_behaviour_is_not_run(small, columns):
    life = live(Mind(agent="LEARNING"), small, steps=15_000, record="all")
    c = columns(life)
    met = c.happened("encounter")
    chosen = {behaviour: set() for behaviour in SERVED_BY.values()}
    for t in np.flatnonzero(met):
        after = c["behaviour"][t + 1 :]
        acts = after[~np.isin(after, ["approach", "leave", "wander"])]
        if len(acts):
            chosen[acts[0]].add(t)
    for behaviour, at in chosen.items():
        trace = c[f"likelihood_{behaviour}"]
        asked = ~np.isnan(trace)
        first = int(np.argmax(asked))
        assert first > 0
        assert asked[first:].all()
        changes = {first, *(np.flatnonzero(np.diff(trace[first:])) + first + 1).tolist()}
        assert len(changes) > 3
        assert changes <= at


# --- learning ---------------------------------------------------------------------------------


def test_a_failure_that_a_bound_hides_is_learnt_from_all_the_same(affording, caring_for):
    """Already at its bound the variable does not move; the jump before clamping counts."""
    variables = caring_for("nutrition", start=0.0, rate=1e-7)
    life = live(Mind(agent="LEARNING", variables=variables), affording(0.0), steps=20_000)
    assert life.state["values"][0] == 0.0
    assert life.state.acts > 5
    assert life.state.trainings == life.state.acts
    for kind in ({"shape": 0.0, "size": 0.0}, {"shape": 1.0, "size": 1.0}):
        assert life.networks.likelihoods(kind)["eat"] < 0.5


def test_a_success_that_a_bound_hides_is_learnt_from_all_the_same(affording, caring_for):
    variables = caring_for("nutrition", start=1.0, set_point=1.0, rate=1e-7)
    mind = Mind(agent="LEARNING", variables=variables)
    life = live(mind, affording(1.0), steps=20_000)
    assert life.state.acts > 5
    assert life.state.trainings == life.state.acts


@pytest.mark.parametrize(("effect", "learns"), [(0.049, False), (0.051, True)])
def test_only_a_sudden_variation_of_the_drive_is_learnt_from(effect, learns, small, step_by_step):
    mind = Mind(agent="LEARNING", success_effect=effect, failure_effect=effect)
    states = [state for state, _ in step_by_step(mind, small, 6_000)]
    birth, end = states[0], states[-1]
    assert end.acts > 5
    assert end.trainings == (end.acts if learns else 0)
    assert np.array_equal(birth.weights, end.weights) != learns


def test_training_moves_only_the_network_that_was_run_towards_what_came_of_it(small, step_by_step):
    before = None
    trained = 0
    for state, _ in step_by_step(Mind(agent="LEARNING"), small, 15_000):
        if before is not None and not np.array_equal(before.weights, state.weights):
            b = before.behaviour
            assert before.mode == ACT
            others = [n for n in range(3) if n != b]
            assert np.array_equal(before.weights[others], state.weights[others])
            target = 1.0 if state.reward == 1 else 0.0
            was, now = (output(s.weights[b], state.features) for s in (before, state))
            assert abs(target - now) < abs(target - was)
            trained += 1
        before = state
    assert trained == state.acts > 20
    assert state.trainings == trained


def output(weights, features):
    """A 2-2-1 network with biases, in NumPy."""
    hidden = 1 / (1 + np.exp(-(weights[[0, 3]] + weights[[[1, 2], [4, 5]]] @ features)))
    return 1 / (1 + np.exp(-(weights[6] + weights[7:9] @ hidden)))


def test_training_follows_the_drive_not_the_success(affording):
    """An absolute error rises when an act serves a variable past its set point."""
    change = {"start": 0.9, "rate": 1e-7}
    quiet = {"stamina": {"start": 0.2, "rate": 1e-9}, "restlessness": {"start": 0.1, "rate": 1e-9}}
    mind = Mind(agent="LEARNING", error="absolute", variables={"nutrition": change, **quiet})
    life = live(mind, affording(1.0), steps=4_000, record="all")
    assert life.state.successes > 0
    assert life.state.trainings > 0
    eat = life.networks.likelihoods({"shape": 0.0, "size": 0.0})["eat"]
    assert eat < 0.5


# --- birth ------------------------------------------------------------------------------------


def test_no_life_starts_upon_an_object_however_small(crowded):
    """A small object fits between the points of the collision ring: 23 mm lie between them."""
    lives = np.arange(20_000, dtype=np.uint64)
    states, _ = bring_together(Mind(), crowded, Khepera()).begin(7, lives)
    objects = shapely.union_all([shapely.Polygon(corners) for corners in crowded.polygons()])
    gap = shapely.distance(shapely.points(states["x"], states["y"]), objects)
    assert gap.min() > 30.0 - 2.0  # mm; a cell is 2 mm wide
    assert (states["mode"] == WANDER).all()
