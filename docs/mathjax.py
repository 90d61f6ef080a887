"""Formulas of the site, typeset by the distribution's MathJax, of which the site gets a copy: no network.

A formula is a block ```` ```math ```` or, in a line, ``$`…`$``, which code forges typeset, too. mkdocs
loads this file as a hook.
"""

import re
import shutil
from html import unescape
from pathlib import Path
from typing import Any

#: Debian's package libjs-mathjax, of version 2.
_INSTALLED = Path("/usr/share/javascript/mathjax")
#: What of it typesets TeX as SVG.
_NEEDED = (
    "MathJax.js", "config/TeX-AMS_SVG.js", "extensions", "jax/element", "jax/input/TeX",
    "jax/output/SVG/autoload", "jax/output/SVG/config.js", "jax/output/SVG/jax.js",
    "jax/output/SVG/fonts/TeX",
)  # fmt: skip
_FOLDER = "mathjax"

_DISPLAYED = re.compile(r'<pre><code class="language-math">(.*?)</code></pre>', re.DOTALL)
_IN_LINE = re.compile(r"\$<code>(.*?)</code>\$", re.DOTALL)
_LOADED = """
<script type="text/x-mathjax-config">
MathJax.Hub.Config({showMathMenu: false, messageStyle: "none", SVG: {linebreaks: {automatic: true}}});
</script>
<script src="BASE/MathJax.js?config=TeX-AMS_SVG"></script>
"""


def on_page_content(html: str, page: Any, **_: Any) -> str:
    """Formulas as MathJax finds them; it is loaded where there are any, and where it is installed."""
    if not _INSTALLED.is_dir():
        return html
    typeset = _DISPLAYED.sub(lambda found: _script(found[1], "; mode=display"), html)
    typeset = _IN_LINE.sub(lambda found: _script(found[1], ""), typeset)
    if typeset == html:
        return html
    up = "../" * page.url.count("/")
    return typeset + _LOADED.replace("BASE", f"{up}{_FOLDER}")


def on_post_build(config: Any, **_: Any) -> None:
    """Copy MathJax into the site."""
    if not _INSTALLED.is_dir():
        return
    for name in _NEEDED:
        source, target = _INSTALLED / name, Path(config["site_dir"]) / _FOLDER / name
        if source.is_dir():
            shutil.copytree(source, target, dirs_exist_ok=True)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)


def _script(formula: str, mode: str) -> str:
    return f'<script type="math/tex{mode}">{unescape(formula).strip()}</script>'
