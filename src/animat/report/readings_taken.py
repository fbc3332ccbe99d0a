"""The readings taken: what the paper leaves open, and how each point is settled here."""

from __future__ import annotations

from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.statistics.numerals import numeral


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
