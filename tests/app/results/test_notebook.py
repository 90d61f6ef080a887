"""How results look in a notebook."""

from html.parser import HTMLParser

import pytest

from galinx.app.errors import BadInput


class Cells(HTMLParser):
    """Text of table cells, and whether every element is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.cells = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag != "br":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1] in ("td", "th"):
            self.cells.append(data)


def test_a_result_shows_its_states_and_verdict(tables_run):
    assert repr(tables_run) == "<galinx result 'Tables 4 and 5': 12 states, PASS>"
    text = tables_run._repr_html_()
    found = Cells(text)
    assert not found.open and ">PASS</b>" in text and "two methods agree to" in text
    assert (
        sum("FM1" in cell for cell in found.cells) == 4
        and "peak pressure" not in text
        and "0.8305" in found.cells
    )


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
