"""Ribs of a mesh, counted: peaks of the upper envelope z(x) along lines of constant y."""

SAMPLES = 600


def read_obj(path):
    points, faces = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                points.append(tuple(map(float, words[1:4])))
            elif words[:1] == ["f"]:
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return points, faces


def slice_at(points, faces, y):
    """Where the plane of this y cuts the faces, each a fan of triangles: pieces of (x, z)."""
    pieces = []
    for face in faces:
        for k in range(1, len(face) - 1):
            corners = [points[face[0]], points[face[k]], points[face[k + 1]]]
            cut = []
            for p, q in zip(corners, corners[1:] + corners[:1]):
                if (p[1] < y) != (q[1] < y):
                    t = (y - p[1]) / (q[1] - p[1])
                    cut.append((p[0] + t * (q[0] - p[0]), p[2] + t * (q[2] - p[2])))
            if len(cut) == 2:
                pieces.append(sorted(cut))
    return pieces


def envelope(pieces, left, right):
    heights = [None] * (SAMPLES + 1)
    step = (right - left) / SAMPLES
    for (x0, z0), (x1, z1) in pieces:
        for i in range(max(0, int((x0 - left) / step)), min(SAMPLES, int((x1 - left) / step) + 1) + 1):
            x = left + i * step
            if x0 <= x <= x1 and x1 > x0:
                z = z0 + (x - x0) / (x1 - x0) * (z1 - z0)
                heights[i] = z if heights[i] is None else max(z, heights[i])
    return [z for z in heights if z is not None]


def peaks(heights, least):
    """Prominences of the peaks that stand out by at least `least`."""
    found, base, top, is_rising = [], heights[0], heights[0], True
    for z in heights[1:]:
        if is_rising:
            top = max(top, z)
            if top - z >= least:
                if top - base >= least:
                    found.append(top - base)
                base, is_rising = z, False
        else:
            base = min(base, z)
            if z - base >= least:
                top, is_rising = z, True
    return found


def count_ribs(path, height, least=0.06, lines=9):
    """Medians over lines across the middle half: the number of peaks that stand out by the share `least` of `height`, and
    how high they rise on the average, in `height`."""
    points, faces = read_obj(path)
    low, high = ([pick(p[axis] for p in points) for axis in range(3)] for pick in (min, max))
    margin = 0.06 * (high[0] - low[0])  # the ends may be round
    counts, rises = [], []
    for k in range(lines):
        y = low[1] + (high[1] - low[1]) * (0.25 + 0.5 * (k + 0.437) / lines)
        found = peaks(envelope(slice_at(points, faces, y), low[0] + margin, high[0] - margin), least * height)
        counts.append(len(found))
        rises.append(sum(found) / len(found) / height if found else 0)
    return sorted(counts)[lines // 2], sorted(rises)[lines // 2]
