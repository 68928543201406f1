"""Line plots as SVG: panels one beside the other, a logarithmic x axis, one colour and marker a line."""

from html import escape

COLORS = ["#d55e00", "#5c6470", "#0064b0", "#009e73"]  # after Okabe and Ito
PANEL, HEIGHT, LEFT, TOP, BOTTOM = 330, 230, 52, 34, 44
WIDTH = PANEL - LEFT - 16


def nice_step(span, count=5):
    """A step of 1, 2 or 5 times a power of ten that cuts the span into about `count` pieces."""
    raw, power = span / count, 1.0
    while power * 10 <= raw:
        power *= 10
    while power > raw:
        power /= 10
    return next(power * k for k in (1, 2, 5, 10) if power * k >= raw)


def text_of(value):
    return f"{value:g}"


def marker(kind, x, y, color):
    if kind == 0:
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>'
    if kind == 1:
        return f'<rect x="{x - 2.8:.1f}" y="{y - 2.8:.1f}" width="5.6" height="5.6" fill="{color}"/>'
    return f'<path d="M{x:.1f} {y - 3.8:.1f}l3.6 6.4h-7.2z" fill="{color}"/>'


def panel(title, xs, lines, left, top):
    """One plot; None among the values leaves a gap."""
    from math import log

    known = [value for line in lines for value in line if value is not None]
    step = nice_step(max(known) or 1)
    ceiling = step * -(-max(known) // step) or 1
    at_x = lambda x: left + WIDTH * log(x / xs[0]) / log(xs[-1] / xs[0])
    at_y = lambda y: top + HEIGHT * (1 - y / ceiling)
    parts = [f'<text x="{left}" y="{top - 10}" class="title">{escape(title)}</text>']
    for k in range(int(ceiling / step + 0.5) + 1):
        y = at_y(k * step)
        parts.append(f'<path d="M{left} {y:.1f}h{WIDTH}" class="grid"/>')
        parts.append(f'<text x="{left - 6}" y="{y + 4:.1f}" class="right">{text_of(k * step)}</text>')
    for x in (0.05, 0.1, 0.2, 0.5, 1, 2):
        if xs[0] <= x <= xs[-1]:
            parts.append(f'<path d="M{at_x(x):.1f} {top}v{HEIGHT}" class="grid"/>')
            parts.append(f'<text x="{at_x(x):.1f}" y="{top + HEIGHT + 16}" class="middle">{text_of(x)}</text>')
    for number, line in enumerate(lines):
        color, path, pen = COLORS[number], "", "M"
        for x, value in zip(xs, line):
            if value is None:
                pen = "M"
                continue
            path += f"{pen}{at_x(x):.1f} {at_y(value):.1f}"
            pen = "L"
        parts.append(f'<path d="{path}" fill="none" stroke="{color}" stroke-width="1.8"/>')
        parts += [marker(number, at_x(x), at_y(v), color) for x, v in zip(xs, line) if v is not None]
    return parts


def line_plot(x_title, xs, names, panels):
    """`panels`: (title, one list of values for each name), two in a row."""
    row_height = TOP + HEIGHT + BOTTOM
    rows = (len(panels) + 1) // 2
    width, height = 2 * PANEL + 12, rows * row_height + 34
    parts = []
    for number, (title, lines) in enumerate(panels):
        left, top = LEFT + PANEL * (number % 2), TOP + row_height * (number // 2)
        parts += panel(title, xs, lines, left, top)
        parts.append(f'<text x="{left + WIDTH / 2}" y="{top + HEIGHT + 34}" class="middle">{escape(x_title)}</text>')
    x = LEFT
    for number, name in enumerate(names):
        parts.append(marker(number, x, height - 16, COLORS[number]))
        parts.append(f'<text x="{x + 9}" y="{height - 12}">{escape(name)}</text>')
        x += 24 + 6.6 * len(name)
    style = ("text{font:12px sans-serif;fill:#222}.title{font-weight:bold}.right{text-anchor:end}"
             ".middle{text-anchor:middle}.grid{stroke:#dde1e6;stroke-width:1}")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
            f'height="{height}"><style>{style}</style><rect width="{width}" height="{height}" fill="#fff"/>'
            + "\n".join(parts) + "</svg>\n")
