"""Drives with a deadband: near its set point a variable asks for nothing.

animat life --settings docs/examples/deadband.toml
"""

BAND = 0.1
"""How far from its set point a variable may be before it raises a drive."""


def deadband(values, changes, set_points, senses, a, b, out):
    """Fill `out` with equation 3, its errors shrunk by BAND towards zero."""
    for d in range(len(out)):
        drive = 0.0
        for v in range(len(values)):
            error = senses[v] * (set_points[v] - values[v])
            if error > BAND:
                error -= BAND
            elif error < -BAND:
                error += BAND
            else:
                error = 0.0
            drive += a[d, v] * error + b[d, v] * changes[v]
        out[d] = drive
