"""How results look in a notebook."""

import pytest

from galinx.app.errors import BadInput


def test_plot_gives_a_figure_that_notebooks_show(exact_run, tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    monkeypatch.chdir(tmp_path)
    figure = exact_run.plot()
    assert isinstance(figure, Figure) and not list(tmp_path.iterdir())
    assert figure._repr_png_().startswith(b"\x89PNG")
    friction = exact_run.figure("friction")
    assert len(friction.axes) < len(figure.axes)
    with pytest.raises(BadInput, match=r"figure 'surfcae': .*did you mean surface"):
        exact_run.figure("surfcae")
