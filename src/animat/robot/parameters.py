"""What a step reads of a robot: one record of numbers."""

from __future__ import annotations

import numpy as np

from animat.numerics.layout import Field, Layout

RING_POINTS = 8
MOST_SENSORS = 64

MICHEL1996, LINEAR = 0, 1
MODELS = {"michel1996": MICHEL1996, "linear": LINEAR}

LINEAR_REACH = 50.0  # mm
REACH = {"michel1996": 58.0, "linear": LINEAR_REACH}
"""How far before it a sensor of each model sees anything, in mm."""

REAL = np.float64

ROBOT = Layout(
    "robot",
    (
        Field("radius", REAL),
        Field("wheel_base", REAL),
        Field("step_mm", REAL),
        Field("max_motor", np.int64),
        Field("motor_noise", np.bool_),
        Field("position_noise", REAL),
        Field("turn_noise", REAL),
        Field("ring_radius", REAL),
        Field("ring_x", REAL, (RING_POINTS,)),
        Field("ring_y", REAL, (RING_POINTS,)),
        Field("infrared", np.int64),
        Field("infrared_noise", np.bool_),
        Field("reach", REAL),
        Field("sensor_radius", REAL),
        Field("sensor_x", REAL, ("N",)),
        Field("sensor_y", REAL, ("N",)),
        Field("sensor_cosine", REAL, ("N",)),
        Field("sensor_sine", REAL, ("N",)),
    ),
)
"""What a step knows of its robot with N sensors; `Khepera.parameters` fills it.

`ring_x`, `ring_y` are the collision points in the robot's frame, from the front
counter-clockwise; `infrared` is MICHEL1996 or LINEAR; `sensor_radius` is how far (mm) the farthest
sensor is from the centre; the rest are the settings of the same names.
"""

robot_at = ROBOT.at
