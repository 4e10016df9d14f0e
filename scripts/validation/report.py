"""The report as one HTML file that needs nothing else."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from html import escape
from itertools import groupby
from pathlib import Path

import boucle_core

from .chapters import CHAPTERS
from .drawing import svg
from .row import Result, Tolerance

STYLE = """
:root { color-scheme: light dark; --ink: #222; --soft: #666; --page: #fff; --card: #f6f6f4; --line: #ddd;
  --good: #1a7f37; --bad: #c4261d; --reference: #0072b2; --result: #d55e00; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e6; --soft: #9a9a9a; --page: #16181a; --card: #1f2225;
  --line: #35393d; --good: #57c46f; --bad: #ff7468; --reference: #58b3e8; --result: #ff9a52; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem; max-width: 84rem; background: var(--page); color: var(--ink);
  font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .8rem; }
h3 { font-size: .95rem; margin: 0 0 .4rem; }
a { color: inherit; text-decoration-color: var(--line); }
.soft { color: var(--soft); }
.good { color: var(--good); } .bad { color: var(--bad); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .2rem .6rem .2rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; }
tr.failed td { background: color-mix(in srgb, var(--bad) 14%, transparent); }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(19rem, 1fr)); gap: .9rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .8rem; }
.card.failed { border-color: var(--bad); }
.card svg { width: 100%; height: auto; display: block; margin: .3rem 0; }
.card svg text { font-family: system-ui, sans-serif !important; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem .7rem; margin: 0; font-size: .82rem; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
.gauge { height: .4rem; border-radius: .2rem; background: var(--line); overflow: hidden; margin: .45rem 0; }
.gauge span { display: block; height: 100%; background: var(--good); }
.failed .gauge span { background: var(--bad); }
"""


def page(results: Sequence[Result], left_out: Sequence[tuple[str, str]]) -> str:
    """The whole report."""
    passed, count = sum(result.has_passed for result in results), len(results)
    verdict = "good" if passed == count else "bad"
    seconds = sum(result.seconds for result in results)
    machine = f"Boucle {boucle_core.__version__}, {platform.system()} {platform.machine()}"
    sections = []
    number = 0
    for chapter, group in groupby(results, key=lambda result: result.row.chapter):
        cards = []
        for result in group:
            cards.append(card(result, number))
            number += 1
        title = escape(CHAPTERS.get(chapter, chapter))
        sections.append(f'<h2>{title}</h2>\n<div class="cards">\n{"".join(cards)}</div>')
    missing = "".join(f"<dt>{escape(what)}</dt><dd>{escape(why)}</dd>" for what, why in left_out)
    return f"""<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Boucle: validation</title><style>{STYLE}</style></head>
<body>
<h1>Validation</h1>
<p class="{verdict}"><strong>{passed} of {count} rows hold.</strong></p>
<p class="soft">{escape(machine)}; {seconds:.0f} s. Each row stands beside a closed form, a table that this code did not
make, or a published number. Rings are results, lines are references; a bar tells how much of its tolerance an error takes.</p>
{summary(results)}
{"".join(sections)}
<h2>Not measured here</h2>
<dl>{missing}</dl>
</body>
</html>
"""


def summary(results: Sequence[Result]) -> str:
    """A table of all rows that leads to their cards."""
    heads = ("", "row", "quantity", "unit", "result", "reference", "error", "tolerance")
    lines = []
    for number, result in enumerate(results):
        kind, word = ("good", "pass") if result.has_passed else ("bad", "fail")
        name = f'<a href="#row{number}">{escape(result.row.name)}</a>'
        cells = [escape(cell) for cell in (result.row.quantity, result.row.unit, *result.cells())]
        filled = "".join(f"<td>{cell}</td>" for cell in (name, *cells))
        is_failed = "" if result.has_passed else ' class="failed"'
        lines.append(f'<tr{is_failed}><td class="{kind}">{word}</td>{filled}</tr>')
    head = "".join(f"<th>{word}</th>" for word in heads)
    return f'<div class="scroll"><table><tr>{head}</tr>\n{chr(10).join(lines)}</table></div>'


def card(result: Result, number: int) -> str:
    """One row with its plot."""
    row, has_passed = result.row, result.has_passed
    mark = '<span class="good">✓</span>' if has_passed else '<span class="bad">✗</span>'
    value, reference, error, tolerance = (escape(cell) for cell in result.cells())
    unit = f" {escape(row.unit)}" if row.unit else ""
    facts = [("quantity", escape(row.quantity))]
    if result.finding is not None:
        facts += [("result", value + unit), ("reference", reference + unit)]
        facts += [("error", f"{error} (tolerance: {tolerance})")]
        if result.finding.note:
            facts.append(("note", escape(result.finding.note)))
    else:
        facts.append(("failed", escape(result.message)))
    facts += [("source", escape(row.source)), ("test", escape(row.test))]
    facts.append(("time", f"{result.seconds:.1f} s"))
    told = "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in facts)
    picture = ""
    if result.finding is not None and result.finding.plot is not None:
        picture = svg(result.finding.plot, f"row{number}")
    failed = "" if has_passed else " failed"
    return (
        f'<article class="card{failed}" id="row{number}"><h3>{mark} {escape(row.name)}</h3>\n'
        f"{picture}\n{gauge(result)}<dl>{told}</dl></article>\n"
    )


def gauge(result: Result) -> str:
    """A bar as long as the part of the tolerance that the error takes; none for ranges."""
    tolerance = result.row.tolerance
    if result.finding is None or not isinstance(tolerance, Tolerance) or tolerance.amount == 0.0:
        return ""
    part = min(1.0, result.error / tolerance.amount)
    return f'<div class="gauge"><span style="width: {100.0 * part:.1f}%"></span></div>\n'


def write(results: Sequence[Result], left_out: Sequence[tuple[str, str]], path: Path) -> None:
    """Write the report."""
    path.write_text(page(results, left_out), encoding="utf-8")
