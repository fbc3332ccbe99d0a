import math

import numpy as np
import pytest
import shapely
from scipy import stats

from animat.numerics.compiled import compiled
from animat.robot.infrared import linear, michel1996, read_infrared, sensor_noise, unlit
from animat.robot.khepera import Khepera

MICHEL = Khepera(infrared_noise=False)
LINEAR = Khepera(infrared="linear", infrared_noise=False)
ALL = np.ones(8, dtype=np.uint8)
SILENT = (0, 0, 0, 0)
SIDE = [(4, 4, 1023), (8, 8, 800), (16, 10, 600), (26, 14, 400), (40, 18, 60)]
COLUMNS = [
    [(12, 0, 900), (20, 0, 750), (32, 0, 650), (44, 0, 160), (58, 0, 40)],
    SIDE,
    [(forward, -sideways, value) for forward, sideways, value in SIDE],
]


def read(pose, raster, settings=MICHEL, present=ALL, words=SILENT):
    readings = np.full(8, -1, dtype=np.int64)
    read_infrared(*pose, settings.parameters(), raster, present, words, readings, 0)
    return readings.tolist()


def unculled(raster):
    """The same world with no room known of: nothing is skipped."""
    return raster._replace(room=np.zeros_like(raster.room))


def covered(x, y, raster, present):
    column, row = ((np.array([x, y]) / raster.resolution) + raster.border).astype(int)
    code = raster.solid[row, column]
    return (code == 1) | ((code > 1) & (present[np.maximum(code - 2, 0)] > 0))


def sensor_places(pose, settings):
    """The sensors' places as complex numbers, and the units of their directions."""
    x, y, heading = pose
    turn = np.exp(1j * heading)
    places = [complex(sensor.x, sensor.y) * turn + complex(x, y) for sensor in settings.sensors]
    ahead = [np.exp(1j * math.radians(sensor.direction)) * turn for sensor in settings.sensors]
    return list(zip(places, ahead, strict=True))


def michel_oracle(pose, raster, present, settings=MICHEL):
    readings = []
    for place, ahead in sensor_places(pose, settings):
        light = 0
        for column in COLUMNS:
            forward, sideways, value = np.array(column).T
            probes = place + (forward + 1j * sideways) * ahead
            hits = covered(probes.real, probes.imag, raster, present)
            light += value[hits.argmax()] if hits.any() else 0
        readings.append(min(light, 1023))
    return readings


def ray_oracle(pose, raster, present):
    """How far each ray gets, by looking every 0.005 mm."""
    ways = np.arange(0, 50, 0.005)
    distances = []
    for place, ahead in sensor_places(pose, LINEAR):
        ray = place + ways * ahead
        hits = covered(ray.real, ray.imag, raster, present)
        distances.append(ways[hits.argmax()] if hits.any() else 50.0)
    return np.array(distances)


def poses(count, seed):
    rng = np.random.default_rng(seed)
    return zip(
        rng.uniform(45, 255, count).tolist(),
        rng.uniform(45, 255, count).tolist(),
        rng.uniform(-math.pi, math.pi, count).tolist(),
        strict=True,
    )


def facing_a_wall(sensor, side, distance):
    """The pose in which a sensor looks squarely at a wall (0 right, 1 top, ...) so far away."""
    setting = MICHEL.sensors[sensor]
    heading = math.remainder(math.radians(90 * side - setting.direction), math.tau)
    offset = complex(setting.x, setting.y) * np.exp(1j * heading)
    wall = np.exp(1j * math.radians(90 * side))
    outward = 130 - distance - (offset * wall.conjugate()).real
    centre = 150 + 150j + outward * wall
    return centre.real, centre.imag, heading


@pytest.mark.parametrize("sensor", range(8))
@pytest.mark.parametrize("side", range(4))
def test_flat_wall_table(sensor, side, drawn):
    raster = drawn()
    for distance in np.arange(0.25, 62, 0.5):
        bounds = [26, 32, 40, 44, 58, math.inf]
        value = [1023, 770, 280, 160, 40, 0][np.searchsorted(bounds, distance)]
        assert read(facing_a_wall(sensor, side, distance), raster)[sensor] == value, distance


@pytest.mark.parametrize("distance", [26.0, 32.0, 40.0, 44.0, 58.0])
def test_flat_wall_at_the_very_distance_counts(distance, drawn):
    readings = read((280 - 24.5 - distance, 150.0, 0.0), drawn())
    expected = {26.0: 1023, 32.0: 770, 40.0: 280, 44.0: 160, 58.0: 40}[distance]
    assert readings[2] == readings[3] == expected


@pytest.mark.parametrize("resolution", [1.5, 2.0, 5.0])
def test_michel1996_follows_its_probes_in_random_worlds(resolution, scattered):
    seen = 0
    for seed in range(3):
        raster = scattered(seed, resolution)
        present = np.random.default_rng(seed).integers(0, 2, 5).astype(np.uint8)
        for pose in poses(60, seed):
            expected = michel_oracle(pose, raster, present)
            assert read(pose, raster, present=present) == expected
            seen += np.count_nonzero(expected)
    assert seen > 200


def test_own_sensors_follow_their_own_places(scattered):
    rng = np.random.default_rng(9)
    sensors = [
        {"x": float(x), "y": float(y), "direction": float(a)}
        for x, y, a in zip(*rng.uniform(-20, 20, (2, 8)), rng.uniform(-400, 400, 8), strict=True)
    ]
    settings = Khepera(infrared_noise=False, sensors=sensors)
    raster = scattered(4)
    for pose in poses(100, 9):
        assert read(pose, raster, settings) == michel_oracle(pose, raster, ALL, settings)


@compiled
def read_all(poses, words, robot, raster, present, readings):
    for row in range(poses.shape[0]):
        x, y, heading = poses[row]
        w = words[row]
        read_infrared(
            x, y, heading, robot, raster, present, (w[0], w[1], w[2], w[3]), readings[row], 0
        )


@pytest.mark.parametrize("model", ["michel1996", "linear"])
@pytest.mark.parametrize("noise", [True, False])
@pytest.mark.parametrize("resolution", [2.0, 0.7])
def test_culling_changes_nothing(model, noise, resolution, dust):
    """Among specks of dust the skipping is at its boldest: only a single cell gives them away."""
    count, specks = 60_000, 25
    robot = Khepera(infrared=model, infrared_noise=noise).parameters()
    for seed in range(2):
        rng = np.random.default_rng(seed)
        raster = dust(seed, resolution, specks)
        present = (rng.random(specks) < 0.8).astype(np.uint8)
        some = np.array(list(poses(count, seed)))
        words = rng.integers(0, 2**32, (count, 4), dtype=np.uint64)
        culled, full = np.empty((2, count, 8), dtype=np.int64)
        read_all(some, words, robot, raster, present, culled)
        read_all(some, words, robot, unculled(raster), present, full)
        np.testing.assert_array_equal(culled, full)
        assert (full > 6).mean() > 0.1


def test_linear_follows_its_ray_in_random_worlds(scattered):
    lit = 0
    for seed in range(2):
        raster = scattered(seed)
        present = np.random.default_rng(seed).integers(0, 2, 5).astype(np.uint8)
        for pose in poses(50, seed):
            expected = 1023 * (1 - ray_oracle(pose, raster, present) / 50)
            readings = np.array(read(pose, raster, LINEAR, present))
            assert np.abs(readings - expected).max() < 1.2
            lit += np.count_nonzero(readings)
    assert lit > 100


def test_linear_falls_evenly_to_nothing_at_50_mm(drawn):
    raster = drawn()
    for distance in (0.0, 0.5, 10.0, 25.0, 49.9):
        reading = read((280 - 24.5 - distance, 150.0, 0.0), raster, LINEAR)[2]
        assert reading == pytest.approx(1023 * (1 - distance / 50), abs=1)
    assert read((280 - 24.5 - 50.0, 150.0, 0.0), raster, LINEAR)[2] == 0
    assert read((280 - 24.5 + 3.0, 150.0, 0.0), raster, LINEAR)[2] == 1023


@pytest.mark.parametrize("settings", [MICHEL, LINEAR])
def test_only_present_objects_are_seen(settings, drawn):
    raster = drawn([shapely.box(180, 140, 200, 160)])
    pose = (140.0, 150.0, 0.0)
    assert read(pose, raster, settings, np.ones(1, np.uint8))[2] > 0
    assert read(pose, raster, settings, np.zeros(1, np.uint8)) == [0] * 8


def test_words_give_each_sensor_its_own_half():
    words = (0x2222_1111, 0x4444_3333, 0x6666_5555, 0x8888_7777)
    halves = [sensor_noise(words, sensor) for sensor in range(8)]
    assert halves == [0x1111 * n for n in range(1, 9)]


def test_dark_readings_are_uniform_0_to_6():
    robot = Khepera().parameters()
    counts = np.bincount([unlit(noise, robot) for noise in range(2**16)])
    assert counts.size == 7
    assert np.abs(counts / 2**16 - 1 / 7).max() < 1 / 2**16
    assert unlit(65535, MICHEL.parameters()) == 0


def test_dark_readings_of_eight_sensors_are_apart(drawn):
    rng = np.random.default_rng(3)
    raster = drawn()
    readings = np.array(
        [
            read((150.0, 150.0, 0.0), raster, Khepera(), words=tuple(words))
            for words in rng.integers(0, 2**32, (1500, 4)).tolist()
        ]
    )
    for sensor in range(8):
        assert stats.chisquare(np.bincount(readings[:, sensor], minlength=7)).pvalue > 0.001
    assert np.abs(np.corrcoef(readings.T) - np.eye(8)).max() < 0.12


def test_noise_of_a_lit_sensor_is_ten_per_cent(drawn):
    rng = np.random.default_rng(4)
    raster = drawn()
    pose = facing_a_wall(2, 0, 29.0)
    readings = [
        read(pose, raster, Khepera(), words=tuple(words))[2]
        for words in rng.integers(0, 2**32, (2000, 4)).tolist()
    ]
    # A whole number stands for the interval up to the next.
    spread = (np.array(readings) + rng.random(2000)) / 770
    assert stats.kstest(spread, "uniform", (0.90, 0.20)).pvalue > 0.01
    assert min(readings) >= 693
    assert max(readings) <= 846


@pytest.mark.parametrize(
    ("light", "noise", "reading"),
    [
        (0, 65535, 6),
        (6, 0, 0),
        (7, 32768, 7),
        (40, 0, 36),
        (40, 65535, 43),
        (1000, 65535, 1023),
        (1022, 0, 919),
        (1023, 0, 1023),
        (3000, 0, 1023),
    ],
)
def test_michel1996_reading(light, noise, reading):
    assert michel1996(light, noise, Khepera().parameters()) == reading


def test_noise_of_linear_grows_with_the_distance():
    robot = Khepera(infrared="linear").parameters()
    for distance in (0.0, 20.0, 25.0, 30.0):
        light = 1023 * (1 - distance / 50)
        readings = np.array([linear(distance, noise, robot) for noise in range(0, 2**16, 64)])
        share = 0.01 * distance / 50
        assert readings.min() == int(light * (1 - share))
        assert readings.max() in (int(light * (1 + share)), int(light * (1 + share * 0.998)))
        if share > 0:
            spread = (readings + np.random.default_rng(1).random(readings.size)) / light
            assert stats.kstest(spread, "uniform", (1 - share, 2 * share)).pvalue > 0.01
    assert linear(50.0, 65535, robot) == 0
