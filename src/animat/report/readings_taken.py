"""The readings taken: what the paper leaves open, and how each point is settled here."""

from __future__ import annotations

from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.statistics.numerals import numeral

CALIBRATED = (
    "The number and the places of the objects of Worlds 1 and 2, because Figure 2 is lost. They"
    " are fixed layouts in data files, chosen among random ones by tools/calibrate.py."
    " Nothing else was fitted."
)

ERRATA = (
    'Table 2 calls 1e-4 and 1e-3 time constants "tau"; they are rates per step. A time constant'
    " of 1e-4 steps would empty every variable at once.",
    "Equation 1 is printed as growth, dV/dt = +V/tau, and equation 2 as its decay. Both are laws"
    " here; a physiology says which variable follows which.",
    "Equation 4 has a sign and a factor wrong. Equation 2 put into equation 3 gives M = a (V_op -"
    " V_m) - (V_M - V_m)(a + b/tau) exp(-t/tau).",
    'The sentence "nutrition to hunger, fatigue to restlessness and curiosity to interaction" is a'
    " slip: nutrition is watched by hunger, stamina by fatigue, restlessness by curiosity.",
    "The law of growth stands still at V_m. An act that would carry a growing variable past V_m"
    " leaves it there, and it never rises again: such a robot can hardly die. A few of these lives"
    " can make most of a mean; compare the medians. docs/reproduction.md says more.",
)


def readings(mind: Mind, robot: Khepera) -> list[tuple[str, str, str]]:
    """Return (what is open, the setting, the reading taken) for every point that matters."""
    laws = ", ".join(
        f"{name} {variable.law}" for name, variable in mind.resolved_variables().items()
    )
    margins = ", ".join(
        f"{name} {numeral(variable.lethal_margin)}"
        for name, variable in mind.resolved_variables().items()
        if variable.lethal_margin
    )
    learning = mind.learning
    return [
        ("How each variable drifts", f'physiology = "{mind.physiology}"', laws),
        ("How near its bound a variable kills", "lethal_margin", margins or "at the bound itself"),
        ("An act that satisfies past the bound", "overflow", mind.overflow),
        ("A failed act that goes past the bound", "failed_act", mind.failed_act),
        ("How far a success moves a variable", "success_effect", numeral(mind.success_effect)),
        ("How far a failure moves it", "failure_effect", numeral(mind.failure_effect)),
        ("The error a drive is raised by", "error", mind.error),
        ("When no drive is positive", "gate", mind.gate),
        ("What becomes of an object used", "consumed", "re-placed" if mind.consumed else "stays"),
        (
            "When an object is met",
            "encounter_range",
            numeral(mind.encounter_range) + " mm from the rim",
        ),
        ("How long an interaction lasts", "interaction_steps", f"{mind.interaction_steps} steps"),
        (
            "How long an approach may take",
            "approach_steps",
            f"{mind.approach_steps} steps, then left without an outcome",
        ),
        ("Biases of the networks", "learning.biases", "yes" if learning.biases else "no"),
        (
            "Learning rate and cycles",
            "learning",
            f"{numeral(learning.rate)}, {learning.cycles} cycles",
        ),
        ("What counts as a sudden variation", "learning.threshold", numeral(learning.threshold)),
        (
            "When AF acts",
            "likelihood_threshold",
            f"likelihood >= {numeral(mind.likelihood_threshold)}",
        ),
        ("Noise in the features perceived", "feature_noise", numeral(mind.feature_noise)),
        ("The search", "wander", f"{mind.wander}, {mind.cruise_speed} motor units ahead"),
        ("The infrared sensors", "robot.infrared", robot.infrared),
    ]
