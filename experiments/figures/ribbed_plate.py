"""A plate whose upper side is a row of roofs: ribs with sharp ridges, `period` apart, `height` high."""


def ribbed_plate(path, count=16, period=0.09, height=0.03, width=0.8, depth=0.25, pieces=4):
    """Writes OFF, closed, `pieces` triangles' edges to a slope; the ribs run along y from 0 to `width`."""
    profile = []  # x, z of the upper side
    for slope in range(2 * count):
        for piece in range(pieces):
            share = piece / pieces
            profile.append(((slope + share) * period / 2, height * (share if slope % 2 == 0 else 1 - share)))
    profile.append((count * period, 0.0))
    step = period / 2 / pieces * 1.5
    rows = [width * k / round(width / step) for k in range(round(width / step) + 1)]
    levels = [depth * k / round(depth / step) for k in range(round(depth / step) + 1)]
    # Each sheet is a grid of points; grids share their borders.
    points, number = [], {}

    def vertex(*p):
        key = tuple(round(c, 9) for c in p)
        if key not in number:
            number[key] = len(points)
            points.append(key)
        return number[key]

    triangles = []

    def sheet(grid):
        for below, above in zip(grid, grid[1:]):
            for a, b, c, d in zip(below, below[1:], above[1:], above):
                triangles.extend([(a, b, c), (a, c, d)])

    sheet([[vertex(x, y, z) for x, z in profile] for y in rows])
    sheet([[vertex(x, y, -depth) for x, _ in reversed(profile)] for y in rows])

    def wall(line):  # from the upper border down
        return [[vertex(x, y, z - share / depth * (z + depth)) for x, y, z in line] for share in levels]

    sheet(wall([(x, 0.0, z) for x, z in profile])[::-1])
    sheet(wall([(x, width, z) for x, z in reversed(profile)])[::-1])
    sheet(wall([(profile[-1][0], y, 0.0) for y in rows])[::-1])
    sheet(wall([(0.0, y, 0.0) for y in reversed(rows)])[::-1])
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        file.writelines(" ".join(map(str, p)) + "\n" for p in points)
        file.writelines(f"3 {a} {b} {c}\n" for a, b, c in triangles)
