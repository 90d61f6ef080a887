"""An archive that says something else than its numbers is found out."""

import h5py
import numpy as np
import pytest

from galinx.postprocess import check


@pytest.fixture
def whole(inside_run, tmp_path):
    """An archive that may be damaged."""
    path = tmp_path / "whole.h5"
    inside_run.save(path)
    assert check.faults(path) == []
    return path


def change(name, value, at=0):
    def apply(file):
        file[name][at] = value

    return apply


def attribute(name, value):
    def apply(file):
        file.attrs[name] = value

    return apply


def foreign(file):
    file["states/else"] = np.zeros(2)


def unit(file):
    file["states/fem/v0"].attrs["units"] = "inch"


@pytest.mark.parametrize(
    "damage, message",
    [
        (change("states/fem/normal_force", -1.0), "nodal forces against the load"),
        (change("states/fem/K_I_left", 0.1), "its comparisons say"),
        (change("states/fem/v0", np.nan), "states/fem/v0 is not finite"),
        (change("interior/fem/sigma_XX", np.inf), "interior/fem/sigma_XX is not finite"),
        (attribute("complete", False), "does not say that it is complete"),
        (attribute("scene_sha256", "0"), "another hash"),
        (attribute("comparisons", "{}"), "its comparisons say {}"),
        (foreign, "states/else is not in the table"),
        (unit, "has the unit 'inch', expected 'm'"),
    ],
)
def test_what_does_not_fit_is_said(whole, damage, message):
    with h5py.File(whole, "r+") as file:
        damage(file)
    assert any(message in fault for fault in check.faults(whole))
