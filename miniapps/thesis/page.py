"""The page: one file without anything from elsewhere, to be read on a screen or printed."""

import base64
import html
import io
import re
import shlex

from figures import plot, plt

SYMBOL = plot.SYMBOL

STYLE = """
:root { --ink: #1a1a1a; --soft: #5a5a5a; --line: #d5d5d5; --paper: #fff; --wash: #f5f5f2; --warn: #a33b00; }
* { box-sizing: border-box; }
body { font: 16px/1.55 Georgia, "DejaVu Serif", serif; color: var(--ink); background: var(--paper); margin: 0 auto;
       max-width: 62rem; padding: 2rem 1.5rem 4rem; }
h1, h2, h3, nav, table, .made { font-family: "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; margin: 0 0 .3rem; } h2 { margin-top: 3.5rem; border-top: 3px solid var(--ink); padding-top: .6rem; }
h3 { font-size: 1.08rem; margin: 0 0 .4rem; } a { color: #0b5394; }
nav { columns: 2; font-size: .82rem; line-height: 1.45; background: var(--wash); padding: 1rem 1.2rem; margin: 1.5rem 0; }
nav ul { list-style: none; margin: 0 0 .7rem; padding: 0; } nav b { break-after: avoid; }
section { margin: 2.4rem 0; } figure { margin: .8rem 0; text-align: center; } figure img { max-width: 100%; height: auto; }
code { font: .84em/1.4 "DejaVu Sans Mono", Consolas, monospace; background: var(--wash); padding: .05em .3em; overflow-wrap: anywhere; }
.made { font-size: .82rem; color: var(--soft); } .made code { color: var(--ink); }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .82rem; margin: .6rem 0; width: 100%; }
th, td { padding: .22rem .6rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; white-space: normal; } th { color: var(--soft); font-weight: 600; }
.plain td { white-space: normal; }
.outside { color: var(--warn); font-weight: 600; }
.wrong { border-left: 4px solid var(--warn); padding: .1rem 0 .1rem .9rem; margin: .8rem 0; }
.missing { border: 1px dashed var(--soft); padding: .6rem .9rem; color: var(--soft); }
@media (max-width: 600px) { nav { columns: 1; } figure { overflow-x: auto; text-align: left; } figure img { max-width: none; width: 36rem; }
  figure::before, .scroll::before { content: "Scroll sideways →"; font: .75rem sans-serif; color: var(--warn); display: block; position: sticky; left: 0; } .plain td { min-width: 5.5em; } }
@media print { body { max-width: none; padding: 0; font-size: 10.5pt; } section { break-inside: avoid; }
  .scroll { overflow: visible; } h2 { break-before: auto; } h2, h3 { break-after: avoid; } a { color: inherit; text-decoration: none; }
  figure img { max-height: 8.6cm; width: auto; } section { margin: 1.2rem 0; } @page { size: A4; margin: 16mm 15mm; } }
"""


def set_symbols(text):
    """K_N with its index below; code stays as it is."""
    parts = re.split(r"(<code>.*?</code>)", text)
    parts[::2] = [SYMBOL.sub(r"\1\2<sub>\3</sub>", part) for part in parts[::2]]
    return "".join(parts)


def prose(text):
    """Paragraphs; `code`, *emphasis* and symbols in them."""
    done = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        one = html.escape(" ".join(paragraph.split()), quote=False)
        one = re.sub(r"`([^`]+)`", r"<code>\1</code>", one)
        done.append("<p>" + set_symbols(re.sub(r"\*([^*]+)\*", r"<em>\1</em>", one)) + "</p>")
    return "\n".join(done)


def anchor(number):
    return "f" + re.sub(r"\W+", "-", number).strip("-")


def picture(figure, words):
    """An image in the page itself."""
    text = io.StringIO()
    figure.tight_layout()
    figure.savefig(text, format="svg", metadata={"Date": None})
    kind, data = "svg+xml", text.getvalue().encode()
    if len(data) > 400_000:  # fields of colour are smaller as pixels
        pixels = io.BytesIO()
        figure.savefig(pixels, format="png", dpi=180)
        kind, data = "png", pixels.getvalue()
    plt.close(figure)
    size = " ".join(f'{name}="{96 * inches:.0f}"' for name, inches in zip(("width", "height"), figure.get_size_inches()))
    return f'<figure><img {size} alt="{html.escape(words)}" src="data:image/{kind};base64,{base64.b64encode(data).decode()}"></figure>'


def number(value, form="{:.5g}"):
    return "–" if value is None else form.format(value)


def verdict(row):
    """Only what is outside of the ± of reference and mesh is marked."""
    if row["reference"] is None or row["computed"] is None:
        return "outside of its ±" if row["outside"] else ""
    off = abs(row["computed"] - row["reference"])
    return "" if off <= max(row["spread"] or 0, row["tolerance"] or 0) else "outside of its ±"


def comparison(rows):
    """reference | its ± (estimate) | thesis | computed | difference, of the runs' own tables."""
    head = "".join(f"<th>{name}</th>" for name in ("quantity", "reference", "its ± (estimate)", "thesis", "computed", "difference", ""))
    body = ""
    for row in rows:
        known = row["reference"] is not None and row["computed"] is not None
        cells = [set_symbols(html.escape(row["quantity"])), number(row["reference"]), number(row["spread"], "{:.2g}"), number(row["thesis"], "{:.4g}"),
                 number(row["computed"]), number(row["computed"] - row["reference"] if known else None, "{:+.2g}"),
                 f'<span class="outside">{verdict(row)}</span>']
        body += "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>\n"
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>'


def section(figure, runs, fault):
    """One figure; `runs` those of its commands, `fault` why it is not there."""
    parts = [f'<section id="{anchor(figure.number)}"><h3>{figure.name}: {set_symbols(html.escape(figure.title))}</h3>']
    fault = fault or figure.missing
    if figure.text:
        parts.append(prose(figure.text))
    if not fault:
        try:
            drawn = figure.draw(*runs)
            parts.append(drawn if isinstance(drawn, str) else picture(drawn, f"{figure.name}: {figure.title}"))
        except Exception as error:  # a page with one figure less is better than none
            fault = f"it could not be drawn: {type(error).__name__}: {error}"
            plt.close("all")
    if fault:
        parts.append(f'<p class="missing">Missing: {html.escape(fault)}</p>')
    if figure.commands:
        seconds = sum(run.seconds for run in runs)
        lines = "<br>".join(f"<code>./run {html.escape(command)}</code>" for command in figure.commands)
        parts.append(f'<p class="made">Alone: <code>./run thesis {html.escape(shlex.quote(figure.number))}</code>; its numbers '
                     f'({seconds:.1f} s), with <code>--csv</code> or <code>--plot</code>:<br>{lines}</p>')
    rows = figure.comparisons(runs) if not fault else []
    if rows:
        parts.append(comparison(rows))
    if figure.wrong and not fault:
        command = figure.proof if figure.proof.startswith("./") else "./run " + figure.proof
        proof = f' Proven by <code>{html.escape(command)}</code>.' if figure.proof else ""
        parts.append('<div class="wrong">' + prose("*Where the thesis differs.* " + figure.wrong)[:-4] + proof + "</p></div>")
    return "\n".join(parts) + "</section>", fault


def page(chapters, found, heading, about):
    """The whole; `found(figure)` gives the runs of a figure and why there are none. Returns the page and the faults."""
    body, index, faults = [], [], []
    for chapter in chapters:
        body.append(f'<h2 id="c{chapter.number}">Chapter {chapter.number}: {html.escape(chapter.title)}</h2>\n' + prose(chapter.text))
        index.append(f'<b><a href="#c{chapter.number}">{chapter.number} {html.escape(chapter.title)}</a></b><ul>')
        for figure in chapter.figures:
            text, fault = section(figure, *found(figure))
            body.append(text)
            faults += [(figure, fault)] if fault else []
            index.append(f'<li><a href="#{anchor(figure.number)}">{figure.number}</a> {html.escape(figure.title)}'
                         + (" <em>(missing)</em>" if fault else "") + "</li>")
        index.append("</ul>")
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{html.escape(heading)}</title><style>{STYLE}</style></head><body>\n<h1>{html.escape(heading)}</h1>\n"
            + prose(about) + "\n<nav>" + "\n".join(index) + "</nav>\n" + "\n".join(body) + "\n</body></html>\n", faults)
