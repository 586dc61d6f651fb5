# SPDX-License-Identifier: Apache-2.0
"""One self-contained page a group of figures: text, tables, plots as SVG; its tables as CSV and
Markdown too."""

import csv
import html
import math
import os

COLOURS = ("#1f6fb2", "#c8501e", "#2f8f4e", "#8a4fa3", "#8c6d1f", "#3aa6a6", "#b03060", "#606060")

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem;
       color: #222; background: #fff; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
table { border-collapse: collapse; margin: .8rem 0; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .7rem; border-bottom: 1px solid #ddd; text-align: right; }
th:first-child, td:first-child { text-align: left; }
figure { margin: 1rem 0; } figcaption { color: #555; font-size: .9rem; }
.plots { display: flex; flex-wrap: wrap; gap: 1rem; }
"""


def ticks(low, high, about=5):
    """Round numbers within [low, high]."""
    span = high - low
    if not span > 0:
        return [low]
    step = 10 ** math.floor(math.log10(span / about))
    step *= next(m for m in (1, 2, 5, 10) if span / (step * m) <= about + 1)
    first = math.ceil(low / step - 1e-9) * step
    return [first + i * step for i in range(int((high - first) / step + 1e-9) + 1)]


def line_plot(caption, series, x_label, y_label, width=460, height=260, y_range=None, dots=False):
    """SVG of curves: series of (label, xs, ys); gaps where y is not a number."""
    left, right, top, bottom = 52, 12, 14 + 15 * ((len(series) + 1) // 2), 38
    points = [(x, y) for _, xs, ys in series for x, y in zip(xs, ys)
              if y is not None and math.isfinite(y)]
    if not points:
        return f"<figure><figcaption>{html.escape(caption)}: nothing to show</figcaption></figure>"
    x_low, x_high = min(p[0] for p in points), max(p[0] for p in points)
    y_low, y_high = y_range or (min(p[1] for p in points), max(p[1] for p in points))
    if y_high <= y_low:
        y_low, y_high = y_low - 0.5, y_high + 0.5
    if not y_range:
        y_low, y_high = y_low - 0.04 * (y_high - y_low), y_high + 0.04 * (y_high - y_low)
    x_high = x_high if x_high > x_low else x_low + 1

    def place(x, y):
        return (left + (x - x_low) / (x_high - x_low) * (width - left - right),
                height - bottom - (min(max(y, y_low), y_high) - y_low) / (y_high - y_low)
                * (height - top - bottom))

    out = [f'<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
           'font-size="11" font-family="system-ui, sans-serif">']
    for t in ticks(y_low, y_high):
        _, y = place(x_low, t)
        out.append(f'<line x1="{left}" x2="{width - right}" y1="{y:.1f}" y2="{y:.1f}" '
                   f'stroke="#e4e4e4"/><text x="{left - 6}" y="{y + 4:.1f}" '
                   f'text-anchor="end">{t:g}</text>')
    for t in ticks(x_low, x_high):
        x, _ = place(t, y_low)
        out.append(f'<text x="{x:.1f}" y="{height - bottom + 15}" '
                   f'text-anchor="middle">{t:g}</text>')
    for i, (label, xs, ys) in enumerate(series):
        colour = COLOURS[i % len(COLOURS)]
        stretch = []
        stretches = [stretch]
        for x, y in zip(xs, ys):
            if y is None or not math.isfinite(y):
                stretch = []
                stretches.append(stretch)
            else:
                stretch.append("{:.1f},{:.1f}".format(*place(x, y)))
        for stretch in stretches:
            if dots:
                out += [f'<circle cx="{p.split(",")[0]}" cy="{p.split(",")[1]}" r="2.4" '
                        f'fill="{colour}"/>' for p in stretch]
            if len(stretch) > 1:
                out.append(f'<polyline points="{" ".join(stretch)}" fill="none" '
                           f'stroke="{colour}" stroke-width="1.4"/>')
        x, y = left + (i % 2) * (width - left) / 2, 12 + 15 * (i // 2)
        out.append(f'<rect x="{x}" y="{y - 8}" width="10" height="10" fill="{colour}"/>'
                   f'<text x="{x + 15}" y="{y + 1}">{html.escape(label)}</text>')
    out.append(f'<text x="{(left + width) / 2}" y="{height - 6}" text-anchor="middle">'
               f'{html.escape(x_label)}</text><text transform="translate(12 {height / 2}) '
               f'rotate(-90)" text-anchor="middle">{html.escape(y_label)}</text></svg>')
    return (f"<figure>{''.join(out)}<figcaption>{html.escape(caption)}</figcaption></figure>")


def overlay(caption, width, height, pixels, outlines, scale=2):
    """SVG of an image of events, {(x, y): colour}, and closed outlines over it."""
    out = [f'<svg viewBox="-0.5 -0.5 {width} {height}" width="{width * scale}" '
           f'height="{height * scale}" style="background:#f4f4f2">']
    out += [f'<rect x="{x - .5}" y="{y - .5}" width="1" height="1" fill="{c}"/>'
            for (x, y), c in pixels.items()]
    for i, (label, lines) in enumerate(outlines):
        colour = COLOURS[i % len(COLOURS)]
        for line in lines:
            text = " ".join(f"{x:.1f},{y:.1f}" for x, y in line)
            out.append(f'<polyline points="{text}" fill="none" stroke="{colour}" '
                       'stroke-width="0.7"/>')
        out.append(f'<text x="4" y="{9 + 9 * i}" font-size="8" fill="{colour}">'
                   f'{html.escape(label)}</text>')
    return f"<figure>{''.join(out)}</svg><figcaption>{html.escape(caption)}</figcaption></figure>"


class Page:
    def __init__(self, name, title):
        self.name = name
        self.title = title
        self.body = []
        self.markdown = []
        self.tables = []

    def text(self, words):
        self.body.append(f"<p>{html.escape(words)}</p>")
        self.markdown.append(words + "\n")

    def heading(self, words):
        self.body.append(f"<h2>{html.escape(words)}</h2>")
        self.markdown.append(f"#### {words}\n")

    def table(self, header, rows):
        self.tables.append((header, rows))
        cells = "".join(f"<th>{html.escape(str(h))}</th>" for h in header)
        lines = "".join("<tr>" + "".join(f"<td>{html.escape(str(c))}</td>" for c in row) + "</tr>"
                        for row in rows)
        self.body.append(f"<table><tr>{cells}</tr>{lines}</table>")
        self.markdown.append("\n".join(
            ["| " + " | ".join(map(str, header)) + " |",
             "|" + "|".join(["---"] + ["--:"] * (len(header) - 1)) + "|"] +
            ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n")

    def plots(self, *figures):
        self.body.append(f'<div class="plots">{"".join(figures)}</div>')

    def write(self, folder):
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, self.name + ".html"), "w") as file:
            file.write(f'<!doctype html><html lang="en"><meta charset="utf-8"><title>'
                       f'{html.escape(self.title)}</title><style>{STYLE}</style>'
                       f'<h1>{html.escape(self.title)}</h1>{"".join(self.body)}</html>\n')
        with open(os.path.join(folder, self.name + ".csv"), "w", newline="") as file:
            writer = csv.writer(file)
            for header, rows in self.tables:
                writer.writerow(header)
                writer.writerows(rows)
                writer.writerow([])
        with open(os.path.join(folder, self.name + ".md"), "w") as file:
            file.write(f"### {self.title}\n\n" + "\n".join(self.markdown))
