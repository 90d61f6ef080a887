"""What a page of HTML links to and loads, its anchors and the cells of its tables."""

from html.parser import HTMLParser


class Page(HTMLParser):
    """What is looked at of a page; ``loaded`` are pictures, scripts and styles."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.anchors, self.cells, self._cell = [], [], set(), [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        target = given.get("src") or given.get("href")
        if target:
            (self.links if tag == "a" else self.loaded).append(target)
        self._cell = tag == "td"

    def handle_data(self, text):
        if self._cell:
            self.cells.append(text)
            self._cell = False
