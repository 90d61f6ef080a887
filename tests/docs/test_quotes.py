"""A page that quotes a wrong number is found out; one that another machine would print passes."""

import pytest
from quotes import fault

PRINTED = """\
do    closed form: 12 states
[0.3172359  0.31413337 0.30964218]
 FM1  0.8  0.3109  0.3109     1.65   1.64    yes
  nodal forces against the load, over N: 3.1e-14, at most 1e-09
  K_I at both ends, relative: 2.0e-08, at most 1e-06
  K_I at both ends, relative: 9.2e-09, at most 1e-06
time: 2 s (assembly 1.2 s, import of dolfinx 0.31 s, back-substitutions 0.28
  s)
archive: 4.786e-07 of 6 states, 0.26 GB
"""


@pytest.mark.parametrize(
    ("quote", "found"),
    [
        ("12 stages", "what is not printed"),
        ("closed form: 13 states", "13 for 12"),
        ("2 states", "2 for 12"),
        ("[0.31732951 0.31413337 0.30964218]", "0.31732951 for 0.3172359"),
        ("[0.3172359  0.31413339 0.30964218]", "0.31413339 for 0.31413337"),
        ("FM1  0.8  0.3109  0.3109     1.65   1.65    yes", "1.65 for 1.64"),
        ("FM1  0.2  0.3109  0.3109     1.65   1.64    yes", "0.2 for 0.8"),
        ("nodal forces against the load, over N: 3.1e-10", "3.1e-10 for 3.1e-14"),
        ("K_I at both ends, relative: 8.0e-08, at most 1e-06", "8.0e-08 for 2.0e-08"),
        ("K_I at both ends, relative: 2.0e-08, at most 2e-06", "2e-06 for 1e-06"),
        ("archive: 4.787e-07 of 6 states", "4.787e-07 for 4.786e-07"),
        ("archive: 4.786e-07 of 7 states", "7 for 6"),
    ],
)
def test_a_wrong_number_is_found(quote, found):
    assert fault(quote, PRINTED) == found
