"""Convolution quadrature by Radau IIA of three stages (Lubich & Ostermann, Math. Comp. 60, 105, 1993).

What a response K makes of f over time is, at the stages of step n, Σ_m W_{n-m} f_m, where the weights are
those of Σ_k W_k ζ^k = K(Δ(ζ)/h) and Δ(ζ) = (A + ζ/(1 - ζ) 1 bᵀ)⁻¹ is the scheme's. It is of order five.
"""

from collections.abc import Callable
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

#: Rounding of Laplace's transform, enlarged where steps are scaled back in time.
_ROUNDING = 1e-16
#: Length of the transform over what is told of it: the longer, the less comes round.
_LONGER = 1.75
#: Stages.
STAGES = 3


class Radau:
    """For a number of steps.

    Args:
        end: last time.
        steps: of equal length.

    Attributes:
        s: where Laplace's transform of a response is needed, (values,).
        times: of all stages, (steps, stages); the last is the end of the step.
    """

    def __init__(self, end: float, steps: int) -> None:
        root = np.sqrt(6.0)
        A = np.array([
            [(88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0, (-2.0 + 3.0 * root) / 225.0],
            [(296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0, (-2.0 - 3.0 * root) / 225.0],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ])  # fmt: skip
        self._steps, h = steps, end / steps
        self._length = ceil(_LONGER * steps)
        self._h, self._nodes = h, A.sum(axis=1)
        self.times = self._stages(steps)
        # What comes round and the enlarged rounding are alike small.
        self._radius = _ROUNDING ** (1.0 / (steps + self._length))
        half = self._length // 2 + 1
        ζ = self._radius * np.exp(-2j * pi * np.arange(half) / self._length)
        Δ = np.linalg.inv(A + (ζ / (1.0 - ζ))[:, None, None] * np.outer(np.ones(STAGES), A[-1]))
        values, self._vectors = np.linalg.eig(Δ)
        self._inverse = np.linalg.inv(self._vectors)
        self.s = (values / h).ravel()

    def _stages(self, steps: int) -> NDArray[np.float64]:
        return np.asarray(self._h * (np.arange(steps)[:, None] + self._nodes))

    def convolved(self, response: NDArray, given: Callable[[NDArray], NDArray]) -> NDArray[np.float64]:
        """What a response makes of what is given over time, after each step, (steps, n).

        Args:
            response: its transform at ``s``, (values, n).
            given: function of time.
        """
        return self.answered(response[..., None], given(self.times)[..., None])

    def answered(self, response: NDArray, given: NDArray) -> NDArray[np.float64]:
        """What a response makes of many functions of time, after each step, (steps, n).

        Args:
            response: its transform at ``s``, (values, n, functions).
            given: at all stages, (steps, stages, functions).
        """
        scale = self._radius ** np.arange(self._steps)[:, None, None]
        scaled = np.fft.rfft(given * scale, self._length, axis=0)
        modes = self._inverse @ scaled
        answers = response.reshape(*modes.shape[:2], -1, modes.shape[2]) @ modes[..., None]
        last = np.einsum("fm,fmn->fn", self._vectors[:, -1], answers[..., 0])
        return np.asarray(np.fft.irfft(last, self._length, axis=0)[: self._steps] / scale[..., 0])

    def weights(self, response: NDArray) -> NDArray[np.float64]:
        """W_0, W_1, … of a response, (steps, stages, stages, ...).

        Args:
            response: its transform at ``s``, (values, ...).
        """
        of_mode = response.reshape(-1, STAGES, *response.shape[1:])
        found = np.empty((self._steps, STAGES, STAGES, *response.shape[1:]))
        scale = self._radius ** -np.arange(float(self._steps))
        for i in range(STAGES):
            for j in range(STAGES):
                both = self._vectors[:, i] * self._inverse[:, :, j]
                whole = np.fft.irfft(np.einsum("fm,fm...->f...", both, of_mode), self._length, axis=0)
                found[:, i, j] = (whole[: self._steps].T * scale).T
        return found
