// Words for what lies under the pointer or was chosen.

export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  return String(Number(value.toPrecision(digits)));
}

export function percent(share, digits = 1) {
  return share === null || share === undefined ? "–" : `${(100 * share).toFixed(digits)}\u00a0%`;
}

export function degrees(radians) {
  return `${((180 / Math.PI) * radians).toFixed(1)}°`;
}

const conflictWords = {
  angle: (measured) => `the angle between them, ${degrees(measured)}, is infeasible`,
  distance: (measured) => `they are ${number(measured)} apart`,
  crossing: (measured) => `they cross or are ${number(measured)} apart`,
  nodes: (measured) => `their ends are ${number(measured)} apart`,
  rule: () => "a rule does not allow both",
};

const reasonWords = {
  conflict: "Dropped: in conflict with what was kept",
  rule: "Dropped: ruled out by what was kept",
  "short arc": "Dropped: too short an arc for this scale, collapsed or given up",
  "closed arc without three segments": "Dropped: too small a loop for three segments",
  "pinned out": "Dropped: the user asked for it",
  crumb: "Dropped: a crumb, too short a piece to stand alone",
};

// {title, facts: [text]} of polyline `line` of a layer; `level` is null for the input.
export function describe(layer, line, levels, level) {
  if (layer === "initial") return describeInitial(levels, line);
  return {
    adapted: describeAdapted,
    dropped: describeDropped,
    conflicts: describeConflict,
    singularities: describeIrregular,
  }[layer](level, line);
}

function curveText(curve) {
  return curve < 0 ? "of no initial curve" : `curve ${curve}`;
}

function describeInitial(levels, line) {
  const { curve, pinned } = levels.initial;
  return {
    title: pinned[line] ? "Initial network, pinned" : "Initial network",
    facts: [
      `arc ${line}, ${curveText(curve[line])}`,
      `length of the curve ${number(levels.model.curve_length[curve[line]])}`,
    ],
  };
}

function describeAdapted(level, line) {
  const { curve, pinned, weight } = level.adapted;
  return {
    title: pinned[line] ? "Kept: pinned segment" : "Kept segment",
    facts: [curveText(curve[line]), `weight ${number(weight[line])}`],
  };
}

function describeDropped(level, line) {
  const d = level.dropped;
  const reason = d.reasons[d.reason[line]];
  const facts = [
    `arc ${d.arc[line]}, ${curveText(d.curve[line])}, length ${number(d.length[line])}`,
    `weight ${number(d.weight[line])}, round ${d.iteration[line]}`,
  ];
  const against = d.blockers[line];
  for (const [arc, weight, conflict, measured] of against.slice(0, 4)) {
    const what = arc < 0 ? "a node" : `arc ${arc}`;
    const why = conflictWords[d.conflicts[conflict]]?.(measured) ?? d.conflicts[conflict];
    facts.push(`lost against ${what} (weight ${number(weight)}): ${why}`);
  }
  if (against.length > 4) facts.push(`and against ${against.length - 4} more`);
  if (d.margin[line] !== null)
    facts.push(`keeping it instead would cost ${number(d.margin[line])} of the objective`);
  return { title: reasonWords[reason] ?? `Dropped: ${reason}`, facts };
}

function describeConflict(level, line) {
  const c = level.conflicts;
  const kind = c.names[c.kind[line]];
  const side = (k) => {
    const fate = c.kept[line] & (1 << k) ? "kept" : "not kept";
    return `arc ${c.arcs[line][k]}, weight ${number(c.weights[line][k])}, ${fate}`;
  };
  return {
    title: `Conflict (${kind})`,
    facts: [
      `at most one of two segments: ${conflictWords[kind]?.(c.measured[line]) ?? kind}`,
      side(0),
      side(1),
    ],
  };
}

function describeIrregular(level, k) {
  const count = level.singularities.valence[k];
  const sign = count < 4 ? "+" : "−";
  return {
    title: `Irregular vertex of index ${sign}${quarters(Math.abs(4 - count))}`,
    facts: [`${count} quads meet here instead of four`],
  };
}

function quarters(count) {
  return count % 4 === 0 ? String(count / 4) : count % 2 === 0 ? `${count / 2}/2` : `${count}/4`;
}

// The line under a pane's name.
export function meshFacts(mesh, isInput) {
  const isOfQuads = mesh.quality?.mean_scaled_jacobian !== undefined;
  const shown =
    isOfQuads && mesh.sides !== 4
      ? ` (${mesh.shown.toLocaleString("en")} triangles shown)`
      : mesh.shown < mesh.faces
        ? ` (${mesh.shown.toLocaleString("en")} shown)`
        : "";
  const facts = [`${mesh.faces.toLocaleString("en")} ${isOfQuads ? "quads" : "triangles"}${shown}`];
  if (isOfQuads)
    facts.push(
      `scaled Jacobian ${mesh.quality.mean_scaled_jacobian.toFixed(3)} on average`,
      `${mesh.quality.min_scaled_jacobian.toFixed(3)} at least`,
      `irregular: ${percent(mesh.quality.irregular)}`,
    );
  else if (mesh.quality && !isInput)
    facts.push(
      `smallest angle ${mesh.quality.min_angle.toFixed(1)}°`,
      `under 15°: ${percent(mesh.quality.under_15, 2)}`,
      `under 30°: ${percent(mesh.quality.under_30, 2)}`,
    );
  return facts.map((fact) => fact.replaceAll(" ", "\u00a0")).join(" · ");
}
