import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import SettingsError
from animat.mind.affordance import feed_forward, weight_count
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.names import malformed

EAT_AND_REST = ("eat", "rest")


def networks(seed=0, behaviours=EAT_AND_REST, features=("shape", "size"), hidden=3):
    shape = (len(behaviours), weight_count(len(features), hidden))
    return Networks(behaviours, features, hidden, np.random.default_rng(seed).normal(size=shape))


@given(st.integers(0, 2**32), st.integers(1, 4), st.integers(1, 4), st.integers(1, 5))
def test_likelihoods_go_by_the_names_of_features_and_behaviours(seed, b, f, hidden):
    behaviours = tuple(f"act{n}" for n in range(b))
    features = tuple(f"feature{n}" for n in range(f))
    known = networks(seed, behaviours, features, hidden)
    inputs = np.random.default_rng(seed).random(f)
    shuffled = dict(reversed(list(zip(features, inputs.tolist(), strict=True))))
    assert known.likelihoods(shuffled) == {
        name: feed_forward(inputs, known.weights[n], np.zeros(hidden))
        for n, name in enumerate(behaviours)
    }


def test_features_it_does_not_know_and_features_left_out_are_refused():
    with pytest.raises(ValueError, match='"sise" is no feature; did you mean "size"'):
        networks().likelihoods({"shape": 1.0, "sise": 0.0})
    with pytest.raises(ValueError, match="features lack size"):
        networks().likelihoods({"shape": 1.0})


def test_the_weights_are_its_own_and_stay_as_they_are():
    weights = np.zeros((1, 9))
    known = Networks(("eat",), ("shape", "size"), 2, weights)
    weights[:] = 5.0
    assert not known.weights.any()
    with pytest.raises(ValueError, match="read-only"):
        known.weights[0, 0] = 1.0


def test_networks_are_equal_if_names_and_weights_are():
    assert networks(1) == networks(1)
    assert hash(networks(1)) == hash(networks(1))
    assert networks(1) != networks(2)
    assert networks(1) != networks(1, behaviours=("eat", "shelter"))
    assert networks(1) != "networks"
    minds = [
        Mind(networks=networks(seed, ("eat", "shelter", "interact"), hidden=2))
        for seed in (1, 1, 2)
    ]
    assert minds[0] == minds[1] != minds[2]


@pytest.mark.parametrize(
    ("hidden", "weights"),
    [
        (3, np.zeros((2, 9))),
        (2, np.zeros((1, 9))),
        (2, np.zeros(18)),
    ],
)
def test_weights_that_do_not_fit_are_refused(hidden, weights):
    with pytest.raises(ValueError, match="do not fit 2 networks of 2 features"):
        Networks(EAT_AND_REST, ("shape", "size"), hidden, weights)


@pytest.mark.parametrize("weight", [np.nan, np.inf])
def test_weights_that_are_no_numbers_are_refused(weight):
    weights = np.zeros((2, 9))
    weights[1, 3] = weight
    with pytest.raises(ValueError, match="finite"):
        Networks(EAT_AND_REST, ("shape", "size"), 2, weights)


doubles = st.floats(allow_nan=False, allow_infinity=False)
names = st.lists(
    st.text(st.characters(codec="utf-8"), max_size=6).filter(lambda name: malformed(name) is None)
    | st.sampled_from(['"', "a\\", "a.b", "[a]", "{a}", "a = 1", "#", "é"]),
    min_size=1, max_size=3, unique=True,
)  # fmt: skip


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("networks") / "learnt.toml"


@given(data=st.data(), behaviours=names, features=names, hidden=st.integers(1, 3))
def test_what_is_saved_is_loaded_to_the_last_bit(file, data, behaviours, features, hidden):
    shape = (len(behaviours), weight_count(len(features), hidden))
    flat = data.draw(st.lists(doubles, min_size=shape[0] * shape[1], max_size=shape[0] * shape[1]))
    known = Networks(tuple(behaviours), tuple(features), hidden, np.array(flat).reshape(shape))
    known.save(file)
    again = Networks.load(str(file))
    assert again == known
    assert again.weights.tobytes() == known.weights.tobytes()


@given(place=st.integers(0, 10_000), byte=st.integers(1, 255))
def test_a_file_that_is_damaged_is_refused_or_says_the_same(file, place, byte):
    networks(4, hidden=2).save(file)
    content = bytearray(file.read_bytes())
    content[place % len(content)] ^= byte
    file.write_bytes(content)
    lines: tuple[str, ...] = ()
    try:
        assert Networks.load(file) == networks(4, hidden=2)
    except SettingsError as error:
        lines = error.problems
    assert all(line.startswith(f"{file}: ") for line in lines)


GOOD = """
format = 1
features = ["shape", "size"]
hidden = 2
[weights]
eat = [[0.0, 1, 2.5], [3.0, 4.0, 5.0], [6.0, 7.0, 8.0]]
"""

BAD = [
    ("format = 1", "format = 2", "format = 2: this animat reads format 1"),
    ("format = 1", "", "key format: missing key"),
    ("hidden = 2", "hidden = 3", "weights.eat has 3 rows; hidden = 3 makes 4"),
    ("hidden = 2", "hidden = 0", "key hidden = 0: must be greater than or equal to 1"),
    ("hidden = 2", "hiden = 2", 'unknown key; did you mean "hidden"'),
    ("4.0, 5.0", "4.0", "weights.eat[1] has 2 numbers; a hidden unit has 3"),
    ("7.0, 8.0", "7.0", "weights.eat[2] has 2 numbers; the output has 3"),
    ("2.5", "nan", "key weights.eat[0][2] = nan: must be a finite number"),
    ("2.5", '"2.5"', "must be a number"),
    ('"size"', '"shape"', "features: names one twice"),
    ("[weights]", 'sha256 = "0"\n[weights]', "sha256 is not that of the file"),
    ("[weights]", "[weights", "is not TOML"),
]


def test_a_file_may_be_written_by_hand(file):
    file.write_text(GOOD)
    assert Networks.load(file).weights.tolist() == [[0.0, 1.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]]


@pytest.mark.parametrize(("old", "new", "told"), BAD)
def test_a_bad_file_is_refused_with_what_and_where(file, old, new, told):
    file.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(SettingsError) as caught:
        Networks.load(file)
    assert told in str(caught.value)
    assert str(caught.value).startswith(f"{file}: ")


def test_what_two_features_make_likely_is_drawn_as_a_surface():
    known = networks(hidden=2)
    fig = known.figure({"TS": {"shape": 0.0, "size": 1.0}})
    assert [ax.get_title() for ax in fig.axes[:2]] == ["eat", "rest"]
    said = fig.axes[1].images[0].get_array()
    corner = known.likelihoods({"shape": 0.0, "size": 1.0})["rest"]
    assert said[-1, 0] == corner  # pyright: ignore[reportOptionalSubscript]


def test_what_other_features_make_likely_is_drawn_as_bars():
    known = networks(features=("a", "b", "c"))
    kinds = {"stone": {"a": 0.0, "b": 1.0, "c": 0.5}, "leaf": {"a": 1.0, "b": 1.0, "c": 0.0}}
    heights = [bar.get_height() for bar in known.figure(kinds).axes[0].patches]  # pyright: ignore
    assert heights == [known.likelihoods(each)["eat"] for each in kinds.values()]
    assert known.figure().axes


def test_networks_of_a_custom_estimator_do_not_say_what_another_would():
    known = Networks(("eat",), ("shape", "size"), 2, np.zeros((1, 9)), custom=True)
    for ask in (known.figure, lambda: known.likelihoods({"shape": 1.0, "size": 0.0})):
        with pytest.raises(SettingsError, match="custom estimator"):
            ask()
