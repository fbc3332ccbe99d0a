"""The Khepera as settings, and the record of numbers that a step reads.

Lengths are in mm, x points forward and y to the left of the robot; settings give directions in
degrees, counter-clockwise from its front. The figures are those of the Khepera Simulator 2.0
(Michel 1996).
"""

from __future__ import annotations

import math
from typing import Literal, Self, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from animat.files.settings import Settings
from animat.numerics.compiled import kernel
from animat.numerics.elementary import sine_cosine
from animat.robot.parameters import MODELS, MOST_SENSORS, REACH, RING_POINTS, ROBOT


class Sensor(Settings):
    """Where an infrared sensor sits and where it looks."""

    x: float = Field(description="mm before the robot's centre")
    y: float = Field(description="mm to the left of the robot's centre")
    direction: float = Field(description="degrees, counter-clockwise from the front")


class Khepera(Settings):
    """The settings of the robot; the defaults are those of Michel's simulator.

    Raises SettingsError for unknown names, wrong types and impossible values.
    """

    radius: float = Field(default=27.5, gt=0, description="of the body, mm")
    wheel_base: float = Field(default=50.0, gt=0, description="distance between the wheels, mm")
    step_mm: float = Field(
        default=0.5, gt=0, description="mm a wheel moves per step and motor unit"
    )
    max_motor: int = Field(
        default=10, ge=1, le=1_000_000, description="largest motor command, either way"
    )
    motor_noise: bool = Field(default=True, description="whether motion is noisy")
    position_noise: float = Field(
        default=0.10,
        ge=0,
        lt=1,
        description="spread of the x and y displacements, as a share of them",
    )
    turn_noise: float = Field(
        default=0.05, ge=0, lt=1, description="spread of the turn, as a share of it"
    )
    ring_radius: float = Field(
        default=30.0, gt=0, le=40, description="of the eight collision points round the centre, mm"
    )
    infrared: Literal["michel1996", "linear"] = Field(
        default="michel1996", description="how the sensors answer to what is before them"
    )
    infrared_noise: bool = Field(default=True, description="whether infrared readings are noisy")
    sensors: tuple[Sensor, ...] = Field(
        default=(
            Sensor(x=9.5, y=23.0, direction=90.0),
            Sensor(x=18.0, y=17.5, direction=45.0),
            Sensor(x=24.5, y=5.5, direction=0.0),
            Sensor(x=24.5, y=-5.5, direction=0.0),
            Sensor(x=18.0, y=-17.5, direction=-45.0),
            Sensor(x=9.5, y=-23.0, direction=-90.0),
            Sensor(x=-23.0, y=-9.5, direction=180.0),
            Sensor(x=-23.0, y=9.5, direction=180.0),
        ),
        strict=False,
        min_length=1,
        max_length=MOST_SENSORS,
        description="the infrared sensors, those of the Khepera from the left side round the front",
    )

    @model_validator(mode="after")
    def _possible(self) -> Self:
        problems = []
        if self.ring_radius < self.radius:
            problems.append(
                f"ring_radius {self.ring_radius:g} mm lies inside the body: it must be at least "
                f"the radius, {self.radius:g} mm"
            )
        if self.wheel_base > 2 * self.radius:
            problems.append(
                f"wheel_base {self.wheel_base:g} mm is wider than the body: it must be at most "
                f"twice the radius, {2 * self.radius:g} mm"
            )
        stride = self.step_mm * self.max_motor * (1 + self.position_noise)
        if stride > self.ring_radius / 2:
            problems.append(
                f"step_mm x max_motor moves the robot up to {stride:g} mm in one step, so far "
                f"that it could pass through an object: it must be at most half the ring_radius, "
                f"{self.ring_radius / 2:g} mm, noise included"
            )
        for number, sensor in enumerate(self.sensors):
            if math.sqrt(sensor.x * sensor.x + sensor.y * sensor.y) > self.ring_radius:
                problems.append(
                    f"sensor {number} at ({sensor.x:g}, {sensor.y:g}) mm lies outside the "
                    f"collision ring: it must be at most {self.ring_radius:g} mm from the centre"
                )
        if problems:
            raise ValueError("\n".join(problems))
        return self

    def parameters(self) -> np.record:
        """Return the record of ROBOT that compiled functions read."""
        robot = np.zeros((), ROBOT.dtype({"N": len(self.sensors)}))
        for name in (
            "radius",
            "wheel_base",
            "step_mm",
            "max_motor",
            "motor_noise",
            "position_noise",
            "turn_noise",
            "ring_radius",
            "infrared_noise",
        ):
            robot[name] = getattr(self, name)
        robot["infrared"] = MODELS[self.infrared]
        robot["reach"] = REACH[self.infrared]
        robot["sensor_radius"] = max(math.sqrt(s.x * s.x + s.y * s.y) for s in self.sensors)
        robot["sensor_x"] = [sensor.x for sensor in self.sensors]
        robot["sensor_y"] = [sensor.y for sensor in self.sensors]
        looking = np.array([sensor.direction for sensor in self.sensors])
        turn_to(looking, robot["sensor_sine"], robot["sensor_cosine"])
        around = np.array([45.0 * point for point in range(RING_POINTS)])
        turn_to(around, robot["ring_y"], robot["ring_x"])
        robot["ring_x"] *= self.ring_radius
        robot["ring_y"] *= self.ring_radius
        return cast(np.record, robot[()])


@kernel
def turn_to(
    degrees: NDArray[np.float64], sines: NDArray[np.float64], cosines: NDArray[np.float64]
) -> None:
    """Fill in sines and cosines [N] of angles [N] in degrees, exact for multiples of 90."""
    for n in range(len(degrees)):
        quarters = round(degrees[n] / 90.0)
        sine, cosine = sine_cosine((degrees[n] - 90.0 * quarters) * (math.pi / 180.0))
        for _ in range(quarters % 4):
            sine, cosine = cosine, -sine
        sines[n] = sine
        cosines[n] = cosine
