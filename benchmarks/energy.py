"""Energy of the processor packages by RAPL, where Linux tells it (Documentation/power/powercap)."""

from pathlib import Path

PACKAGES = Path("/sys/class/powercap")


def counters(root: Path = PACKAGES) -> dict[Path, int]:
    """Microjoules of each package so far; none where the machine tells nothing, or not to this user."""
    found = {}
    for package in sorted(root.glob("intel-rapl:[0-9]*")):
        if package.name.count(":") == 1:  # cores and memory below a package are part of it
            try:
                found[package] = int((package / "energy_uj").read_text())
            except OSError:
                return {}
    return found


def joules(before: dict[Path, int], after: dict[Path, int]) -> float:
    """Energy between two readings; NaN where nothing is told. A counter that went round once is right."""
    if not before or before.keys() != after.keys():
        return float("nan")
    total = 0
    for package, start in before.items():
        used = after[package] - start
        total += used if used >= 0 else used + int((package / "max_energy_range_uj").read_text())
    return total / 1e6
