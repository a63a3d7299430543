"""Rows of measurements: a Markdown table and a JSON file of the same."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path


@dataclass
class Row:
    """One comparison; `ratio` is how many times better Lesk is, of which `must` and `aim` are the targets."""

    what: str
    lesk: str
    peer: str
    ratio: float | None = None
    must: float | None = None
    aim: float | None = None
    note: str = ""

    def verdict(self) -> str:
        """Where the ratio lies; empty without a target."""
        if self.ratio is None or self.must is None:
            return ""
        if self.aim is not None and self.ratio >= self.aim:
            return "aim met"
        return "must met" if self.ratio >= self.must else "BELOW"


@dataclass
class Table:
    """A section of the report."""

    title: str
    peer: str
    rows: list[Row] = field(default_factory=list)

    def add(self, row: Row) -> None:
        """Append a row."""
        self.rows.append(row)

    def markdown(self) -> str:
        """The section as a Markdown table."""
        lines = [
            f"### {self.title}",
            "",
            f"| what | Lesk | {self.peer} | ratio | must | aim | |",
            "|---|--:|--:|--:|--:|--:|---|",
        ]
        for row in self.rows:
            ratio, must, aim = ("" if v is None else f"{v:.3g}" for v in (row.ratio, row.must, row.aim))
            ratio = f"**{ratio}**" if ratio else ""
            remark = "; ".join(filter(None, (row.verdict(), row.note)))
            lines.append(f"| {row.what} | {row.lesk} | {row.peer} | {ratio} | {must} | {aim} | {remark} |")
        return "\n".join([*lines, ""])


def save(path: Path, about: dict, tables: list[Table]) -> None:
    """Writes everything that was measured."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        json.dumps({"version": 1, "about": about, "sections": [asdict(t) for t in tables]}, indent=1) + "\n"
    )
