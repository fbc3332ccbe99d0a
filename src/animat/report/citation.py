"""How to cite animat and the paper it rebuilds, for BibTeX; CITATION.cff says the same."""

PAPER = """\
@misc{cosaguilera2003motivation,
  author = {Cos-Aguilera, I. and Ca{\\~n}amero, Lola and Hayes, G. M.},
  title  = {Motivation-Driven Learning of Object Affordances: First Experiments Using a
            Simulated {Khepera} Robot},
  year   = {2003}
}
"""

ANIMAT = """\
@software{{animat,
  author  = {{{{animat contributors}}}},
  title   = {{animat: a laboratory for motivated robots}},
  version = {{{version}}},
  license = {{MIT}}
}}
"""


def bibtex(version: str) -> str:
    """The paper, and animat of a version."""
    return PAPER + "\n" + ANIMAT.format(version=version)
