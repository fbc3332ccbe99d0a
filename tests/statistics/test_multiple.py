import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from animat.statistics.multiple import holm

ps = st.lists(st.floats(0.0, 1.0), min_size=1, max_size=12)


@given(ps, st.floats(0.001, 0.999))
def test_it_rejects_what_holms_procedure_rejects(p, level):
    """The procedure itself: go up from the smallest p, stop at the first above level / left."""
    order = sorted(range(len(p)), key=lambda k: p[k])
    rejected = set()
    for done, k in enumerate(order):
        if p[k] * (len(p) - done) > level:
            break
        rejected.add(k)
    assert set(np.flatnonzero(holm(p) <= level)) == rejected


def test_a_test_that_could_not_be_made_does_not_count():
    np.testing.assert_allclose(holm([0.01, np.nan, 0.04]), [0.02, np.nan, 0.04])
    assert np.isnan(holm([np.nan])).all()
    assert holm([]).size == 0
