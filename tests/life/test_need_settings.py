"""Every setting of a variable, a drive and a behaviour does what it says."""

import numpy as np

DRIVES = {
    "hunger": {"a": {"nutrition": 1.0}},
    "fatigue": {"a": {"stamina": 1.0}},
    "curiosity": {"a": {"restlessness": 1.0}},
}

BEHAVIOURS = {
    "eat": {"serves": "hunger", "needs": "grasp"},
    "shelter": {"serves": "fatigue", "needs": "shelter"},
    "interact": {"serves": "curiosity", "needs": "interact"},
}

SLOW = {
    name: {"rate": 1e-9, "start": start}
    for name, start in (("nutrition", 0.5), ("stamina", 0.5), ("restlessness", 0.9))
}


def test_variablechange_law(lived):
    c = lived(variables={"nutrition": {"law": "linear", "kind": "deficit"}})
    c.drifted("nutrition", lambda n: 0.5 - 1e-4 * n)
    lived().drifted("nutrition", lambda n: 0.5 * np.exp(-1e-4 * n))


def test_variablechange_rate(lived):
    c = lived(variables={"nutrition": {"rate": 3e-4}})
    c.drifted("nutrition", lambda n: 0.5 * np.exp(-3e-4 * n))


def test_variablechange_set_point(lived):
    c = lived(variables={"nutrition": {"set_point": 0.7}})
    assert np.allclose(c["hunger"], 0.7 - c["nutrition"], atol=1e-15)


def test_variablechange_start(lived):
    c = lived(variables={"stamina": {"start": 0.3}})
    c.drifted("stamina", lambda n: 0.3 * np.exp(1e-4 * n))


def test_variablechange_low(lived):
    c = lived(variables={"nutrition": {"low": -1.0}})
    c.drifted("nutrition", lambda n: -1.0 + 1.5 * np.exp(-1e-4 * n))


def test_variablechange_high(lived):
    c = lived(variables={"stamina": {"law": "relax", "high": 2.0}})
    c.drifted("stamina", lambda n: 2.0 - 1.5 * np.exp(-1e-4 * n))


def test_variablechange_kind(lived):
    falling, rising = (
        lived(variables={"stamina": {"law": "linear", "kind": kind, "rate": 1e-4}})
        for kind in ("deficit", "excess")
    )
    falling.drifted("stamina", lambda n: 0.5 - 1e-4 * n)
    rising.drifted("stamina", lambda n: 0.5 + 1e-4 * n)
    assert np.allclose(falling["fatigue"], 0.2 - falling["stamina"])
    assert np.allclose(rising["fatigue"], rising["stamina"] - 0.2)


def test_variablechange_lethal(lived, caring_for):
    change = {"law": "linear", "kind": "excess", "rate": 0.01}
    settings = {"death": True, "success_effect": 0.0, "failure_effect": 0.0}
    mortal = lived(**settings, variables=caring_for("restlessness", **change))
    immortal = lived(**settings, variables=caring_for("restlessness", **change, lethal=False))
    assert mortal.life.death == "restlessness high, metabolism"
    assert not immortal.life.dead


def test_variablechange_lethal_margin(lived, caring_for):
    for margin, steps in ((0.1, 40), (0.2, 30)):
        change = {"law": "linear", "kind": "excess", "rate": 0.01, "lethal_margin": margin}
        variables = caring_for("restlessness", **change)
        c = lived(death=True, variables=variables, success_effect=0.0, failure_effect=0.0)
        assert len(c["step"]) in (steps, steps + 1)  # 0.5 + 0.01 n is rounded
        assert c["restlessness"][-1] >= 1.0 - margin > c["restlessness"][-2]


def test_drive_a(lived):
    drives = DRIVES | {"hunger": {"a": {"nutrition": 2.0, "stamina": 0.5}}}
    c = lived(drives=drives)
    wanted = 2.0 * (0.9 - c["nutrition"]) + 0.5 * (c["stamina"] - 0.2)
    assert np.allclose(c["hunger"], wanted, atol=1e-14)


def test_drive_b(lived):
    drives = DRIVES | {"hunger": {"a": {"nutrition": 1.0}, "b": {"nutrition": 500.0}}}
    c = lived(drives=drives)
    rate = np.diff(c["nutrition"], prepend=0.5)
    assert np.allclose(c["hunger"], 0.9 - c["nutrition"] + 500.0 * rate, atol=1e-12)
    eaten = np.flatnonzero((c["behaviour"] == "eat") & (c["reward"] == 1))
    assert len(eaten) == 0 or (c["hunger"][eaten + 1] > 50).all()  # a meal is a rate too


def test_behaviour_serves(lived, usual):
    crossed = BEHAVIOURS | {
        "eat": {"serves": "curiosity", "needs": "grasp"},
        "interact": {"serves": "hunger", "needs": "interact"},
    }
    by_drive = {"hunger": "interact", "curiosity": "eat", "fatigue": "shelter"}
    told = list(lived(behaviours=crossed).acts())
    assert told
    assert all(behaviour == by_drive[drive] for behaviour, _, _, drive in told)
    assert any(behaviour == "interact" for behaviour, *_ in usual.acts())


def test_behaviour_needs(lived):
    needs = BEHAVIOURS | {"interact": {"serves": "curiosity", "needs": "grasp"}}
    told = [one for one in lived(behaviours=needs).acts() if one[0] == "interact"]
    assert {reward for *_, reward, _ in told} == {1, -1}
    assert all((reward == 1) == (kind in ("TS", "CS")) for _, kind, reward, _ in told)


def test_behaviour_success(lived):
    effects = {"nutrition": 0.05, "stamina": -0.03, "restlessness": 0.01}
    behaviours = BEHAVIOURS | {"interact": BEHAVIOURS["interact"] | {"success": effects}}
    c = lived(behaviours=behaviours, variables=SLOW, steps=1_000)
    assert np.allclose(c.jumps("nutrition", "interact", 1), 0.05, atol=1e-6)
    assert np.allclose(c.jumps("stamina", "interact", 1), 0.03, atol=1e-6)  # away from satisfaction
    assert np.allclose(c.jumps("restlessness", "interact", 1), -0.01, atol=1e-6)


def test_behaviour_failure(lived, affording):
    effects = {"nutrition": -0.05, "stamina": 0.03, "restlessness": -0.01}
    behaviours = BEHAVIOURS | {"interact": BEHAVIOURS["interact"] | {"failure": effects}}
    c = lived(world=affording(0.0), behaviours=behaviours, variables=SLOW, steps=1_000)
    assert np.allclose(c.jumps("nutrition", "interact", -1), -0.05, atol=1e-6)
    assert np.allclose(c.jumps("stamina", "interact", -1), -0.03, atol=1e-6)
    assert np.allclose(c.jumps("restlessness", "interact", -1), 0.01, atol=1e-6)
