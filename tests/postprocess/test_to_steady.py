"""When starts are near steady motion, of courses that are known."""

import numpy as np
import pytest

from galinx.postprocess.over_time import from_steady, times_near_steady


def test_times_are_found_between_steps_and_told_like_1_over_t_beyond():
    t = np.linspace(0.1, 40.0, 400)
    load = np.clip(t / 2.0, 0.0, 1.0)  # as if it came on at once at t = 1
    off = np.array([2.0 / np.maximum(t - 1.0, 0.1), 0.05 * np.exp(-t)])
    found = times_near_steady(t, load, off)
    np.testing.assert_allclose(found[0], [21.0, 201.0, 2001.0], rtol=1e-3)
    np.testing.assert_allclose(found[1], [t[0], np.log(5.0), np.log(50.0)], rtol=1e-2)


def test_what_does_not_fall_like_1_over_t_yet_is_not_told():
    """Short of its steady lean, past it, or on the way through it: nothing is known of later times."""
    t = np.linspace(0.1, 8.0, 80)
    load = np.clip(t / 3.0, 0.0, 1.0)
    off = np.array([0.6 - 0.02 * t, 0.3 + 0.0 * t, 0.5 - t / 25.0])
    assert np.isnan(times_near_steady(t, load, off)).all()


def test_the_largest_difference_is_taken():
    data = {
        "time/steady_K_I": np.array([0.3]), "time/steady_centre": np.array([-0.1]),
        "time/sie/K_I_left": np.array([[0.3, 0.33]]), "time/sie/K_I_right": np.array([[0.3, 0.24]]),
        "time/sie/centre_of_pressure": np.array([[0.05, -0.1]]), "time/load": np.array([0.5, 1.0]),
    }  # fmt: skip
    assert from_steady(data, "sie") == pytest.approx(np.array([[0.15, 0.2]]))


def test_steady_motion_is_that_under_the_last_load():
    """Half of N is left: with half of K_I motion is steady, and times are from when it had come on."""
    data = {
        "time/steady_K_I": np.array([0.3]), "time/steady_centre": np.array([-0.1]),
        "time/sie/K_I_left": np.array([[0.3, 0.15]]), "time/sie/K_I_right": np.array([[0.33, 0.165]]),
        "time/sie/centre_of_pressure": np.array([[-0.1, -0.1]]), "time/load": np.array([1.0, 0.5]),
    }  # fmt: skip
    np.testing.assert_allclose(from_steady(data, "sie"), [[1.2, 0.1]], rtol=1e-12)
    t = np.linspace(0.01, 40.0, 4000)
    load = np.where(t < 2.0, 0.0, np.where(t < 4.0, 1.0, 0.5))
    off = 1.0 / np.maximum(t, 0.1)[None]  # (1 × 2 - 0.5 × 4)/0.5 = 0: as if it came on then
    np.testing.assert_allclose(times_near_steady(t, load, off)[0, 1], 100.0, rtol=2e-3)
